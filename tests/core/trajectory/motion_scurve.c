/* S-curve: limits, joints and ends of random plans, symmetries, closed forms, unusable input.
 * That no plan takes longer than it must is tested against ruckig, in test_scurve.py. */
#include <stdbool.h>
#include <string.h>

#include "check.h"
#include "scurve.h"

/* Rounding of a plan, as a part of its greatest length, speed, acceleration. */
static const double TIGHT = 1e-9;

enum kind { REST, MOVING, THROUGH, SPEED, KINDS };

struct move {
    struct scurve_start from;
    double s1, v1;
    struct scurve_limits l;
    enum kind kind;
};

static double decade(uint64_t *seed, double low, double high)
{
    return pow(10.0, check_real(seed, low, high));
}

/* Limits and ways from "never reached" to "reached at once", about the acceleration
 * sqrt(jerk speed) and the way speed sqrt(speed / jerk) of a ramp with no constant part. */
static struct move random_move(uint64_t *seed, enum kind kind, double spread)
{
    const double v = decade(seed, -1.0, 3.0), j = decade(seed, 0.0, 7.0), a = sqrt(j * v);
    struct move m = { .l = { v, a * decade(seed, -1.0, 1.0), a * decade(seed, -1.0, 1.0), j },
                      .kind = kind };
    m.s1 = v * sqrt(v / j) * decade(seed, -spread, spread);
    m.s1 = check_real(seed, 0.0, 1.0) < 0.5 ? -m.s1 : m.s1;
    if (kind != REST) {
        m.from.s = check_real(seed, -1.0, 1.0) * fabs(m.s1);
        m.from.v = check_real(seed, -1.5, 1.5) * v;
        m.from.a = check_real(seed, -fmin(a, m.l.dec), fmin(a, m.l.acc));
        m.v1 = kind == MOVING ? 0.0 : check_real(seed, 0.0, 1.0) * v;
    }
    return m;
}

static enum scurve_status plan(struct scurve *p, const struct move *m)
{
    return m->kind == SPEED ? scurve_plan_speed(p, &m->from, m->v1, &m->l)
                            : scurve_plan_through(p, &m->from, m->s1, m->v1, &m->l);
}

struct state {
    double s, v, a, j;
};

static struct state at(const struct scurve *p, double t)
{
    struct state x;
    scurve_state(p, t, &x.s, &x.v, &x.a, &x.j);
    return x;
}

/* Phase i, some time after it began, without scurve_state(). */
static struct state in_phase(const struct scurve *p, int i, double t)
{
    const struct scurve_phase *f = &p->phase[i];
    const double dt = t - f->t;
    return (struct state){ f->s + f->v * dt + f->a * dt * dt / 2 + f->j * dt * dt * dt / 6,
                           f->v + f->a * dt + f->j * dt * dt / 2, f->a + f->j * dt, f->j };
}

static double greatest(double a, double b, double c)
{
    return fmax(fabs(a), fmax(fabs(b), fabs(c)));
}

/* Start, joints and end. */
static void check_joints(const struct scurve *p, const struct move *m)
{
    const double v = greatest(m->l.speed, m->from.v, m->v1) + m->from.a * m->from.a / m->l.jerk;
    const double s = greatest(m->from.s, p->s1, v * p->total);
    const double a = greatest(m->l.acc, m->l.dec, m->from.a);
    struct state before = { m->from.s, m->from.v, m->from.a, 0.0 };
    double begin = 0.0;
    CHECK(p->count >= 0 && p->count <= SCURVE_PHASES);
    for (int i = 0; i <= p->count; i++) {
        const struct state end = { p->s1, m->v1, 0.0, 0.0 };
        const struct state after = i < p->count ? in_phase(p, i, begin) : end;
        CHECK_NEAR(after.s, before.s, TIGHT * s);
        CHECK_NEAR(after.v, before.v, TIGHT * v);
        CHECK_NEAR(after.a, before.a, TIGHT * a);
        if (i < p->count) {
            CHECK(p->phase[i].end > begin);
            CHECK(after.j == 0.0 || fabs(after.j) == m->l.jerk);
            begin = p->phase[i].end;
            before = in_phase(p, i, begin);
        }
    }
    CHECK(begin == p->total && scurve_total(p) == p->total);
    const struct state first = at(p, -1.0), last = at(p, p->total), later = at(p, 2 * p->total + 1);
    CHECK(memcmp(&first, (struct state[]){ at(p, 0.0) }, sizeof first) == 0);
    CHECK(last.v == m->v1 && last.a == 0.0 && last.j == 0.0);
    CHECK(m->kind == SPEED || last.s == m->s1);
    CHECK(memcmp(&later, &last, sizeof last) == 0);
}

