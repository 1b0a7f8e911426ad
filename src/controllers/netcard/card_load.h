/* card_load - share of the processor's time that each task and the interrupts have had in the last
 * second.
 *
 *     told    v  v  v  v  v  v  v  v  v  v  v     each call marks the busy times so far, but at
 *             '------- 1 s -------------'         most one mark is kept for each 0.1 s
 *
 * The share is that since the youngest mark that is at least 1 s old, so up to 1.1 s count. Until
 * there is such a mark the share is that since power-up; if calls are rarer than one a second, that
 * since the call before.
 */
#ifndef CARD_LOAD_H
#define CARD_LOAD_H

#include <stdbool.h>
#include <stdint.h>

enum { CARD_LOADS = 7, CARD_LOAD_MARKS = 11 };

struct card_load {
    int32_t latest; /* index of the latest mark */
    struct card_load_mark {
        int64_t clock;            /* [ns] clock of the kernel */
        int64_t busy[CARD_LOADS]; /* [ns] processor time of each since power-up */
    } mark[CARD_LOAD_MARKS];      /* the one that is all 0 is that of power-up */
};

/* Take the processor time that each has had at this clock [ns], and give its share [1/1000]. */
void card_load_tell(struct card_load *l, int64_t clock, const int64_t busy[CARD_LOADS],
                    uint16_t share[CARD_LOADS]);

#endif
