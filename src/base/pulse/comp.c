#include "comp.h"

#include <stdlib.h>

#include "floor_divide.h"

bool comp_valid(const struct comp_table *t)
{
    if (t->interval < 0 || t->home < 0 || t->home >= COMP_POINTS) {
        return false;
    }
    for (int i = 0; i < COMP_POINTS; i++) {
        if (abs(t->forward[i]) > COMP_LARGEST || abs(t->backward[i]) > COMP_LARGEST) {
            return false;
        }
    }
    return true;
}

int32_t comp_wanted(const struct comp_table *t, int64_t position, bool backward)
{
    const int32_t *row = backward ? t->backward : t->forward;

    if (t->interval == 0) {
        return 0;
    }
    const int64_t below = floor_divide(position, t->interval) + t->home;
    if (below < 0) {
        return row[0];
    }
    if (below >= COMP_POINTS - 1) {
        return row[COMP_POINTS - 1];
    }
    const int64_t part = position - (below - t->home) * t->interval;
    const int64_t rise = (int64_t)(row[below + 1] - row[below]) * part;
    /* to the nearest pulse, halves upward */
    return row[below] + (int32_t)floor_divide(2 * rise + t->interval, 2 * (int64_t)t->interval);
}

static int32_t clamp(int64_t value, int64_t low, int64_t high)
{
    return (int32_t)(value < low ? low : value > high ? high : value);
}

int32_t comp_step(const struct comp_table *t, struct comp *c, int64_t position, int32_t frame,
                  const struct comp_limits *l)
{
    if (frame != 0) {
        c->backward = frame < 0;
    }
    if (abs(frame) > l->command) {
        return 0;
    }
    const int64_t missing = (int64_t)comp_wanted(t, position, c->backward) - c->added;
    const int32_t fits = clamp(missing, -(int64_t)l->change, l->change);
    const int32_t add = clamp(fits, -(int64_t)l->command - frame, (int64_t)l->command - frame);

    c->added += add;
    return add;
}

bool comp_done(const struct comp_table *t, const struct comp *c, int64_t position)
{
    return comp_wanted(t, position, c->backward) == c->added;
}
