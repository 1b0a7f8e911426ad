/* player_ticks - reference model of the player for its tests: the hardware, stepped clock by clock.
 * It shares no code with the player. */
#ifndef PLAYER_TICKS_H
#define PLAYER_TICKS_H

#include <stdlib.h>
#include <string.h>

#include "player.h"

enum { TICKS_DEPTH = 64 };

struct ticks {
    int depth, width, setup, hold, period;
    struct frame fifo[TICKS_DEPTH], frame;
    int stock, high;
    int running, playing, whole;
    int64_t clock, accumulator, tick, wait, dead, dry, refused, frames;
    int64_t sum[FRAME_AXES], count[FRAME_AXES];   /* accumulators of the DDA; pulses so far */
    int high_left[FRAME_AXES], since[FRAME_AXES]; /* [clocks] left of the pulse; since its end */
    int backward[FRAME_AXES], wanted[FRAME_AXES]; /* direction line; direction of the frame */
    int64_t turn_in[FRAME_AXES];                  /* [clocks] until the direction line changes */
    uint32_t told, events;
};

static inline void ticks_start(struct ticks *t, int depth, int width, int setup, int hold,
                               int period)
{
    memset(t, 0, sizeof *t);
    t->depth = depth, t->width = width, t->setup = setup, t->hold = hold, t->period = period;
    for (int i = 0; i < FRAME_AXES; i++) {
        t->since[i] = 1 << 30;
    }
}

static inline void ticks_look(struct ticks *t)
{
    const int high = 2 * t->stock > t->depth + (t->depth % 2 == 0 ? 0 : -1);
    t->told |= t->high && !high ? PLAYER_HALF : 0;
    t->high = high;
}

static inline int ticks_push(struct ticks *t, const struct frame *f)
{
    if (t->stock == t->depth) {
        t->refused++;
        return PLAYER_FULL;
    }
    t->fifo[t->stock++] = *f;
    ticks_look(t);
    return PLAYER_OK;
}

/* Number of ticks before an axis' first pulse, found by running its accumulator. */
static inline int64_t ticks_first(const struct ticks *t, int command)
{
    int64_t sum = t->period / 2, n = 0;
    for (; sum < t->period; n++) {
        sum += abs(command);
    }
    return n;
}

static inline void ticks_period(struct ticks *t)
{
    t->tick = 0;
    for (int i = 0; i < FRAME_AXES; i++) {
        t->sum[i] = t->period / 2;
    }
    if (t->stock == 0) {
        memset(&t->frame, 0, sizeof t->frame);
        if (t->whole) {
            t->running = t->playing = 0;
            t->accumulator = 0;
            t->told |= PLAYER_ENDED;
        } else {
            t->told |= t->playing || !t->running ? PLAYER_DRY : 0;
            t->playing = 0;
            t->running = 1;
            t->dry++;
        }
        return;
    }
    t->frame = t->fifo[0];
    memmove(t->fifo, t->fifo + 1, sizeof *t->fifo * (size_t)--t->stock);
    ticks_look(t);
    t->frames++;
    t->running = t->playing = 1;
    t->wait = 0;
    if (t->frame.event) {
        t->told |= PLAYER_EVENT;
        t->events |= 1u << t->frame.event;
    }
    for (int i = 0; i < FRAME_AXES; i++) {
        const int c = t->frame.command[i];
        if (c != 0 && (c < 0) != t->wanted[i]) {
            t->wanted[i] = c < 0;
            /* clocks until the last pulse is over and held */
            int64_t in = t->high_left[i] > 0 ? t->high_left[i] + t->hold : t->hold - t->since[i];
            t->turn_in[i] = in > 0 ? in : 0;
            const int64_t wait = t->turn_in[i] + t->setup - ticks_first(t, c);
            t->wait = wait > t->wait ? wait : t->wait;
        }
    }
    t->dead += t->wait;
}

/* Advance by one clock at this rate. */
static inline void ticks_clock(struct ticks *t, int64_t rate)
{
    int pulse[FRAME_AXES] = { 0 }, end = 0;

    t->clock++;
    if (t->running && t->wait > 0) {
        t->wait--;
    } else if (t->running) {
        t->accumulator += rate;
        if (t->accumulator >= PLAYER_FULL_RATE) {
            t->accumulator -= PLAYER_FULL_RATE;
            for (int i = 0; i < FRAME_AXES; i++) {
                t->sum[i] += abs(t->frame.command[i]);
                if (t->sum[i] >= t->period) {
                    t->sum[i] -= t->period;
                    t->count[i] += t->frame.command[i] < 0 ? -1 : 1;
                    pulse[i] = 1;
                }
            }
            end = ++t->tick == t->period;
        }
    }
    for (int i = 0; i < FRAME_AXES; i++) {
        if (t->high_left[i] > 0) {
            t->since[i] = 0;
            t->high_left[i]--;
        } else {
            t->since[i]++;
        }
        if (pulse[i]) {
            t->high_left[i] = t->width;
        }
        if (t->turn_in[i] > 0) {
            t->turn_in[i]--;
        }
    }
    if (end) {
        ticks_period(t);
    }
    for (int i = 0; i < FRAME_AXES; i++) {
        if (t->turn_in[i] == 0) {
            t->backward[i] = t->wanted[i];
        }
    }
}

/* Stop all pulses and empty the FIFO. */
static inline void ticks_clear(struct ticks *t)
{
    t->running = t->playing = t->stock = t->high = t->whole = 0;
    t->accumulator = t->tick = t->wait = 0;
    memset(&t->frame, 0, sizeof t->frame);
    for (int i = 0; i < FRAME_AXES; i++) {
        t->wanted[i] = t->backward[i];
        t->turn_in[i] = 0;
    }
}

#endif
