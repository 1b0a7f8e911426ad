/* mcc - the motion library: the calls of the source document under their own names.
 *
 * The document's library has one implicit state; here it is the first argument, so that several
 * libraries live side by side and a state can be copied. Positions are in mm and in machine
 * coordinates, X Y Z U V W. A call that is refused changes nothing.
 */
#ifndef MCC_H
#define MCC_H

#include "guard.h"
#include "homing.h"
#include "inquiry.h"
#include "comp.h"
#include "interpreter.h"
#include "manual.h"
#include "trajectory.h"
#include "signals.h"

/* Return codes of the library that occur here. */
enum mcc_return {
    MCC_NO_ERR = 0,
    MCC_INITIAL_MOTION = -1, /* MCC_init_motion has not been called */
    MCC_COMMAND_BUFFER_FULL = -2,
    MCC_COMMAND_NOTACCEPTED = -3, /* a part program is running, or axes are moved by hand */
    MCC_COMMAND_NOTFINISHED = -4, /* allowed at standstill only */
    MCC_PARAMETER = -5,
    MCC_GROUP_PARAMETER = -6, /* no such group, or its channels cannot be */
    MCC_FEED_RATE = -7,
    MCC_VOLTAGE_COMMAND_CHANNEL = -9, /* the DAC is the voltage command of an axis */
    MCC_HOME_COMMAND_NOTCALLED = -10,
    MCC_HOLD_ILLEGAL = -11,
    MCC_CONTI_ILLEGAL = -12,
    MCC_ABORT_ILLEGAL = -13,
    MCC_RUN_TIME = -14, /* a run-time error waits for MCC_clear_error */
    MCC_ABORT_NOT_FINISH = -15,
    MCC_GROUP_RAN_OUT = -16
};

/* Run-time errors. That of homing is ours: 0xF700 + 16 enum home_fault + axis from 1, so 0xF732 is
 * an index of the Y axis that was not found. */
enum mcc_error {
    MCC_ERROR_STOP = 0xF102,   /* emergency stop */
    MCC_ERROR_ARC = 0xF104,    /* invalid command met while the program ran */
    MCC_ERROR_SPEED = 0xF203,  /* more pulses in one DDA time than max_dda_spd */
    MCC_ERROR_ACC = 0xF204,    /* a change of them larger than max_dda_acc */
    MCC_ERROR_TRAVEL = 0xF301, /* axis 1 at a software limit or limit switch; .. 0xF306 */
    MCC_ERROR_IN_POS = 0xF501, /* not in position within inpos_timeout */
    MCC_ERROR_HOME = 0xF700,
    MCC_ERROR_PROBE_FREE = 0xF781, /* ours: the probe touches (G38.2, .3), or does not, already */
    MCC_ERROR_PROBE_END = 0xF782,  /* ours: it came to its end without contact (G38.2, .4) */
    MCC_ERROR_TRACK = 0xF801       /* following error of axis 1 too large; .. 0xF806 */
};

/* The axes as the source document's library is told of them: the user fills epcio_axis_param[] and
 * cart_max_speed, and MCC_update_param makes them effective. Names and meaning are the document's;
 * numbers of the types, and units not given here, are ours. */

/* Kind of an axis. A rotary one has degrees for mm. A spindle takes no part in the motion, so it
 * gets no pulses, as an unused axis. */
enum mcc_axis_type { MCC_LINEAR, MCC_ROTARY, MCC_SPINDLE, MCC_UNUSED };

typedef struct {
    int32_t type;            /* enum mcc_axis_type */
    int32_t pos2encoder_dir; /* 0: encoder counts up when the position grows; 1: down, and the
                              * pulses of the card are inverted likewise */
    int32_t PPR;             /* pulses of the motor per turn that reach the position loop */
    double RPM;              /* [rpm] highest safe motor speed */
    double pitch;            /* [mm] lead of the screw */
    double gear_ratio;       /* motor turns per screw turn */
    double high_limit;       /* [mm] from the logical origin to the positive limit switch */
    double low_limit;        /* [mm] to the negative one */
    double HOT_offset;       /* [mm] software limit, positive end */
    double LOT_offset;       /* [mm] negative end */
    int32_t sensor_on;       /* logic state of the home sensor when ON, 0 or 1 */
    int32_t index_on;        /* of the index; 1 at the start */
    int32_t home_dir;        /* bits 0, 1, 2: direction in phases 1, 2, 3; 0 positive,
                              * 1 negative */
} MCC_MACH_PARAM;

