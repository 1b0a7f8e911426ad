/* group - several motion libraries on one PC: groups of axes, each with its own program, on cards.
 *
 * A group is a whole library: coordinate system, command ring, queue, program. Its axes X .. W are
 * mapped to channels of one card, and a channel belongs to one group. Each card has its position
 * control: a frame to the card is the sum of what its groups have for that DDA time; a group that
 * has nothing stands still in it. What the card has taken goes back to each group, so the groups
 * start, hold and end as if each were alone. One interpolation cycle works on all groups in turn.
 *
 * A card has six channels of pulses and eight DAC, so fourteen axes: those of a voltage group are
 * DAC, each with an encoder counter. The PC puts out its frames itself and closes the loop (servo).
 * A DAC gives the voltage of such an axis, or of the card's own position loop of a pulse channel
 * (command mode 1), or what groups_set_dac_output says.
 *
 * Other interrupt sources than the FIFO, output modes and the manual motions stay with pc.
 */
#ifndef GROUP_H
#define GROUP_H

#include "card_view.h"
#include "pcl.h"
#include "servo.h"
#include "task.h"

enum { GROUP_MAX = 6, GROUP_CARDS = 2, GROUP_DACS = 8, GROUP_COUNTERS = 9 };

struct group_config {
    int64_t bus;            /* [clocks] T_b */
    int64_t ipo;            /* [clocks] interpolation cycle */
    double latency, jitter; /* [clocks] as of pc */
    int32_t seed;           /* of the first card; the next number for the next card */
    int32_t min_stock, batch;
};

struct group_panel {
    bool hold, abort, cycle_start;
    double override;               /* 0..2 */
    bool probe;                    /* it touches */
    uint32_t digital;              /* inputs of M66, a bit each */
    double analog[SIGNALS_ANALOG]; /* the same */
};

/* Command mode of a pulse channel, MCCL's wCommandMode. */
enum group_command_mode {
    GROUP_COMMAND_PULSE,  /* pulses to a drive in position mode */
    GROUP_COMMAND_VOLTAGE /* the card's position loop to the DAC of its number */
};

/* An axis at a DAC. */
struct group_dac {
    struct machine_axis axis; /* ppr: counts per motor turn */
    int32_t encoder;          /* its counter, from 0 */
    double position_gain;     /* [1/s] Kp, above 0 */
    double speed_per_volt;    /* [rpm/V] of the drive */
    double feed_forward;      /* 0..1 part of the commanded speed */
    double lag;               /* [s] of the pre-filter; 0 none */
};

struct group {
    bool used;
    bool voltage; /* its channels are DAC */
    int32_t card;
    int32_t channel[AXES]; /* of the card, -1: no such axis */
    struct pcl_part part;  /* of the card's transaction */
    int32_t starved;       /* frames of standstill that were too late */
    bool program;          /* there is one */
    int64_t start;         /* [clocks] it starts at the first cycle from here on */
    bool started;          /* or dropped by an abort */
    struct key abort, cycle_start;
    /* From here on it is large, and anything may stand there while the group is not used. */
    struct mcc mcc;
    struct servo servo; /* of a voltage group */
};

struct group_card {
    struct machine machine; /* settings of its channels; used: by a group */
    struct pcl pcl;
    uint64_t random;
    int32_t command_mode[AXES];       /* enum group_command_mode of the pulse channels */
    struct group_dac dac[GROUP_DACS]; /* used: by a voltage group */
    int32_t counts[GROUP_COUNTERS];   /* the card's counters at this instant */
    int32_t pulses[AXES];             /* [pulses] its channels have put out by then */
    double volts[GROUP_DACS];         /* [V] of the DAC, shown at the next one */
    int32_t command[GROUP_DACS];      /* [pulses] of the axes at them then, */
    int32_t error[GROUP_DACS];        /* [counts] and the errors the voltages are of */
};

struct groups {
    struct group_config config;
    bool running;
    int64_t next_ipo; /* [clocks] */
    struct group group[GROUP_MAX];
    struct group_card card[GROUP_CARDS];
};

/* No group yet; the cards' channels and DDA time. The channels' `used` is of no meaning. */
void groups_init(struct groups *s, const struct group_config *config,
                 const struct machine card[GROUP_CARDS]);

/* A new group: its axes on channels of a card from 0 (-1: no such axis), speeds and times of its
 * motion. Returns its index, or -6 no such card or channel, no axis at all, or a channel twice or
 * of another group; -16 no group left; -5 its machine is none; -3 after groups_start. */
int group_create(struct groups *s, int card, const int32_t channel[AXES],
                 const struct machine *motion);

/* The same with its axes on DAC from 0. -9: a DAC is the voltage of a pulse channel of a group;
 * -6 also: no groups_set_dac before, or an encoder counter of another axis. */
int group_create_voltage(struct groups *s, int card, const int32_t dac[AXES],
                         const struct machine *motion);

/* Settings of the axis at a DAC from 0. -6 no such card or DAC, -9 a voltage group has it, -5 a
 * value out of range, -3 after groups_start. */
int groups_set_dac(struct groups *s, int card, int dac, const struct group_dac *settings);

/* Command mode of a pulse channel, pulses at first. -6 no such card or channel, -9 its DAC is that
 * of a voltage group, -5 no such mode, -3 after groups_start. */
int groups_set_command_mode(struct groups *s, int card, int channel, int mode);

/* Voltage of a DAC that no axis has [V], at any time; MCCL's MCC_SetDACOutput. -6 no such card or
 * DAC, -9 it is the voltage command of an axis, -5 beyond +-10 V. */
int groups_set_dac_output(struct groups *s, int card, int dac, double volts);

/* Give a group with all its channels back. -6 no such group, -3 after groups_start. */
int group_close(struct groups *s, int group);

/* A program for a group, from clock `start` on. -6 no such group, -3 after groups_start. */
int group_program(struct groups *s, int group, int64_t start);

/* Everything at rest at clock 0. -6 there is no group, -3 it runs already. */
int groups_start(struct groups *s);

/* What the counters of encoders and pulses of a card show at the next groups_instant. */
void groups_counters(struct groups *s, int card, const struct link_card *link);

/* One bus instant, at clock now = k T_b, as of pc_instant; a panel and a program for each group. */
void groups_instant(struct groups *s, int64_t now, const struct pcl_card card[GROUP_CARDS],
                    const struct group_panel panel[GROUP_MAX],
                    const struct source program[GROUP_MAX]);

/* A card whose pulse channels some group has. */
bool groups_card_used(const struct groups *s, int card);

/* What a card is given, on the link; frames if they are new there. */
void groups_publish(const struct groups *s, int card, struct link_host *link);

/* Whether the axis of a voltage group has the encoder counter that the card's seventh error counter
 * looks at; its command is *command [pulses], as the counter runs. */
bool groups_watched(const struct groups *s, int card, int32_t *command);

/* The program of a group has ended without error and every point is in the card. */
bool group_done(const struct groups *s, int group);

#endif
