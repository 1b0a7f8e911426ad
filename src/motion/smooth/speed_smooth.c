#include "speed_smooth.h"

#include <math.h>
#include <stddef.h>

#include "el_extremes.h"

/* A plan is made once a fourth of the boxes it would know are new. */
enum { PLAN_SHARE = 4 };

/* Bisections of a step, and steps in one call, at most. */
enum { HALVES = 4, STEPS = 4096 };

/* A way needs no plan if one jerk drives it that is at least this part of what its start allows. */
static const double HOPS = 0.9;

/* From nearly rest the jerk stops the motion within a stride, which lets it gain a thousandfold of
 * x (speed_box): over such a share of it no more than half of x is lost. */
static const double NEAR_REST = 1.0 / 64.0;

/* Number of shares of a stride that are tried; each is NEAR_REST times the one before. */
enum { SHARES = 5 };

/* A landing is slow that takes less than this part of the jerk that is allowed. */
static const double SLOW = 0.25;

/* Ways and states count as the same if they differ by such a share. */
static const double SAME = 1e-9;

/* A motion along a speed profile that stays as it is. */
struct ride {
    const struct speed_profile *p;
    struct speed_profile_place at;
    int32_t count;
};

static struct speed_box *box_at(struct speed_profile *p, int32_t i)
{
    return &p->ring[(uint32_t)(p->at.head + i) % SPEED_PROFILE_CELLS].box;
}

static struct speed_road road(const struct ride *r, double override)
{
    return (struct speed_road){ r->p->ring, SPEED_PROFILE_CELLS, r->at.head, r->count, override };
}

static const struct speed_plan *held(const struct ride *r)
{
    return &r->p->plan[r->p->held];
}

/* Append a box. It begins where the last one ends, to the bit: in a gap a motion that rests would
 * be at the end of one box, and no plan would lead on. */
static void append(struct speed_profile *p, const struct speed_box *g)
{
    if (p->count == 0 || p->at.planned == p->count || !speed_box_join(box_at(p, p->count - 1), g)) {
        *box_at(p, p->count++) = *g;
    }
    const struct speed_box *last = box_at(p, p->count - 1);
    p->end = last->from + last->length;
}

bool speed_smooth_join(struct speed_profile *p, const struct segment *segment)
{
    struct speed_part part;
    struct speed_box g;

    if (p->closed || p->count + SPEED_SPLIT + SPEED_PROFILE_KEPT > SPEED_PROFILE_CELLS) {
        return false;
    }
    for (speed_part_first(&part, segment); speed_part_next(&part);) {
        speed_box_make(&g, segment, &p->limits, p->end, part.to - part.from, &part.bounds);
        append(p, &g);
    }
    p->at.left = box_at(p, 0)->from + box_at(p, 0)->length - p->at.here;
    return true;
}

/* Begin a step from here to a place. */
static void set_out(struct ride *r, struct speed_step step, double goal)
{
    r->at.step = step;
    r->at.spent = 0.0;
    r->at.origin = r->at.here;
    r->at.goal = goal;
}

/* From rest into the way of a plan, or, where that is short, to its end. */
static void start(struct ride *r, double override)
{
    const struct speed_plan *plan = held(r);
    const struct speed_road soft = road(r, override);
    const double way = plan->end - r->at.here;
    const struct speed_step hop = speed_road_hop(&soft, r->at.here, 0, way);
    struct speed_step step;

    if (hop.c >= HOPS * speed_box_jerk(speed_road_box(&soft, 0), 0.0, 0.0)) {
        set_out(r, hop, plan->end);
        return;
    }
    for (int n = 0; speed_road_start(&soft, r->at.here, 0, 1.0, way, n, &step); n++) {
        const double to = r->at.here + step.way;
        if (speed_plan_safe(plan, &soft, speed_plan_spot(plan, &soft, to, step.to))) {
            set_out(r, step, to);
            return;
        }
    }
    set_out(r, hop, plan->end);
}

/* Whether the motion can go on from the end of a step. */
static bool good(const struct ride *r, const struct speed_road *to, struct speed_spot spot,
                 double c, double s, bool may_land)
{
    const struct speed_state end = speed_step_to(spot.state, c, s);

    if (speed_step_top(spot.state, c, s)
            > speed_road_top(to, speed_road_box(to, spot.box)) * (1.0 + SAME)
        || !speed_box_keeps(speed_road_box(to, spot.box), spot.state, c, s)) {
        return false;
    }
    speed_plan_pass(held(r), to, &spot, s, end);
    return (may_land && speed_road_lands(to, spot.at, spot.box, end))
           || speed_plan_safe(held(r), to, spot);
}

