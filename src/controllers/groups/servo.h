/* servo - the axes of a library that the PC moves by voltages: their frames, errors and law.
 *
 * At bus instant k the PC takes the frames whose DDA time begins by k + 1 and knows the command c
 * of that instant; what it computes from c and from the counters shows at k + 1. The card shows at
 * k the counts p of k - 1. So the error is that of one instant, e = c(k-1) - p(k-1), and the lag
 * of a steady motion at speed v with gain Kp is v / Kp exactly, however late the voltage is.
 *
 *     instant   k-1         k               k+1          k+2
 *     card      counts p    shows p                      DAC shows u
 *     PC                    u = K e, takes  shows u,
 *                           frames          c of k+1
 */
#ifndef SERVO_H
#define SERVO_H

#include "dda.h"
#include "voltage.h"

struct servo {
    struct dda dda; /* in software: its pulses exist as numbers only */
    struct voltage voltage;
    int32_t before[AXES]; /* [pulses] command at k - 1, */
    int32_t now[AXES];    /* at k */
    int32_t next[AXES];   /* and at k + 1, which shows there */
    double volts[AXES];   /* [V] as the drive has it: of an inverted axis turned round */
    int32_t starved;      /* DDA times of standstill in the middle of a motion */
};

/* At rest at clock 0; the law's period, axes and pulses per mm come from the machine. */
void servo_start(struct servo *s, const struct law_config *law, const struct machine *m,
                 int64_t bus);

/* A bus instant, with the counters as the card shows them. The library has the points of all cycles
 * before now + bus. */
void servo_instant(struct servo *s, struct mcc *m, int64_t now, int64_t bus,
                   const int32_t counts[AXES]);

#endif
