/* group - several motion libraries on one PC: groups of axes, each with its own program, on cards.
 *
 * A group is a whole library: coordinate system, command ring, queue, program. Its axes X .. W are
 * mapped to channels of one card, and a channel belongs to at most one group. Each card has its
 * position control: a frame to the card holds the points that its groups have for that DDA time; a
 * group without a point stands still in it. Each group is told which of its points the card has
 * taken, so groups start, hold and end as if each were alone. One interpolation cycle works on all
 * in turn.
 *
 * A card has six pulse channels and eight DAC, so it moves fourteen axes. The axes of a voltage
 * group are DAC, each with an encoder counter; the PC itself puts out its frames and closes the
 * loops (servo.h). A DAC gives the voltage of such an axis, or that of the card's own position loop
 * of a pulse channel (command mode 1), or the one that groups_set_dac_output sets.
 *
 * Interrupt sources other than the FIFO, output modes and motion by hand are those of pc alone.
 */
#ifndef GROUP_H
#define GROUP_H

#include "card_view.h"
#include "pcl.h"
#include "servo.h"
#include "task.h"

enum { GROUP_MAX = 6, GROUP_CARDS = 2, GROUP_DACS = 8, GROUP_COUNTERS = 9 };

struct group_config {
    int64_t bus;              /* [clocks] period T_b of the bus grid */
    int64_t ipo;              /* [clocks] interpolation cycle */
    double latency, jitter;   /* [clocks] of interrupts, as in struct pc_config */
    int32_t seed;             /* of the first card; the next card has the next number */
    int32_t min_stock, batch; /* [commands] n and N of pcl.h */
};

/* The operator's panel of a group, and the inputs of its program. */
struct group_panel {
    bool hold, abort, cycle_start;
    double override;               /* 0..2 */
    bool probe;                    /* the probe touches */
    uint32_t digital;              /* digital inputs of M66, a bit each */
    double analog[SIGNALS_ANALOG]; /* analog inputs of M66 */
};

/* Command mode of a pulse channel, MCCL's wCommandMode. */
enum group_command_mode {
    GROUP_COMMAND_PULSE,  /* pulses to a drive in position mode */
    GROUP_COMMAND_VOLTAGE /* the card's position loop gives the voltage of the DAC of this number */
};

/* Settings of an axis of a voltage group. */
struct group_dac {
    struct machine_axis axis; /* with encoder counts per motor turn as ppr */
    int32_t encoder;          /* its encoder counter, from 0 */
    double position_gain;     /* [1/s] Kp of law.h, above 0 */
    double speed_per_volt;    /* [rpm/V] of the drive */
    double feed_forward;      /* 0..1 share of the commanded speed that is fed forward */
    double lag;               /* [s] time constant of the pre-filter; 0: none */
};

struct group {
    bool used;
    bool voltage;          /* a voltage group: its channels are DAC */
    int32_t card;          /* from 0 */
    int32_t channel[AXES]; /* channel of the card for each axis; -1: the group has no such axis */
    struct pcl_part part;  /* its points in the card's transaction */
    int32_t starved;       /* frames of standstill in the middle of a motion */
    bool program;          /* the group has a program */
    int64_t start;         /* [clock] from which on the first cycle starts the program */
    bool started;          /* the program has been started, or an abort has dropped it */
    struct key abort, cycle_start;
    /* What follows is large, and holds no particular value while the group is not used. */
    struct mcc mcc;
    struct servo servo; /* of a voltage group */
};

struct group_card {
    struct machine machine; /* settings of its pulse channels; `used`: a group has the channel */
    struct pcl pcl;
    uint64_t random;
    int32_t command_mode[AXES];       /* enum group_command_mode of the pulse channels */
    struct group_dac dac[GROUP_DACS]; /* `axis.used`: a voltage group has the DAC */
    int32_t counts[GROUP_COUNTERS];   /* [counts] encoder counters shown at this instant */
    int32_t pulses[AXES];             /* [pulses] that the pulse channels have put out, likewise */
    double volts[GROUP_DACS];         /* [V] of each DAC, shown at the next instant */
    int32_t command[GROUP_DACS];      /* [pulses] commanded position of its axis at that instant */
    int32_t error[GROUP_DACS];        /* [counts] error of which the voltage was computed */
};

