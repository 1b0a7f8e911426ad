/* group - several motion libraries on one PC: groups of axes, each with its own program, on cards.
 *
 * A group is a whole library: coordinate system, command ring, queue, program. Its axes X .. W are
 * mapped to channels of one card, and a channel belongs to one group. Each card has its position
 * control: a frame to the card is the sum of what its groups have for that DDA time; a group that
 * has nothing stands still in it. What the card has taken goes back to each group, so the groups
 * start, hold and end as if each were alone. One interpolation cycle works on all groups in turn.
 *
 * Other interrupt sources than the FIFO, output modes and the manual motions stay with pc.
 */
#ifndef GROUP_H
#define GROUP_H

#include "pcl.h"
#include "task.h"

enum { GROUP_MAX = 6, GROUP_CARDS = 2 };

struct group_config {
    int64_t bus;            /* [clocks] T_b */
    int64_t ipo;            /* [clocks] interpolation cycle */
    double  latency, jitter;    /* [clocks] as of pc */
    int32_t seed;           /* of the first card; the next number for the next card */
    int32_t min_stock, batch;
};

struct group_panel {
    bool   hold, abort, cycle_start;
    double override;        /* 0..2 */
};

struct group {
    bool    used;
    int32_t card;
    int32_t channel[AXES];  /* of the card, -1: no such axis */
    struct mcc mcc;
    struct pcl_part part;   /* of the card's transaction */
    int32_t starved;        /* frames of standstill that were too late */
    bool    program;        /* there is one */
    int64_t start;          /* [clocks] it starts at the first cycle from here on */
    bool    started;        /* or dropped by an abort */
    bool    abort_seen, abort_due, cycle_seen, cycle_due;
};

struct group_card {
    struct machine machine; /* settings of its channels; used: by a group */
    struct pcl pcl;
    uint64_t random;
};

struct groups {
    struct group_config config;
    bool    running;
    int64_t next_ipo;       /* [clocks] */
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

/* Give a group with all its channels back. -6 no such group, -3 after groups_start. */
int group_close(struct groups *s, int group);

/* A program for a group, from clock `start` on. -6 no such group, -3 after groups_start. */
int group_program(struct groups *s, int group, int64_t start);

/* Everything at rest at clock 0. -6 there is no group, -3 it runs already. */
int groups_start(struct groups *s);

/* One bus instant, at clock now = k T_b, as of pc_instant; a panel and a program for each group. */
void groups_instant(struct groups *s, int64_t now, const struct pcl_card card[GROUP_CARDS],
                    const struct group_panel panel[GROUP_MAX],
                    const struct source program[GROUP_MAX]);

/* A card that some group is on. */
bool groups_card_used(const struct groups *s, int card);

/* The program of a group has ended without error and every point is in the card. */
bool group_done(const struct groups *s, int group);

#endif
