/* words - what is in force of coordinate systems, scaling, rotation, polar words and feed. */
#ifndef WORDS_H
#define WORDS_H

#include <stdbool.h>
#include <stdint.h>

#include "axis_count.h"

enum {
    INTERPRETER_SYSTEMS = 9, /* G54 .. G59, G59.1, G59.2, G59.3 */
    INTERPRETER_MORE = 99,   /* G54.1 P1 .. */
    INTERPRETER_ALL = INTERPRETER_SYSTEMS + INTERPRETER_MORE
};

struct words {
    double turn[INTERPRETER_SYSTEMS]; /* [deg] of each system about its origin: R of G10 L2 */
    double park[2][AXES];             /* [mm] of G28, G30, machine coordinates */
    bool scaled;                      /* G51: */
    double factor[3];                 /* of X Y Z, negative: mirrored */
    double centre[3];                 /* [mm] program coordinates */
    bool rotated;                     /* G68: */
    int32_t plane;                    /* enum path_plane */
    double angle;                     /* [deg] counter-clockwise */
    double about[2];                  /* [mm] in the plane's axes, program coordinates */
    bool polar;                       /* G16: */
    double pole[2];                   /* [mm] program coordinates of the plane's axes */
    double radius, azimuth;           /* [mm], [deg] of the point about the pole */
    int32_t feed_mode;                /* 930 G93, 940 G94, 950 G95 */
    double per_turn;                  /* [mm] of G95; 0 none yet */
    bool spline;                      /* the motion before was a G5, whose end leads on by: */
    double onward[3];                 /* [mm] as a way of the machine */
};

#endif
