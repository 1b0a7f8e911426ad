#include "speed_smooth.h"

#include <math.h>

#include "el_extremes.h"

/* New cells are planned once they are so many of the planned ones (a fourth), so that a plan costs
 * each cell the same whatever their number. */
enum { PLAN_SHARE = 4 };

/* Values of x count as the same if they differ by such a share. */
static const double SAME = 1e-12;

/* A bend that takes less than this part of the limits counts as none. */
static const double SLIGHT = 0.05;

/* Part by which the way to rest that is told is longer than the one that is counted. */
static const double SLOWER = 1e-3;

static struct speed_cell *cell_at(struct speed_profile *p, int32_t i)
{
    return &p->ring[(uint32_t)(p->at.head + i) % SPEED_PROFILE_CELLS].cell;
}

static const struct speed_cell *cell_peek(const struct speed_profile *p, int32_t i)
{
    return &p->ring[(uint32_t)(p->at.head + i) % SPEED_PROFILE_CELLS].cell;
}

void speed_profile_start(struct speed_profile *p, const struct speed_limits *l)
{
    p->limits = *l;
    p->at.head = p->count = p->at.planned = 0;
    p->closed = false;
    p->override = -1.0;
    p->smooth = p->pending = false;
    for (int k = 0; k < AXES; k++) {
        p->smooth = p->smooth || l->jerk[k] > 0.0;
    }
    p->held = p->reach = 0;
    p->plan[0].first = p->plan[1].first = SPEED_NODES;
    p->plan[0].end = p->plan[1].end = 0.0;
    p->at.state = (struct speed_state){ 0.0, 0.0 };
    p->at.step = (struct speed_step){ .kind = SPEED_NO_STEP };
    p->at.twitch = p->at.spent = p->at.origin = p->at.goal = p->at.here = p->at.asked = 0.0;
    p->end = p->at.base = p->at.left = p->at.way = p->at.rate = p->at.gain = 0.0;
}

bool speed_profile_join(struct speed_profile *p, const struct segment *segment)
{
    struct speed_cell cell[SPEED_SPLIT];

    if (p->end <= 0.0 && !speed_by_axes(&p->limits)) {
        p->smooth = segment->ramp.acc_jerk > 0.0 || segment->ramp.dec_jerk > 0.0;
    }
    if (p->smooth) {
        return speed_smooth_join(p, segment);
    }
    if (p->closed || p->count + SPEED_SPLIT + SPEED_PROFILE_KEPT > SPEED_PROFILE_CELLS) {
        return false;
    }
    const int32_t n = speed_cut(segment, &p->limits, cell);
    for (int32_t i = 0; i < n; i++) {
        if (p->count == 0) {
            p->at.left = cell[i].length;
        }
        *cell_at(p, p->count++) = cell[i];
    }
    p->end += segment->length;
    return true;
}

/* x of a cell at the feed under an override. */
static double feed_limit(const struct speed_cell *c, double override)
{
    const double v = el_min(c->feed * override, c->cap);
    return v * v;
}

/* Most x at the end of cell i, if so many cells are known. */
static double end_limit(const struct speed_profile *p, int32_t i, int32_t known, double override)
{
    return i + 1 < known ? el_min(feed_limit(cell_peek(p, i), override), cell_peek(p, i + 1)->most)
                         : 0.0;
}

/* Plan from the end backwards. Once a cell that is not new comes out as it was, those before it
 * would, too. */
static void plan(struct speed_profile *p, double override)
{
    const bool all = override != p->override;

    for (int32_t i = p->count - 1; i >= 0; i--) {
        struct speed_cell *c = cell_at(p, i);
        const double x1 = end_limit(p, i, p->count, override), feed = feed_limit(c, override);
        double top, most;
        if (feed <= c->flat) {
            top = speed_top(c, x1, feed);
            most = el_min(top, feed);
        } else {
            most = speed_back(c, x1, feed, &top);
        }
        if (!all && i < p->at.planned && top == c->top && most == c->most) {
            break;
        }
        c->top = top;
        c->most = most;
    }
    p->at.planned = p->count;
    p->override = override;
}

/* A phase of constant acceleration. */
struct phase {
    double acc; /* [mm/s^2] */
    double way; /* [mm] */
    double x;   /* [mm^2/s^2] at its end */
};

/* The phase to the end of the cell, with at most x1 there. */
static struct phase across(double acc, double left, double x, double x1)
{
    return (struct phase){ acc, left, el_min(x1, el_max(0.0, x + 2.0 * acc * left)) };
}