/* Limits by value and by difference at every sample. */
static void check_limits(const struct scurve *p, const struct move *m)
{
    enum { SAMPLES = 300 };
    const double more = 1.0 + TIGHT, dt = p->total / SAMPLES;
    const struct scurve_limits *l = &m->l;
    bool inside = false; /* from then on v may not leave its limits */
    double slowest = m->from.v;
    struct state x = at(p, 0.0);
    for (int i = 0; i <= SAMPLES; i++) {
        const struct state last = x;
        x = at(p, i < SAMPLES ? i * dt : p->total);
        const double settled = x.v + x.a * fabs(x.a) / (2.0 * l->jerk);
        CHECK(x.a <= l->acc * more && x.a >= -l->dec * more && fabs(x.j) <= l->jerk);
        CHECK(!inside || fabs(x.v) <= l->speed * more);
        inside = inside || (m->kind != SPEED && fmax(fabs(x.v), fabs(settled)) <= l->speed);
        slowest = fmin(slowest, x.v);
        if (i > 0 && dt > 0.0) {
            const double scale_s = greatest(x.s, last.s, m->from.s) * 1e-15;
            const double scale_v = greatest(x.v, last.v, l->speed) * 1e-15;
            const double top = fmax(fabs(x.v), fabs(last.v)) + (l->acc + l->dec) * dt;
            CHECK(fabs(x.s - last.s) <= top * dt * more + 10 * scale_s);
            CHECK(x.v - last.v <= l->acc * dt * more + 10 * scale_v);
            CHECK(x.v - last.v >= -l->dec * dt * more - 10 * scale_v);
            CHECK(fabs(x.a - last.a) <= l->jerk * dt * more + 1e-14 * (l->acc + l->dec));
        }
    }
    CHECK(scurve_slowest(p) <= slowest + TIGHT * l->speed);
    CHECK(m->kind != REST || m->s1 < 0.0 || scurve_slowest(p) >= -TIGHT * l->speed);
}

static void random_plans(void)
{
    uint64_t seed = 1;
    for (int i = 0; i < 8000; i++) {
        const struct move m = random_move(&seed, (enum kind)(i % KINDS), 3.0);
        struct scurve p;
        CHECK(plan(&p, &m) == SCURVE_OK);
        check_joints(&p, &m);
        check_limits(&p, &m);
    }
}

/* Rest to rest never turns back, and slows down to exactly 0. */
static void monotone(void)
{
    uint64_t seed = 2;
    for (int i = 0; i < 500; i++) {
        struct move m = random_move(&seed, REST, 5.0);
        struct scurve p;
        m.s1 = fabs(m.s1);
        CHECK(plan(&p, &m) == SCURVE_OK);
        for (int k = 1; k <= 1000; k++) {
            const struct state a = at(&p, p.total * (k - 1) / 1000), b = at(&p, p.total * k / 1000);
            CHECK(b.s >= a.s && b.s <= m.s1 && b.v >= 0.0);
        }
    }
}

/* A move seen from the other side, faster, and in another unit of length is the same move. */
static void symmetries(void)
{
    uint64_t seed = 3;
    for (int i = 0; i < 4000; i++) {
        const struct move m = random_move(&seed, (enum kind)(i % KINDS), 3.0);
        const double t = 1.7, u = -25.4, k = u / t;
        struct move n = { { m.from.s * u, m.from.v * k, m.from.a * k / t },
                          m.s1 * u,
                          m.v1 * k,
                          { m.l.speed * -k, m.l.dec * -k / t, m.l.acc * -k / t,
                            m.l.jerk * -k / t / t },
                          m.kind };
        struct scurve p, q;
        CHECK(plan(&p, &m) == SCURVE_OK && plan(&q, &n) == SCURVE_OK);
        CHECK_NEAR(q.total, p.total * t, 1e-11 * q.total);
        CHECK_NEAR(q.s1, p.s1 * u, 1e-11 * (fabs(q.s1) + fabs(n.from.s)));
        const struct state x = at(&p, 0.4 * p.total), y = at(&q, 0.4 * q.total);
        CHECK_NEAR(y.v, x.v * k, 1e-8 * (fabs(y.v) + n.l.speed));
    }
}

