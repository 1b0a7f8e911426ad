/* latency - how long a PC lets an interrupt wait.
 *
 *     least + exponential of a mean      mostly
 *     uniform between least and most     rarely: somebody keeps the interrupts off, a graphics
 *                                        driver for one
 *
 * The figures of ordinary PCs that such a law fits are those of LatencyMon reports. Numbers come
 * from a seeded state (splitmix64), so that a run can be repeated.
 */
#ifndef LATENCY_H
#define LATENCY_H

#include <stdint.h>

struct latency {
    double least, mean, most; /* [clocks]; mean is that of what is added to least */
    double rare;              /* probability of the second line, 0..1 */
};

/* Uniform in [0, 1). */
double latency_uniform(uint64_t *random);

/* One interrupt's wait. [clocks] Two numbers are drawn whatever the law. */
int64_t latency_draw(const struct latency *l, uint64_t *random);

#endif
