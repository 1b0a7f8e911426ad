#include "bow.h"

#include <math.h>
#include <stdbool.h>

#include "el_extremes.h"

/* Widen by halves until nothing in a part leaves the places known by more than BOW_NEAR. */
static void widen(const struct bow *w, double s0, const double p0[AXES], double s1,
                  const double p1[AXES], double low[AXES], double high[AXES])
{
    const double strays = 0.125 * w->bend * (s1 - s0) * (s1 - s0);
    bool inside = true;

    for (int k = 0; k < AXES; k++) {
        low[k] = el_min(low[k], el_min(p0[k], p1[k]));
        high[k] = el_max(high[k], el_max(p0[k], p1[k]));
        inside = inside && el_min(p0[k], p1[k]) - strays >= low[k] - BOW_NEAR
                 && el_max(p0[k], p1[k]) + strays <= high[k] + BOW_NEAR;
    }
    if (!inside && s1 - s0 > BOW_NEAR) {
        const double s = 0.5 * (s0 + s1);
        double p[AXES];
        w->place(w->curve, s, p);
        widen(w, s0, p0, s, p, low, high);
        widen(w, s, p, s1, p1, low, high);
    }
}

void bow_widen(const struct bow *w, double from, double to, double low[AXES], double high[AXES])
{
    double first[AXES], last[AXES];

    w->place(w->curve, from, first);
    w->place(w->curve, to, last);
    widen(w, from, first, to, last, low, high);
}
