/* modes - a program, and all that is in force where it is being read. */
#ifndef MODES_H
#define MODES_H

#include "command.h"
#include "cutter_state.h"
#include "cycle_state.h"
#include "flow.h"
#include "parameters.h"
#include "source.h"
#include "tool_table.h"
#include "words.h"

enum {
    INTERPRETER_MADE = 40       /* commands of one block: outputs, moves, stop or end */
};

/* What a program is read against; all of it constant while it runs. */
struct program {
    const struct source *source;
    struct mechanism machine;
    struct motion_limits limits;
    struct path_tolerance arc;  /* of the ends of arcs in mm; 0: rounded at 2 decimals */
    bool plain;             /* what moves the tool knows no splines */
    bool bare;              /* no spindle, no coolant, no M48 to M53: these are notes */
    bool block_delete;      /* lines that begin with / are passed over */
    bool optional_stop;     /* M1 stops */
    bool change_stops;      /* M6 waits for the operator */
    bool has_inputs;        /* M66 can be answered */
    bool has_probe;         /* G38 can */
    bool angles;            /* the last three coordinates are the tool's angles A B C [deg] */
    bool fanuc;             /* G4 X, G4 P in ms, M98 P with its runs in front, G65 */
    int64_t check_again;    /* lines read again after which a check stops; 0: CHECK_AGAIN */
    double least_increment; /* [mm, inch, deg] of coordinates without a decimal point; 0: 1 */
};

/* What S, M3 to M9 have set so far; it outlives the program. */
struct switches {
    double  speed;          /* [rpm] S of G97 */
    bool    by_radius;      /* G96: */
    double  pass, most;     /* [mm/s] S, [rpm] D */
    struct outputs_surface told;    /* to the machine */
    int32_t turning;        /* 1 M3, -1 M4, 0 M5 */
    int32_t coolant;        /* enum outputs_coolant */
    uint32_t overrides;     /* enum outputs_overrides; ends with the program */
};

/* Speed of the spindle, in G96 the most it may have; counter-clockwise below 0. [rpm] */
static inline double switches_spindle(const struct switches *s)
{
    const double most = s->pass > 0.0 ? s->most : 0.0;
    return s->turning * (s->by_radius ? most : s->speed);
}

enum { INPUTS_DIGITAL = 32, INPUTS_ANALOG = 4 };    /* P0 .. P31, E0 .. E3 of M66 */

/* FREE: whether the probe may move, before PROBE: where it touched. */
enum wait_kind { WAIT_DIGITAL, WAIT_ANALOG, WAIT_FREE, WAIT_PROBE };

/* L of M66; the probe waits for HIGH, touching, or LOW. */
enum wait_mode { WAIT_NOW, WAIT_RISE, WAIT_FALL, WAIT_HIGH, WAIT_LOW };

/* What reading waits for. */
struct waiting {
    enum wait_kind kind;
    enum wait_mode mode;
    int32_t index;          /* of the input */
    double  limit;          /* [s] then it is too late */
    int32_t behind;         /* commands of the block that come before */
    int32_t until;          /* of FREE: those before PROBE */
    bool    must;           /* of a probe: no contact is an error */
};

/* What a program does with tools. The one in the spindle outlives it. */
struct tools {
    struct tool_table table;    /* of this program: G10 changes it */
    bool    chosen;             /* by T, since the latest M6: */
    int32_t next;
    int32_t loaded;             /* in the spindle */
    double  length[AXES];       /* [mm], [deg] offset in force */
};

struct interpreter {
    int64_t offset;         /* [byte] next line in the text */
    int32_t line;           /* lines read */
    bool    ended;
    bool    waits;          /* for the machine, behind the commands made */
    bool    percent;        /* the first % has passed */
    int32_t motion;         /* ten times the code in force; GCODE_NO_MOTION: none */
    enum path_plane plane;
    bool    inch, incremental, absolute_centre;
    bool    blend;          /* G64 */
    double  tolerance;      /* [mm] P of G64: look-ahead instead of path mixing; 0 none */
    double  merge;          /* [mm] Q of G64, P without it */
    int32_t system;         /* 0..8 for G54 .. G59.3 */
    double  origin[INTERPRETER_SYSTEMS][AXES];  /* [mm] of each system, machine coordinates */
    double  shift[AXES];    /* [mm] G52, G92 */
    bool    shifted;        /* it is in force */
    double  feed;           /* [mm/s] of G94; 0: none since it is in force again */
    double  point[AXES];    /* [mm] end of the last command, machine coordinates */
    struct words words;
    struct switches switches;
    struct cycle cycle;
    struct cutter cutter;
    struct tools tools;
    struct waiting wait;       /* where `waits` */
    double  input;          /* the latest answer to M66 */
    double  contact[AXES];  /* [mm], [deg] of the latest probing, program coordinates */
    bool    touched;        /* it has touched */
    uint32_t set, clear;    /* digital outputs of M62, M63, for the next motion */
    struct outputs_analog analog;   /* the same of M67 */
    struct parameters parameters;
    struct flow flow;
    struct command made[INTERPRETER_MADE];      /* of the block read last */
    int32_t taken, count;   /* of them handed out, made */
};

#endif