static void go(struct ride *r, const struct speed_road *to, struct speed_spot spot, double c,
               double s)
{
    const struct speed_step step = speed_step_bent(spot.state, c, s);

    speed_plan_pass(held(r), to, &spot, s, step.to);
    set_out(r, step, spot.at);
}

static void land(struct ride *r)
{
    const struct speed_step step = speed_step_land(r->at.state);
    const double goal = r->at.here + step.way, end = held(r)->end;

    set_out(r, step, fabs(goal - end) <= SAME * step.way || goal > r->p->end ? end : goal);
}

/* Between a c that is good and one that is not, nearly the last good one. */
static double halve(const struct ride *r, const struct speed_road *to,
                    const struct speed_spot *spot, double kept, double fails, double s,
                    bool may_land)
{
    for (int i = 0; i < HALVES; i++) {
        const double middle = 0.5 * (kept + fails);
        *(good(r, to, *spot, middle, s, may_land) ? &kept : &fails) = middle;
    }
    return kept;
}

/* Whether a motion goes on at its speed, or brakes so little that it would take much longer to rest
 * than its jerk needs. */
static bool idles(const struct speed_box *g, struct speed_state from, bool lands, double stride)
{
    if (fabs(from.b) * stride <= SAME * from.x) {
        return true;
    }
    const struct speed_step s = speed_step_land(from);
    return lands && s.c < SLOW * speed_box_jerk(g, s.speed, s.acc);
}

/* Whether a step of a length brakes with a fair part of the jerk, and can be driven. */
static bool turns_down(const struct ride *r, const struct speed_road *to, struct speed_spot spot,
                       double stride)
{
    const struct speed_box *g = speed_road_box(to, spot.box);
    const double v = sqrt(spot.state.x), jerk = speed_box_jerk(g, v, 0.5 * spot.state.b);
    double c;

    return speed_box_turn(g, spot.state, stride, -1.0, &c) && -0.5 * c * v >= SLOW * jerk
           && good(r, to, spot, c, stride, true);
}

/* The longest share of a stride over which a step turns down, or the stride if there is none. */
static double fair_stride(const struct ride *r, const struct speed_road *to, struct speed_spot spot,
                          double stride)
{
    double part = stride;

    for (int n = 0; n < SHARES; n++, part *= NEAR_REST) {
        if (turns_down(r, to, spot, part)) {
            return part;
        }
    }
    return stride;
}

/* The slowest step within the limits from which the motion can go on by the plan or rest; with
 * `slower`, no faster at its end. */
static void brake(struct ride *r, bool slower)
{
    const struct speed_road hard = road(r, -1.0);
    const struct speed_spot spot = speed_plan_spot(held(r), &hard, r->at.here, r->at.state);
    const struct speed_box *g = speed_road_box(&hard, spot.box);
    const bool lands = speed_road_lands(&hard, spot.at, spot.box, spot.state);
    double stride = speed_box_stride(g, spot.state, speed_plan_rest(held(r), &hard, &spot));
    double s, steer, c;

    const bool idle = idles(g, spot.state, lands, stride) || (slower && spot.state.b > 0.0);
    stride = idle ? fair_stride(r, &hard, spot, stride) : stride;
    const bool turns = speed_box_turn(g, spot.state, stride, -1.0, &c);
    if (turns && good(r, &hard, spot, c, stride, true)) {
        const struct speed_state to = speed_step_to(spot.state, c, stride);
        if (to.b >= 0.0 || !lands || idle
            || speed_road_lands(&hard, spot.at + stride, spot.box, to)) {
            go(r, &hard, spot, c, stride);
            return;
        }
    }
    const bool steers = speed_plan_steer(held(r), &hard, &spot, &s, &steer);
    if (lands || (!steers && spot.state.b < 0.0)) {
        land(r);
        return;
    }
    if (!steers) { /* a state from outside, beyond all limits */
        go(r, &hard, spot, 0.0, stride);
        return;
    }
    s = el_min(s, stride);
    go(r, &hard, spot, turns ? halve(r, &hard, &spot, steer, c, s, true) : steer, s);
}

