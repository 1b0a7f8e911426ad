#include "plan_chain.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* Acceleration [mm/s^2] of a command without limits of its axes. It has no effect: all axes have
 * limits. */
static const double ANY = 1.0;

void plan_chain_start(struct plan_chain *c, const double place[AXES], double tolerance,
                      const struct speed_limits *l)
{
    c->open = true;
    c->full = false;
    c->stops = 0;
    c->tolerance = tolerance;
    c->joined = 0;
    c->base = 0.0;
    c->limits = *l;
    memcpy(c->end, place, sizeof c->end);
    memcpy(c->place, place, sizeof c->place);
    shape_start(&c->shape, tolerance);
    speed_profile_start(&c->profile, l);
}

bool plan_chain_line(struct plan_chain *c, const double place[AXES], double feed)
{
    struct command line;

    memset(&line, 0, sizeof line);
    line.type = COMMAND_LINE;
    line.tolerance = c->tolerance;
    line.feed = line.cap = feed;
    line.ramp = (struct ramp_limits){ ANY, ANY, 0.0, 0.0 };
    path_line(&line.path, c->end, place);
    c->full = shape_take(&c->shape, &line) != SHAPE_TAKEN;
    shape_drop_marks(&c->shape, shape_marks(&c->shape));
    if (!c->full) {
        memcpy(c->end, place, sizeof c->end);
    }
    return !c->full;
}

void plan_chain_end(struct plan_chain *c)
{
    if (c->open) {
        shape_end(&c->shape);
        c->open = false;
    }
}

bool plan_chain_ready(const struct plan_chain *c)
{
    return c->full || !c->open;
}

/* Give finished segments of the shape to the speed profile, up to one with a rest at its end. */
static void join(struct plan_chain *c)
{
    while (!c->profile.closed && c->joined < shape_count(&c->shape)) {
        const struct segment *p = shape_segment(&c->shape, c->joined);
        if (!speed_profile_join(&c->profile, p)) {
            return;
        }
        c->profile.closed = p->rest;
        c->joined++;
    }
}

/* Compute the position of the motion and drop the segments that it has passed. */
static void look(struct plan_chain *c)
{
    const double way = c->profile.at.way;
    struct segment_state s;
    int32_t passed = 0;

    if (c->joined == 0) {
        return;
    }
    while (passed + 1 < c->joined && way >= c->base + shape_segment(&c->shape, passed)->length) {
        c->base += shape_segment(&c->shape, passed)->length;
        passed++;
    }
    const struct segment *p = shape_segment(&c->shape, passed);
    segment_at(p, el_min(el_max(way - c->base, 0.0), p->length), &s);
    memcpy(c->place, s.point, sizeof s.point);
    c->joined -= passed;
    shape_drop(&c->shape, passed);
    shape_drop_marks(&c->shape, shape_marks(&c->shape));
}

/* Whether the motion rests at the end of a segment with a rest, or at the end of the chain. */
static bool rests(const struct plan_chain *c)
{
    return c->profile.closed && speed_profile_at_end(&c->profile);
}

double plan_chain_advance(struct plan_chain *c, double dt)
{
    join(c);
    dt = speed_profile_advance(&c->profile, 1.0, dt);
    look(c);
    while (rests(c)) { /* the next segment begins at rest */
        shape_drop(&c->shape, c->joined);
        c->joined = 0;
        c->base = 0.0;
        if (plan_chain_done(c)) {
            return dt;
        }
        c->stops++;
        speed_profile_start(&c->profile, &c->limits);
        join(c);
        if (dt > 0.0) {
            dt = speed_profile_advance(&c->profile, 1.0, dt);
            look(c);
        }
    }
    return 0.0;
}

bool plan_chain_done(const struct plan_chain *c)
{
    return !c->open && c->joined == shape_count(&c->shape)
           && (shape_count(&c->shape) == 0 || rests(c));
}
