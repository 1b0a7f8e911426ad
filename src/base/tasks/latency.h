/* latency - random interrupt latency of a PC: the time from an interrupt to the first instruction
 * of its routine. It is drawn from a mixture of two distributions:
 *
 *     least + exponential with a mean    mostly
 *     uniform between least and most     rarely: a driver, of graphics for instance, keeps
 *                                        interrupts disabled
 *
 * Such a mixture fits the figures of ordinary PCs in LatencyMon reports. Numbers come from a seeded
 * generator (splitmix64), so that a run can be repeated.
 */
#ifndef LATENCY_H
#define LATENCY_H

#include <stdint.h>

struct latency {
    double least, mean, most; /* [clocks] mean is that of the exponential part alone */
    double rare;              /* probability of the uniform distribution, 0 .. 1 */
};

/* A random number, uniform in [0, 1); `random` is the generator's state. */
double latency_uniform(uint64_t *random);

/* Latency of one interrupt [clocks]. It always draws two random numbers, whichever distribution. */
int64_t latency_draw(const struct latency *l, uint64_t *random);

#endif