/* The slowest phase within the limits: to rest, to the cell's end, or until they allow more. */
static struct phase halt(const struct speed_cell *c, double left, double x)
{
    const struct speed_span span = speed_span(c, left, x);
    const double fall = speed_fall(c, x);
    const double acc = fall > 0.0 ? el_min(span.low, -fall) : span.low;

    const double to = c->bend * x > SLIGHT ? 0.5 * x : 0.0;

    return acc < 0.0 && x - to < -2.0 * acc * left
               ? (struct phase){ acc, (x - to) / (-2.0 * acc), to }
               : across(acc, left, x, INFINITY);
}

/* A line that x keeps below: its value now, and how much it falls each mm. */
struct line {
    double x, fall;
};

/* The fastest phase within the limits: with an acceleration of at most `want`, up to x = `until`
 * or to x1 at the end of the cell. Below the line `safe`, from which the rest can be driven, also
 * with what is within the limits anywhere in the cell. */
static struct phase hurry(const struct speed_cell *c, double left, double x, double want,
                          double until, struct line safe, double x1)
{
    const struct speed_span span = speed_span(c, left, x);
    double acc = el_min(span.high, want);

    if (x < safe.x * (1.0 - SAME)) {
        double stop = el_max(safe.x, safe.x - safe.fall * left);
        const double rise = speed_rise(c, x, &stop);
        if (rise > acc) {
            acc = rise;
            until = stop;
            if (2.0 * acc + safe.fall > 0.0) {
                until = el_min(stop, x + 2.0 * acc * (safe.x - x) / (2.0 * acc + safe.fall));
            }
        }
    }
    return acc > 0.0 && x + 2.0 * acc * left > until
               ? (struct phase){ acc, (until - x) / (2.0 * acc), until }
               : across(acc, left, x, x1);
}

/* What comes next where the limits allow more than the feed: up or down to it, along it, and down
 * the line of steepest braking to x1. */
static struct phase next_feed(const struct speed_cell *c, double left, double x, double most,
                              double x1)
{
    const double slope = (c->top - x1) / c->length, line = x1 + slope * left;
    const double goal = el_min(most, line);

    if (x > goal * (1.0 + SAME)) {
        const struct phase s = halt(c, left, x);
        const double steeper = -2.0 * s.acc - slope;
        double way = x <= most ? 0.0 : s.acc < 0.0 ? (most - x) / (2.0 * s.acc) : INFINITY;
        if (x > line) {
            way = steeper > 0.0 ? el_max(way, (x - line) / steeper) : left;
        }
        return way < s.way ? (struct phase){ s.acc, way, el_min(most, x1 + slope * (left - way)) }
                           : s;
    }
    if (x >= goal * (1.0 - SAME)) {
        if (line <= most * (1.0 + SAME)) {
            return (struct phase){ -0.5 * slope, left, x1 };
        }
        return (struct phase){ 0.0, slope > 0.0 ? el_min(left, (line - most) / slope) : left, x };
    }
    const struct phase s = hurry(c, left, x, INFINITY, most, (struct line){ most, 0.0 }, x1);
    const double way = (line - x) / (2.0 * s.acc + slope);
    return way < s.way ? (struct phase){ s.acc, way, x1 + slope * (left - way) } : s;
}

/* What comes next where the limits allow less than the feed: to x1 at the end of the cell, or as
 * near to it as they allow. */
static struct phase next_bend(const struct speed_cell *c, double left, double x, double most,
                              double x1)
{
    const double acc = 0.5 * (x1 - x) / left, fall = (c->most - c->top) / c->length;
    const struct line safe = { c->top + fall * left, fall };
    const struct phase s = halt(c, left, x);

    if (x > most * (1.0 + SAME)) {
        const double way = s.acc < 0.0 ? (most - x) / (2.0 * s.acc) : INFINITY;
        return way < s.way ? (struct phase){ s.acc, way, most } : s;
    }
    return acc <= s.acc ? s : hurry(c, left, x, acc, INFINITY, safe, x1);
}

/* What comes next under an override. */
static struct phase next(const struct speed_profile *p, double x, double override)
{
    const struct speed_cell *c = cell_peek(p, 0);
    const double most = feed_limit(c, override), x1 = end_limit(p, 0, p->at.planned, override);

    return most <= c->flat ? next_feed(c, p->at.left, x, most, x1)
                           : next_bend(c, p->at.left, x, most, x1);
}