/* How the text of programs is meant: members of struct program. */
struct mcc_dialect {
    bool angles, fanuc, strict_feed;
    double least_increment;
};

/* State of the reactions: see reaction.h. */
struct protection {
    int32_t base[AXES];      /* [pulses] position where the card's pulse count is 0 */
    int32_t frame[AXES];     /* [pulses] of the latest DDA time, uncompensated, 0 at rest */
    int32_t seen[AXES];      /* [pulses] the card's count at the latest look */
    int64_t quiet;           /* [clocks] since it changed or the emergency stop acted */
    int64_t waited, settled; /* [clocks] in-position check: since its begin, within tolerance */
};

struct mcc {
    bool open;
    struct machine machine;
    double offset[INTERPRETER_SYSTEMS][AXES]; /* [mm] origins a program begins with */
    bool block_delete, optional_stop;         /* of task_set_switches */
    struct inquiry inquiry;                   /* what the program asks of the machine */
    bool change_stops;                        /* of task_set_tools */
    struct tool_table tools;
    struct mcc_dialect dialect; /* of task_set_dialect */
    double feed;                /* [mm/s] of MCC_line, arcs and circles */
    bool incremental;
    bool blend;
    double tolerance; /* [mm] */
    bool curve;       /* of mcc_set_curve */
    double merge;     /* [mm] */
    int32_t error;    /* enum mcc_error, 0 none */
    int32_t commands; /* commands accepted; the index of the latest */
    double end[AXES]; /* [mm] end of the latest */
    bool running;     /* the part program has lines to come */
    struct interpreter program;
    struct ring ring;
    struct trajectory trajectory;
    struct lookahead_mean mean;
    struct curve_plan curve_plan;
    struct queue queue;
    struct point written;   /* the latest point the card took */
    struct signals signals; /* as the card reported them last */
    struct protection protection;
    int32_t latch_seq[AXES]; /* a new number arms the latch for the next index, once */
    struct manual manual;
    struct homing homing;
    struct comp_table comp_table[AXES];
    struct comp comp[AXES];                /* of the latest point */
    bool dry_run;                          /* the points go to the card without pulses */
    double dry_place[AXES];                /* [mm] where the axes really stand meanwhile */
    int32_t dry_pulses[AXES];              /* [pulses] */
    MCC_MACH_PARAM epcio_axis_param[AXES]; /* for the user to fill, see MCC_update_param */
    double cart_max_speed;                 /* [mm/s] likewise */
};

/* What a library's trajectory uses beside itself. */
static inline struct trajectory_beside mcc_beside(struct mcc *m)
{
    const struct trajectory_beside beside = { &m->ring, &m->mean, &m->curve_plan };
    return beside;
}

/* System. MCC_init_motion: at rest at the origin, settings from the machine. */
int MCC_init_motion(struct mcc *m, const struct machine *machine);
int MCC_close_motion(struct mcc *m);
int MCC_get_errcode(const struct mcc *m); /* enum mcc_error */
/* Make epcio_axis_param and cart_max_speed effective, at standstill. The axes stay where they are
 * and their pulses count on. */
int MCC_update_param(struct mcc *m);
MCC_MACH_PARAM mcc_param_of(const struct machine_axis *a);
void mcc_param_home(struct mcc *m, int axis); /* homing has been set: show it there */

/* Motion: each returns the command's index > 0, or a code < 0. Targets are absolute or incremental
 * as set; a circle direction is 0 clockwise, 1 counter-clockwise. */
int MCC_line(struct mcc *m, const double target[AXES]);
int MCC_line_x(struct mcc *m, double x);
int MCC_line_y(struct mcc *m, double y);
int MCC_line_z(struct mcc *m, double z);
int MCC_arc_xy(struct mcc *m, double via_x, double via_y, double x, double y);
int MCC_arc_yz(struct mcc *m, double via_y, double via_z, double y, double z);
int MCC_arc_zx(struct mcc *m, double via_z, double via_x, double z, double x);
int MCC_circle_xy(struct mcc *m, double centre_x, double centre_y, int direction);
int MCC_circle_yz(struct mcc *m, double centre_y, double centre_z, int direction);
int MCC_circle_zx(struct mcc *m, double centre_z, double centre_x, int direction);
/* The arc through (plane[0], plane[1]) to (plane[2], plane[3]), or the circle, while U V W go to
 * their own target in proportion; their speed counts for the safe speed, not for the feed. */
