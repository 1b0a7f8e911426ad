/* command - one planned motion command. */
#ifndef COMMAND_H
#define COMMAND_H

#include "axes.h"
#include "mechanism.h"
#include "profile.h"
#include "queue.h"

/* Farthest place of a joint: counters are 32-bit, path mixing adds up three positions, and an axis
 * out there can still come to rest. [pulses] */
#define COMMAND_PULSES_MAX (2147483647.0 / 3.0)

/* Two of them take no time. Those up to 10 have the numbers that libraries show them by. */
enum command_type {
    COMMAND_PTP,
    COMMAND_LINE,
    COMMAND_CW_ARC,
    COMMAND_CCW_ARC,
    COMMAND_CW_HELIX,
    COMMAND_CCW_HELIX,
    COMMAND_DELAY,
    COMMAND_OUTPUTS = 11, /* switch spindle, coolant, digital outputs */
    COMMAND_STOP,         /* M0, M1, M60, M6: wait for the operator */
    COMMAND_PTP_ASYN,
    COMMAND_CUBIC
};

/* What a controller allows its motion, beside the bounds of the joints. */
struct motion_limits {
    double feed;  /* [mm/s] highest along a path */
    double rapid; /* > 0..1 share of the joints' highest speeds for rapids */
    struct ramp_rule up, down;
    double smooth; /* [s] time of the mean for S-shaped ramps of look-ahead; 0 none */
};

struct command {
    enum command_type type;
    int32_t index;    /* counts from 1 those that take time; 0 for the others */
    int32_t line;     /* line of the part program; 0 for a call of the API */
    bool blend;       /* continuous path: the next command may start in the deceleration */
    double tolerance; /* [mm] tolerance of corners with its neighbours; 0: no look-ahead */
    bool curve;       /* its look-ahead is the one of curve.h, not of lookahead.h */
    double merge;     /* [mm] tolerance of runs of short ones that become one curve; 0 none do */
    double smooth;    /* [s] time of the mean that makes a chain's ramps S-shaped */
    double feed;      /* [mm/s] programmed */
    double cap;       /* [mm/s] highest speed any override may bring */
    struct ramp_limits ramp; /* its ramps at its feed */
    double dwell;            /* [s] time of a delay */
    uint32_t set, clear;     /* digital outputs that its start switches on, off */
    double spindle; /* [rpm] COMMAND_OUTPUTS: of the spindle; the most, if `surface` is on */
    struct outputs_surface surface; /* COMMAND_OUTPUTS: the surface speed, if it has one */
    int32_t coolant;                /* COMMAND_OUTPUTS: enum outputs_coolant */
    uint32_t overrides;             /* COMMAND_OUTPUTS: enum outputs_overrides */
    int32_t tool; /* COMMAND_OUTPUTS: tool in the spindle; a stop for a change: the new one */
    bool probes;  /* it may be cut short, so it never shares the tool with a neighbour */
    bool changes; /* COMMAND_STOP: it waits for a change of the tool */
    struct outputs_analog analog; /* analog outputs that its start sets */
    struct path path;
};

/* Why there is no such command. */
enum command_status {
    COMMAND_OK,
    COMMAND_FAST,   /* it drives a joint above its highest speed */
    COMMAND_FAR,    /* a position that does not fit a pulse counter of 32 bits, or any joint */
    COMMAND_OUTSIDE /* it leaves the bounds of a joint */
};

struct command_refusal {
    int joint;
    double value, limit; /* FAST: part of the highest speed, and 1; OUTSIDE: place, bound [mm] */
    double feed;         /* FAST: the largest feed at which no joint is too fast [mm/s] */
};

/* Complete a command whose path is set (and is not a point): type and feed [mm/s] given; cap, acc
 * and dec found. FAST and OUTSIDE complete *r. */
enum command_status command_move(struct command *c, const struct mechanism *m,
                                 const struct motion_limits *l, enum command_type type, double feed,
                                 struct command_refusal *r);

/* Rapid positioning on a straight line, the slowest joint at its share of its highest speed. */
enum command_status command_ptp(struct command *c, const struct mechanism *m,
                                const struct motion_limits *l, struct command_refusal *r);

/* Rapid positioning, each joint for itself. Start and end of its path are joints. */
enum command_status command_ptp_asyn(struct command *c, const struct mechanism *m,
                                     struct command_refusal *r);

/* Wait for so many seconds at a point. */
void command_delay(struct command *c, const double point[AXES], double seconds);

/* Type of an arc's command from its geometry. */
enum command_type command_arc_type(const struct path *p);

/* True if time passes in it: a motion or a delay. The others have no path. */
bool command_lasts(const struct command *c);

/* True if it can share the tool with a neighbour: line, arc or curve, not a rapid or a delay. */
bool command_blends(const struct command *c);

/* Begin its profile. */
void command_start(const struct command *c, double override, struct profile *p);

/* Speed it runs at under an override. [mm/s] */
double command_speed(const struct command *c, double override);

#endif
