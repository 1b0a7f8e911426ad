/* modes - a program, and all that is in force where it is being read. */
#ifndef MODES_H
#define MODES_H

#include "command.h"
#include "flow.h"
#include "kept_words.h"
#include "parameters.h"
#include "source.h"
#include "tool_table.h"
#include "words.h"

enum {
    INTERPRETER_MADE = 24 /* commands of one block: outputs, moves, stop or end; 12 at most */
};

/* What a program is read against; all of it constant while it runs. */
struct program {
    const struct source *source;
    struct mechanism machine;
    struct motion_limits limits;
    struct path_tolerance arc; /* of the ends of arcs in mm; 0: rounded at 2 decimals */
    bool plain;                /* what moves the tool knows no splines */
    bool bare;                 /* no spindle, no coolant, no M48 to M53: these are notes */
    bool block_delete;         /* lines that begin with / are passed over */
    bool optional_stop;        /* M1 stops */
    bool change_stops;         /* M6 waits for the operator */
    bool has_inputs;           /* M66 can be answered */
    bool has_probe;            /* G38 can */
    bool angles;               /* the last three coordinates are the tool's angles A B C [deg] */
    bool strict_feed;          /* F above the highest feed is a fault, else a note */
    bool fanuc;                /* the language of Fanuc's controls: P in ms, macros, GOTO .. */
    int64_t check_again;       /* lines read again after which a check stops; 0: CHECK_AGAIN */
    double least_increment;    /* [mm, inch, deg] of coordinates without a decimal point; 0: 1 */
};

/* What S, M3 to M9 have set so far; it outlives the program. */
struct switches {
    double speed;                /* [rpm] S of G97 */
    bool by_radius;              /* G96: */
    double pass, most;           /* [mm/s] S, [rpm] D */
    struct outputs_surface told; /* to the machine */
    int32_t turning;             /* 1 M3, -1 M4, 0 M5 */
    int32_t coolant;             /* enum outputs_coolant */
    uint32_t overrides;          /* enum outputs_overrides; ends with the program */
};

/* Speed of the spindle, in G96 the most it may have; counter-clockwise below 0. [rpm] */
static inline double switches_spindle(const struct switches *s)
{
    const double most = s->pass > 0.0 ? s->most : 0.0;
    return s->turning * (s->by_radius ? most : s->speed);
}

enum { INPUTS_DIGITAL = 32, INPUTS_ANALOG = 4 }; /* P0 .. P31, E0 .. E3 of M66 */

/* FREE: whether the probe may move, before PROBE: where it touched. */
enum wait_kind { WAIT_DIGITAL, WAIT_ANALOG, WAIT_FREE, WAIT_PROBE };

/* L of M66; the probe waits for HIGH, touching, or LOW. */
enum wait_mode { WAIT_NOW, WAIT_RISE, WAIT_FALL, WAIT_HIGH, WAIT_LOW };

/* What reading waits for. */
struct waiting {
    enum wait_kind kind;
    enum wait_mode mode;
    int32_t index;  /* of the input */
    double limit;   /* [s] then it is too late */
    int32_t behind; /* commands of the block that come before */
    int32_t until;  /* of FREE: those before PROBE */
    bool must;      /* of a probe: no contact is an error */
};

/* What a program does with tools. The one in the spindle outlives it. */
struct tools {
    struct tool_table table; /* of this program: G10 changes it */
    bool chosen;             /* by T, since the latest M6: */
    int32_t next;
    int32_t loaded;      /* in the spindle */
    double length[AXES]; /* [mm], [deg] offset in force */
};

/* What is in force: M70, M73. */
struct saved_modes {
    bool kept, returns; /* it can be restored; at the end of the call it is */
    enum path_plane plane;
    bool inch, incremental, absolute_centre, blend, to_r, by_radius;
    double tolerance, merge; /* [mm] */
    int32_t system;
    int32_t feed_mode;
    double feed, per_turn;    /* [mm/s], [mm] */
    double speed, pass, most; /* as in struct switches */
    int32_t turning, coolant;
    uint32_t overrides;
    double length[AXES]; /* [mm], [deg] of the tool */
    int32_t side;        /* of cutter compensation */
};

struct interpreter {
    int64_t offset; /* [byte] next line in the text */
    int32_t line;   /* lines read */
    int32_t file;   /* of the text: 0 the program, else one that it calls */
    bool ended;
    bool waits;     /* for the machine, behind the commands made */
    bool percent;   /* the first % has passed */
    int32_t motion; /* ten times the code in force; GCODE_NO_MOTION: none */
    enum path_plane plane;
    bool inch, incremental, absolute_centre;
    bool blend;       /* G64 */
    double tolerance; /* [mm] P of G64: look-ahead instead of path mixing; 0 none */
    double merge;     /* [mm] Q of G64, P without it */
    int32_t system;   /* 0..8 for G54 .. G59.3, from 9 on G54.1 P1 .. */
    double origin[INTERPRETER_ALL][AXES]; /* [mm] of each system, machine coordinates */
    int32_t more;                         /* systems of G54.1 up to the last that has been set */
    double shift[AXES];                   /* [mm] G52, G92 */
    bool shifted;                         /* it is in force */
    double feed;                          /* [mm/s] of G94; 0: none since it is in force again */
    double point[AXES];                   /* [mm] end of the last command, machine coordinates */
    struct words words;
    struct switches switches;
    struct cycle cycle;
    struct nurbs nurbs;
    struct cutter cutter;
    struct rounding rounding;
    struct tools tools;
    struct waiting wait;          /* where `waits` */
    double input;                 /* the latest answer to M66 */
    double contact[AXES];         /* [mm], [deg] of the latest probing, program coordinates */
    double touched;               /* 1 if it has, or what #5070 has been set to */
    uint32_t set, clear;          /* digital outputs of M62, M63, for the next motion */
    struct outputs_analog analog; /* the same of M67 */
    struct parameters parameters;
    struct flow flow;
    struct saved_modes saved[FLOW_CALLS + 1]; /* of each call, the program first */
    struct command made[INTERPRETER_MADE];    /* of the block read last */
    int32_t taken, count;                     /* of them handed out, made */
};

#endif
