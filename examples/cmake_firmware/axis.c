#include "axis.h"

void axis_start(struct axis *a)
{
    *a = (struct axis){ .speed = 0 };
    fifo_reset(&a->fifo, AXIS_DEPTH);
    dda_reset(&a->dda, 1, AXIS_TICKS, 1);
}

void axis_go(struct axis *a, int32_t way)
{
    a->left += way;
}

/* A pulse/ms faster, as fast, or slower: a ramp from v to rest takes v (v + 1)/2 pulses. */
static int32_t next_speed(const struct axis *a)
{
    int32_t v = a->speed < AXIS_TOP_SPEED ? a->speed + 1 : AXIS_TOP_SPEED;
    while (v > 0 && v * (v + 1) / 2 > a->left)
        v--;
    return v;
}

void axis_plan(struct axis *a)
{
    while (a->fifo.stock < AXIS_DEPTH) {
        a->speed = next_speed(a);
        a->left -= a->speed;
        fifo_push(&a->fifo, a->waiting, a->speed);
    }
}

void axis_begin(struct axis *a)
{
    int32_t command = 0;
    a->underflows += !fifo_pop(&a->fifo, a->waiting, &command);
    dda_begin(&a->dda, &command);
}

int64_t axis_pulses(const struct axis *a, int64_t tick)
{
    int64_t pulses;
    dda_counts(&a->dda, tick, &pulses);
    return pulses;
}
