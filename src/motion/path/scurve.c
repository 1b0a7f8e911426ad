#include "scurve.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "el_extremes.h"
#include "scurve_reach.h"

enum { BRAKES = SCURVE_LEG_BRAKES, PHASES = SCURVE_PHASES };

_Static_assert(SCURVE_PHASES == SCURVE_LEG_BRAKES + SCURVE_LEG_PHASES, "brake, then leg");

/* The phases of a plan before they are put together. */
struct parts {
    double t[PHASES]; /* [s] durations */
    double j[PHASES]; /* [mm/s^3] */
};

/* The parts from this one on are counted back from the end: what rounding leaves over lies before
 * it, and the end is met exactly. */
enum { FROM_END = BRAKES + 2 };

/* The motion at dt after, or before, the moment of the phase. */
static void follow(const struct scurve_phase *f, double dt, double *s, double *v, double *a)
{
    *s = f->s + dt * (f->v + dt * (f->a / 2.0 + dt * (f->j / 6.0)));
    *v = f->v + dt * (f->a + dt * (f->j / 2.0));
    *a = f->a + dt * f->j;
}

/* Far more than rounding leaves (some 1e-13), far less than an overflow does. */
static const double NEAR = 1e-6;

/* What was counted from the start meets what was counted back from the end. */
static bool meet(const struct scurve *p, const struct scurve_start *from,
                 const struct scurve_phase *f, const struct scurve_phase *b)
{
    const double v = fabs(from->v) + fabs(f->v) + fabs(b->v) + fabs(p->v1);
    const double s = fabs(from->s) + fabs(f->s) + fabs(b->s) + fabs(p->s1) + v * p->total;
    return isfinite(s) && fabs(f->v - b->v) <= NEAR * v && fabs(f->s - b->s) <= NEAR * s;
}

/* Phases from parts; p->s1 and p->v1 are given. A part too short to move the time on is left
 * out. */
static enum scurve_status assemble(struct scurve *p, const struct scurve_start *from,
                                   const struct parts *q)
{
    struct scurve_phase f = { .s = from->s, .v = from->v, .a = from->a };
    struct scurve_phase b = { .s = p->s1, .v = p->v1 };
    double end[PHASES + 1] = { 0 }; /* of the part before */
    int n = 0;

    for (int i = 0; i < PHASES; i++) {
        end[i + 1] = end[i] + q->t[i];
        if (end[i + 1] > end[i]) {
            f.t = end[i];
            f.end = end[i + 1];
            f.j = q->j[i];
            p->phase[n++] = f;
        }
        if (i < FROM_END) {
            f.j = q->j[i];
            follow(&f, q->t[i], &f.s, &f.v, &f.a);
        }
    }
    p->count = n;
    p->total = end[PHASES];
    for (int i = PHASES - 1; i >= FROM_END; i--) {
        b.t = b.end = end[i + 1];
        b.j = q->j[i];
        if (end[i + 1] > end[i]) {
            p->phase[--n] = b;
        }
        follow(&b, -q->t[i], &b.s, &b.v, &b.a);
    }
    return meet(p, from, &f, &b) ? SCURVE_OK : SCURVE_RANGE;
}

/* Rest at the start, for a plan that is refused. */
static enum scurve_status refuse(struct scurve *p, const struct scurve_start *from,
                                 enum scurve_status status)
{
    memset(p, 0, sizeof *p);
    p->s1 = isfinite(from->s) ? from->s : 0.0;
    return status;
}

static enum scurve_status usable(const struct scurve_start *from, double s1, double v1,
                                 const struct scurve_limits *l)
{
    /* Any number times 0 is 0, but infinity and not-a-number are not. */
    const double sum = 0.0 * from->s + 0.0 * from->v + 0.0 * from->a + 0.0 * s1 + 0.0 * v1
                       + 0.0 * l->speed + 0.0 * l->acc + 0.0 * l->dec + 0.0 * l->jerk;
    if (!(sum == 0.0)) {
        return SCURVE_NOT_FINITE;
    }
    if (!(l->speed > 0.0 && l->acc > 0.0 && l->dec > 0.0 && l->jerk > 0.0)) {
        return SCURVE_LIMITS;
    }
    return SCURVE_OK;
}

/* A leg in units of the jerk. */
static struct scurve_leg leg_of(const struct scurve_start *from, double way, double v1,
                                const struct scurve_limits *l)
{
    const double u = 1.0 / l->jerk;
    return (struct scurve_leg){ from->v * u, from->a * u, way * u,     v1 * u,
                                l->acc * u,  l->dec * u,  l->speed * u };
}

