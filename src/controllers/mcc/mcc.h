/* mcc - the motion library: the calls of the EPCIO card's document under their own names. It turns
 * commands and part programs into interpolation points for the card, and watches over the motion.
 *
 * The document's library has one implicit state; here it is the first argument, so that several
 * libraries live side by side and a state can be copied. Positions are in mm and in machine
 * coordinates, X Y Z U V W. A call returns MCC_NO_ERR or a code < 0 unless its comment says
 * otherwise; a call that is refused changes nothing.
 */
#ifndef MCC_H
#define MCC_H

#include "guard.h"
#include "homing.h"
#include "inquiry.h"
#include "comp.h"
#include "interpreter.h"
#include "manual.h"
#include "mdi.h"
#include "readout.h"
#include "trajectory.h"
#include "signals.h"

/* Those return codes of the library that occur here; numbers and names are the library's. */
enum mcc_return {
    MCC_NO_ERR = 0,
    MCC_INITIAL_MOTION = -1,          /* MCC_init_motion has not been called */
    MCC_COMMAND_BUFFER_FULL = -2,     /* the command ring has no room */
    MCC_COMMAND_NOTACCEPTED = -3,     /* a part program is running, or axes are moved by hand */
    MCC_COMMAND_NOTFINISHED = -4,     /* the call is allowed at standstill only */
    MCC_PARAMETER = -5,               /* an argument is no number or out of its range */
    MCC_GROUP_PARAMETER = -6,         /* no such group, or a group cannot have such channels */
    MCC_FEED_RATE = -7,               /* a speed is not above 0 or above its limit */
    MCC_VOLTAGE_COMMAND_CHANNEL = -9, /* the DAC is the voltage command of an axis */
    MCC_HOME_COMMAND_NOTCALLED = -10, /* MCC_go_home has not been called */
    MCC_HOLD_ILLEGAL = -11,           /* nothing moves, or a hold or an abort is in force */
    MCC_CONTI_ILLEGAL = -12,          /* nothing is held, or nothing waits for task_continue */
    MCC_ABORT_ILLEGAL = -13,          /* nothing moves, or an abort is under way */
    MCC_RUN_TIME = -14,               /* a run-time error waits for MCC_clear_error */
    MCC_ABORT_NOT_FINISH = -15,       /* an abort is still on its ramp */
    MCC_GROUP_RAN_OUT = -16           /* all groups are in use */
};

/* Run-time errors, as MCC_get_errcode returns them. The error of homing is ours: 0xF700 + 16 times
 * the enum home_fault + the axis, counted from 1. So 0xF732 says that the index of the Y axis was
 * not found. */
enum mcc_error {
    MCC_ERROR_STOP = 0xF102,       /* emergency stop */
    MCC_ERROR_ARC = 0xF104,        /* the running program had an invalid command, such as an arc */
    MCC_ERROR_SPEED = 0xF203,      /* more pulses in one DDA time than max_dda_spd */
    MCC_ERROR_ACC = 0xF204,        /* pulses per DDA time changed by more than max_dda_acc */
    MCC_ERROR_TRAVEL = 0xF301,     /* axis 1 at a software limit or limit switch; .. 0xF306 */
    MCC_ERROR_IN_POS = 0xF501,     /* not in position within inpos_timeout */
    MCC_ERROR_HOME = 0xF700,       /* base of the errors of homing, see above */
    MCC_ERROR_PROBE_FREE = 0xF781, /* ours: before it moves the probe is already as G38 wants it */
    MCC_ERROR_PROBE_END = 0xF782,  /* ours: probing ended without contact (G38.2, .4) */
    MCC_ERROR_TRACK = 0xF801       /* following error of axis 1 too large; .. 0xF806 */
};

/* Parameters of the axes as the document has them: the user fills epcio_axis_param[] and
 * cart_max_speed, and MCC_update_param makes them effective. Names and meanings are the document's;
 * the numbers of the types, and units that the document does not give, are ours. */

/* Kind of an axis. For a rotary axis, degrees stand in the place of mm. A spindle takes no part in
 * the motion: like an unused axis it gets no pulses. */
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
    double low_limit;        /* [mm] from the logical origin to the negative limit switch */
    double HOT_offset;       /* [mm] from the positive limit switch inwards to the software limit */
    double LOT_offset;       /* [mm] from the negative limit switch inwards to its limit */
    int32_t sensor_on;       /* logic state of the home sensor when ON, 0 or 1 */
    int32_t index_on;        /* logic state of the encoder's index when ON; 1 at the start */
    int32_t home_dir;        /* bits 0, 1, 2: direction in phases 1, 2, 3; 0 positive,
                              * 1 negative */
} MCC_MACH_PARAM;

