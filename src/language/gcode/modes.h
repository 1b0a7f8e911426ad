/* modes - what a part program is read with (struct program), and the state of its interpreter: all
 * that is in force at the place up to which it has been read (struct interpreter). */
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
    INTERPRETER_MADE = 24 /* room for the commands of one block, which are 12 at most */
};

/* What a program is read with. Nothing of it changes while the program runs. */
struct program {
    const struct source *source;
    bool by_hand; /* lines given by hand: behind the last one there may come more */
    int32_t upto; /* reading stops in front of this line of the program; 0: it does not */
    struct mechanism machine;
    struct motion_limits limits;
    struct path_tolerance arc; /* of the ends of arcs [mm]; least 0: rounded at 2 decimals */
    bool plain;                /* the controller drives no splines: these are faults */
    bool bare;                 /* no spindle, no coolant, no M48 to M53: these are notes */
    bool block_delete;         /* lines that begin with / are passed over */
    bool optional_stop;        /* M1 stops */
    bool change_stops;         /* M6 waits for the operator */
    bool has_inputs;           /* M66 can be answered; else it is a fault */
    bool has_probe;            /* G38.2 to G38.5 can; else a fault */
    bool angles;               /* the last three coordinates are the tool's angles A B C [deg] */
    bool strict_feed;          /* F above the highest feed is a fault; else a note */
    bool fanuc;                /* the language of Fanuc's controls: P in ms, macros, GOTO .. */
    int64_t check_again;       /* lines read again at which a check stops; 0: CHECK_AGAIN */
    double least_increment;    /* [mm, inch, deg] unit of numbers without a point; 0: 1 */
};

/* What S, G96, G97, M3 to M9 and M48 to M53 have set so far; it outlives the program. */
struct switches {
    double speed;                /* [rpm] S with G97 */
    bool by_radius;              /* G96 is in force */
    double pass, most;           /* G96: surface speed S [mm/s], highest speed D [rpm] */
    struct outputs_surface told; /* surface speed that the latest command gave the machine */
    int32_t turning;             /* 1 M3, -1 M4, 0 M5 */
    int32_t coolant;             /* enum outputs_coolant */
    uint32_t overrides;          /* enum outputs_overrides; ends with the program */
};

/* Speed of the spindle [rpm], negative counter-clockwise; with G96 the highest that it may have. */
static inline double switches_spindle(const struct switches *s)
{
    const double most = s->pass > 0.0 ? s->most : 0.0;
    return s->turning * (s->by_radius ? most : s->speed);
}

enum { INPUTS_DIGITAL = 32, INPUTS_ANALOG = 4 }; /* P0 .. P31, E0 .. E3 of M66 */

/* What a wait is for: an input of M66, or a probing motion. That has two: FREE, until it may begin,
 * and PROBE, for its contact. */
enum wait_kind { WAIT_DIGITAL, WAIT_ANALOG, WAIT_FREE, WAIT_PROBE };

/* What ends the wait: L0 to L4 of M66. A probing motion waits for HIGH, contact, or for LOW. */
enum wait_mode { WAIT_NOW, WAIT_RISE, WAIT_FALL, WAIT_HIGH, WAIT_LOW };

/* What the reading of the program waits for. */
struct waiting {
    enum wait_kind kind;
    enum wait_mode mode;
    int32_t index;  /* number of the input */
    double limit;   /* [s] longest time to wait */
    int32_t behind; /* number of the block's commands in front of the wait */
    int32_t until;  /* FREE: the same of the PROBE that follows */
    bool must;      /* probing: that nothing happens is an error (G38.2, G38.4) */
};

/* Tools of a program. The one in the spindle outlives the program. */
struct tools {
    struct tool_table table; /* the program's own copy, which G10 changes */
    bool chosen;             /* T has chosen `next` since the latest M6 */
    int32_t next;
    int32_t loaded;      /* number of the tool in the spindle; 0: none */
    double length[AXES]; /* [mm], [deg] offset in force */
};

/* What M70 or M73 has saved; members as in struct interpreter and its parts. */
struct saved_modes {
    bool kept, returns; /* something is saved; the end of the call restores it (M73) */
    enum path_plane plane;
    bool inch, incremental, absolute_centre, blend, to_r, by_radius;
    double tolerance, merge; /* [mm] */
    int32_t system;
    int32_t feed_mode;
    double feed, per_turn;    /* [mm/s], [mm per turn] */
    double speed, pass, most; /* as in struct switches */
    int32_t turning, coolant;
    uint32_t overrides;
    double length[AXES]; /* [mm], [deg] offset of the tool */
    int32_t side;        /* of cutter compensation */
};

/* The state of a part program that is read: its place in the text, modes, commands made. */
struct interpreter {
    int64_t offset; /* [byte] of the next line in its text */
    int32_t line;   /* number of lines in front of it */
    int32_t file;   /* its text: 0 the program, else number of a called file */
    bool ended;
    bool waits;     /* reading waits for the machine, as `wait` says */
    bool percent;   /* the first % has passed */
    int32_t motion; /* ten times the code of motion in force; GCODE_NO_MOTION: none */
    enum path_plane plane;
    bool inch, incremental, absolute_centre;
    bool blend;       /* G64 */
    double tolerance; /* [mm] P of G64: look-ahead within it; 0: path mixing instead */
    double merge;     /* [mm] Q of G64, for runs of short lines; P if there is none */
    int32_t system;   /* coordinate system: 0 .. 8: G54 .. G59.3, from 9 on G54.1 P1 .. */
    double origin[INTERPRETER_ALL][AXES]; /* [mm] of each system, machine coordinates */
    int32_t more;       /* highest P of G54.1 whose origin has been set; 0: none */
    double shift[AXES]; /* [mm] G52, G92 */
    bool shifted;       /* the shift is in force */
    double feed;        /* [mm/s] F of G94; 0: none since G94 came into force */
    double point[AXES]; /* [mm] end of the last command, machine coordinates */
    struct words words;
    struct switches switches;
    struct cycle cycle;
    struct nurbs nurbs;
    struct cutter cutter;
    struct rounding rounding;
    struct tools tools;
    struct waiting wait;  /* for what, if `waits` */
    double input;         /* the latest answer to M66 */
    double contact[AXES]; /* [mm], [deg] place of the latest contact, program coordinates */
    double touched;       /* #5070: 1 if the latest probing had contact, or what it was set to */
    uint32_t set, clear;  /* bits of digital outputs that M62, M63 switch with the next motion */
    struct outputs_analog analog; /* analog outputs of M67, likewise */
    struct parameters parameters;
    struct flow flow;
    struct saved_modes saved[FLOW_CALLS + 1]; /* by depth of calls, 0 the program */
    struct command made[INTERPRETER_MADE];    /* commands of the block read last */
    int32_t taken, count;                     /* number of these handed out, made */
};

#endif
