#include "readout.h"

#include <string.h>

#include "mcc.h"
#include "offsets.h"

static struct readout_zero *at(struct readout *r, int32_t i)
{
    return &r->zero[(r->first + i) % READOUT_KEPT];
}

const struct readout_zero *readout_zero(const struct readout *r)
{
    return &r->zero[r->first];
}

static struct readout_zero zero_of(const struct mcc *m)
{
    const struct interpreter *in = &m->program;
    struct readout_zero z = { m->commands + 1, active_system(in), { 0.0 } };

    for (int i = 0; i < AXES; i++) {
        z.offset[i] = offsets_zero(in, i);
    }
    return z;
}

void readout_start(struct mcc *m)
{
    struct readout *r = &m->readout;

    r->zero[0] = zero_of(m);
    r->first = 0;
    r->count = 1;
    active_codes(&m->program, r->codes);
}

void readout_note(struct mcc *m)
{
    struct readout *r = &m->readout;
    const struct readout_zero z = zero_of(m);
    const struct readout_zero *last = at(r, r->count - 1);

    active_codes(&m->program, r->codes);
    if (z.system == last->system && memcmp(z.offset, last->offset, sizeof z.offset) == 0) {
        return;
    }
    if (r->count == READOUT_KEPT) {
        r->first = (r->first + 1) % READOUT_KEPT;
        r->count--;
    }
    *at(r, r->count) = z;
    r->count++;
}

void readout_look(struct mcc *m)
{
    struct readout *r = &m->readout;

    while (
        r->count > 1
        && (at(r, 1)->command <= m->written.command
            || (m->queue.count == 0 && m->ring.count == 0 && !trajectory_busy(&m->trajectory)))) {
        r->first = (r->first + 1) % READOUT_KEPT;
        r->count--;
    }
}
