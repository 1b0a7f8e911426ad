#include "inquiry.h"

#include <string.h>

#include "mcc.h"
#include "reaction.h"
#include "waiting.h"

int inquiry_set_place(struct mcc *m, enum inquiry_place place)
{
    if (m->running) {
        return MCC_COMMAND_NOTFINISHED;
    }
    m->inquiry.place = place;
    return MCC_NO_ERR;
}

/* True if all commands so far have ended and the card has taken their points. */
static bool ended(const struct mcc *m)
{
    return m->ring.count == 0 && !trajectory_busy(&m->trajectory) && !m->trajectory.stopped
           && !m->trajectory.confirming && !m->trajectory.untold && m->queue.count == 0;
}

static double value_of(const struct signals *s, const struct waiting *w)
{
    return w->kind == WAIT_ANALOG ? s->analog[w->index] : s->digital >> w->index & 1;
}

static void input(struct mcc *m, int64_t clocks)
{
    struct inquiry *q = &m->inquiry;
    const struct waiting *w = &m->program.wait;
    const double is = value_of(&m->signals, w);

    if (!q->waits) {
        if (!ended(m)) {
            return;
        }
        q->waits = true;
        q->was = is;
        q->clocks = -clocks;
    }
    q->clocks += clocks;
    if (waiting_done(w, is, q->was)) {
        waiting_answer(&m->program, is);
    } else if ((double)q->clocks >= w->limit * CLOCK_HZ) {
        waiting_answer(&m->program, -1.0);
    }
    q->was = is;
}

/* True if the card has latched the axis' counter since the probe began to move, and latches
 * count. */
static bool latched(const struct mcc *m, int i)
{
    return m->inquiry.place == INQUIRY_LATCH && m->program.wait.kind == WAIT_PROBE
           && m->machine.axis[i].used && m->signals.latched[i] != m->inquiry.latched[i];
}

/* True if the probe is as G38 wants it: it touches, or no longer touches. */
static bool contact(const struct mcc *m)
{
    bool any = m->signals.probe == (m->program.wait.mode == WAIT_HIGH);

    for (int i = 0; i < AXES; i++) {
        any = any || latched(m, i);
    }
    return any && !m->dry_run;
}

/* Before the probe moves: once the machine rests, let it go unless it is already as G38 wants. */
static void free_to_move(struct mcc *m)
{
    struct inquiry *q = &m->inquiry;

    if (!ended(m) || !reaction_arrived(m)) {
        return;
    }
    if (contact(m)) {
        reaction_stop(m, MCC_ERROR_PROBE_FREE);
        return;
    }
    q->touched = false;
    q->clocks = 0;
    memcpy(q->latched, m->signals.latched, sizeof q->latched);
    waiting_free(&m->program);
}

/* Place of an axis at a contact that this look has seen. [mm] */
static double place_of(const struct mcc *m, int i)
{
    const double scale = machine_pulses_per_mm(&m->machine.axis[i]);

    if (!m->machine.axis[i].used) {
        return m->trajectory.rest[i];
    }
    if (m->inquiry.place == INQUIRY_PULSES) {
        return reaction_put_out(m, i) / scale;
    }
    return homing_place(m, i, latched(m, i) ? m->signals.latch[i] : m->signals.enc[i])
           - m->written.added[i] / scale;
}

static void probe(struct mcc *m, int64_t clocks)
{
    struct inquiry *q = &m->inquiry;

    if (!q->touched && contact(m) && m->trajectory.started == m->commands) {
        q->touched = true;
        for (int i = 0; i < AXES; i++) {
            q->contact[i] = place_of(m, i);
        }
        trajectory_leave(&m->trajectory, &m->ring);
    }
    if (!ended(m) || !reaction_arrived(m)) {
        return;
    }
    q->clocks += clocks; /* the axes are still behind their pulses */
    if (q->touched) {
        waiting_probed(&m->program, q->contact, m->trajectory.rest, true);
    } else if (q->clocks >= m->homing.settle) {
        if (m->program.wait.must && !m->dry_run) {
            reaction_stop(m, MCC_ERROR_PROBE_END);
        } else {
            waiting_probed(&m->program, m->trajectory.rest, m->trajectory.rest, false);
        }
    }
}

void inquiry_look(struct mcc *m, int64_t clocks)
{
    const bool asked = m->running && !m->trajectory.abort && waiting_now(&m->program);

    if (asked && m->program.wait.kind == WAIT_PROBE) {
        probe(m, clocks);
    } else if (asked && m->program.wait.kind == WAIT_FREE) {
        free_to_move(m);
    } else if (asked) {
        input(m, clocks);
    }
    m->inquiry.waits = m->inquiry.waits && asked && waiting_now(&m->program);
}
