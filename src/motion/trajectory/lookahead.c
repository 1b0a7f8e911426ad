#include "lookahead.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

/* New commands are planned once they are so many of the planned ones (a fourth), so that a plan,
 * which goes through all, costs each command the same whatever their number. */
enum { PLAN_SHARE = 4 };

/* Speed, up to the command's highest, at which a path of this bend and twist needs the acceleration
 * of a command, or the jerk if it is limited. [mm/s] */
static double bend_speed(const struct command *c, double bend, double twist)
{
    const struct ramp_limits *r = &c->ramp;
    double v = c->cap;

    if (bend > 0.0) {
        v = el_min(v, sqrt(el_min(r->acc, r->dec) / bend));
    }
    if (c->smooth > 0.0 && twist > 0.0) {
        v = el_min(v, el_cbrt((r->acc + r->dec) / (c->smooth * twist)));
    }
    return v;
}

double lookahead_half(const struct lookahead *t, const struct ring *r, int32_t i)
{
    return i > 0 && i < t->joined ? ring_peek(r, i)->corner.half : 0.0;
}

bool lookahead_begins(const struct ring *r)
{
    const struct command *c = ring_head(r);
    return c && c->tolerance > 0.0 && command_blends(c);
}

/* Append a command: its limits on its own, and those of its corner with the one before. */
static void add(struct lookahead *t, struct ring *r, const struct corner *k)
{
    struct ring_entry *n = ring_at(r, t->joined);
    const double bend = path_bend(&n->command.path);

    n->body = bend_speed(&n->command, bend, path_twist(&n->command.path));
    n->corner = *k;
    n->turn = n->command.cap;
    n->enter.count = n->leave.count = 0; /* until it is planned */
    if (t->joined > 0) {
        const struct command *before = &ring_peek(r, t->joined - 1)->command;
        n->turn = el_min(bend_speed(&n->command, k->bend, k->twist),
                         bend_speed(before, k->bend, k->twist));
    }
    t->end += n->command.path.length;
    t->dec = t->joined ? el_min(t->dec, n->command.ramp.dec) : n->command.ramp.dec;
    t->joined++;
}

/* Whether the motion can still be as slow as `speed` once it has gone `way` on, its mean, too. */
static bool slow_at(const struct lookahead *t, double speed, double way)
{
    const double brake = el_max(0.0, way - speed * t->smooth);
    return way >= 0.0 && t->v * t->v <= speed * speed + 2.0 * t->dec * brake;
}

/* Whether the corner with the next command, and that command, are not too slow for the motion. */
static bool in_time(const struct lookahead *t, const struct ring *r, const struct corner *k,
                    double override)
{
    const struct command *last = &ring_peek(r, t->joined - 1)->command;
    const struct command *next = &ring_peek(r, t->joined)->command;
    const double way = t->end - (t->base + t->s), bend = path_bend(&next->path);
    const double body =
        el_min(bend_speed(next, bend, path_twist(&next->path)), command_speed(next, override));
    double turn = el_min(bend_speed(next, k->bend, k->twist), bend_speed(last, k->bend, k->twist));

    turn = el_min(turn, el_min(command_speed(next, override), command_speed(last, override)));
    return slow_at(t, body, way + k->half) && (k->half <= 0.0 || slow_at(t, turn, way - k->half));
}

/* Take commands of the ring into the chain while they fit smoothly. */
static void join(struct lookahead *t, struct ring *r, double override)
{
    while (!t->closed && t->joined < r->count) {
        const struct command *a = &ring_peek(r, t->joined - 1)->command;
        const struct command *b = &ring_peek(r, t->joined)->command;
        struct corner k;

        if (!(b->tolerance > 0.0) || !command_blends(b) || b->smooth != t->smooth) {
            return;
        }
        const double room = 0.5 * el_min(a->path.length, b->path.length);
        if (!corner_make(&k, &a->path, &b->path, el_min(a->tolerance, b->tolerance), room,
                         t->smooth > 0.0)
            || !in_time(t, r, &k, override)) {
            return;
        }
        add(t, r, &k);
    }
}

void lookahead_start(struct lookahead *t, struct ring *r)
{
    const struct corner none = { 0.0, 0.0, 0.0 };

    memset(t, 0, sizeof *t);
    t->started = ring_head(r)->index;
    t->smooth = ring_head(r)->smooth;
    t->override = -1.0;
    add(t, r, &none);
}

static double body_limit(const struct ring_entry *n, double override)
{
    return el_min(n->body, command_speed(&n->command, override));
}

