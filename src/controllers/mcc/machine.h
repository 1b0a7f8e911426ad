/* machine - the settings of the axes and of the card as the library knows them: units, speeds,
 * ramps, limits, DDA time; and what follows from them for planning and for the DDA. */
#ifndef MACHINE_H
#define MACHINE_H

#include "axes.h"
#include "command.h"
#include "speed_profile.h"

enum { CLOCK_HZ = 40000000, CLOCK_NS = 1000000000 / CLOCK_HZ }; /* clock of the card */

/* Settings of one axis: those of MCC_MACH_PARAM that matter here, and the guards of its motion. */
struct machine_axis {
    bool used;           /* the axis takes part in motion and gets pulses */
    double pitch;        /* [mm] travel per turn of the screw */
    double gear_ratio;   /* motor turns per screw turn */
    int32_t ppr;         /* pulses per motor turn */
    double rpm;          /* [rpm] highest safe motor speed */
    int32_t p_gain;      /* gain of the card's position loop, 0 .. 65535 */
    int32_t max_dda;     /* [pulses] most in one DDA time; 0 at init means 2^dda_length - 1 */
    bool inverted;       /* pulses and encoder counts of the card run against the position */
    bool index_low;      /* the encoder's index is ON at the low level */
    int32_t max_dda_acc; /* [pulses] largest change between DDA times; 0 at init: no limit */
    bool check_ot;       /* software limits are in force */
    double high_limit, low_limit;  /* [mm] from the logical origin to the limit switches */
    double hot_offset, lot_offset; /* [mm] from them inwards to the software limits */
    int32_t track_limit;           /* [counts] largest following error; 0: it is not watched */
    bool in_pos;                   /* a command ends when the axis is in position */
    double inpos_tol;              /* [mm] following error that counts as in position */
    double acc;  /* [mm/s^2] highest on a smooth path; 0 of all axes: as the ramps */
    double jerk; /* [mm/s^3] highest jerk on a smooth path; 0: no limit */
};

/* What a limit switch does, with the library's numbers. The last two also raise an error. */
enum machine_limit {
    MACHINE_LIMIT_BOTH,   /* blocks both directions */
    MACHINE_LIMIT_TOWARD, /* blocks the direction towards it */
    MACHINE_LIMIT_BOTH_ERROR,
    MACHINE_LIMIT_TOWARD_ERROR
};

/* When a command that has ended is in position, with the library's numbers: once the error counters
 * are within the tolerance, or when they have stayed there for inpos_settle. After inpos_timeout
 * `block` raises an error and `unblock` goes on. */
enum machine_inpos {
    MACHINE_INPOS_ONCE_BLOCK,
    MACHINE_INPOS_ONCE_UNBLOCK,
    MACHINE_INPOS_SETTLE_BLOCK,
    MACHINE_INPOS_SETTLE_UNBLOCK
};

/* Ramps of axes that move by themselves: asynchronous point-to-point, jog, handwheel, homing. A 0
 * at init takes the machine's own. */
struct machine_asyn {
    char acc_type[AXES], dec_type[AXES];   /* 'T' or 'S' */
    double acc_time[AXES], dec_time[AXES]; /* [s] from rest to the axis' speed, and back */
};

struct machine {
    struct machine_axis axis[AXES];
    double dda_time;      /* [s] DDA time that is wanted; the card takes the nearest it has */
    int32_t dda_length;   /* [bit] length of the DDA's command, 10..15 */
    int32_t queue_depth;  /* interpolation points kept ahead */
    double feed;          /* [mm/s] feed until one is set */
    double max_feed;      /* [mm/s] highest feed, the document's cart_max_speed */
    double arc_tolerance; /* [mm] by which an arc of a program may miss its end; 0: 0.0283 */
    double acc_time;      /* [s] from rest to the commanded feed */
    double dec_time;      /* [s] from the commanded feed to rest */
    char acc_type;        /* 'T' or 0: constant acceleration; 'S': S-curve */
    char dec_type;
    double jerk_share; /* 0..1 share of an S-curve's time in which the acceleration changes;
                        * 0 means 0.5 */
    double ptp_ratio;  /* 0..1 share of the safe motor speed for point-to-point; 0 means 1 */
    struct machine_asyn asyn;
    bool limit_check;     /* the limit switches act as limit_mode says */
    int32_t limit_mode;   /* enum machine_limit */
    int32_t inpos_mode;   /* enum machine_inpos */
    double inpos_settle;  /* [s] for which the error counters must stay within the tolerance */
    double inpos_timeout; /* [s] after the end of motion until it is too late; 0: never */
};

/* True if every value lies in its range and is finite. */
bool machine_valid(const struct machine *m);

/* True for a speed [mm/s], time [s], distance [mm] or share that is above 0: from 1e-9 to 1e9, so
 * that products and quotients of such values stay finite. */
bool machine_positive(double x);

/* True for a share: from 1e-9 to 1. */
bool machine_share(double x);

/* Fill in the ramps of m->asyn that are 0 with the machine's own. */
void machine_complete_asyn(struct machine *m);

/* Divider, 1..65535, that brings 2^length * divider * 25 ns nearest to dda_time; the
 * longer time if two are as near. */
int32_t machine_dda_divider(const struct machine *m);

/* DDA time that the card has with this divider. */
int64_t machine_dda_clocks(const struct machine *m); /* [25 ns clocks] */
double machine_dda_time(const struct machine *m);    /* [s] */

/* Largest command of the DDA for one DDA time: 2^dda_length - 1. [pulses] */
int32_t machine_dda_limit(const struct machine *m);

/* The axes as joints of a Cartesian machine, with pulses per mm, safe speeds and software limits.
 * Unused axes stay 0. */
struct mechanism machine_mechanism(const struct machine *m);

/* Highest feed, share of rapids and ramps for motion along paths. */
struct motion_limits machine_limits(const struct machine *m);

/* Speed, acceleration and jerk that each axis keeps within on a smooth path. */
struct speed_limits machine_speed_limits(const struct machine *m);

/* Limits of an axis that moves by itself at a speed [mm/s], with its ramps of m->asyn. */
struct axes_limits machine_axis_limits(const struct machine *m, int axis, double speed);

double machine_pulses_per_mm(const struct machine_axis *a);  /* [pulses/mm] */
double machine_axis_speed(const struct machine_axis *a);     /* [mm/s] safe speed: at rpm */
double machine_ptp_speed(const struct machine *m, int axis); /* [mm/s] share ptp_ratio of it */

/* Software limits: the limit switches less |hot_offset|, |lot_offset|. [mm] */
double machine_high(const struct machine_axis *a);
double machine_low(const struct machine_axis *a);

#endif