int MCC_arc_xyuvw(struct mcc *m, const double plane[4], const double uvw[3]);
int MCC_arc_yzuvw(struct mcc *m, const double plane[4], const double uvw[3]);
int MCC_arc_zxuvw(struct mcc *m, const double plane[4], const double uvw[3]);
int MCC_circle_xyuvw(struct mcc *m, const double centre[2], int direction, const double uvw[3]);
int MCC_circle_yzuvw(struct mcc *m, const double centre[2], int direction, const double uvw[3]);
int MCC_circle_zxuvw(struct mcc *m, const double centre[2], int direction, const double uvw[3]);
int MCC_ptp(struct mcc *m, const double target[AXES]); /* all axes arrive together */
int MCC_ptp_x(struct mcc *m, double x);
int MCC_ptp_y(struct mcc *m, double y);
int MCC_ptp_z(struct mcc *m, double z);
int MCC_ptp_uvw(struct mcc *m, double u, double v, double w);
int MCC_ptp_asyn(struct mcc *m, const double target[AXES]); /* each axis for itself */
int MCC_motion_delay(struct mcc *m, double ms);

/* By hand: each axis for itself, only while no command is under way or waits; commands are refused
 * meanwhile. Hold, conti, abort and the override of point-to-point act on all of them. Axes count
 * from 0. A jog's percent is > 0..100 of the safe motor speed. */
int MCC_jog_c(struct mcc *m, int axis, int direction, double percent);   /* -1, +1; 0 stops */
int MCC_jog_i(struct mcc *m, int axis, double distance, double percent); /* [mm] */
int MCC_jog_s(struct mcc *m, int axis, int32_t pulses);
/* The axis follows the counts of an encoder counter, 0..8, times ratio [pulses/count], to the
 * pulse. MCC_MPG_disable brings all such axes to rest where they are. */
int MCC_MPG_set(struct mcc *m, int axis, int encoder, double ratio);
int MCC_MPG_disable(struct mcc *m);
/* Search the origins: axes with order 1 together, then those with 2, ...; 0: not. Then the place
 * found is 0. How is set by homing_set(). */
int MCC_go_home(struct mcc *m, const int32_t order[AXES]);
int MCC_check_homef(const struct mcc *m); /* 1 found, 0 under way; MCC_HOME_COMMAND_NOTCALLED,
                                           * also after an abort; MCC_RUN_TIME: it failed */

/* Trajectory control. */
int MCC_motion_hold(struct mcc *m); /* ramp to rest on the path */
int MCC_motion_conti(struct mcc *m);
int MCC_motion_abort(struct mcc *m); /* ramp to rest, drop commands and program */

/* Settings. Acceleration and deceleration times count from the next command on. */
int MCC_set_abs(struct mcc *m);
int MCC_set_inc(struct mcc *m);
int MCC_get_pos_type(const struct mcc *m);          /* 0 incremental, 1 absolute */
int MCC_set_fspd(struct mcc *m, double feed);       /* [mm/s] at least 1e-9 */
int MCC_set_ptp_spd(struct mcc *m, double percent); /* > 0..100 of the safe motor speed */
int MCC_enable_quit(struct mcc *m);                 /* continuous path */
int MCC_disable_quit(struct mcc *m);
int MCC_check_quit(const struct mcc *m); /* 0 enabled, 1 disabled, as the library */
/* Ours: look-ahead over lines, arcs and circles from here on, whose corners are rounded by no more
 * than this [mm]; 0 switches it off. */
int mcc_set_tolerance(struct mcc *m, double tolerance);
/* Ours: how that look-ahead works. As a curve each axis keeps its own acc and jerk, and runs of
 * short commands become one curve within `merge` of them [mm]; 0 merges none. */