/* Planned anew on the way, a move still ends at the same moment. */
static void replanned(void)
{
    uint64_t seed = 4;
    for (int i = 0; i < 20000; i++) {
        const struct move m = random_move(&seed, (enum kind)(i % KINDS), 2.0);
        struct scurve p, q;
        CHECK(plan(&p, &m) == SCURVE_OK);
        const double t = check_real(&seed, 0.0, 1.0) * p.total;
        const struct state x = at(&p, t);
        const struct move n = { { x.s, x.v, x.a }, m.s1, m.v1, m.l, m.kind };
        CHECK(plan(&q, &n) == SCURVE_OK);
        CHECK_NEAR(t + q.total, p.total, TIGHT * p.total);
    }
}

/* Jerk takes a from a0 to x, then to y, then to 0, held at x and y for a while: no plan between its
 * ends takes longer. With a0 < x < 0 and y < x it may pass its end on the way. */
static void by_hand(void)
{
    uint64_t seed = 7;
    for (int i = 0; i < 50000; i++) {
        struct move m = random_move(&seed, MOVING, 0.0);
        const double j = m.l.jerk, least = i % 2 ? -m.l.dec : fmin(0.0, m.from.a);
        const double x = check_real(&seed, least, i % 2 ? m.l.acc : 0.0);
        const double y = check_real(&seed, -m.l.dec, m.l.acc), edge[] = { x, x, y, y, 0.0 };
        const double hold = m.l.dec / j * (i / 2 % 2 ? 0.0 : check_real(&seed, 0.0, 1.0));
        double total = 0.0, s = m.from.s, v = m.from.v, a = m.from.a;
        m.l.speed = fabs(v);
        for (int k = 0; k < 5; k++) {
            const double da = edge[k] - a, t = k % 2 ? hold : fabs(da) / j;
            const double end = v + (a + da / 2.0) * t;
            /* Where a = 0 within the phase the speed has its extreme. */
            const double turn = a * edge[k] < 0.0 ? v + a * fabs(a) / (2.0 * j) : end;
            m.l.speed = fmax(m.l.speed, fmax(fabs(end), fabs(turn)));
            s += t * (v + t * (a / 2.0 + da / 6.0));
            v = end;
            a = edge[k];
            total += t;
        }
        m.s1 = s;
        m.v1 = v;
        struct scurve p;
        CHECK(plan(&p, &m) == SCURVE_OK);
        CHECK(p.total <= total + TIGHT * (total + m.l.dec / j));
    }
}

/* The way to a speed is its plan's; a target just there is met by the same plan, without a turn. */
static void ways(void)
{
    uint64_t seed = 5;
    for (int i = 0; i < 5000; i++) {
        struct move m = random_move(&seed, SPEED, 1.0);
        struct scurve p, q;
        m.from.v = check_real(&seed, 0.0, 1.0) * m.l.speed;
        m.from.a *= 0.5 * fmin(1.0, sqrt(m.l.speed - m.from.v) / sqrt(m.l.speed));
        CHECK(plan(&p, &m) == SCURVE_OK);
        CHECK_NEAR(scurve_way(&m.from, m.v1, &m.l), p.s1 - m.from.s,
                   1e-14 * (fabs(p.s1) + fabs(m.from.s)));
        CHECK(scurve_plan_through(&q, &m.from, p.s1, m.v1, &m.l) == SCURVE_OK);
        CHECK_NEAR(q.total, p.total, 1e-12 * p.total);
    }
}

static void rest(double way, struct scurve_limits l, double want)
{
    const struct scurve_start from = { 7.0, 0.0, 0.0 };
    struct scurve p;
    CHECK(scurve_plan(&p, &from, 7.0 + way, &l) == SCURVE_OK);
    CHECK_NEAR(p.total, want, 1e-14 * want);
}

static void closed_forms(void)
{
    const double far = 1e9;
    rest(2.0, (struct scurve_limits){ far, far, far, 1000.0 }, cbrt(32.0 * 2.0 / 1000.0));
    /* L/v + v (1/a + 1/d)/2 + (a + d)/(2 j) = 1 + 0.075 + 0.015 */
    rest(100.0, (struct scurve_limits){ 100.0, 1000.0, 2000.0, 1e5 }, 1.09);
    /* Peak acceleration just reached, a = sqrt(v j); speed just reached, L = v (v/a + a/j). */
    rest(20.0, (struct scurve_limits){ 100.0, 1000.0, 1000.0, 1e4 }, 0.4);
    rest(-20.0, (struct scurve_limits){ 100.0, 1000.0, 1000.0, 1e4 }, 0.4);
    /* Acceleration just reached, no part constant: L = 2 a^3/j^2, T = 4 a/j. */
    rest(0.25, (struct scurve_limits){ far, 50.0, 50.0, 1000.0 }, 0.2);
    /* One limit only: with a << j t it is the trapezoid, T = sqrt(2 L (1/a + 1/d)). */
    const struct scurve_start from = { 0.0, 0.0, 0.0 };
    struct scurve p;
    CHECK(scurve_plan(&p, &from, 1.0, &(struct scurve_limits){ far, 2.0, 4.0, 1e15 }) == SCURVE_OK);
    CHECK_NEAR(p.total, sqrt(1.5), 1e-12);
    /* To rest from 20 mm/s, a just not reaching 100: v/a = a/j, T = 2 a/j, way v T/2. */
    const struct scurve_start moving = { 3.0, 20.0, 0.0 };
    const struct scurve_limits l = { 50.0, 100.0, 100.0, 500.0 };
    CHECK(scurve_plan_speed(&p, &moving, 0.0, &l) == SCURVE_OK);
    CHECK_NEAR(p.total, 0.4, 1e-15);
    CHECK_NEAR(p.s1, 7.0, 1e-14);
}

