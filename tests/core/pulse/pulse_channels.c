/* The pulse core as a card of four channels would use it: FIFOs of 512, a clock of 20 ns, a DDA
 * time of any number of clocks, which grows and shrinks while pulses are put out (a rate that
 * pauses on the path). Against accumulators stepped clock by clock. */
#include "check.h"
#include "fifo.h"
#include "pulse.h"

#include <stdlib.h>
#include <string.h>

enum {
    CHANNELS = 4,
    DEPTH = 512,
    HALF = DEPTH / 2,
    CLOCK_NS = 20,
    TIME = 1000000 / CLOCK_NS, /* [clocks] 1 ms */
    WIDTH = 1000 / CLOCK_NS,   /* [clocks] 1 us */
    SENT_MAX = 8192,
};

/* What one channel is by addition, queue and looking at the lines. */
struct literal {
    int32_t sent[SENT_MAX], written, taken;
    int32_t accumulator, command;
    int64_t count;
    int64_t latest; /* [clock] of the latest pulse of this DDA time, -1 if none */
    struct lines lines;
    int64_t received;
};

struct rig {
    struct dda dda;
    struct fifo fifo[CHANNELS];
    int32_t entry[CHANNELS][DEPTH];
    struct pulse pulse[CHANNELS];
    struct literal literal[CHANNELS];
    int32_t falls; /* of a stock to half */
};

static const struct pulse_config CONFIG[CHANNELS] = {
    { PULSE_DIRECTION, 0, WIDTH },
    { PULSE_CW_CCW, 0, WIDTH },
    { PULSE_AB, 0, WIDTH },
    { PULSE_DIRECTION, LINES_A_INVERSE | LINES_SWAP, WIDTH },
};

static struct rig rig;

static void power_on(struct rig *r, int32_t ticks)
{
    memset(r, 0, sizeof *r);
    dda_reset(&r->dda, CHANNELS, ticks, 1);
    for (int i = 0; i < CHANNELS; i++) {
        fifo_reset(&r->fifo[i], DEPTH);
        pulse_reset(&r->pulse[i]);
        r->literal[i].latest = -1;
        r->literal[i].accumulator = ticks / 2;
        r->literal[i].lines = pulse_at(&CONFIG[i], &r->pulse[i], &r->dda, i, 0);
    }
}

static void watch(struct rig *r, int i, int32_t before)
{
    const struct literal *m = &r->literal[i];
    const bool fell = fifo_fell(&r->fifo[i], HALF);
    CHECK_EQ(fell, before > HALF && m->written - m->taken <= HALF);
    r->falls += fell;
    CHECK_EQ(r->fifo[i].stock, m->written - m->taken);
}

/* A frame for each channel, at most half a pulse a clock; refused while the FIFO is full. */
static void write(struct rig *r, uint64_t *seed, int32_t ticks)
{
    for (int i = 0; i < CHANNELS; i++) {
        struct literal *m = &r->literal[i];
        const int32_t top = check_random(seed, 0, 3) ? ticks / 2 : 20;
        const int32_t before = r->fifo[i].stock, command = (int32_t)check_random(seed, -top, top);
        CHECK_EQ(fifo_push(&r->fifo[i], r->entry[i], command), before < DEPTH);
        if (before < DEPTH)
            m->sent[m->written++] = command;
        watch(r, i, before);
    }
}

/* Lines at a clock: pulses that a receiver sees. */
static void receive(struct rig *r, int i, int64_t clock)
{
    struct literal *m = &r->literal[i];
    const struct lines now = pulse_at(&CONFIG[i], &r->pulse[i], &r->dda, i, clock);
    const struct lines was = m->lines;
    if (CONFIG[i].format == PULSE_CW_CCW)
        m->received += (now.a && !was.a) - (now.b && !was.b);
    else if (CONFIG[i].format == PULSE_AB)
        m->received += now.a != was.a   ? (now.a != now.b ? 1 : -1)
                       : now.b != was.b ? (now.a == now.b ? 1 : -1)
                                        : 0;
    else if (CONFIG[i].wiring == 0)
        m->received += now.a && !was.a ? (now.b ? -1 : 1) : 0;
    else /* direction on A, the pulse on B, low while it is on */
        m->received += !now.b && was.b ? (now.a ? -1 : 1) : 0;
    m->lines = now;
}

