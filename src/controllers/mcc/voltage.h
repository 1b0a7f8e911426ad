/* voltage - the control law on the card's wires: what it sees of frames, pulses and counters.
 *
 * At bus instant k the library sees pulses and FIFO of k, but the error counters of k - 1: the card
 * counts at an instant and shows it at the next. The speed of the commanded point is that of k, of
 * the frame being put out, whose number is (frames taken) - (stock). The voltage appears at k + 1,
 * at the card's DAC at k + 2. So the error acts three periods late, the speed two.
 */
#ifndef VOLTAGE_H
#define VOLTAGE_H

#include "law.h"
#include "pcl.h"

enum { VOLTAGE_RANGE = 10 }; /* [V] of the card's DAC, both ways */

struct voltage {
    struct law_config config; /* its axes and pulses per mm as of the machine now */
    bool wanted[AXES], inverted[AXES];
    bool special; /* more than the P law is wanted */
    struct law law;
    struct commanded_path commanded_path;
    int32_t base[3];       /* [pulses] put out where the commanded path's coordinates are 0 */
    int64_t sum[AXES];     /* [pulses] of the frames taken since, without compensation */
    double place[AXES];    /* [pulses] the ideal point of it */
    int32_t added[AXES];   /* [pulses] compensation of the latest frame, */
    int32_t added_base[3]; /* [pulses] compensation there */
    int64_t frame;         /* being put out, */
    int64_t since;         /* [clock] the instant at which that was first seen */
};

/* At rest, with these gains; the commanded path begins at the first look. An axis is on if it is on
 * here and the machine uses it; pulses per mm are the machine's. */
void voltage_start(struct voltage *v, const struct law_config *c, const struct machine *m);

/* Before the tick of an instant: the machine may have another lead, direction or use of an axis,
 * set at standstill; then the law begins anew. */
void voltage_follow(struct voltage *v, const struct machine *m);

/* The card has taken so many frames of a transaction, whose points are still in the queue. */
void voltage_taken(struct voltage *v, const struct mcc *m, const struct pcl_part *part,
                   int32_t taken);

/* Voltages at a bus instant [clock], counted as the library counts, within +-limit [V]. */
void voltage_tick(struct voltage *v, const struct mcc *m, int64_t now, int32_t stock, double limit,
                  double volts[AXES]);

#endif
