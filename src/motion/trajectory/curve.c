#include "curve.h"

#include <math.h>
#include <string.h>

#include "bow.h"
#include "el_extremes.h"
#include "speed_smooth.h"

/* A motion that will not get this much further [s] before it has to brake waits no longer for
 * commands to come. */
static const double WAIT = 0.05;

bool curve_begins(const struct ring *r)
{
    const struct command *c = ring_head(r);
    return c && c->curve && c->tolerance > 0.0 && command_blends(c);
}

void curve_start(struct curve *c, struct curve_plan *m, const struct ring *r)
{
    const struct command *first = ring_head(r);

    memset(c, 0, sizeof *c);
    memcpy(c->point, first->path.start, sizeof c->point);
    shape_start(&m->shape, first->merge);
    speed_profile_start(&m->profile, &m->limits);
    m->joined = 0;
    m->joined_way = m->part = m->start = m->widest = 0.0;
    c->goal = INFINITY;
    c->place = m->profile.at;
}

/* Places that are nearer to each other are one: a goal at the end of a segment is that end, though
 * lengths summed from elsewhere tell it otherwise by their rounding. A sliver of 1e-16 mm between
 * them would have no acceleration that could be told. [mm] */
static const double NEAR = 1e-9;

/* Give the speed profile the next finished segment, or what is left of it, or what lies before the
 * goal. */
static bool join_one(const struct curve *c, struct curve_plan *m)
{
    const struct segment *whole = shape_segment(&m->shape, m->joined);
    const double goal = c->goal - m->joined_way;
    const double to = goal > whole->length - NEAR ? whole->length : el_max(goal, m->part);
    struct segment part;

    if (m->part <= 0.0 && to >= whole->length) {
        if (!speed_profile_join(&m->profile, whole)) {
            return false;
        }
    } else if (to > m->part + NEAR) {
        part = *whole;
        shape_cut(&part, m->part, to);
        if (!speed_profile_join(&m->profile, &part)) {
            return false;
        }
    }
    m->part = to;
    m->profile.closed = to < whole->length || whole->rest;
    if (to >= whole->length) {
        m->joined_way += whole->length;
        m->part = 0.0;
        m->joined++;
    }
    return true;
}

/* Give the speed profile finished segments up to the goal, to one that ends at rest, or to the last
 * of all. */
static void join(struct curve *c, struct curve_plan *m)
{
    while (!m->profile.closed && m->joined < shape_count(&m->shape) && join_one(c, m)) {
    }
    m->profile.closed = m->profile.closed || (c->closed && m->joined == shape_count(&m->shape));
    c->place = m->profile.at;
}

/* Nothing more joins: the chain ends at rest at the end of what has been taken. */
static void end(struct curve *c, struct curve_plan *m)
{
    shape_end(&m->shape);
    c->closed = true;
}

/* Take commands while they fit; whether one has been taken. */
static bool take(struct curve *c, struct curve_plan *m, struct ring *r)
{
    bool any = false;

    while (!c->closed && r->count > 0) {
        const struct command *next = ring_head(r);
        const bool joins = curve_begins(r) && next->merge == m->shape.merge;
        const enum shape_status status = joins ? shape_take(&m->shape, next) : SHAPE_OTHER;
        if (status == SHAPE_OTHER) {
            end(c, m);
            break;
        }
        if (status == SHAPE_FULL) {
            break;
        }
        memcpy(m->end, next->path.end, sizeof m->end);
        m->widest = el_max(m->widest, next->tolerance);
        ring_pop(r);
        c->idle = 0;
        any = true;
    }
    return any;
}

/* Whether the motion is about to brake for want of commands. */
static bool starves(const struct curve *c, const struct curve_plan *m)
{
    return c->idle > 0 && speed_profile_nears_end(&m->profile, WAIT * c->place.rate);
}

/* The motion has come to a rest behind which segments go on, but not to its goal. */
static bool rests_between(const struct curve *c, const struct curve_plan *m)
{
    return m->profile.closed && speed_profile_at_end(&m->profile)
           && m->joined < shape_count(&m->shape) && !curve_waits(c);
}

/* Put the speed profile where the motion is; if its latest rest has been taken back, where that
 * was. */