/* The corner is driven at the feed of neither more than the command's that follows it nor that of
 * the one before. */
static double turn_limit(const struct ring *r, int32_t i, double override)
{
    const struct ring_entry *n = ring_peek(r, i);
    const double v = el_min(n->turn, command_speed(&n->command, override));
    return i > 0 ? el_min(v, command_speed(&ring_peek(r, i - 1)->command, override)) : v;
}

/* Along a command its own acceleration and deceleration; in the corner before it what the one
 * before allows, too. */
static struct ramp_limits ramp_of(const struct ring *r, int32_t i, bool turning)
{
    struct ramp_limits own = ring_peek(r, i)->command.ramp;

    if (turning) {
        const struct ramp_limits *before = &ring_peek(r, i - 1)->command.ramp;
        own.acc = el_min(own.acc, before->acc);
        own.dec = el_min(own.dec, before->dec);
    }
    return own;
}

/* Plan the speeds from the end backwards. */
static void plan(struct lookahead *t, struct ring *r, double override)
{
    struct brake b;

    brake_rest(&b);
    t->dec = INFINITY;
    for (int32_t i = t->joined - 1; i >= t->at; i--) {
        struct ring_entry *n = ring_at(r, i);
        const double dec = n->command.ramp.dec, half = lookahead_half(t, r, i);
        const double body = body_limit(n, override), turn = turn_limit(r, i, override);

        n->leave = b;
        brake_back(&b, n->command.path.length - half - lookahead_half(t, r, i + 1), dec);
        brake_limit(&b, body, body * t->smooth);
        n->enter = b;
        if (half > 0.0) {
            brake_back(&b, 2.0 * half, ramp_of(r, i, true).dec);
            brake_limit(&b, turn, turn * t->smooth);
        }
        t->dec = el_min(t->dec, dec);
    }
    t->planned = t->joined;
    t->override = override;
}

/* Where the corner or the command's own part ends. */
static double border(const struct lookahead *t, const struct ring *r)
{
    return t->turning ? lookahead_half(t, r, t->at)
                      : ring_peek(r, t->at)->command.path.length - lookahead_half(t, r, t->at + 1);
}

/* One segment of the way with constant limits: up to `end`, at most `top` fast, and no faster than
 * `leave` there. */
struct limit_segment {
    double end, top, leave;
    double acc, dec;
};

static struct limit_segment next_limit_segment(const struct lookahead *t, const struct ring *r,
                                               double override)
{
    const struct ring_entry *n = ring_peek(r, t->at);
    const double most = t->turning ? turn_limit(r, t->at, override) : body_limit(n, override);
    const struct ramp_limits ramp = ramp_of(r, t->at, t->turning);
    const struct brake_segment b =
        brake_next(t->turning ? &n->enter : &n->leave, t->s, border(t, r), ramp.dec);
    struct limit_segment p = { b.end, el_min(most, b.top), b.leave, ramp.acc, ramp.dec };

    for (int32_t i = 0; i < t->caps; i++) {
        const double until = t->cap[i].until - t->base;
        if (t->s < until) {
            p.top = el_min(p.top, t->cap[i].speed);
            p.end = el_min(p.end, until);
        }
    }
    /* so much speed can still be braked from there on */
    p.leave = el_min(p.top, sqrt(p.leave * p.leave + 2.0 * p.dec * (b.end - p.end)));
    return p;
}

/* Move on by constant accelerations: up to time dt or way `way`. Returns the time used. */
static double glide(struct lookahead *t, double acc, double to, double way, double dt, double *done)
{
    double time = acc != 0.0 ? (to - t->v) / acc : (t->v > 0.0 ? way / t->v : dt);
    time = el_max(0.0, el_min(time, dt));
    *done = time * (t->v + 0.5 * acc * time);
    t->v = time < dt && acc != 0.0 ? to : el_max(0.0, t->v + acc * time);
    t->s += *done;
    return time;
}

/* Part by which braking may be harder to meet a plan again that rounding has missed. */
static const double ROUNDING = 1e-7;

/* Too fast for the segment: slower, to the limit or as much as the way allows, at most `leave` at
 * its end. Returns the time left of dt. */
