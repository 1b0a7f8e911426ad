/* mover_damage - whether counts and places of a motion are such that it stays within its arrays. */
#include "mover.h"

static bool within(int64_t x, int64_t low, int64_t high)
{
    return x >= low && x <= high;
}

static bool scurve_good(const struct scurve *s)
{
    return within(s->count, 0, SCURVE_PHASES);
}

static bool ramp_good(const struct ramp *r)
{
    return scurve_good(&r->ease) && scurve_good(&r->change);
}

/* Only commands in the chain have speeds before their ends. */
static bool ring_good(const struct ring *r, int32_t joined)
{
    if (!within(r->head, 0, RING_SIZE - 1) || !within(r->count, 0, RING_SIZE)) {
        return false;
    }
    for (int32_t i = 0; i < joined && i < r->count; i++) {
        const struct ring_entry *e = ring_peek(r, i);
        if (!(within(e->enter.count, 0, BRAKE_STEPS) && within(e->leave.count, 0, BRAKE_STEPS))) {
            return false;
        }
    }
    return true;
}

/* The chain under way is the head of the ring; the tool is not ahead of the planned motion. */
static bool track_good(const struct track *t, const struct ring *r, bool active)
{
    const int32_t last = t->joined > 0 ? t->joined - 1 : 0;
    return within(t->caps, 0, TRACK_CAPS) && within(t->taps, 0, TRACK_MEAN) &&
           within(t->next, 0, TRACK_MEAN - 1) &&
           (!active || (within(t->joined, 1, r->count) && within(t->planned, 0, t->joined) &&
                        within(t->at, 0, last) && within(t->out, 0, t->at) &&
                        within(t->begun, 0, t->joined)));
}

bool mover_damaged(const struct mover *p, const struct ring *r)
{
    const int32_t joined = p->motion == MOVER_CHAIN ? p->track.joined : 0;
    bool good = ring_good(r, joined) && within(p->mix.count, 0, p->motion == MOVER_AXES ? 1 : 2) &&
                track_good(&p->track, r, p->motion == MOVER_CHAIN);

    for (int i = 0; i < 2; i++) {
        const struct profile *profile = &p->mix.move[i].profile;
        good = good && ramp_good(&profile->rise) && ramp_good(&profile->fall);
    }
    for (int i = 0; i < AXES; i++) {
        good = good && scurve_good(&p->axes.axis[i].plan);
    }
    return !good;
}

bool queue_damaged(const struct queue *q)
{
    return !within(q->head, 0, QUEUE_SIZE - 1) || !within(q->count, 0, QUEUE_SIZE);
}