static void resume(struct curve *c, struct curve_plan *m)
{
    if (c->start == m->start) {
        speed_profile_put(&m->profile, &c->place);
    } else {
        c->start = m->start;
        c->place = m->profile.at;
    }
}

/* Way of the motion from the start of the chain. [mm] */
static double way_of(const struct curve *c)
{
    return c->start + c->place.way;
}

/* Segments that the speed profile has, the last one perhaps in part. */
static int32_t segments_known(const struct curve_plan *m)
{
    return m->joined + (m->part > 0.0);
}

/* The segment at a way, which lies not before the one found last. */
static const struct segment *find(struct curve *c, const struct curve_plan *m, double way)
{
    const struct segment *p = shape_segment(&m->shape, c->at);

    while (way >= c->base + p->length && c->at + 1 < segments_known(m)) {
        c->base += p->length;
        p = shape_segment(&m->shape, ++c->at);
    }
    return p;
}

/* Begin a speed profile at a way of the chain, at rest; the caller may give it a speed then. */
static void set_out(struct curve *c, struct curve_plan *m, double way)
{
    m->start = c->start = way;
    speed_profile_start(&m->profile, &m->limits);
    join(c, m);
}

/* Whether a block begins with this mark: another line of the program, or call, than before. */
static bool begins_block(const struct curve *c, const struct curve_plan *m, int32_t i)
{
    const struct shape_mark *k = shape_mark(&m->shape, i);
    const int32_t before = i > 0 ? shape_mark(&m->shape, i - 1)->line : c->line;
    return k->line == 0 || k->line != before;
}

/* Where the first block begins at or behind a way, and behind the tool; INFINITY: not known. */
static double next_block(const struct curve *c, const struct curve_plan *m, double way)
{
    for (int32_t i = 0; i < shape_marks(&m->shape); i++) {
        const double at = shape_mark(&m->shape, i)->at;
        if (at > way_of(c) + NEAR && at >= way && begins_block(c, m, i)) {
            return at;
        }
    }
    return INFINITY;
}

/* Ways that differ by such a share of the way to rest may not be told apart. */
static const double MARGIN = 0.02;

/* With limited jerk: the chain ends before the first block before which it can come to rest. */
static double halt_smooth(struct curve *c, struct curve_plan *m)
{
    double goal = next_block(c, m, way_of(c));
    bool ends = false;

    while (!ends && goal < m->start + m->profile.end) {
        ends = speed_smooth_end(&m->profile, goal - m->start);
        goal = ends ? goal : next_block(c, m, goal + NEAR);
    }
    if (ends) {
        m->joined = c->at;
        m->joined_way = c->base;
        while (m->joined_way + shape_segment(&m->shape, m->joined)->length <= goal) {
            m->joined_way += shape_segment(&m->shape, m->joined++)->length;
        }
        m->part = goal - m->joined_way;
        c->place = m->profile.at;
    }
    return goal;
}

/* The chain anew from where the motion is, at its speed, to the first block before which it can
 * come to rest. */
static double halt_quick(struct curve *c, struct curve_plan *m)
{
    const double way = way_of(c), rate = c->place.rate;
    double stop = speed_profile_stop_way(&m->profile) - c->place.way, goal = 0.0;

    while (goal < INFINITY) {
        goal = next_block(c, m, way + stop * (1.0 + MARGIN));
        if (goal == c->goal && m->shape.marks_set < m->shape.marks) {
            return goal;
        }
        c->goal = goal;
        m->joined = c->at;
        m->joined_way = c->base;
        m->part = way - c->base;
        set_out(c, m, way);
        m->profile.at.rate = rate;
        c->place = m->profile.at;
        stop = speed_profile_stop_way(&m->profile);
        if (way + stop <= goal) {
            break;
        }
        stop = el_max(stop, goal - way) * (1.0 + MARGIN);
    }
    return goal;
}

/* Single block: choose where it rests; if that is not known yet, as the shape has no room for what
 * is to come, later. */
static void halt(struct curve *c, struct curve_plan *m)
{
    if (c->halts) {
        find(c, m, way_of(c));
        c->goal = m->profile.smooth ? halt_smooth(c, m) : halt_quick(c, m);
        c->halts = c->goal == INFINITY && m->shape.marks_set < m->shape.marks;
    }
}