/* A clock of a channel: an overflow is a pulse, and its distance from the one before in this DDA
 * time is the mean distance, rounded down or up. */
static void step(struct rig *r, int i, int64_t clock)
{
    struct literal *m = &r->literal[i];
    const int32_t ticks = r->dda.ticks, size = abs(m->command);
    m->accumulator += size;
    if (m->accumulator < ticks)
        return;
    m->accumulator -= ticks;
    m->count += m->command < 0 ? -1 : 1;
    if (m->latest >= 0)
        CHECK(clock - m->latest == ticks / size || clock - m->latest == (ticks + size - 1) / size);
    m->latest = clock;
}

/* The boundary: what was put out is what was taken; another rate from here on. */
static void boundary(struct rig *r, int32_t ticks)
{
    int32_t next[CHANNELS] = { 0 };
    for (int i = 0; i < CHANNELS; i++) {
        struct literal *m = &r->literal[i];
        int64_t sum = 0;
        for (int32_t k = 0; k < m->taken; k++)
            sum += m->sent[k];
        CHECK_EQ(m->count, sum);
        CHECK_EQ(m->accumulator, r->dda.ticks / 2);
        const int32_t before = r->fifo[i].stock;
        m->command = 0;
        CHECK_EQ(fifo_pop(&r->fifo[i], r->entry[i], &next[i]), before > 0);
        if (before > 0)
            m->command = m->sent[m->taken++];
        CHECK_EQ(next[i], m->command);
        watch(r, i, before);
        pulse_boundary(&CONFIG[i], &r->pulse[i], &r->dda, i);
        m->accumulator = ticks / 2;
        m->latest = -1;
    }
    dda_set_time(&r->dda, ticks, 1, dda_boundary(&r->dda));
    dda_begin(&r->dda, next);
}

static void run(uint64_t seed, int32_t ticks, int times)
{
    struct rig *r = &rig;
    int64_t counts[CHANNELS], clock = 0;
    power_on(r, ticks);
    for (int t = 0; t < times; t++) {
        for (int64_t n = check_random(&seed, 0, 2) ? 1 : check_random(&seed, 0, 700); n > 0; n--)
            if (r->literal[0].written < SENT_MAX)
                write(r, &seed, ticks);
        while (++clock <= dda_boundary(&r->dda)) {
            dda_counts(&r->dda, clock, counts);
            for (int i = 0; i < CHANNELS; i++) {
                step(r, i, clock);
                CHECK_EQ(counts[i], r->literal[i].count);
                if (clock == dda_boundary(&r->dda))
                    continue;
                receive(r, i, clock);
            }
        }
        clock--;
        for (int k = check_random(&seed, 0, 5) ? 0 : 600; k > 0; k--) /* taken, put out at rest */
            for (int i = 0; i < CHANNELS && r->fifo[i].stock > 0; i++) {
                int32_t command = 0, before = r->fifo[i].stock;
                struct literal *m = &r->literal[i];
                CHECK(fifo_pop(&r->fifo[i], r->entry[i], &command));
                CHECK_EQ(command, m->sent[m->taken]);
                memmove(m->sent + m->taken, m->sent + m->taken + 1,
                        (size_t)(--m->written - m->taken) * sizeof *m->sent);
                watch(r, i, before);
            }
        const int64_t slower = check_random(&seed, 0, 1) ? 4 : check_random(&seed, 4, 40);
        boundary(r, (int32_t)(ticks * slower / 4));
        for (int i = 0; i < CHANNELS; i++) {
            receive(r, i, clock);
            CHECK_EQ(r->literal[i].received, r->literal[i].count);
        }
    }
}

int main(void)
{
    int32_t falls = 0;
    run(1, TIME, 8);
    for (uint64_t seed = 2; seed < 12; seed++) {
        run(seed * 7919, (int32_t)seed * 97, 60);
        falls += rig.falls;
    }
    CHECK(falls > 10);
    return check_result();
}
