/* station - a whole control station on one clock: the PC with the motion library, the EPCIO card
 * and ideal motors, for programs that call the library without any FMU.
 *
 *     struct station_config config = station_defaults();
 *     struct station *s = ...;                         400 kB, one struct without pointers
 *     station_start(s, &config);
 *     MCC_line(&s->pc.mcc, target);                    any call of the library, between two runs
 *     station_run(s, s->clock + STATION_HZ, NULL);     one second
 *     station_read(s, &reading);
 *
 * PC and card meet on the bus grid k T_b of pc.h, as the FMUs do whose communication step is T_b.
 * At an instant the PC reads the card as it is, and the card takes what the PC publishes. The PC
 * has decided that by what it read one instant before. Pulses, FIFO and interrupts happen at their
 * own clock whatever T_b is, and a run in pieces gives the same bits as one without a break.
 */
#ifndef STATION_H
#define STATION_H

#include "host.h"
#include "pc.h"

enum { STATION_HZ = CLOCK_HZ }; /* clocks of a second */

/* What the motor of an axis follows. */
enum station_mode {
    STATION_PULSES,  /* the pulses: it stands where they say */
    STATION_LOOP,    /* the voltage of the card's position loop */
    STATION_SOFTWARE /* the voltage of the library's control law: software_gain * error */
};

struct station_config {
    struct machine machine;
    struct pc_config pc;        /* output_mode as in station_mode; program and panel unused */
    double software_gain[AXES]; /* [V/count] gain of STATION_SOFTWARE */
};

enum station_status {
    STATION_OK,
    STATION_BAD_MACHINE,    /* the library refuses a value of machine */
    STATION_BAD_PC,         /* a time below 0 or above 1e15 clocks, a period of 0, n + N > 63 */
    STATION_BAD_MODE,       /* not an enum station_mode, or a gain that is no number */
    STATION_BAD_HOME,       /* the home_config of an axis with a home_order cannot be used */
    STATION_FRAMES_REFUSED, /* the card does not take frames any more */
    STATION_MOTOR_LOST      /* a motor is out of the range of the encoder input */
};

struct station {
    struct pc pc; /* pc.mcc is the library */
    struct epcio card;
    struct epcio_lines lines; /* pins: the caller may set lines.local (home, up, down, stop) and the
                               * phase of the spare encoders 6 .. 8 */
    double software_gain[AXES]; /* [V/count] */
    double motor[AXES];         /* [counts] positions of the motors at the latest instant */
    double volts[AXES];         /* [V] of the drives since that instant */
    int64_t clock;              /* [25 ns] up to which everything has happened */
    int64_t instant;            /* [25 ns] next instant of the bus grid */
    struct mailbox taken;       /* what the card has taken from the PC */
};

/* What a station shows at its clock. */
struct station_reading {
    int64_t clock;            /* [25 ns] */
    int64_t pulses[AXES];     /* [pulses] put out */
    int64_t counts[AXES];     /* [counts] encoder counters, as of the latest instant */
    int32_t errors[AXES];     /* [counts] error counters, likewise */
    double volts[AXES];       /* [V] of the DAC */
    double motor[AXES];       /* [counts] positions of the motors */
    double table[AXES];       /* [mm] positions behind gear and screw, in the axes' direction */
    double position[AXES];    /* [mm] positions of the library, of the latest point in the card */
    double path_feed;         /* [mm/s] feed along the path at that point */
    int32_t stock[AXES];      /* [commands] in the FIFOs */
    int32_t underflows[AXES]; /* DDA times that began with an empty FIFO after motion */
    int32_t frames_taken, frames_refused; /* number of frames, by the card */
    int32_t interrupts;                   /* number of pulls of the interrupt line */
    int64_t irq_clock;                    /* [25 ns] clock of the latest pull */
    int32_t services;                     /* number of refills of the FIFO after an interrupt */
    int64_t latency;                      /* [25 ns] of the latest refill after its interrupt */
    int32_t missed;                       /* deadlines that modules on the PC have missed */
    int32_t ipo_cycle;                    /* enum pc_cycle: 0 the document's rule is kept */
    int32_t queue;                        /* interpolation points waiting */
    int32_t starved;                      /* frames of standstill sent in the middle of a motion */
    int32_t status;                       /* enum task_status */
    int32_t error;                        /* run-time error, 0 none */
    int32_t line, command;                /* of the program, and index, of the command that moves */
    int32_t digital_out;                  /* digital outputs of the program, a bit each */
    int32_t coolant;                      /* bits: 0 mist, 1 flood */
    double spindle_speed;                 /* [rpm] negative: counter-clockwise */
    bool stopped;                         /* MCC_check_stop, with every pulse put out */
};

/* Three axes X Y Z of 10 mm and 10,000 pulses a turn, 3000 rpm, that follow their pulses; DDA time
 * 1.024 ms, n = 3 and N = 4, IPO cycle 1 ms, bus 100 us, interrupt latency 200 us. Homing (of axes
 * whose pc.home_order is not 0): switch at the negative end, left forward, index forward. */
struct station_config station_defaults(void);

/* Power on at clock 0, everything at rest at the origin. A refused start changes nothing. */
enum station_status station_start(struct station *s, const struct station_config *config);

/* Run up to and including clock `until`; nothing happens if that has passed. The program is the
 * text that task_check has found good and task_start has started; NULL if none runs. */
enum station_status station_run(struct station *s, int64_t until, const struct source *program);

void station_read(const struct station *s, struct station_reading *r);

#endif