double curve_advance(struct curve *c, struct curve_plan *m, struct ring *r, double override,
                     double dt)
{
    resume(c, m);
    if (override > 0.0 && take(c, m, r) && r->count == 0 && !m->last) {
        join(c, m);
        return dt;
    }
    if (!c->closed && r->count == 0 && (m->last || starves(c, m))) {
        end(c, m);
    }
    halt(c, m);
    join(c, m);
    dt = speed_profile_advance(&m->profile, override, dt);
    c->place = m->profile.at;
    while (rests_between(c, m) && dt > 0.0 && override > 0.0) {
        set_out(c, m, m->start + m->profile.end);
        dt = speed_profile_advance(&m->profile, override, dt);
        c->place = m->profile.at;
    }
    return curve_done(c, m) ? dt : 0.0;
}

void curve_single(struct curve *c, struct curve_plan *m, bool on)
{
    if (on && !c->closed) {
        end(c, m);
    }
    c->halts = on && !curve_waits(c);
    if (!on && !curve_waits(c)) {
        c->goal = INFINITY;
        m->profile.closed =
            m->part <= 0.0 && m->joined > 0 && shape_segment(&m->shape, m->joined - 1)->rest;
    }
}

void curve_go(struct curve *c, struct curve_plan *m, bool single)
{
    const double way = c->goal;

    c->goal = INFINITY;
    c->goal = single ? next_block(c, m, way) : INFINITY;
    set_out(c, m, way);
}

bool curve_waits(const struct curve *c)
{
    return c->place.rate == 0.0 && way_of(c) >= c->goal - NEAR;
}

void curve_sample(struct curve *c, struct curve_plan *m)
{
    struct segment_state s;

    c->idle++;
    if (segments_known(m) == 0) {
        return;
    }
    const double way = way_of(c);
    const struct segment *p = find(c, m, way);
    segment_at(p, el_min(el_max(way - c->base, 0.0), p->length), &s);
    for (int i = 0; i < AXES; i++) {
        c->point[i] = s.point[i];
        c->velocity[i] = c->place.rate * s.slope[i];
    }
}

const struct shape_mark *curve_begun(struct curve *c, const struct curve_plan *m)
{
    const bool known = c->begun < shape_marks(&m->shape);
    const struct shape_mark *k = known ? shape_mark(&m->shape, c->begun) : NULL;
    if (!k || (k->at > way_of(c) && !curve_done(c, m)) || k->at >= c->goal) {
        return NULL;
    }
    c->begun++;
    c->line = k->line;
    return k;
}

void curve_drop(struct curve *c, struct curve_plan *m)
{
    shape_drop(&m->shape, c->at);
    shape_drop_marks(&m->shape, c->begun);
    m->joined -= c->at;
    c->at = c->begun = 0;
}

bool curve_rests(const struct curve *c)
{
    return c->place.rate == 0.0;
}

bool curve_done(const struct curve *c, const struct curve_plan *m)
{
    return c->closed && m->profile.closed && speed_profile_at_end(&m->profile)
           && m->joined == shape_count(&m->shape);
}

static void place_on_segment(const void *segment, double u, double place[AXES])
{
    struct segment_state s;

    segment_at(segment, u, &s);
    memcpy(place, s.point, sizeof s.point);
}

void curve_stop_extent(const struct curve *c, struct curve_plan *m, double low[AXES],
                       double high[AXES])
{
    struct curve at = *c;

    memcpy(low, c->point, sizeof c->point);
    memcpy(high, c->point, sizeof c->point);
    resume(&at, m);
    const double stop = at.start + speed_profile_stop_way(&m->profile);
    for (double from = way_of(&at); segments_known(m) > 0 && from < stop;) {
        const struct segment *p = find(&at, m, from);
        const double end = el_min(stop, at.base + p->length);
        struct segment_bounds b;
        if (!(end > from)) {
            break;
        }
        segment_bounds(p, from - at.base, end - at.base, &b);
        struct bow bow = { place_on_segment, p, 0.0 };
        for (int k = 0; k < AXES; k++) {
            bow.bend = el_max(bow.bend, el_max(-b.low[1][k], b.high[1][k]));
        }
        bow_widen(&bow, from - at.base, end - at.base, low, high);
        from = end;
    }
    for (int k = 0; k < AXES; k++) {
        low[k] -= BOW_NEAR;
        high[k] += BOW_NEAR;
    }
}