struct groups {
    struct group_config config;
    bool running;
    int64_t next_ipo; /* [clock] of the next interpolation cycle */
    struct group group[GROUP_MAX];
    struct group_card card[GROUP_CARDS];
};

/* No group yet. card[] gives the settings of channels and the DDA time of each card; their `used`
 * does not count. */
void groups_init(struct groups *s, const struct group_config *config,
                 const struct machine card[GROUP_CARDS]);

/* Create a group: channels of a card from 0 for its axes (-1: no such axis), and speeds and times
 * of its motion. Returns its index, or
 *     -6   no such card or channel, no axis at all, or a channel named twice or of another group
 *     -16  no group is left    -5  its machine is not valid    -3  after groups_start
 * also -9 or -6 where the command mode of a channel needs a DAC or counter that is taken. */
int group_create(struct groups *s, int card, const int32_t channel[AXES],
                 const struct machine *motion);

/* Create a voltage group: DAC from 0 for its axes. Codes as above, but -9: a pulse channel of a
 * group has the DAC for its voltage; and -6 also: groups_set_dac has not been called for the DAC,
 * or its encoder counter is that of another axis. */
int group_create_voltage(struct groups *s, int card, const int32_t dac[AXES],
                         const struct machine *motion);

/* Set the axis at a DAC from 0. -6: no such card or DAC; -9: a voltage group has the DAC; -5: a
 * value is out of range; -3: after groups_start. */
int groups_set_dac(struct groups *s, int card, int dac, const struct group_dac *settings);

/* Set the enum group_command_mode of a pulse channel; at first it is pulses. -6: no such card or
 * channel, or its encoder counter is taken; -9: a voltage group has its DAC; -5: no such mode; -3:
 * after groups_start. */
int groups_set_command_mode(struct groups *s, int card, int channel, int mode);

/* Set the voltage [V] of a DAC that no axis has, at any time, as MCCL's MCC_SetDACOutput. -6: no
 * such card or DAC; -9: the DAC is the voltage command of an axis; -5: beyond +-10 V. */
int groups_set_dac_output(struct groups *s, int card, int dac, double volts);

/* Close a group, whose channels are free again. -6: no such group; -3: after groups_start. */
int group_close(struct groups *s, int group);

/* Let a group have a program, which starts from clock `start` on. -6: no such group; -3: after
 * groups_start. */
int group_program(struct groups *s, int group, int64_t start);

/* Start with everything at rest at clock 0. -6: there is no group; -3: it has been called
 * before. */
int groups_start(struct groups *s);

/* Take the encoder and pulse counters that a card shows, before the next groups_instant. */
void groups_counters(struct groups *s, int card, const struct link_card *link);

/* One bus instant, at clock now = k T_b, as pc_instant; with a panel and a program for each
 * group. */
void groups_instant(struct groups *s, int64_t now, const struct pcl_card card[GROUP_CARDS],
                    const struct group_panel panel[GROUP_MAX],
                    const struct source program[GROUP_MAX]);

/* True if some group has a pulse channel of the card. */
bool groups_card_used(const struct groups *s, int card);

/* Write what a card is given to the link; the frames only if their transaction is new there. */
void groups_publish(const struct groups *s, int card, struct link_host *link);

/* True if an axis of a voltage group has the encoder counter of the card's seventh error counter.
 * *command gets its commanded position [pulses], in the direction of that counter. */
bool groups_watched(const struct groups *s, int card, int32_t *command);

/* True if the program of a group has ended without error and every point is in the card. */
bool group_done(const struct groups *s, int group);

#endif