/* How the text of part programs is read; see the members of these names in struct program. */
struct mcc_dialect {
    bool angles, fanuc, strict_feed;
    double least_increment;
};

/* What the reactions of reaction.h remember from one look at the card to the next. */
struct protection {
    int32_t base[AXES];      /* [pulses] position at which the card's pulse count is 0 */
    int32_t frame[AXES];     /* [pulses] uncompensated frame of the latest DDA time; 0 at rest */
    int32_t seen[AXES];      /* [pulses] the card's pulse count at the latest look */
    int64_t quiet;           /* [clocks] since that count changed or the emergency stop acted */
    int64_t waited, settled; /* [clocks] since the in-position check began; since all axes are
                              * in position, -1: they are not */
};

struct mcc {
    bool open; /* MCC_init_motion has been called, MCC_close_motion has not */
    struct machine machine;
    double offset[INTERPRETER_SYSTEMS][AXES]; /* [mm] origins of G54 .. G59 at program start */
    bool block_delete, optional_stop;         /* as task_set_switches has set them */
    struct inquiry inquiry;                   /* what the program asks of the machine */
    bool change_stops;                        /* M6 waits, as task_set_tools has set it */
    struct tool_table tools;
    struct mcc_dialect dialect; /* as task_set_dialect has set it */
    double feed;                /* [mm/s] of MCC_line, arcs and circles */
    bool incremental;           /* targets of the calls are incremental */
    bool blend;                 /* continuous path: commands are mixed (MCC_enable_quit) */
    double tolerance;           /* [mm] of corners under look-ahead; 0: no look-ahead */
    bool curve;                 /* look-ahead makes a smooth path (mcc_set_curve) */
    double merge;               /* [mm] tolerance of a spline through short commands; 0: none */
    int32_t error;              /* run-time error, enum mcc_error; 0 none */
    int32_t commands;           /* number of commands accepted, which is the index of the latest */
    double end[AXES];           /* [mm] where the latest command ends and the next begins */
    bool running;               /* program or lines by hand have blocks still to be read */
    bool begun;                 /* a program, or a line by hand, has been started */
    int32_t first;              /* index of the last command of the first program started */
    bool dropped, moved;        /* since then: what was read has not been driven; axes have been
                                 * moved otherwise */
    struct interpreter program;
    struct mdi mdi;
    struct readout readout;
    struct ring ring;
    struct trajectory trajectory;
    struct lookahead_mean mean;
    struct curve_plan curve_plan;
    struct queue queue;
    struct point written;   /* the latest point that the card has taken */
    struct signals signals; /* as the card reported them last */
    struct protection protection;
    int32_t latch_seq[AXES]; /* a new number arms the card's latch for the next index, once */
    struct manual manual;
    struct homing homing;
    struct comp_table comp_table[AXES];
    struct comp comp[AXES];                /* compensation up to the latest point */
    bool dry_run;                          /* the card gets frames without pulses */
    double dry_place[AXES];                /* [mm] where the axes stand during a dry run */
    int32_t dry_pulses[AXES];              /* [pulses] the same */
    MCC_MACH_PARAM epcio_axis_param[AXES]; /* for the user to fill, see MCC_update_param */
    double cart_max_speed;                 /* [mm/s] highest feed; likewise for the user to fill */
};

/* The parts of the library's state that the functions of trajectory.h use beside the trajectory. */
static inline struct trajectory_beside mcc_beside(struct mcc *m)
{
    const struct trajectory_beside beside = { &m->ring, &m->mean, &m->curve_plan };
    return beside;
}

/* System. MCC_init_motion opens the library: at rest at the origin, with the machine's settings;
 * MCC_PARAMETER if the machine is not valid or its point queue too deep. MCC_close_motion closes
 * it, at standstill. */
int MCC_init_motion(struct mcc *m, const struct machine *machine);
int MCC_close_motion(struct mcc *m);
int MCC_get_errcode(const struct mcc *m); /* enum mcc_error */
/* Make epcio_axis_param and cart_max_speed effective, at standstill. The axes stay where they are
 * and keep their pulse counts. */
int MCC_update_param(struct mcc *m);
/* Parameters of an axis as the document has them, all but those of homing. mcc_param_home copies
 * the latter of an axis from its homing settings into epcio_axis_param. */
MCC_MACH_PARAM mcc_param_of(const struct machine_axis *a);
void mcc_param_home(struct mcc *m, int axis);