/* The fastest step from which the motion can still turn into the way of the plan.
 * CCN 17: each way to go on for a step, tried from the fastest to the safest. */
static void hurry(struct ride *r, double override)
{
    const struct speed_plan *plan = held(r);
    const struct speed_road soft = road(r, override);
    const struct speed_spot spot = speed_plan_spot(plan, &soft, r->at.here, r->at.state);
    const struct speed_box *g = speed_road_box(&soft, spot.box);
    double s, steer, c;

    if (spot.node >= SPEED_NODES && r->at.state.b < 0.0) {
        land(r);
        return;
    }
    const double stride = speed_box_stride(g, spot.state, speed_plan_rest(plan, &soft, &spot));
    const bool turns = speed_box_turn(g, spot.state, stride, 1.0, &c);
    const bool steers = speed_plan_steer(plan, &soft, &spot, &s, &steer);
    if (turns && (!steers || c > steer) && good(r, &soft, spot, c, stride, false)) {
        go(r, &soft, spot, c, stride);
        return;
    }
    if (!steers) {
        brake(r, false);
        return;
    }
    const struct speed_node *node = spot.node < SPEED_NODES ? &plan->node[spot.node] : NULL;
    const struct speed_state to = speed_step_to(spot.state, steer, s);
    if (node && (s <= stride || spot.state.b == 0.0) && spot.at + s >= node->at - SAME * s
        && to.x >= node->state.x * (1.0 - SAME)) {
        go(r, &soft, spot, steer, s);
        return;
    }
    s = el_min(s, stride);
    if (!good(r, &soft, spot, steer, s, false)) {
        brake(r, false);
        return;
    }
    go(r, &soft, spot, turns && c > steer ? halve(r, &soft, &spot, steer, c, s, false) : steer, s);
}

static void choose(struct ride *r, double override)
{
    if (r->at.state.x <= 0.0) {
        start(r, override);
    } else if (override > 0.0 && !r->p->pending) {
        hurry(r, override);
    } else {
        brake(r, true);
    }
}

/* Where the motion is in its step. */
static void place(struct speed_profile_place *at)
{
    const struct speed_motion m = speed_step_at(&at->step, at->spent);

    at->here = el_min(at->goal, at->origin + m.way);
    at->rate = m.rate;
    at->gain = m.gain;
    at->twitch = m.jerk;
}

/* The step is done. */
static void arrive(struct speed_profile_place *at)
{
    at->here = at->goal;
    at->state = at->step.to;
    at->rate = sqrt(at->state.x);
    at->gain = 0.5 * at->state.b;
    at->twitch = 0.0;
    at->step.kind = SPEED_NO_STEP;
}

static double end_of(const struct ride *r, int32_t box)
{
    const struct speed_road any = road(r, 1.0);
    return speed_road_end(&any, box);
}

static void cross(struct ride *r)
{
    while (r->count > 1 && r->at.here >= end_of(r, 0)) {
        r->at.base = end_of(r, 0);
        r->at.head = (r->at.head + 1) % SPEED_PROFILE_CELLS;
        r->count--;
        r->at.planned -= r->at.planned > 0;
    }
    r->at.left = r->count > 0 ? end_of(r, 0) - r->at.here : 0.0;
}

/* Go on from where the motion is in its step, if that is safe under what holds now. */
static bool cut(struct ride *r, const struct speed_plan *plan, double override)
{
    const struct speed_road to = road(r, override);
    const struct speed_state now = { r->at.rate * r->at.rate, 2.0 * r->at.gain };
    const struct speed_spot spot = speed_plan_spot(plan, &to, r->at.here, now);

    if (r->at.step.kind != SPEED_NO_STEP) {
        if (now.x <= 0.0 || !speed_plan_safe(plan, &to, spot)) {
            return false;
        }
        r->at.state = now;
        r->at.step.kind = SPEED_NO_STEP;
        return true;
    }
    return now.x <= 0.0 || speed_plan_safe(plan, &to, spot);
}

static struct ride ride_of(const struct speed_profile *p)
{
    return (struct ride){ p, p->at, p->count };
}

