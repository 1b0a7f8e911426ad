/* kept_words - what a program has in force from one block to the next beside its modes: canned
 * cycles, cutter compensation, rounded corners, NURBS. */
#ifndef KEPT_WORDS_H
#define KEPT_WORDS_H

#include <stdbool.h>
#include <stdint.h>

#include "command.h"

/* A line whose motion is finished only when later lines are known; faults of it are told there. */
struct kept_line {
    int64_t offset;           /* [byte] where it begins in its text */
    int32_t file;             /* 0: the program, else number of a called file */
    int32_t line, at, length; /* number; its text without blanks at the ends [characters] */
};

enum cycle_polar {
    CYCLE_STRAIGHT,
    CYCLE_POLE, /* by @ and ^, about the zero of X and Y */
    CYCLE_POLAR /* G16 */
};

/* Step from one hole of a block to the next (L with G91). */
struct cycle_way {
    enum cycle_polar polar;
    bool about;      /* CYCLE_POLAR: the pole is the hole itself, as the block has a radius */
    double plane[2]; /* [mm] along its axes; polar: added to radius [mm], angle [deg] */
};

/* Canned cycles: the words that hold for the blocks of a series, and the block whose commands are
 * being made. Heights are program coordinates along the normal of the plane. */
struct cycle {
    bool to_r;                 /* G99 */
    int32_t code;              /* ten times the code of the cycle whose words hold; 0: none */
    double r, depth;           /* [mm] as programmed: heights, with G91 distances */
    double peck;               /* [mm] Q: depth of one peck */
    double dwell;              /* [s] P: at the bottom */
    double aside[2];           /* [mm] G87: distances from the hole, I J K of the plane */
    double bore;               /* [mm] G87: I J K of the normal, as programmed */
    double initial;            /* [mm] height in front of the series; R of G91 counts from it */
    bool running;              /* commands of the latest block are still to be made */
    int32_t step;              /* the next one in the cycle's list of steps */
    int32_t repeats;           /* number of holes behind this one */
    double hole[AXES];         /* [mm] its place, program coordinates */
    struct cycle_way way;      /* from it to the next hole */
    double top, bottom, clear; /* [mm] heights: R, bottom, on the way to the next hole */
    double bored;              /* [mm] G87: height to which it bores back */
    double pecked;             /* [mm] height to which the hole has been drilled */
    double feed;               /* [mm/s] */
    int32_t turning;           /* direction of the spindle in front of the cycle */
    uint32_t overrides;        /* enum outputs_overrides in front of the cycle */
    int32_t stop;          /* ten times the M code that stops or ends behind it, or GCODE_ABSENT */
    struct kept_line line; /* of the block */
};

/* Commands that are held at most: two motions in the plane, the arc about the corner between them,
 * and 21 others that stand between them. */
enum { CUTTER_HELD = 24 };

/* Cutter compensation: its modes, and a ring of commands that wait for the next motion. */
struct cutter {
    int32_t side;          /* 1: left of the contour (G41), -1: right (G42), 0: off */
    double edge;           /* [mm] of the tool's centre to the left of the contour; 0: no offset */
    enum path_plane plane; /* in which compensation works */
    bool straight;         /* the next motion may not be an arc: it comes behind G40 */
    bool aside;     /* since G40 the tool has stood at `from`, beside the end of the contour */
    double left[2]; /* [mm] that end of the contour */
    bool enters;    /* the motion held is the first with compensation */
    bool concave;   /* the corner in front of the motion held is concave */
    bool moves;     /* behind the ready commands is a motion whose end is not known yet */
    double from[2]; /* [mm] where the tool's centre begins that motion, or stands */
    struct kept_line latest, moving; /* the line read last, and that of the motion held */
    int32_t first, ready, count;     /* held: index of the oldest; number to hand out, of all */
    struct command held[CUTTER_HELD];
};

/* ,C and ,R of Fanuc's controls: a motion that waits, to be shortened, for the next one. */
struct rounding {
    bool waits;     /* a motion waits for the next one */
    bool fresh;     /* it is of the line read last */
    int32_t before; /* commands that its line has made in front of it */
    bool chamfer;   /* ,C; else ,R */
    double size;    /* [mm] ,C: distance of its ends from the corner; ,R: radius */
    enum path_plane plane;
    struct kept_line line;
    struct command held; /* the motion, not yet shortened */
};

enum {
    NURBS_ORDER = 10,              /* highest L */
    NURBS_WINDOW = 2 * NURBS_ORDER /* control points that are kept */
};

/* The NURBS that G5.2 has begun, until G5.3 ends it. */
struct nurbs {
    int32_t count;                 /* control points so far; 0: no curve has begun */
    int32_t order;                 /* L: one more than the degree */
    enum path_plane plane;         /* in force when G5.2 began the curve */
    int32_t first;                 /* number of the oldest control point that is kept, from 0 */
    double point[NURBS_WINDOW][4]; /* machine coordinates [mm] and weight of each */
    bool ended;                    /* G5.3 has come: the last knots lie at the curve's end */
    bool running;                  /* spans are still to be made into commands */
    int32_t span, upto;            /* the next one; the one behind the last that can be made */
    double from;                   /* 0 .. 1: where the next command begins in the span */
    double feed;                   /* [mm/s] */
    int32_t stop;                  /* as in struct cycle */
    struct kept_line line;         /* of the latest control point, or of G5.3 */
};

#endif
