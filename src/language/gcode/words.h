/* words - the part of the interpreter's state that turns, scales and measures coordinates: turn of
 * the systems, points of G28 and G30, scaling, rotation, polar words; and the mode of the feed. */
#ifndef WORDS_H
#define WORDS_H

#include <stdbool.h>
#include <stdint.h>

#include "axis_count.h"

enum {
    INTERPRETER_SYSTEMS = 9, /* G54 .. G59, G59.1, G59.2, G59.3 */
    INTERPRETER_MORE = 99,   /* G54.1 P1 .. P99 */
    INTERPRETER_ALL = INTERPRETER_SYSTEMS + INTERPRETER_MORE
};

struct words {
    double turn[INTERPRETER_SYSTEMS]; /* [deg] of each system about its origin: R of G10 L2 */
    double park[2][AXES];             /* [mm], [deg] points of G28, G30, machine coordinates */
    bool scaled;                      /* G51 is in force */
    double factor[3];                 /* of X Y Z; negative: mirrored */
    double centre[3];                 /* [mm] centre of the scaling, program coordinates */
    bool rotated;                     /* G68 is in force */
    int32_t plane;                    /* enum path_plane of the rotation */
    double angle;                     /* [deg] of the rotation, counter-clockwise */
    double about[2];        /* [mm] its centre along the plane's axes, program coordinates */
    bool polar;             /* G16 is in force */
    double pole[2];         /* [mm] pole along the plane's axes, program coordinates */
    double radius, azimuth; /* [mm], [deg] of the programmed point about the pole */
    int32_t feed_mode;      /* 930 G93, 940 G94, 950 G95 */
    double per_turn;        /* [mm per turn] F of G95; 0: none yet */
    bool spline;            /* the motion in front was a G5, which `onward` continues */
    double onward[3];       /* [mm] to the next first control point, machine axes */
};

#endif
