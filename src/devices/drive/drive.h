/* drive - digital servo drive of one motor: velocity or position mode with a smoothed command, a PI
 * velocity loop with torque limit, thermal model of the motor, alarms and holding brake. Call
 * drive_tick() once per sampling period; fmus/servo_drives/README.md has the equations. */
#ifndef DRIVE_H
#define DRIVE_H

#include <stdbool.h>
#include <stdint.h>

enum drive_mode { DRIVE_VELOCITY = 0, DRIVE_POSITION = 1 };
enum drive_alarm {
    DRIVE_NO_ALARM = 0,
    DRIVE_FOLLOWING_ERROR = 1,
    DRIVE_OVERSPEED = 2,
    DRIVE_OVERLOAD = 3,
    DRIVE_ENCODER = 4
};
enum drive_status { DRIVE_OK = 0, DRIVE_BAD_PHASE = -1 };

/* The overspeed alarm comes at this multiple of the speed limit: a usual factory setting, above the
 * overshoot of a velocity loop. */
#define DRIVE_OVERSPEED_RATIO 1.2

/* Most samples of the moving mean of the command: 100 ms at 100 us. */
#define DRIVE_MEAN_MOST 1000

/* Largest position whose counts are whole numbers in a double, 2^53 [counts]. */
#define DRIVE_COUNTS_MAX 9007199254740992.0

struct drive_config {
    int32_t mode;             /* enum drive_mode */
    double period;            /* [s] sampling period */
    double speed_per_volt;    /* [rpm/V] velocity mode */
    double volt_offset;       /* [V] added to the command voltage */
    int32_t encoder_lines;    /* [line periods/turn] */
    int32_t encoder_counts;   /* [counts/turn] resolution of the drive's position */
    int32_t pulses_per_turn;  /* [pulses/turn] of the command, position mode */
    double velocity_gain;     /* [N.m.s/rad] of the velocity loop */
    double velocity_time;     /* [s] integral time; 0: no integral */
    double position_gain;     /* [1/s] */
    double feed_forward;      /* share of the command speed that is fed forward, 0 .. 1 */
    double feed_forward_time; /* [s] time constant of its filter; 0: none */
    double torque_limit;      /* [N.m] */
    double speed_limit;       /* [rpm] */
    double error_limit;       /* [turns] following error that raises the alarm */
    double overload_time;     /* [s] with the torque at its limit that raises the alarm; 0: none */
    double brake_torque;      /* [N.m] holding torque of the motor's brake; 0: no brake */
    int32_t command_mean;     /* [samples] of the command's moving mean, <= DRIVE_MEAN_MOST */
    double command_time;      /* [s] time constant of the command's filter; 0: none */
    double rated_torque;      /* [N.m] that the motor bears for ever; 0: no thermal model */
    double thermal_time;      /* [s] time constant of the motor's heat */
    double thermal_limit;     /* [rated torque] root of the heat that raises the alarm */
    double brake_close_time;  /* [s] from the brake's signal until it bears */
    double brake_hold_time;   /* [s] the loops go on behind the signal, switched off at rest */
    double brake_run_time;    /* [s] most that the signal waits for a motor that turns */
    double brake_speed;       /* [rpm] the motor rests below it */
};

struct drive_input {
    bool enable;
    bool alarm_reset; /* a rising edge clears the alarm */
    double volts;     /* [V] velocity command */
    int32_t pulses;   /* [pulses] command, cumulative, may wrap */
    double phase;     /* [line periods] motor encoder */
    bool unplugged;   /* the plug of the encoder is out: the drive does not see it */
};

struct drive_state {
    bool primed;     /* the first sample has come */
    bool on;         /* the loops ran at the latest sample */
    bool reset;      /* alarm_reset at the latest sample */
    int32_t alarm;   /* enum drive_alarm */
    int64_t counts;  /* [counts] position at the latest sample */
    int64_t zero;    /* [counts] position at which the loops were switched on */
    int32_t pulses;  /* [pulses] input at the latest sample */
    int64_t command; /* [pulses] received since the loops were switched on */
    double integral; /* [N.m] integral part of the velocity loop */
    double forward;  /* [turns/s] command speed behind the feed-forward filter */
    int64_t load;    /* number of samples with the torque at its limit minus those without, >= 0 */
    int64_t sum;     /* [pulses samples] of the mean: smoothed command times its samples */
    int64_t window;  /* [pulses] in the samples of the mean */
    double lag;      /* [pulses] that the command's filter is behind its input */
    double heat;     /* square of the torque in units of the rated one, over the thermal time */
    int64_t off; /* number of samples since the loops were switched off, while the brake is open */
    int64_t signal; /* those since the brake was told to close */
    bool released;  /* the brake is open */
    bool holding;   /* switched off at rest: the loops go on while the brake closes */
    int32_t place;  /* of the oldest sample in `past` */
    int32_t past[DRIVE_MEAN_MOST]; /* [pulses] of the latest samples, while they are averaged */
};

struct drive_output {
    double torque;          /* [N.m] of the motor, or of the brake while the drive is off */
    double speed;           /* [rpm] measured */
    double speed_command;   /* [rpm] command of the velocity loop */
    double following_error; /* [turns] position mode */
    bool ready;             /* enabled and without alarm */
    double load_ratio;      /* root of the heat [rated torque] */
    bool saturated;         /* torque at its limit */
    int32_t alarm;          /* enum drive_alarm */
};

/* One sampling instant. DRIVE_BAD_PHASE, and nothing changed, if the phase is not a number or
 * beyond DRIVE_COUNTS_MAX. */
enum drive_status drive_tick(const struct drive_config *c, struct drive_state *s,
                             const struct drive_input *in, struct drive_output *out);

#endif
