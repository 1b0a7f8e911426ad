/* FIFO, transactions and DDA of the model: plain arrays, an accumulator an axis. */
#include "tick_state.h"

/* FIFO and transactions. */

static void watch(struct tick *m, int axis)
{
    struct queue *q = &m->fifo[axis];
    bool was_high = q->high;
    q->high = q->stock > m->minimum;
    if (was_high && !q->high)
        tick_fire(m, PAGE_DDA, axis, m->clock);
}

static int64_t oldest(struct queue *q)
{
    int64_t command = q->command[0];
    q->stock--;
    for (int k = 0; k < q->stock; k++)
        q->command[k] = q->command[k + 1];
    return command;
}

static int64_t refuse(struct tick *m, int64_t status, int64_t axis, int64_t command)
{
    m->refusal[0] = status;
    m->refusal[1] = axis;
    m->refusal[2] = command;
    return status;
}

int64_t tick_write_frame(void *card, const int64_t *frame)
{
    struct tick *m = card;
    if (m->expired || (m->stop && m->stop_enable))
        return refuse(m, TICK_STOPPED, 0, frame[0]);
    for (int i = 0; i < TICK_AXES; i++) {
        if (!m->active[i] && frame[i] != 0)
            return refuse(m, TICK_AXIS_UNUSED, i, frame[i]);
        if (llabs(frame[i]) > (1 << m->next_length) - 1)
            return refuse(m, TICK_COMMAND_TOO_LARGE, i, frame[i]);
        if (m->fifo[i].stock == TICK_DEPTH) {
            m->overflows++;
            return refuse(m, TICK_FIFO_FULL, i, frame[i]);
        }
    }
    for (int i = 0; i < TICK_AXES; i++) {
        if (!m->active[i])
            continue;
        m->fifo[i].command[m->fifo[i].stock++] = frame[i];
        watch(m, i);
    }
    return TICK_OK;
}

/* The transaction in front leaves the bus; `taken` of its frames are in the FIFOs. */
static void leave(struct tick *m, int64_t taken)
{
    const struct transaction *w = &m->bus[0];
    m->cmd_ack = w->seq;
    m->frames_taken += taken;
    m->frames_refused += w->count - taken;
    m->arrived_seq[m->arrivals] = w->seq;
    m->arrived_taken[m->arrivals++] = taken;
    m->on_the_way--;
    for (int k = 0; k < m->on_the_way; k++)
        m->bus[k] = m->bus[k + 1];
}

void tick_arrive(struct tick *m)
{
    while (m->on_the_way > 0 && m->bus[0].clock <= m->clock) {
        int64_t taken = 0;
        while (taken < m->bus[0].count && tick_write_frame(m, m->bus[0].frame[taken]) == TICK_OK)
            taken++;
        leave(m, taken);
    }
}

int64_t tick_post(void *card, int64_t seq, int64_t clock, int64_t count, const int64_t *frames)
{
    struct tick *m = card;
    if (m->on_the_way == TICK_BUS)
        return TICK_BUS_FULL;
    struct transaction *w = &m->bus[m->on_the_way++];
    w->seq = seq;
    w->clock = clock;
    w->count = count;
    memcpy(w->frame, frames, (size_t)count * sizeof w->frame[0]);
    tick_arrive(m);
    return TICK_OK;
}

int64_t tick_arrivals(void *card, int64_t *seq, int64_t *taken)
{
    struct tick *m = card;
    int64_t n = m->arrivals;
    memcpy(seq, m->arrived_seq, sizeof m->arrived_seq);
    memcpy(taken, m->arrived_taken, sizeof m->arrived_taken);
    m->arrivals = 0;
    return n;
}

int64_t tick_clear(void *card)
{
    struct tick *m = card;
    while (m->on_the_way > 0) {
        if (m->bus[0].count > 0)
            refuse(m, TICK_DROPPED, 0, m->bus[0].frame[0][0]);
        leave(m, 0);
    }
    for (int i = 0; i < TICK_AXES; i++) {
        while (m->fifo[i].stock > 0)
            m->emptied[i] += oldest(&m->fifo[i]);
        watch(m, i);
    }
    return TICK_OK;
}

int64_t tick_erase_last(void *card, int64_t axis, int64_t n)
{
    struct tick *m = card;
    int64_t erased = 0;
    while (erased < n && m->fifo[axis].stock > 0) {
        m->fifo[axis].stock--;
        erased++;
    }
    watch(m, (int)axis);
    return erased;
}

int64_t tick_shift_out(void *card, int64_t axis, int64_t *command)
{
    struct tick *m = card;
    if (m->fifo[axis].stock == 0)
        return TICK_FIFO_EMPTY;
    *command = oldest(&m->fifo[axis]);
    watch(m, (int)axis);
    return TICK_OK;
}

int64_t tick_set_minimum(void *card, int64_t minimum)
{
    struct tick *m = card;
    m->minimum = minimum;
    for (int i = 0; i < TICK_AXES; i++)
        watch(m, i);
    return TICK_OK;
}

/* DDA. */

/* The length and divider asked for become those of the DDA time that begins. What the accumulators
 * hold is the same share of a pulse. */
static void take_time(struct tick *m)
{
    for (int i = 0; i < TICK_AXES; i++)
        m->accumulator[i] = (m->accumulator[i] << m->next_length) >> m->length;
    m->length = m->next_length;
    m->divider = m->next_divider;
}

static void boundary(struct tick *m)
{
    m->ticks = 0;
    take_time(m);
    for (int i = 0; i < TICK_AXES; i++) {
        if (!m->active[i])
            continue;
        bool moved = m->command[i] != 0, empty = m->fifo[i].stock == 0;
        m->before[i] = m->pulses[i];
        m->command[i] = empty ? 0 : oldest(&m->fifo[i]);
        if (empty && moved)
            m->underflows[i]++;
        watch(m, i);
    }
    tick_fire(m, PAGE_DDA, CYCLE_BIT, m->clock);
}

void tick_dda_clock(struct tick *m)
{
    if (++m->part < m->divider)
        return;
    m->part = 0;
    for (int i = 0; i < TICK_AXES; i++) {
        m->accumulator[i] += llabs(m->command[i]);
        if (m->accumulator[i] >= 1 << m->length) {
            m->accumulator[i] -= 1 << m->length;
            m->pulses[i] += m->command[i] > 0 ? 1 : -1;
        }
    }
    if (++m->ticks == 1 << m->length)
        boundary(m);
}

void tick_ask_time(struct tick *m, int64_t length, int64_t divider)
{
    bool idle = m->ticks == 0 && m->part == 0;
    for (int i = 0; i < TICK_AXES; i++)
        idle = idle && m->command[i] == 0;
    m->next_length = length;
    m->next_divider = divider;
    if (idle)
        take_time(m);
}

int64_t tick_set_dda(void *card, int64_t length, int64_t divider)
{
    struct tick *m = card;
    for (int i = 0; i < TICK_AXES; i++)
        for (int k = 0; k < m->fifo[i].stock; k++)
            if (llabs(m->fifo[i].command[k]) > (1 << length) - 1)
                return TICK_STOCK_TOO_LARGE;
    tick_ask_time(m, length, divider);
    return TICK_OK;
}

int64_t tick_set_run(void *card, int64_t run)
{
    struct tick *m = card;
    m->run = run != 0;
    return TICK_OK;
}
