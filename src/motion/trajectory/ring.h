/* ring - commands that wait for the interpolation or are in a chain under way; first in, first
 * out. */
#ifndef RING_H
#define RING_H

#include "brake.h"
#include "command.h"
#include "corner.h"

enum { RING_SIZE = 256 };

struct ring_entry {
    struct command command;
    union {
        struct {                       /* in a chain (lookahead.h) */
            struct corner corner;      /* at its start, with the command before */
            double body, turn;         /* [mm/s] most by the bend: of the command, of that corner */
            struct brake enter, leave; /* limits before the end of the corner at its start, and
                                        * before the start of the corner at its end */
        };
        struct axes_limits axis[AXES]; /* limits of a COMMAND_PTP_ASYN */
    };
};

struct ring {
    int32_t head, count;
    struct ring_entry entry[RING_SIZE];
};

void ring_clear(struct ring *r);
bool ring_full(const struct ring *r);
void ring_push(struct ring *r, const struct command *c); /* not when full */
/* Push a COMMAND_PTP_ASYN, with limits of each axis. */
void ring_push_asyn(struct ring *r, const struct command *c, const struct axes_limits axis[AXES]);
const struct command *ring_head(const struct ring *r); /* NULL when empty */
void ring_pop(struct ring *r);                         /* not when empty */

/* Entry i from the head, 0 .. count - 1. */
static inline struct ring_entry *ring_at(struct ring *r, int32_t i)
{
    return &r->entry[(uint32_t)(r->head + i) % RING_SIZE];
}

static inline const struct ring_entry *ring_peek(const struct ring *r, int32_t i)
{
    return &r->entry[(uint32_t)(r->head + i) % RING_SIZE];
}

#endif