bool speed_profile_at_end(const struct speed_profile *p)
{
    const bool steps = p->smooth && p->at.step.kind != SPEED_NO_STEP;
    return p->count == 0 || (p->count == 1 && p->at.left <= 0.0 && !steps);
}

/* Drive a phase for up to dt; returns the time used. */
static double drive(struct speed_profile *p, const struct phase *s, double dt)
{
    const double v = p->at.rate, to = sqrt(s->x);
    const double time = v + to > 0.0 ? 2.0 * s->way / (v + to) : s->way > 0.0 ? INFINITY : 0.0;

    p->at.gain = s->acc;
    if (time <= dt) {
        p->at.left = s->way < p->at.left ? p->at.left - s->way : 0.0;
        p->at.rate = to;
        return time;
    }
    p->at.rate = el_max(0.0, v + s->acc * dt);
    p->at.left = el_max(0.0, p->at.left - 0.5 * dt * (v + p->at.rate));
    return dt;
}

/* Into the next cell, if there is one. */
static void cross(struct speed_profile *p)
{
    while (p->at.left <= 0.0 && p->count > 1) {
        p->at.base += cell_peek(p, 0)->length;
        p->at.head = (p->at.head + 1) % SPEED_PROFILE_CELLS;
        p->count--;
        p->at.planned -= p->at.planned > 0;
        p->at.left = cell_peek(p, 0)->length;
    }
}

static double length_at(const struct speed_profile *p, int32_t i)
{
    const uint32_t at = (uint32_t)(p->at.head + i) % SPEED_PROFILE_CELLS;
    return p->smooth ? p->ring[at].box.length : p->ring[at].cell.length;
}

/* speed_profile_advance without a limit of jerk. */
static double advance(struct speed_profile *p, double override, double dt)
{
    cross(p);
    if (override > 0.0
        && (override != p->override || PLAN_SHARE * (p->count - p->at.planned) > p->at.planned)) {
        plan(p, override);
    }
    while (dt > 0.0 && !speed_profile_at_end(p)) {
        const double x = p->at.rate * p->at.rate;
        if (override <= 0.0 && x <= 0.0) {
            p->at.gain = 0.0;
            return 0.0;
        }
        const struct phase s =
            override > 0.0 ? next(p, x, override) : halt(cell_peek(p, 0), p->at.left, x);
        dt -= drive(p, &s, dt);
        cross(p);
    }
    return dt;
}

double speed_profile_advance(struct speed_profile *p, double override, double dt)
{
    const double left =
        p->smooth ? speed_smooth_advance(p, override, dt) : advance(p, override, dt);

    if (p->count > 0) {
        const double way = p->at.base + (length_at(p, 0) - p->at.left);
        p->at.way = el_min(p->end, el_max(p->at.way, way));
    }
    if (speed_profile_at_end(p)) {
        p->at.way = p->end;
        p->at.rate = p->at.gain = p->at.twitch = 0.0;
    }
    return left;
}

/* Where the most braking leads if it is looked for only where a phase ends. [mm] */
static double rest_way(const struct speed_profile *p)
{
    double x = p->at.rate * p->at.rate, base = p->at.base;

    for (int32_t i = 0; i < p->count; i++) {
        const struct speed_cell *c = cell_peek(p, i);
        double left = i == 0 ? p->at.left : c->length;
        while (left > 0.0 && x > 0.0) {
            const struct phase s = halt(c, left, x);
            left = s.way < left ? left - s.way : 0.0;
            x = s.x;
        }
        if (x <= 0.0) {
            return base + (c->length - left);
        }
        base += c->length;
    }
    return p->end;
}

double speed_profile_stop_way(const struct speed_profile *p)
{
    if (p->smooth) {
        return speed_smooth_stop_way(p);
    }
    const double way = rest_way(p);
    return el_min(p->end, way + SLOWER * (way - p->at.way));
}

bool speed_profile_nears_end(const struct speed_profile *p, double further)
{
    return p->smooth ? speed_smooth_nears_end(p, further)
                     : speed_profile_stop_way(p) + further >= p->end;
}

void speed_profile_put(struct speed_profile *p, const struct speed_profile_place *place)
{
    const int32_t crossed = (p->at.head - place->head + SPEED_PROFILE_CELLS) % SPEED_PROFILE_CELLS;
    const int32_t planned = p->at.planned > 0 ? p->at.planned + crossed : place->planned;

    p->at = *place;
    p->at.planned = planned;
    p->count += crossed;
    if (p->at.way <= 0.0 && p->count > 0) { /* no cell was known, or the first has grown */
        p->at.left = length_at(p, 0);
    }
}