/* Motion: each call returns the command's index > 0, or a code < 0. Targets in mm are absolute or
 * incremental, as MCC_set_abs or MCC_set_inc has set. An arc leads through the point (via) to its
 * end; the direction of a circle is 0 clockwise, 1 counter-clockwise. */
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
 * their own target in proportion. The feed is that of the arc; U V W keep below the safe speed of
 * their motors. */
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
int MCC_ptp_asyn(struct mcc *m, const double target[AXES]); /* each axis arrives in its own time */
int MCC_motion_delay(struct mcc *m, double ms);

/* Motion by hand: each axis moves by itself, and only while no command is under way or waits;
 * commands are refused meanwhile. Hold, conti, abort and the override of point-to-point act on all
 * axes that move so. Axes count from 0. The percent of a jog is > 0..100 of the safe motor speed;
 * MCC_jog_s moves at the speed of point-to-point. MCC_COMMAND_NOTACCEPTED: the axis stands on the
 * limit switch of that direction. */
int MCC_jog_c(struct mcc *m, int axis, int direction, double percent);   /* -1, +1; 0: stop */
int MCC_jog_i(struct mcc *m, int axis, double distance, double percent); /* [mm] */
int MCC_jog_s(struct mcc *m, int axis, int32_t pulses);
/* Handwheel: the axis follows the encoder counter 0..8 of another axis or a spare one, to the pulse
 * nearest to counts * ratio [pulses/count]. MCC_MPG_disable brings all such axes to rest where they
 * are. */
int MCC_MPG_set(struct mcc *m, int axis, int encoder, double ratio);
int MCC_MPG_disable(struct mcc *m);
/* Homing: axes of order 1 search their origins together, then those of order 2, and so on; an axis
 * of order 0 is not homed. Each place found becomes position 0. homing_set() says how an axis
 * searches. */
int MCC_go_home(struct mcc *m, const int32_t order[AXES]);
int MCC_check_homef(const struct mcc *m); /* 1 all found, 0 under way; MCC_RUN_TIME: it failed;
                                           * MCC_HOME_COMMAND_NOTCALLED also after an abort */

/* Trajectory control. */
int MCC_motion_hold(struct mcc *m);  /* ramp to rest on the path */
int MCC_motion_conti(struct mcc *m); /* go on from there */
int MCC_motion_abort(struct mcc *m); /* ramp to rest, drop commands and program */

/* Settings. Those of feed, path and ramps act from the next command on. */
int MCC_set_abs(struct mcc *m);
int MCC_set_inc(struct mcc *m);
int MCC_get_pos_type(const struct mcc *m);          /* 0 incremental, 1 absolute */
int MCC_set_fspd(struct mcc *m, double feed);       /* [mm/s] at least 1e-9 */
int MCC_set_ptp_spd(struct mcc *m, double percent); /* > 0..100 of the safe motor speed */
int MCC_enable_quit(struct mcc *m);                 /* continuous path, by path mixing */
int MCC_disable_quit(struct mcc *m);
int MCC_check_quit(const struct mcc *m); /* 0 enabled, 1 disabled: the library's own polarity */
/* Ours: look-ahead over the lines, arcs and circles that follow. Their corners are rounded within
 * this tolerance [mm]; 0 switches look-ahead off. */
int mcc_set_tolerance(struct mcc *m, double tolerance);
/* Ours: with `on` look-ahead makes a smooth path, on which each axis keeps within its own
 * acceleration and jerk. Short commands in a row become one spline within `merge` [mm] of them; 0
 * makes none. */