/* Jerks of the parts, of a leg seen in direction sign. */
static void set_jerks(struct parts *q, double sign, double jerk)
{
    for (int i = 0; i < BRAKES; i++) {
        q->j[i] *= jerk;
    }
    for (int i = 0; i < SCURVE_LEG_PHASES; i++) {
        q->j[BRAKES + i] = sign * jerk * SCURVE_LEG_JERK[i];
    }
}

enum scurve_status scurve_plan_through(struct scurve *p, const struct scurve_start *from, double s1,
                                       double v1, const struct scurve_limits *l)
{
    enum scurve_status status = usable(from, s1, v1, l);
    if (status == SCURVE_OK && fabs(v1) > l->speed) {
        status = SCURVE_TARGET;
    }
    if (status != SCURVE_OK) {
        return refuse(p, from, status);
    }
    struct parts q;
    struct scurve_leg leg = leg_of(from, s1 - from->s, v1, l);
    scurve_leg_brake(&leg, 1, q.j, q.t);
    double sign = scurve_leg_sign(&leg), rounding;
    struct scurve_leg seen = scurve_leg_seen(&leg, sign);
    const double beyond = seen.way - scurve_leg_speed(&seen, q.t + BRAKES, &rounding);
    if (leg.v != 0.0 || leg.a != 0.0 || v1 != 0.0) {
        rounding += DBL_EPSILON * (fabs(from->s) + fabs(s1)) / l->jerk;
    }
    if (!(fabs(beyond) <= rounding)) {
        sign = beyond > 0.0 ? sign : -sign;
        seen = scurve_leg_seen(&leg, sign);
        scurve_reach(&seen, q.t + BRAKES);
    }
    set_jerks(&q, sign, l->jerk);
    memset(p, 0, sizeof *p);
    p->s1 = s1;
    p->v1 = v1;
    status = assemble(p, from, &q);
    return status == SCURVE_OK ? SCURVE_OK : refuse(p, from, status);
}

enum scurve_status scurve_plan(struct scurve *p, const struct scurve_start *from, double s1,
                               const struct scurve_limits *l)
{
    return scurve_plan_through(p, from, s1, 0.0, l);
}

/* Parts of the fastest change of speed; returns its way. [mm] */
static double change_speed(struct parts *q, const struct scurve_start *from, double v1,
                           const struct scurve_limits *l)
{
    struct scurve_leg leg = leg_of(from, 0.0, v1, l);
    scurve_leg_brake(&leg, 0, q->j, q->t);
    const double sign = scurve_leg_sign(&leg);
    const struct scurve_leg seen = scurve_leg_seen(&leg, sign);
    double rounding;
    const double way = sign * scurve_leg_speed(&seen, q->t + BRAKES, &rounding) - leg.way;
    set_jerks(q, sign, l->jerk);
    return way * l->jerk;
}

enum scurve_status scurve_plan_speed(struct scurve *p, const struct scurve_start *from, double v1,
                                     const struct scurve_limits *l)
{
    enum scurve_status status = usable(from, 0.0, v1, l);
    if (status != SCURVE_OK) {
        return refuse(p, from, status);
    }
    struct parts q;
    memset(p, 0, sizeof *p);
    p->s1 = from->s + change_speed(&q, from, v1, l);
    p->v1 = v1;
    status = assemble(p, from, &q);
    return status == SCURVE_OK ? SCURVE_OK : refuse(p, from, status);
}

double scurve_way(const struct scurve_start *from, double v1, const struct scurve_limits *l)
{
    struct parts q;
    return change_speed(&q, from, v1, l);
}

void scurve_state(const struct scurve *p, double t, double *s, double *v, double *a, double *j)
{
    t = el_max(0.0, t);
    if (!(t < p->total)) {
        *s = p->s1;
        *v = p->v1;
        *a = *j = 0.0;
        return;
    }
    const struct scurve_phase *f = p->phase;
    while (t >= f->end) {
        f++;
    }
    follow(f, t - f->t, s, v, a);
    *j = f->j;
}

double scurve_total(const struct scurve *p)
{
    return p->total;
}

double scurve_slowest(const struct scurve *p)
{
    double least = p->v1, s, v, a, begin = 0.0;
    for (int i = 0; i < p->count; i++) {
        const struct scurve_phase *f = &p->phase[i];
        const double turn = f->j != 0.0 ? f->t - f->a / f->j : begin; /* where a = 0 */
        follow(f, begin - f->t, &s, &v, &a);
        least = el_min(least, v);
        if (turn > begin && turn < f->end) {
            follow(f, turn - f->t, &s, &v, &a);
            least = el_min(least, v);
        }
        begin = f->end;
    }
    return least;
}
