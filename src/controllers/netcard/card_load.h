/* card_load - share of the processor that tasks and interrupts have had in the last second.
 *
 *     told    v  v  v  v  v  v  v  v  v  v  v     each time what everyone has had so far is kept,
 *             '------- 1 s -------------'         but not more often than each 0.1 s
 *
 * The share is that since the youngest mark of an age of 1 s, so up to 1.1 s are looked at. Until
 * there is one it is the share since power-up; told more rarely than each second, since the last
 * time.
 */
#ifndef CARD_LOAD_H
#define CARD_LOAD_H

#include <stdbool.h>
#include <stdint.h>

enum { CARD_LOADS = 7, CARD_LOAD_MARKS = 11 };

struct card_load {
    int32_t latest; /* index of the latest mark */
    struct card_load_mark {
        int64_t clock;            /* [ns] of the kernel */
        int64_t busy[CARD_LOADS]; /* [ns] so far */
    } mark[CARD_LOAD_MARKS];      /* all 0: that of power-up */
};

/* Tell what each has had so far at this clock [ns], and get the share of each [1/1000]. */
void card_load_tell(struct card_load *l, int64_t clock, const int64_t busy[CARD_LOADS],
                    uint16_t share[CARD_LOADS]);

#endif
