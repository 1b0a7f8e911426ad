/* bow - how far a part of a curve reaches, whose second derivative has a bound. */
#ifndef BOW_H
#define BOW_H

#include "axis_count.h"

/* An extent may be told by so much too little: far below a pulse. [mm] */
#define BOW_NEAR 1e-6

struct bow {
    void (*place)(const void *curve, double s, double place[AXES]); /* [mm] */
    const void *curve;
    double bend; /* [1/mm] most of the second derivative of an axis */
};

/* Widen bounds by the part between two places; by up to BOW_NEAR less. */
void bow_widen(const struct bow *w, double from, double to, double low[AXES], double high[AXES]);

#endif
