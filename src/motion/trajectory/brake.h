/* brake - most speed before a place, from the limits that lie behind it.
 *
 *   v ^ \                     A step allows `speed` on the last `even` of the way to the place, and
 *     |  \______  step 1      what a deceleration from that gives before it; the least of all steps
 *     |         \             counts. A limit is even for some way before it begins, because a mean
 *     |          \__  step 0  over a time smears the motion.
 *     +-------------> place
 */
#ifndef BRAKE_H
#define BRAKE_H

#include <stdint.h>

enum { BRAKE_STEPS = 4 };

struct brake_step {
    double speed; /* [mm/s] */
    double even;  /* [mm] */
};

struct brake {
    struct brake_step step[BRAKE_STEPS]; /* both ascending */
    int32_t count;
};

/* Rest at the place. */
void brake_rest(struct brake *b);

/* One step more. With too many, two become one that holds for both. */
void brake_limit(struct brake *b, double speed, double even);

/* Limits before a place become limits before an earlier one, `way` [mm] back; the deceleration
 * between them is dec. */
void brake_back(struct brake *b, double way, double dec);

/* What is allowed on a segment of the way. */
struct brake_segment {
    double end;   /* [mm] */
    double top;   /* [mm/s] most speed on it; INFINITY: what can be braked to `leave` */
    double leave; /* [mm/s] most speed at its end */
};

/* The segment that begins at s; the place is at `place`, beyond s. */
struct brake_segment brake_next(const struct brake *b, double s, double place, double dec);

#endif