static void unusable(void)
{
    const struct scurve_start from = { 1.0, 2.0, 3.0 };
    const struct scurve_limits good = { 10.0, 20.0, 30.0, 40.0 };
    const double bad[] = { NAN, INFINITY, -INFINITY, 0.0, -1.0 };
    struct scurve p;
    for (int i = 0; i < 5; i++) {
        const enum scurve_status want = i < 3 ? SCURVE_NOT_FINITE : SCURVE_LIMITS;
        for (int k = 0; k < 4; k++) {
            double v[4] = { 10.0, 20.0, 30.0, 40.0 };
            v[k] = bad[i];
            const struct scurve_limits l = { v[0], v[1], v[2], v[3] };
            CHECK(scurve_plan(&p, &from, 5.0, &l) == want);
            CHECK(scurve_plan_speed(&p, &from, 5.0, &l) == want);
            CHECK(p.total == 0.0 && at(&p, 1.0).s == 1.0 && at(&p, 0.0).v == 0.0);
        }
        for (int k = 0; k < 5 && i < 3; k++) {
            double x[5] = { 1.0, 2.0, 3.0, 4.0, 5.0 };
            x[k] = bad[i];
            const struct scurve_start start = { x[0], x[1], x[2] };
            CHECK(scurve_plan_through(&p, &start, x[3], x[4], &good) == SCURVE_NOT_FINITE);
            CHECK(isfinite(at(&p, 0.0).s));
        }
    }
    CHECK(scurve_plan_through(&p, &from, 5.0, 10.001, &good) == SCURVE_TARGET);
    CHECK(scurve_plan(&p, &(struct scurve_start){ 5.0, 0.0, 0.0 }, 5.0, &good) == SCURVE_OK);
    CHECK(p.total == 0.0 && p.count == 0 && at(&p, 0.0).s == 5.0 && at(&p, NAN).s == 5.0);
}

/* Whatever numbers come: a plan that is true to its limits and meets its end, or a refusal. */
static void extremes(void)
{
    uint64_t seed = 6;
    int refused = 0;
    for (int i = 0; i < 100000; i++) {
        const double wide = i % 2 ? 300.0 : 30.0;
        double x[9];
        for (int k = 0; k < 9; k++) {
            const double dice = check_real(&seed, 0.0, 1.0);
            x[k] = dice < 0.3 ? pow(10.0, (int)(10 * dice)) : decade(&seed, -wide, wide);
            x[k] = k < 5 && dice > 0.9 ? 0.0 : k < 5 && dice > 0.6 ? -x[k] : x[k];
        }
        const struct scurve_start from = { x[0], x[1], x[2] };
        const struct scurve_limits l = { x[5], x[6], x[7], x[8] };
        struct scurve p;
        const enum scurve_status status = scurve_plan_through(&p, &from, x[3], x[4], &l);
        CHECK(status == SCURVE_OK || status == SCURVE_RANGE || status == SCURVE_TARGET);
        refused += status == SCURVE_RANGE;
        for (int k = 0; k <= 8; k++) {
            const struct state y = at(&p, p.total * k / 8.0);
            CHECK(isfinite(y.s) && isfinite(y.v) && isfinite(y.a) && isfinite(y.j));
        }
        for (int k = 1; k < p.count; k++) {
            CHECK(p.phase[k].end >= p.phase[k - 1].end);
        }
    }
    CHECK(refused < 50000);
}

int main(void)
{
    random_plans();
    monotone();
    symmetries();
    replanned();
    by_hand();
    ways();
    closed_forms();
    unusable();
    extremes();
    return check_result();
}