static double slow_down(struct lookahead *t, const struct limit_segment *p, double leave, bool fits,
                        double dt)
{
    const double way = p->end - t->s, v = t->v;
    const double to = v > p->top && fits ? p->top : el_min(p->top, leave);
    double dec = p->dec, done;

    if (!fits && way > 0.0) { /* rounding has taken some of the way */
        dec = el_min(el_max(dec, (v * v - leave * leave) / (2.0 * way)), (1.0 + ROUNDING) * dec);
    }
    if (to >= v) { /* no way but rounding */
        t->s = p->end;
        return dt;
    }
    const double there = v * v - 2.0 * dec * way; /* square of the speed at the end */
    const bool all = there >= to * to;
    const double used = glide(t, -dec, all ? sqrt(there) : to, way, dt, &done);
    if (all && used < dt) {
        t->s = p->end;
    }
    return dt - used;
}

/* Drive the segment for up to dt; returns the time left. Ends on the segment's end exactly if it
 * gets there. */
static double drive(struct lookahead *t, const struct limit_segment *p, double dt)
{
    const double way = p->end - t->s, v = t->v;
    double done, leave = el_min(p->leave, sqrt(v * v + 2.0 * p->acc * way));
    const double peak =
        sqrt(el_max(0.0, (2.0 * p->acc * p->dec * way + p->dec * v * v + p->acc * leave * leave)
                             / (p->acc + p->dec)));

    if (v > p->top || peak < v) {
        return slow_down(t, p, leave, peak >= v, dt);
    }
    const double top = el_min(p->top, peak);
    const double up = (top * top - v * v) / (2.0 * p->acc);
    const double down = (top * top - leave * leave) / (2.0 * p->dec);
    double left = dt;
    left -= top > v ? glide(t, p->acc, top, up, left, &done) : 0.0;
    if (left > 0.0 && way - up - down > 0.0 && top > 0.0) {
        left -= glide(t, 0.0, top, way - up - down, left, &done);
    }
    if (left > 0.0 && top > leave) {
        left -= glide(t, -p->dec, leave, down, left, &done);
    }
    if (left > 0.0) {
        t->s = p->end;
        t->v = leave;
    }
    return left;
}

/* A limit that has been left goes on for the way the mean is behind. */
static void keep_limit(struct lookahead *t, double speed)
{
    const double way = t->base + t->s, until = way + speed * t->smooth;
    int32_t n = 0;

    if (t->smooth <= 0.0) {
        return;
    }
    for (int32_t i = 0; i < t->caps; i++) {
        const struct lookahead_cap *c = &t->cap[i];
        if (c->until > way && !(c->speed >= speed && c->until <= until)) {
            t->cap[n++] = *c;
        }
    }
    if (n == LOOKAHEAD_CAPS) { /* two become one that holds for both */
        n--;
        t->cap[n - 1].speed = el_min(t->cap[n - 1].speed, t->cap[n].speed);
        t->cap[n - 1].until = el_max(t->cap[n - 1].until, t->cap[n].until);
    }
    t->cap[n] = (struct lookahead_cap){ speed, until };
    t->caps = n + 1;
}

/* Go over the border to the next segment of the way. */
static void cross(struct lookahead *t, const struct ring *r, double override)
{
    keep_limit(t, t->turning ? turn_limit(r, t->at, override)
                             : body_limit(ring_peek(r, t->at), override));
    if (t->turning) {
        t->turning = false;
    } else {
        const double length = ring_peek(r, t->at)->command.path.length;
        t->base += length;
        t->s -= length;
        t->at++;
        t->turning = lookahead_half(t, r, t->at) > 0.0;
    }
}

bool lookahead_at_end(const struct lookahead *t, const struct ring *r)
{
    return t->at == t->joined - 1 && !t->turning
           && t->s >= ring_peek(r, t->at)->command.path.length;
}

double lookahead_advance(struct lookahead *t, struct ring *r, double override, double dt)
{
    join(t, r, override > 0.0 ? override : t->override);
    while (dt > 0.0) {
        if (lookahead_at_end(t, r)) {
            t->v = 0.0;
            return dt;
        }
        if (override > 0.0
            && (override != t->override
                || PLAN_SHARE * (t->joined - t->planned) > t->planned - t->at)) {
            plan(t, r, override);
        }
        struct limit_segment p = next_limit_segment(t, r, override);
        if (override <= 0.0) {
            p.top = 0.0;
        }
        if (p.top <= 0.0 && t->v <= 0.0) {
            return 0.0;
        }
        dt = p.end > t->s ? drive(t, &p, dt) : dt;
        if (t->s >= border(t, r) && !lookahead_at_end(t, r)) {
            cross(t, r, override);
        }
    }
    return dt;
}

