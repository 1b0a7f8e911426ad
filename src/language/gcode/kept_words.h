/* kept_words - what a program has in force from one block to the next beside its modes: canned
 * cycles, cutter compensation, rounded corners, NURBS. */
#ifndef KEPT_WORDS_H
#define KEPT_WORDS_H

#include <stdbool.h>
#include <stdint.h>

#include "command.h"

/* A line of a text without blanks at its ends: what becomes of it later is told there. */
struct kept_line {
    int64_t offset; /* [byte] where it begins in its text, */
    int32_t file;   /* 0 the program, else a file that it calls */
    int32_t line, at, length;
};

enum cycle_polar {
    CYCLE_STRAIGHT,
    CYCLE_POLE, /* @ and ^ about the zero of X and Y */
    CYCLE_POLAR /* G16 */
};

/* From one hole of a line to the next. */
struct cycle_way {
    enum cycle_polar polar;
    bool about;      /* G16: about the hole itself, for a radius is named */
    double plane[2]; /* [mm] a way in it; [mm], [deg] by which radius and angle grow */
};

/* Heights are program coordinates along the normal of the plane. */
struct cycle {
    bool to_r;                 /* G99 */
    int32_t code;              /* ten times the cycle whose words are kept, 0 none */
    double r, depth;           /* [mm] as programmed: coordinates, or with G91 ways */
    double peck;               /* [mm] Q */
    double dwell;              /* [s] P */
    double aside[2];           /* [mm] of G87: I J K of the plane, ways from the hole, */
    double bore;               /* [mm] and that of the normal, as programmed */
    double initial;            /* [mm] height before the series, from which R of G91 counts */
    bool running;              /* commands of the latest block are still to be made: */
    int32_t step;              /* the next one in the list of the cycle */
    int32_t repeats;           /* holes after this one */
    double hole[AXES];         /* [mm] program coordinates, */
    struct cycle_way way;      /* and what leads to the next one */
    double top, bottom, clear; /* [mm] heights of R, the hole's end, the way to the next hole */
    double bored;              /* [mm] height to which G87 bores back */
    double pecked;             /* [mm] height drilled to */
    double feed;               /* [mm/s] */
    int32_t turning;           /* of the spindle before the cycle */
    uint32_t overrides;        /* in force before it */
    int32_t stop;              /* code (M times ten) that stops behind it, or GCODE_ABSENT */
    struct kept_line line;     /* of the block */
};

/* Commands that may stand between two motions in the plane, those two and a corner with them. */
enum { CUTTER_HELD = 24 };

struct cutter {
    int32_t side;          /* 1: left of the contour (G41), -1: right (G42), 0: off */
    double edge;           /* [mm] of the centre to the left of the contour; 0: nothing to do */
    enum path_plane plane; /* in which it went on */
    bool straight;         /* the next motion in the plane may not be an arc: G40 was before it */
    bool aside;            /* since then the tool stands at `from`, beside where it ended: */
    double left[2];        /* [mm] the end of the contour */
    bool enters;           /* the motion held is the first one */
    bool concave;          /* a concave corner is in front of it */
    bool moves;            /* held[ready] is a motion in the plane, whose end is not known yet */
    double from[2];        /* [mm] where the centre begins it, or is */
    struct kept_line latest, moving; /* the line read last, and that of the motion held */
    int32_t first, ready, count;     /* in held: the oldest, those to hand out, all */
    struct command held[CUTTER_HELD];
};

/* ,C and ,R of Fanuc's controls. */
struct rounding {
    bool waits;     /* a motion waits for the next one, */
    bool fresh;     /* of the line read last, */
    int32_t before; /* commands of that in front of it */
    bool chamfer;   /* ,C, else ,R */
    double size;    /* [mm] */
    enum path_plane plane;
    struct kept_line line;
    struct command held; /* the motion, whole */
};

/* NURBS between G5.2 and G5.3. */
enum {
    NURBS_ORDER = 10, /* highest L */
    NURBS_WINDOW = 2 * NURBS_ORDER
};

struct nurbs {
    int32_t count;                 /* points so far; 0: none is being read */
    int32_t order;                 /* L: one more than the degree */
    enum path_plane plane;         /* in which G5.2 has begun the curve */
    int32_t first;                 /* of the points that are kept: the first one's number, from 0 */
    double point[NURBS_WINDOW][4]; /* [mm] machine coordinates, and weights */
    bool ended;                    /* by G5.3: the last knot is that of the end */
    bool running;                  /* spans are still to be made into commands: */
    int32_t span, upto;            /* the next one, behind the last */
    double from;                   /* 0..1 where the next command begins in it */
    double feed;                   /* [mm/s] */
    int32_t stop;                  /* as in struct cycle */
    struct kept_line line;         /* of the latest point */
};

#endif
