/* cutter_state - cutter compensation as far as it is in a program. */
#ifndef CUTTER_STATE_H
#define CUTTER_STATE_H

#include "command.h"

/* Commands that may stand between two motions in the plane, those two and a corner with them. */
enum { CUTTER_HELD = 24 };

/* A line of the program without blanks at its ends. */
struct cutter_line {
    int64_t offset;         /* [byte] where it begins in the program */
    int32_t line, at, length;
};

struct cutter {
    int32_t side;           /* 1: left of the contour (G41), -1: right (G42), 0: off */
    double  edge;           /* [mm] of the centre to the left of the contour; 0: nothing to do */
    enum path_plane plane;      /* in which it went on */
    bool    straight;       /* the next motion in the plane may not be an arc: G40 was before it */
    bool    enters;         /* the motion held is the first one */
    bool    moves;          /* a motion in the plane is held, the first one behind those ready: */
    double  from[2];        /* [mm] where the centre begins it */
    struct cutter_line latest, moving;  /* the line read last, and that of the motion held */
    int32_t first, ready, count;    /* in held: the oldest, those to hand out, all */
    struct command held[CUTTER_HELD];
};

#endif