int mcc_set_curve(struct mcc *m, bool on, double merge);
int MCC_set_acc_type(struct mcc *m, char type); /* 'T' trapezoidal, 'S' S-shaped */
char MCC_get_acc_type(const struct mcc *m);
int MCC_set_dec_type(struct mcc *m, char type);
char MCC_get_dec_type(const struct mcc *m);
int MCC_set_acc_step(struct mcc *m, double ms);
double MCC_get_acc_step(const struct mcc *m); /* [ms] */
int MCC_set_dec_step(struct mcc *m, double ms);
double MCC_get_dec_step(const struct mcc *m); /* [ms] */
/* The same for the axes of MCC_ptp_asyn, jog, hand wheel and homing, one by one. */
int MCC_set_ptp_asyn_acc_type(struct mcc *m, const char types[AXES]); /* 'T' or 'S' */
int MCC_get_ptp_asyn_acc_type(const struct mcc *m, char types[AXES]);
int MCC_set_ptp_asyn_decc_type(struct mcc *m, const char types[AXES]); /* as it is printed */
int MCC_get_ptp_asyn_dec_type(const struct mcc *m, char types[AXES]);
int MCC_set_ptp_asyn_acc_step(struct mcc *m, const double ms[AXES]);
int MCC_get_ptp_asyn_acc_step(const struct mcc *m, double ms[AXES]);
int MCC_set_ptp_asyn_dec_step(struct mcc *m, const double ms[AXES]);
int MCC_get_ptp_asyn_dec_step(const struct mcc *m, double ms[AXES]);
int MCC_set_dda(struct mcc *m, double ms); /* at standstill; the nearest possible */
double MCC_get_dda(const struct mcc *m);   /* [ms] that the card has */
int MCC_set_max_dda_spd(struct mcc *m, const int32_t pulses[AXES]);
int MCC_get_max_dda_spd(const struct mcc *m, int32_t pulses[AXES]);
int MCC_set_over_spd(struct mcc *m, double percent); /* 0..200, lines and arcs */
double MCC_get_over_spd(const struct mcc *m);
int MCC_set_ptp_ospd(struct mcc *m, double percent); /* 0..200, never above the safe speed */
double MCC_get_ptp_ospd(const struct mcc *m);
int MCC_set_P_gain(struct mcc *m, const int32_t gain[AXES]);
int MCC_get_P_gain(const struct mcc *m, int32_t gain[AXES]);
/* Pitch and backlash table of an axis, at standstill; interval 0 drives its correction out. */
int MCC_set_comp(struct mcc *m, int axis, const struct comp_table *table);
/* Dry run: all is done and reported, but the card gets no pulses. At standstill; switched off, the
 * position is again where the axes stand. */
int MCC_enable_dry_run(struct mcc *m);
int MCC_disable_dry_run(struct mcc *m);
int MCC_check_dry_run(const struct mcc *m); /* 0 enabled, 1 disabled */

/* Protection. MCC_clear_error is refused with MCC_RUN_TIME while the cause lasts, with
 * MCC_COMMAND_NOTFINISHED until everything has come to rest; then commands are taken again. */
int MCC_clear_error(struct mcc *m);
int MCC_set_check_OT(struct mcc *m, const int on[AXES]); /* software limits, 1 on, 0 off */
int MCC_get_check_OT(const struct mcc *m, int on[AXES]);
int MCC_set_max_dda_acc(struct mcc *m, const int32_t pulses[AXES]);
int MCC_get_max_dda_acc(const struct mcc *m, int32_t pulses[AXES]);
int MCC_enable_in_pos(struct mcc *m, int axes); /* bits: X 1, Y 2 .. W 0x20 */
int MCC_disable_in_pos(struct mcc *m, int axes);
int MCC_check_in_pos(const struct mcc *m, int in[AXES]); /* 1: within the tolerance */
int MCC_set_inpos_tol(struct mcc *m, const double mm[AXES]);
int MCC_get_inpos_tol(const struct mcc *m, double mm[AXES]);

/* Status: of the points the card has taken. */
int MCC_get_cpos(const struct mcc *m, double place[AXES]);     /* [mm] */
int MCC_get_ppos(const struct mcc *m, int32_t pulses[AXES]);   /* [pulses] */
int MCC_get_errcnt(const struct mcc *m, int32_t counts[AXES]); /* [counts] */
int MCC_check_stop(const struct mcc *m); /* 1 all commands done and every point written */

/* What the limit switches do: enum machine_limit, -1 nothing. The document has no such call, nor
 * one for the largest following errors, 0: not watched. [counts] */
int protect_set_limit_mode(struct mcc *m, int mode);
int protect_set_track_limit(struct mcc *m, const int32_t counts[AXES]);

/* Compensation. The position of the library, in mm and in pulses, is the uncompensated one; only
 * the frames of the card carry the correction. When motion ends, frames go on until all of it has
 * been driven in. Is some to be where the axes stand? */
bool compensate_due(const struct mcc *m);

/* Add what fits to the frames of the next point, whose pulses and frames are uncompensated;
 * in a dry run the frames become zero. */
void compensate_frame(struct mcc *m, struct point *p);

/* As MCC_check_stop, but that some compensation may be still to be driven in. */
bool control_rests(const struct mcc *m);

/* With nothing under way and nothing to come, the next command begins where the axes stand. */
void control_settle(struct mcc *m);

#endif