/* A limit and the share of it that the motion takes. */
struct taken {
    double share;
    struct limited told;
};

static void take_more(struct taken *most, double value, double limit, enum limited_by by, int axis)
{
    const double share = limit > 0.0 ? fabs(value) / limit : 0.0;
    if (share > most->share) {
        *most = (struct taken){ share, { .by = by, .axis = axis } };
    }
}

/* The limit of which the motion on a segment takes most; the third derivative is a difference. */
static struct limited most_taken(const struct curve *c, const struct curve_plan *m,
                                 const struct segment *p)
{
    const struct speed_limits *l = &m->limits;
    const double v = c->place.rate, a = c->place.gain, j = c->place.twitch;
    const double u = el_min(el_max(way_of(c) - c->base, 0.0), p->length);
    const double from = el_max(u - 1e-4 * p->length, 0.0);
    const double to = el_min(u + 1e-4 * p->length, p->length);
    struct taken most = { 0.0, { .by = LIMITED_ACCELERATION } };
    struct segment_state s, before, after;
    double across = 0.0;

    segment_at(p, u, &s);
    segment_at(p, from, &before);
    segment_at(p, to, &after);
    for (int i = 0; i < AXES; i++) {
        const double third = (after.bend[i] - before.bend[i]) / (to - from);
        const double jerk = s.slope[i] * j + 3.0 * s.bend[i] * v * a + third * v * v * v;
        if (fabs(s.slope[i]) * v >= 0.99 * l->speed[i]) {
            take_more(&most, s.slope[i] * v, l->speed[i], LIMITED_SPEED, i + 1);
        }
        take_more(&most, s.slope[i] * a + s.bend[i] * v * v, l->acc[i], LIMITED_ACCELERATION,
                  i + 1);
        take_more(&most, jerk, l->jerk[i], LIMITED_JERK, i + 1);
        across += s.bend[i] * s.bend[i];
    }
    if (!speed_by_axes(l)) {
        take_more(&most, a, a > 0.0 ? p->ramp.acc : p->ramp.dec, LIMITED_ACCELERATION, 0);
        take_more(&most, sqrt(across) * v * v, el_min(p->ramp.acc, p->ramp.dec),
                  LIMITED_ACCELERATION, 0);
        take_more(&most, j, a > 0.0 ? p->ramp.acc_jerk : p->ramp.dec_jerk, LIMITED_JERK, 0);
    }
    return most.told;
}

/* Whether a corner lies within the way to rest. */
static bool nears_corner(const struct curve *c, const struct curve_plan *m)
{
    double left = speed_profile_stop_way(&m->profile) - c->place.way + (way_of(c) - c->base);

    for (int32_t i = c->at; i < segments_known(m) && left > 0.0; i++) {
        const struct segment *p = shape_segment(&m->shape, i);
        if (p->joint) {
            return true;
        }
        left -= p->length;
    }
    return false;
}

static struct limited limited_now(const struct curve *c, const struct curve_plan *m,
                                  const struct segment *p, double override)
{
    const struct limited stop = { .by = LIMITED_STOP }, corner = { .by = LIMITED_CORNER };

    if (c->place.rate >= el_min(p->feed * override, p->cap) * 0.999) {
        const struct limited most = most_taken(c, m, p);
        const bool axis = most.by == LIMITED_SPEED && p->feed * override >= p->cap;
        return axis ? most : (struct limited){ .by = LIMITED_FEED };
    }
    if (c->place.gain < 0.0 && speed_profile_nears_end(&m->profile, 0.0)) {
        return stop;
    }
    if (p->joint || (c->place.gain < 0.0 && nears_corner(c, m))) {
        return corner;
    }
    return most_taken(c, m, p);
}

struct limited curve_limited(const struct curve *c, const struct curve_plan *m, double override)
{
    if (c->at >= segments_known(m)) {
        return (struct limited){ .by = LIMITED_STOP };
    }
    const struct segment *p = shape_segment(&m->shape, c->at);
    struct limited told = limited_now(c, m, p, override);
    told.feed = p->feed;
    return told;
}
