/* modes - a program, and all that is in force where it is being read. */
#ifndef MODES_H
#define MODES_H

#include "command.h"
#include "source.h"

enum {
    INTERPRETER_SYSTEMS = 6,    /* G54 .. G59 */
    INTERPRETER_MADE = 4        /* commands of one block: outputs, G28's two rapids, stop or end */
};

/* What a program is read against; all of it constant while it runs. */
struct program {
    const struct source *source;
    struct mechanism machine;
    struct motion_limits limits;
    bool block_delete;      /* lines that begin with / are passed over */
    bool optional_stop;     /* M1 stops */
    bool angles;            /* the last three coordinates are the tool's angles A B C [deg] */
};

/* What S, M3 to M9 have set so far; it outlives the program. */
struct switches {
    double  speed;          /* [rpm] S */
    int32_t turning;        /* 1 M3, -1 M4, 0 M5 */
    int32_t coolant;        /* enum outputs_coolant */
};

struct interpreter {
    int64_t offset;         /* [byte] next line in the text */
    int32_t line;           /* lines read */
    bool    ended;
    bool    percent;        /* the first % has passed */
    int32_t motion;         /* 0..3, or -1 before the first motion code */
    enum path_plane plane;
    bool    inch, incremental, absolute_centre;
    bool    blend;          /* G64 */
    double  tolerance;      /* [mm] P of G64: look-ahead instead of path mixing; 0 none */
    int32_t system;         /* 0..5 for G54 .. G59 */
    double  origin[INTERPRETER_SYSTEMS][AXES];  /* [mm] of each system, machine coordinates */
    double  local[AXES];    /* [mm] G52 */
    double  shift[AXES];    /* [mm] G92 */
    bool    shifted;        /* it is in force */
    double  feed;           /* [mm/s] */
    double  point[AXES];    /* [mm] end of the last command, machine coordinates */
    struct switches switches;
    uint32_t set, clear;    /* digital outputs of M62, M63, for the next motion */
    struct command made[INTERPRETER_MADE];      /* of the block read last */
    int32_t taken, count;   /* of them handed out, made */
};

#endif
