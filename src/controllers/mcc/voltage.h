/* voltage - the control law of law.h at the card: it gathers what the law sees of frames, pulses
 * and counters at each bus instant, and gives the voltages of the axes.
 *
 * At bus instant k the library sees pulses and FIFO of k, but the error counters of k - 1: the card
 * counts at an instant and shows the counts at the next. The speed of the commanded point is that
 * of the frame being put out at k, whose number is (frames taken) - (stock). The voltage appears at
 * k + 1, and at the card's DAC at k + 2. So the error acts three periods late, the speed two.
 */
#ifndef VOLTAGE_H
#define VOLTAGE_H

#include "law.h"
#include "pcl.h"

enum { VOLTAGE_RANGE = 10 }; /* [V] of the card's DAC, both ways */

struct voltage {
    struct law_config config; /* with the axes and pulses per mm that the machine has now */
    bool wanted[AXES], inverted[AXES]; /* the gains have the axis on; the machine inverts it */
    bool special;                      /* more than the P law is in use */
    struct law law;
    struct commanded_path commanded_path;
    int32_t base[3];       /* [pulses] put out where the commanded path starts, at 0 */
    int64_t sum[AXES];     /* [pulses] of the frames taken since, without compensation */
    double place[AXES];    /* [pulses] the same before it was rounded to pulses */
    int32_t added[AXES];   /* [pulses] compensation of the latest frame taken */
    int32_t added_base[3]; /* [pulses] compensation where the commanded path starts */
    int64_t frame;         /* number of the frame being put out, */
    int64_t since;         /* [clock] of the instant at which it was first seen */
};

/* At rest, with these gains; the commanded path begins at the first instant. An axis is on if it is
 * on in c and the machine uses it; pulses per mm are the machine's. */
void voltage_start(struct voltage *v, const struct law_config *c, const struct machine *m);

/* Call before the tick of an instant: if the machine has got another lead, direction or use of an
 * axis meanwhile, at standstill, the law begins anew with these. */
void voltage_follow(struct voltage *v, const struct machine *m);

/* Note that the card has taken so many frames of a transaction. Its points must still be in the
 * queue. */
void voltage_taken(struct voltage *v, const struct mcc *m, const struct pcl_part *part,
                   int32_t taken);

/* Compute the voltages at a bus instant `now` [clock], within +-limit [V], with signs as the
 * library counts; `stock` is that of the card's watched FIFO. */
void voltage_tick(struct voltage *v, const struct mcc *m, int64_t now, int32_t stock, double limit,
                  double volts[AXES]);

#endif
