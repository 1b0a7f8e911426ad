/* servo - position control in software for a library whose axes the PC moves by voltages: it puts
 * out the frames as numbers, forms the errors and computes the control law of law.h.
 *
 * At bus instant k the PC takes the frames whose DDA time begins by k + 1, and so knows the
 * commanded position c of that instant. What it computes from c and from the counters shows at k +
 * 1. The card shows at k the counts p of k - 1. So both are of one instant, e = c(k-1) - p(k-1),
 * and the following error of a steady motion at speed v with gain Kp is exactly v / Kp, however
 * late the voltage is.
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
    int32_t before[AXES]; /* [pulses] commanded position at k - 1, */
    int32_t now[AXES];    /* [pulses] at k, */
    int32_t next[AXES];   /* [pulses] and at k + 1, where it shows */
    double volts[AXES];   /* [V] for the drive: the sign of an inverted axis is turned */
    int32_t starved;      /* DDA times of standstill in the middle of a motion */
};

/* Start at rest at clock 0. The law's period is the bus period [clocks], its axes and pulses per mm
 * are the machine's. */
void servo_start(struct servo *s, const struct law_config *law, const struct machine *m,
                 int64_t bus);

/* One bus instant at clock `now`, with the counters as the card shows them. The library must have
 * the points of all interpolation cycles before now + bus. */
void servo_instant(struct servo *s, struct mcc *m, int64_t now, int64_t bus,
                   const int32_t counts[AXES]);

#endif
