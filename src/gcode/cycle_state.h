/* cycle_state - canned cycles as far as they are in a program. */
#ifndef CYCLE_STATE_H
#define CYCLE_STATE_H

#include <stdbool.h>
#include <stdint.h>

#include "axis_count.h"

/* Heights are program coordinates along the normal of the plane. */
struct cycle {
    bool    to_r;               /* G99 */
    int32_t code;               /* ten times the cycle whose words are kept, 0 none */
    double  r, depth;           /* [mm] as programmed: coordinates, or with G91 ways */
    double  peck;               /* [mm] Q */
    double  dwell;              /* [s] P */
    double  aside[2];       /* [mm] of G87: I J K of the plane, ways from the hole, */
    double  bore;           /* [mm] and that of the normal, as programmed */
    double  initial;            /* [mm] height before the first of the series */
    bool    running;            /* commands of the latest block are still to be made: */
    int32_t step;               /* the next one in the list of the cycle */
    int32_t repeats;            /* holes after this one */
    double  hole[AXES], way[2]; /* [mm] program coordinates, way in the plane to the next one */
    double  top, bottom, clear; /* [mm] heights of R, the hole's end, the way to the next hole */
    double  bored;          /* [mm] height to which G87 bores back */
    double  pecked;             /* [mm] height drilled to */
    double  feed;               /* [mm/s] */
    int32_t turning;            /* of the spindle before the cycle */
    uint32_t overrides;         /* in force before it */
    int32_t stop;               /* ten times M0 .. M30 of the block, or GCODE_ABSENT */
    int64_t offset;             /* [byte] where its line begins in the program, */
    int32_t at, length;         /* and the line without blanks at its ends */
};

#endif
