/* single_buffer_literal - reference model of the single-buffer card for its tests: literal DDA
 * accumulators, stepped clock by clock, axis 6 unused. It shares only the interrupt latch with the
 * card, which has a test of its own. */
#ifndef SINGLE_BUFFER_LITERAL_H
#define SINGLE_BUFFER_LITERAL_H

#include <stdlib.h>
#include <string.h>

#include "single_buffer.h"

enum { AXES = EPCIO_AXES, LITERAL_UNUSED = 5, LITERAL_FIFO = 0x1F };

struct literal {
    bool latched, run, running, waits, stopped;
    int64_t now;
    int32_t length, divider, next_length, next_divider;
    int64_t elapsed; /* [clocks] since the begin of this DDA time, or of the wait */
    int32_t acc[AXES], command[AXES], waiting[AXES], last[AXES], underflows[AXES];
    int64_t out[AXES], gap[AXES], stood;
    struct irq irq;
    struct bus_write coming[BUS_DEPTH];
    int on_way;
    int32_t ack, taken, refused;
};

static void literal_begin(struct literal *m, const int32_t *command)
{
    for (int i = 0; i < AXES; i++) {
        m->command[i] = command ? command[i] : 0;
        m->acc[i] = 1 << (m->next_length - 1);
        if (command && m->last[i] && command[i] && !m->stopped)
            m->gap[i] += m->stood;
        m->last[i] = command ? command[i] : m->last[i];
    }
    m->stood = command ? 0 : m->stood;
    m->stopped = command ? false : m->stopped;
    m->running = command != NULL;
    m->length = m->next_length;
    m->divider = m->next_divider;
    m->elapsed = 0;
}

static void literal_boundary(struct literal *m)
{
    bool freed = !m->latched || m->waits;
    for (int i = 0; i < AXES; i++)
        m->underflows[i] += !freed && m->command[i] != 0;
    literal_begin(m, m->waits ? m->waiting : NULL);
    m->waits = false;
    irq_raise(&m->irq, IRQ_DDA, freed ? LITERAL_FIFO | 0x40 : 0x40, m->now);
}

/* One clock of the DDA. */
static void literal_clock(struct literal *m)
{
    m->now++;
    if (!m->run)
        return;
    m->elapsed++;
    if (!m->running) {
        m->stood++;
        for (int i = 0; i < AXES && !m->latched; i++) /* at the first clock of the wait */
            m->underflows[i] += m->stood == 1 && m->last[i] != 0;
        if (!m->latched)
            return;
    }
    for (int i = 0; i < AXES && m->elapsed % m->divider == 0; i++) {
        m->acc[i] += abs(m->command[i]);
        if (m->acc[i] >= 1 << m->length) {
            m->acc[i] -= 1 << m->length;
            m->out[i] += m->command[i] < 0 ? -1 : 1;
        }
    }
    if (m->elapsed == (int64_t)m->divider << m->length)
        literal_boundary(m);
}

static bool literal_write(struct literal *m, const int32_t *frame)
{
    for (int i = 0; i < AXES; i++)
        if (abs(frame[i]) >= 1 << m->next_length || (i == LITERAL_UNUSED && frame[i] != 0))
            return false;
    if (m->latched ? m->waits : m->running)
        return false;
    if (m->latched) {
        m->waits = true;
        memcpy(m->waiting, frame, sizeof m->waiting);
    } else {
        literal_begin(m, frame);
    }
    return true;
}

static void literal_arrivals(struct literal *m)
{
    while (m->on_way > 0 && m->coming[0].clock <= m->now) {
        bool ok = true;
        for (int k = 0; k < m->coming[0].count; k++) {
            ok = ok && literal_write(m, m->coming[0].frame[k]);
            m->taken += ok;
            m->refused += !ok;
        }
        m->ack = m->coming[0].seq;
        memmove(m->coming, m->coming + 1, sizeof m->coming - sizeof m->coming[0]);
        m->on_way--;
    }
}

static bool literal_set_dda(struct literal *m, int32_t length, int32_t divider)
{
    bool still = true;
    for (int i = 0; i < AXES; i++) {
        if (m->waits && abs(m->waiting[i]) >= 1 << length)
            return false;
        still = still && m->command[i] == 0;
    }
    m->next_length = length;
    m->next_divider = divider;
    if (still && m->elapsed == 0) {
        m->length = length;
        m->divider = divider;
        for (int i = 0; i < AXES; i++)
            m->acc[i] = 1 << (length - 1);
    }
    return true;
}

static void literal_clear(struct literal *m)
{
    for (int k = 0; k < m->on_way; k++) {
        m->ack = m->coming[k].seq;
        m->refused += m->coming[k].count;
    }
    m->on_way = 0;
    if (m->waits)
        irq_raise(&m->irq, IRQ_DDA, LITERAL_FIFO, m->now);
    m->waits = false;
    m->stopped = true;
}

#endif
