/* command - one planned motion command, and the ring it waits in. */
#ifndef COMMAND_H
#define COMMAND_H

#include "axes.h"
#include "fault.h"
#include "machine.h"
#include "path.h"
#include "profile.h"

/* nType of the library's COMMAND_INFO, which ends at 10, and ours: two that take no time, and
 * point-to-point with independent axes. */
enum command_type {
    COMMAND_PTP, COMMAND_LINE, COMMAND_CW_ARC, COMMAND_CCW_ARC, COMMAND_CW_HELIX,
    COMMAND_CCW_HELIX, COMMAND_DELAY,
    COMMAND_OUTPUTS = 11,   /* switch spindle, coolant, digital outputs */
    COMMAND_STOP,           /* M0, M1: wait for the operator */
    COMMAND_PTP_ASYN
};

struct command {
    enum command_type type;
    int32_t index;      /* counts from 1 those that take time; 0 for the others */
    int32_t line;       /* of the part program; 0 for a call of the API */
    bool    blend;      /* continuous path: the next command may start in the deceleration */
    double  tolerance;  /* [mm] of the corners with its neighbours, by look-ahead; 0 none */
    double  smooth;     /* [s] time of the mean that makes a chain's ramps S-shaped */
    double  feed;       /* [mm/s] programmed */
    double  cap;        /* [mm/s] highest speed any override may bring */
    struct ramp_limits ramp;    /* of its feed in acc_time, dec_time */
    double  dwell;      /* [s] of a delay */
    uint32_t set, clear;    /* digital outputs that its start switches on, off */
    double  spindle;    /* [rpm] of COMMAND_OUTPUTS */
    int32_t coolant;    /* of COMMAND_OUTPUTS */
    struct path path;
};

/* Complete a command whose path is set (and is not a point): type and feed [mm/s] given; cap, acc
 * and dec found. Refuses what the machine cannot do; FAULT_SPEED, FAULT_TRAVEL complete *r. */
enum fault command_move(struct command *c, const struct machine *m, enum command_type type,
                        double feed, struct fault_report *r);

/* Rapid positioning: all axes together, the slowest at its share of the safe motor speed. */
enum fault command_ptp(struct command *c, const struct machine *m, struct fault_report *r);

/* Rapid positioning, each axis for itself. */
enum fault command_ptp_asyn(struct command *c, const struct machine *m, struct fault_report *r);

/* Wait for so many seconds at a point. */
void command_delay(struct command *c, const double point[AXES], double seconds);

/* Type of an arc's command from its geometry. */
enum command_type command_arc_type(const struct path *p);

/* True if time passes in it: a motion or a delay. The others have no path. */
bool command_lasts(const struct command *c);

/* True if it can share the tool with a neighbour: line or arc, not a rapid or a delay. */
bool command_blends(const struct command *c);

/* Begin its profile. */
void command_start(const struct command *c, double override, struct profile *p);

/* Speed it runs at under an override. [mm/s] */
double command_speed(const struct command *c, double override);

#endif