void lookahead_close(struct lookahead *t, const struct ring *r)
{
    double end = t->base, dec = INFINITY;

    t->closed = true;
    for (int32_t i = t->at; i < t->joined; i++) {
        const struct command *c = &ring_peek(r, i)->command;
        end += c->path.length;
        dec = el_min(dec, c->ramp.dec);
        if (t->v * t->v <= 2.0 * dec * (end - (t->base + t->s))) {
            t->joined = i + 1;
            t->end = end;
            t->override = -1.0; /* plan anew */
            return;
        }
    }
}

void lookahead_to_rest(struct lookahead *t, struct ring *r)
{
    lookahead_advance(t, r, 0.0, INFINITY);
}

/* Speeds that differ by less than such a share are the same. */
static const double SAME = 1e-6;

/* What limits a command on its own to body_limit(). */
static struct limited limited_body(const struct ring *r, int32_t i, double s,
                                   const struct mechanism *m, double override)
{
    const struct ring_entry *n = ring_peek(r, i);
    const struct command *c = &n->command;
    const double bend = path_bend(&c->path);
    double at[AXES], slope[AXES];

    if (n->body < command_speed(c, override)) {
        const bool jerk = bend_speed(c, bend, 0.0) > n->body * (1.0 + SAME);
        return (struct limited){ .by = jerk ? LIMITED_JERK : LIMITED_ACCELERATION };
    }
    path_at(&c->path, el_min(el_max(s, 0.0), c->path.length), at, slope);
    return limited_speed(m, slope, body_limit(n, override));
}

/* Whether a speed has to fall now to be `limit` so much further on, as the mean wants it. */
static bool slows_for(const struct lookahead *t, double speed, double limit, double dec, double way)
{
    const double brake = el_max(0.0, way - limit * t->smooth);
    return speed * speed * (1.0 + SAME) >= limit * limit + 2.0 * dec * brake;
}

/* What ahead of the planned motion keeps it to its speed. */
static struct limited limited_ahead(const struct lookahead *t, const struct ring *r,
                                    const struct mechanism *m, double override)
{
    double way = border(t, r) - t->s; /* to the start of what is looked at */

    for (int32_t i = t->at + !t->turning; i < t->joined; i++) {
        const struct ring_entry *n = ring_peek(r, i);
        const double half = lookahead_half(t, r, i), turn = turn_limit(r, i, override);
        const double dec = el_min(t->dec, n->command.ramp.dec);
        if (i > t->at && half > 0.0) {
            if (turn < t->v * (1.0 - SAME) && slows_for(t, t->v, turn, dec, way)) {
                return (struct limited){ .by = LIMITED_CORNER };
            }
            way += 2.0 * half;
        }
        const double body = body_limit(n, override);
        if (body < t->v * (1.0 - SAME) && slows_for(t, t->v, body, dec, way)) {
            return limited_body(r, i, 0.0, m, override);
        }
        way += n->command.path.length - half - lookahead_half(t, r, i + 1);
    }
    return (struct limited){ .by = LIMITED_STOP };
}

static struct limited limited_now(const struct lookahead *t, const struct ring *r,
                                  const struct mechanism *m, double override)
{
    if (lookahead_at_end(t, r)) {
        return (struct limited){ .by = LIMITED_STOP };
    }
    const struct limit_segment p = next_limit_segment(t, r, override);
    const double own =
        t->turning ? turn_limit(r, t->at, override) : body_limit(ring_peek(r, t->at), override);
    const double way = p.end - t->s;
    const bool brakes = t->v * t->v * (1.0 + SAME) >= p.leave * p.leave + 2.0 * p.dec * way;

    if (t->v < p.top * (1.0 - SAME) && !brakes) {
        const bool lags = t->smooth > 0.0 && t->out_v <= 0.0;
        return (struct limited){ .by = lags ? LIMITED_JERK : LIMITED_ACCELERATION };
    }
    if (t->v < own * (1.0 - SAME)) {
        for (int32_t i = 0; i < t->caps; i++) {
            if (t->s < t->cap[i].until - t->base && t->v >= t->cap[i].speed * (1.0 - SAME)) {
                return (struct limited){ .by = LIMITED_CORNER };
            }
        }
        return limited_ahead(t, r, m, override);
    }
    return t->turning ? (struct limited){ .by = LIMITED_CORNER }
                      : limited_body(r, t->at, t->s, m, override);
}

struct limited lookahead_limited(const struct lookahead *t, const struct ring *r,
                                 const struct mechanism *m, double override)
{
    struct limited told = limited_now(t, r, m, override);

    told.feed = ring_peek(r, t->at)->command.feed;
    return told;
}
