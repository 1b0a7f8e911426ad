/* shape - commands in a row become segments of one smooth path within their tolerance.
 *
 *   commands ──> long lines, arcs, cubics ────────> segments as they are ─┐
 *           └──> short ones: chords ──> shape_run ──> spline ───────────┴─> shape_join ──> segments
 *
 * - Long lines, arcs and cubics keep their geometry. Runs of short ones, with a part of the long
 *   ones they touch without a corner, become a spline (shape_run.h).
 * - At a corner the direction turns by more than 53 degrees within 15 tolerances. There the path
 *   goes through the vertex with r'' = 0. It also does so near a place at which no spline stays
 *   within the tolerance, where the run turns most or is farthest out.
 * - At such a vertex, and between long ones, a quintic joins both sides (shape_join.h). Where there
 *   is no room for one the last segment before says `rest`.
 * - r, r' and r'' are continuous but where the motion rests. The distance from the path to the
 *   commands and back, in six coordinates, is proved to be at most the tolerance.
 * - The window is bounded: the cost of a command does not depend on how many there are.
 */
#ifndef SHAPE_H
#define SHAPE_H

#include "shape_join.h"
#include "shape_run.h"

enum {
    SHAPE_SEGMENTS = 640,
    SHAPE_MARKS = 1536, /* for a window of SHAPE_VERTICES and for what lies ahead */
    SHAPE_HELD = 8,     /* newest segments, which a corner may cut: they are not finished */
    SHAPE_TAIL = 24     /* vertices of a run that are kept for the corner at its end */
};

enum shape_closing { SHAPE_OPEN, SHAPE_BY_LONG, SHAPE_BY_END };

/* Where a command begins. */
struct shape_mark {
    double at;           /* [mm] parameter, from the chain's start */
    int32_t index, line; /* of the command */
    uint32_t set, clear; /* digital outputs */
    struct outputs_analog analog;
    float end[AXES]; /* [mm] end of the command, for a display */
};

enum shape_status {
    SHAPE_TAKEN,
    SHAPE_FULL, /* no room now: drop segments and marks */
    SHAPE_OTHER /* not of this chain: no path, no tolerance, or it begins elsewhere;
                 * or the chain has ended */
};

struct shape {
    double merge; /* [mm] highest tolerance of a run; 0 none */
    bool started, ended;
    double end[AXES];       /* [mm] end of the commands so far */
    double u;               /* [mm] length of the segments so far */
    struct shape_law law;   /* limits of the newest command */
    bool exact;             /* a long command waits for what follows it */
    struct segment whole;   /* that long command */
    double whole_tolerance; /* [mm] its tolerance */
    bool running;
    enum shape_closing closing; /* what ends the run */
    struct segment next;        /* the long command that ends it */
    double next_tolerance;      /* [mm] its tolerance */
    double next_from;           /* [mm] its part up to there is in the run */
    int32_t next_vertex;        /* vertex of the run where it begins */
    int32_t grabbed;            /* vertex of the run where the long command ends; 0 none */
    int32_t looked;             /* vertices up to it are no corners */
    int64_t made, gone;         /* segments, since the chain's start */
    int64_t cut_from;           /* first segment that a corner at the end may cut */
    bool corner;                /* a corner waits for the segments behind it */
    int64_t corner_made;        /* number of segments before it */
    int64_t corner_cut_from;    /* first of these that it may cut */
    double corner_tolerance;    /* [mm] of a long command before it */
    int32_t tail_points;        /* kept vertices of a run before it, the last is it; else 0 */
    double tail[SHAPE_TAIL][AXES], tail_u[SHAPE_TAIL], tail_tolerance[SHAPE_TAIL];
    int64_t marks, marks_set, marks_gone;
    int32_t marks_loose; /* newest marks, which lie where the next command begins */
    struct shape_run run;
    struct segment segment[SHAPE_SEGMENTS];
    struct shape_mark mark[SHAPE_MARKS];
};

/* A chain begins, at rest. merge: highest tolerance for runs [mm]; 0: each command for itself. */
void shape_start(struct shape *s, double merge);

/* Takes a line, an arc or a cubic with a tolerance > 0 that begins where the one before ended. */
enum shape_status shape_take(struct shape *s, const struct command *c);

/* Nothing more comes: the chain ends at rest at the end of the last command. */
void shape_end(struct shape *s);

/* Finished segments, the oldest first. */
int32_t shape_count(const struct shape *s);
const struct segment *shape_segment(const struct shape *s, int32_t i);
void shape_drop(struct shape *s, int32_t n);

/* Commands whose place is known, the oldest first. */
int32_t shape_marks(const struct shape *s);
const struct shape_mark *shape_mark(const struct shape *s, int32_t i);
void shape_drop_marks(struct shape *s, int32_t n);

#endif
