/* machine - the axes and the card as the library knows them: units, speeds, DDA time. */
#ifndef MACHINE_H
#define MACHINE_H

#include "axes.h"
#include "command.h"
#include "speed_profile.h"

enum { CLOCK_HZ = 40000000, CLOCK_NS = 1000000000 / CLOCK_HZ }; /* clock of the card */

/* One axis; the fields of MCC_MACH_PARAM that have a meaning here. */
struct machine_axis {
    bool used;
    double pitch;        /* [mm] travel per turn of the screw */
    double gear_ratio;   /* motor turns per screw turn */
    int32_t ppr;         /* pulses per motor turn */
    double rpm;          /* [rpm] highest safe motor speed */
    int32_t p_gain;      /* position loop of the card */
    int32_t max_dda;     /* most pulses in one DDA time; 0 at init means 2^dda_length - 1 */
    bool inverted;       /* pulses and encoder counts of the card run against the position */
    bool index_low;      /* the encoder's index is ON at the low level */
    int32_t max_dda_acc; /* [pulses] largest change of that; 0 at init means no limit */
    bool check_ot;       /* the software limits are in force: */
    double high_limit, low_limit;  /* [mm] from the logical origin to the limit switches */
    double hot_offset, lot_offset; /* [mm] so far inside them the software stops */
    int32_t track_limit;           /* [counts] largest following error; 0: it is not watched */
    bool in_pos;                   /* commands wait until the axis is in position: */
    double inpos_tol;              /* [mm] following error that counts as in position */
    double acc;                    /* [mm/s^2] highest on curves; 0 of all axes: as the ramps */
    double jerk;                   /* [mm/s^3] highest jerk there; 0 no limit */
};

/* What a limit switch does; the library's numbers. */
enum machine_limit {
    MACHINE_LIMIT_BOTH,   /* blocks both directions */
    MACHINE_LIMIT_TOWARD, /* blocks the direction towards it */
    MACHINE_LIMIT_BOTH_ERROR,
    MACHINE_LIMIT_TOWARD_ERROR /* and generates an error */
};

/* When a command is in position; the library's numbers. Block: too late is an error. */
enum machine_inpos {
    MACHINE_INPOS_ONCE_BLOCK,
    MACHINE_INPOS_ONCE_UNBLOCK,
    MACHINE_INPOS_SETTLE_BLOCK,
    MACHINE_INPOS_SETTLE_UNBLOCK
};

/* Ramps of motion whose axes are independent, of each axis its own; 0 at init: the machine's. */
struct machine_asyn {
    char acc_type[AXES], dec_type[AXES];   /* 'T' or 'S' */
    double acc_time[AXES], dec_time[AXES]; /* [s] from rest to the axis' speed, and back */
};

struct machine {
    struct machine_axis axis[AXES];
    double dda_time;      /* [s] wanted */
    int32_t dda_length;   /* [bit] 10..15 */
    int32_t queue_depth;  /* interpolation points kept ahead */
    double feed;          /* [mm/s] until one is set */
    double max_feed;      /* [mm/s] cart_max_speed of the source document */
    double arc_tolerance; /* [mm] that the end of a program's arc may miss; 0: 0.0283 */
    double acc_time;      /* [s] from rest to the commanded feed */
    double dec_time;      /* [s] from the commanded feed to rest */
    char acc_type;        /* 'T' or 0: at constant acceleration; 'S': S-shaped */
    char dec_type;
    double jerk_share; /* 0..1 part of the time of an S-shaped ramp in which the acceleration
                        * changes; 0 means 0.5 */
    double ptp_ratio;  /* 0..1 share of the safe motor speed for point-to-point; 0 means 1 */
    struct machine_asyn asyn;
    bool limit_check;     /* the limit switches are looked at: */
    int32_t limit_mode;   /* enum machine_limit */
    int32_t inpos_mode;   /* enum machine_inpos */
    double inpos_settle;  /* [s] that the error counters must stay within the tolerance */
    double inpos_timeout; /* [s] in which that must have happened; 0: no end */
};

/* True if every value lies in its range and is finite. */
bool machine_valid(const struct machine *m);

/* Whether a speed [mm/s], time [s], way [mm] or share that must be above 0 is: 1e-9 .. 1e9, so that
 * their products and quotients stay numbers. */
bool machine_positive(double x);

/* The same of a share: up to 1. */
bool machine_share(double x);

/* Ramps of independent axes where none are given. */
void machine_complete_asyn(struct machine *m);

/* Divider, 1..65535, that brings 2^length * divider * 25 ns nearest to dda_time; the
 * longer time if two are as near. */
int32_t machine_dda_divider(const struct machine *m);

/* DDA time the card really has. */
int64_t machine_dda_clocks(const struct machine *m); /* [25 ns clocks] */
double machine_dda_time(const struct machine *m);    /* [s] */

/* Largest command the DDA can take: 2^length - 1. [pulses] */
int32_t machine_dda_limit(const struct machine *m);

/* The axes as joints of a Cartesian machine; those not used have no numbers. */
struct mechanism machine_mechanism(const struct machine *m);

/* What motion along paths keeps to. */
struct motion_limits machine_limits(const struct machine *m);

/* What each axis keeps to on a curve. */
struct speed_limits machine_speed_limits(const struct machine *m);

/* Limits of an axis that moves for itself at a speed [mm/s]. */
struct axes_limits machine_axis_limits(const struct machine *m, int axis, double speed);

double machine_pulses_per_mm(const struct machine_axis *a);  /* [pulses/mm] */
double machine_axis_speed(const struct machine_axis *a);     /* [mm/s] at rpm */
double machine_ptp_speed(const struct machine *m, int axis); /* [mm/s] its share for rapids */

/* Software limits: the limit switches less |hot_offset|, |lot_offset|. [mm] */
double machine_high(const struct machine_axis *a);
double machine_low(const struct machine_axis *a);

#endif