/* Plan anew, beside the plan that holds. */
static void plan(struct speed_profile *p, double override)
{
    const struct ride r = ride_of(p);
    struct speed_road to = road(&r, override);

    while (!speed_plan_make(&p->plan[1 - p->held], &to, p->at.here) && to.count > 1) {
        to.count = (to.count + 1) / 2; /* so far ahead is enough */
    }
    p->at.planned = to.count;
    p->reach = to.count < p->count ? to.count : 0;
    p->override = override;
    p->pending = true;
}

/* The new plan holds once the motion can turn into it. */
static void adopt(struct speed_profile *p, struct ride *r)
{
    if (p->pending && cut(r, &p->plan[1 - p->held], p->override)) {
        p->held = 1 - p->held;
        p->pending = false;
    }
}

static bool wants_plan(const struct speed_profile *p, double override)
{
    const int32_t new = p->count - p->at.planned;
    const bool rests = p->at.step.kind == SPEED_NO_STEP && p->at.state.x <= 0.0;

    return override > 0.0 && p->count > 0
           && (override != p->override || (rests && new > 0)
               || (PLAN_SHARE * new > p->at.planned
                   && (p->reach == 0 || PLAN_SHARE * p->at.planned < (PLAN_SHARE - 1) * p->reach)));
}

double speed_smooth_advance(struct speed_profile *p, double override, double dt)
{
    struct ride r = ride_of(p);

    cross(&r);
    p->at = r.at;
    p->count = r.count;
    if (wants_plan(p, override)) {
        plan(p, override);
        r = ride_of(p);
    }
    if (override > 0.0) {
        adopt(p, &r);
    } else if (p->at.asked > 0.0 && r.at.step.kind != SPEED_NO_STEP) {
        cut(&r, &p->plan[p->held], -1.0);
    }
    r.at.asked = override;
    for (int n = 0; n < STEPS && dt > 0.0; n++) {
        if (r.at.step.kind == SPEED_NO_STEP) {
            if (r.count == 1 && r.at.left <= 0.0) {
                break;
            }
            if (r.at.state.x <= 0.0 && (override <= 0.0 || r.at.here >= p->plan[p->held].end)) {
                dt = 0.0;
                break;
            }
            choose(&r, override);
        }
        const double rest = r.at.step.time - r.at.spent;
        if (rest > dt) {
            r.at.spent += dt;
            dt = 0.0;
            place(&r.at);
        } else {
            dt -= el_max(0.0, rest);
            arrive(&r.at);
            if (override > 0.0) {
                adopt(p, &r);
            }
        }
        cross(&r);
    }
    cross(&r);
    p->at = r.at;
    p->count = r.count;
    return dt;
}

double speed_smooth_stop_way(const struct speed_profile *p)
{
    struct ride r = ride_of(p);

    if (r.at.step.kind != SPEED_NO_STEP && !cut(&r, held(&r), -1.0)) {
        arrive(&r.at);
    }
    for (int n = 0; n < STEPS && r.at.state.x > 0.0; n++) {
        cross(&r);
        brake(&r, true);
        arrive(&r.at);
    }
    return r.at.here;
}

bool speed_smooth_nears_end(const struct speed_profile *p, double further)
{
    const struct speed_plan *plan = &p->plan[p->held];
    int32_t i = SPEED_NODES - 1;

    while (i > plan->first && plan->node[i].state.b < 0.0) {
        i--;
    }
    return p->at.here + further >= (plan->first < SPEED_NODES ? plan->node[i].at : p->end);
}

bool speed_smooth_end(struct speed_profile *p, double way)
{
    const double end = p->end;
    const int32_t count = p->count;
    struct ride r = ride_of(p);
    int32_t i = 0;

    if (count == 0) {
        return false;
    }
    while (i + 1 < count && end_of(&r, i) < way) {
        i++;
    }
    struct speed_box *g = box_at(p, i);
    const double length = g->length;
    g->length = way - g->from;
    p->count = i + 1;
    p->end = way;
    plan(p, p->override > 0.0 ? p->override : 1.0);
    r = ride_of(p);
    adopt(p, &r);
    const bool ends = !p->pending && p->reach == 0;
    if (ends) {
        p->at = r.at;
        p->closed = true;
    } else {
        g->length = length;
        p->count = count;
        p->end = end;
        p->override = -1.0; /* plan anew */
        p->pending = false;
    }
    p->at.planned = p->at.planned < p->count ? p->at.planned : p->count;
    return ends;
}