int mcc_set_curve(struct mcc *m, bool on, double merge);
int MCC_set_acc_type(struct mcc *m, char type); /* 'T' trapezoidal, 'S' S-shaped */
char MCC_get_acc_type(const struct mcc *m);
int MCC_set_dec_type(struct mcc *m, char type);
char MCC_get_dec_type(const struct mcc *m);
int MCC_set_acc_step(struct mcc *m, double ms); /* [ms] from rest to the commanded feed, above 0 */
double MCC_get_acc_step(const struct mcc *m);   /* [ms] */
int MCC_set_dec_step(struct mcc *m, double ms); /* [ms] from that feed to rest, above 0 */
double MCC_get_dec_step(const struct mcc *m);   /* [ms] */
/* Ramps of axes that move by themselves (MCC_ptp_asyn, jog, handwheel, homing), one by one. */
int MCC_set_ptp_asyn_acc_type(struct mcc *m, const char types[AXES]); /* 'T' or 'S' */
int MCC_get_ptp_asyn_acc_type(const struct mcc *m, char types[AXES]);
int MCC_set_ptp_asyn_decc_type(struct mcc *m, const char types[AXES]); /* the document's spelling */
int MCC_get_ptp_asyn_dec_type(const struct mcc *m, char types[AXES]);
int MCC_set_ptp_asyn_acc_step(struct mcc *m, const double ms[AXES]);
int MCC_get_ptp_asyn_acc_step(const struct mcc *m, double ms[AXES]);
int MCC_set_ptp_asyn_dec_step(struct mcc *m, const double ms[AXES]);
int MCC_get_ptp_asyn_dec_step(const struct mcc *m, double ms[AXES]);
int MCC_set_dda(struct mcc *m, double ms); /* at standstill; the card takes the nearest DDA time */
double MCC_get_dda(const struct mcc *m);   /* [ms] the DDA time that the card has */
int MCC_set_max_dda_spd(struct mcc *m, const int32_t pulses[AXES]);
int MCC_get_max_dda_spd(const struct mcc *m, int32_t pulses[AXES]);
int MCC_set_over_spd(struct mcc *m, double percent); /* 0..200, override of lines and arcs */
double MCC_get_over_spd(const struct mcc *m);
int MCC_set_ptp_ospd(struct mcc *m, double percent); /* 0..200, up to the safe motor speed */
double MCC_get_ptp_ospd(const struct mcc *m);
int MCC_set_P_gain(struct mcc *m, const int32_t gain[AXES]);
int MCC_get_P_gain(const struct mcc *m, int32_t gain[AXES]);
/* Table of an axis for pitch error and backlash, set at standstill. A table of interval 0 drives
 * out the correction that the axis has. */
int MCC_set_comp(struct mcc *m, int axis, const struct comp_table *table);
/* Dry run: everything is planned, checked and reported, but the card gets no pulses. It is switched
 * at standstill; when it is switched off the position is again where the axes stand. */
int MCC_enable_dry_run(struct mcc *m);
int MCC_disable_dry_run(struct mcc *m);
int MCC_check_dry_run(const struct mcc *m); /* 0 enabled, 1 disabled */

/* Protection. After MCC_clear_error commands are taken again. It is refused with MCC_RUN_TIME while
 * the cause of the error lasts, with MCC_COMMAND_NOTFINISHED until everything has come to rest. */
int MCC_clear_error(struct mcc *m);
int MCC_set_check_OT(struct mcc *m, const int on[AXES]); /* software limits: 1 on, 0 off */
int MCC_get_check_OT(const struct mcc *m, int on[AXES]);
int MCC_set_max_dda_acc(struct mcc *m, const int32_t pulses[AXES]);
int MCC_get_max_dda_acc(const struct mcc *m, int32_t pulses[AXES]);
int MCC_enable_in_pos(struct mcc *m, int axes); /* axes as bits: X 1, Y 2 .. W 0x20 */
int MCC_disable_in_pos(struct mcc *m, int axes);
int MCC_check_in_pos(const struct mcc *m, int in[AXES]); /* 1: motion has ended, in position */
int MCC_set_inpos_tol(struct mcc *m, const double mm[AXES]);
int MCC_get_inpos_tol(const struct mcc *m, double mm[AXES]);

/* Status. Positions are those of the latest point that the card has taken. */
int MCC_get_cpos(const struct mcc *m, double place[AXES]);     /* [mm] */
int MCC_get_ppos(const struct mcc *m, int32_t pulses[AXES]);   /* [pulses] */
int MCC_get_errcnt(const struct mcc *m, int32_t counts[AXES]); /* [counts] */
int MCC_check_stop(const struct mcc *m); /* 1: all commands done, every point in the card */

/* What the limit switches do: a number of enum machine_limit, or -1 for nothing; and the largest
 * following error of each axis [counts], 0: it is not watched. The document has no such calls. */
int protect_set_limit_mode(struct mcc *m, int mode);
int protect_set_track_limit(struct mcc *m, const int32_t counts[AXES]);

/* Compensation. The library's position, in mm and in pulses, is uncompensated; only the frames to
 * the card carry the correction. When motion ends, frames go on until all of the correction has
 * been driven in. True while some is still due where the axes stand. */
bool compensate_due(const struct mcc *m);

/* Add to the frames of the next point, which are uncompensated, as much of the due correction as
 * the limits of speed and acceleration leave room for. In a dry run the frames become 0. */
void compensate_frame(struct mcc *m, struct point *p);

/* As MCC_check_stop, except that some compensation may still have to be driven in. */
bool control_rests(const struct mcc *m);

/* Once nothing is under way and nothing is to come, let the next command begin where the axes stand
 * and with the outputs as they are; an abort may have changed both. */
void control_settle(struct mcc *m);

#endif
