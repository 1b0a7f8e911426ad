#include "bounds.h"

#include <math.h>
#include <string.h>

#include "axes_bounds.h"
#include "el_extremes.h"
#include "elementary.h"
#include "jet.h"

static const double MM = 1e-3; /* [m] */

/* The part of the path that is looked at. */
struct part {
    const struct arm_geometry *g;
    const struct arm_move *move;
    const struct path *path;
    double middle;            /* [mm] */
    const double *joint;      /* [rad] there */
    double inner[OPW_JOINTS]; /* [rad] the same as opw counts them */
};

/* An arm of three joints [mm]: its lengths and where it ends may depend on the place. */
struct limbs {
    struct jet a2, b, c3;
    double a1, c2;
    struct jet end[3];      /* from axis 2's height */
    const double *inner;    /* [rad] joints in the middle */
    double shoulder, elbow; /* side: +1 or -1 */
};

/* Joints 1 to 3 of that arm: directions and rates. */
struct stand {
    struct jet base[2], fore[2]; /* cosine, sine of joint 1, of the forearm from upright */
    struct jet rate[3];          /* of the joints */
};

static struct jet pair(const struct jet *a, const struct jet *b, const struct jet *c,
                       const struct jet *d, double sign)
{
    const struct jet p = jet_product(a, b), q = jet_product(c, d);
    return sign > 0.0 ? jet_sum(&p, &q) : jet_difference(&p, &q);
}

/* How the slope of a path turns: evenly, on a line not at all. [rad/mm] */
static void arc_turn(const struct path *path, double turn[3])
{
    memset(turn, 0, 3 * sizeof *turn);
    for (int i = 0; i < 3 && path->arc; i++) {
        turn[i] = path->sweep / path->length
                  * (path->plane == PATH_TILTED ? path->normal[i] : i == (int)path->plane);
    }
}

/* The tip: straight, or on an arc. */
static void tip(const struct part *p, double half, struct jet at[3])
{
    double place[AXES], slope[AXES], turn[3];
    struct jet along[3];

    path_at(p->path, p->middle, place, slope);
    arc_turn(p->path, turn);
    jet_turning(slope, turn, half, along);
    for (int i = 0; i < 3; i++) {
        const double reach = half * jet_most(&along[i].all[0]);
        at[i].half = half;
        at[i].middle[0] = place[i];
        at[i].all[0] = (struct jet_range){ place[i] - reach, place[i] + reach };
        for (int k = 1; k < JET_TERMS; k++) {
            at[i].middle[k] = along[i].middle[k - 1] / k;
            at[i].all[k].low = along[i].all[k - 1].low / k;
            at[i].all[k].high = along[i].all[k - 1].high / k;
        }
    }
}

static void direction(double angle, const struct jet *rate, struct jet out[2])
{
    const struct el_turn t = el_sincos(angle);
    jet_direction(t.cosine, t.sine, rate, out);
}

/* Rate of joint 1: that of the end, without the lateral offset's. */
static struct jet swing(const struct limbs *l, bool *good)
{
    const struct jet *x = &l->end[0], *y = &l->end[1];
    const struct jet all = jet_angle_rate(x, y, good);

    if (l->b.all[0].low == 0.0 && l->b.all[0].high == 0.0) {
        return all;
    }
    const struct jet square = pair(x, x, y, y, 1.0), bb = jet_product(&l->b, &l->b);
    const struct jet reach = jet_difference(&square, &bb), ahead = jet_root(&reach, good);
    const struct jet side = jet_scaled(&ahead, l->shoulder);
    const struct jet skew = jet_angle_rate(&side, &l->b, good);
    return jet_difference(&all, &skew);
}

/* Joints 1 to 3 by the end of the forearm. Joint 1 known, the rest is an arm in a plane. */
static bool stand_at(const struct limbs *l, struct stand *out)
{
    const struct jet *z = &l->end[2], a1 = jet_constant(l->a1, z->half);
    const struct jet one = jet_constant(1.0, z->half), upper = jet_constant(l->c2, z->half);
    bool good = true;

    out->rate[0] = swing(l, &good);
    direction(l->inner[0], &out->rate[0], out->base);
    const struct jet ahead = pair(&l->end[0], &out->base[0], &l->end[1], &out->base[1], 1.0);
    const struct jet n = jet_difference(&ahead, &a1), ss = pair(&n, &n, z, z, 1.0);
    const struct jet kk = pair(&l->a2, &l->a2, &l->c3, &l->c3, 1.0), k = jet_root(&kk, &good);
    const struct jet upper2 = jet_product(&upper, &upper), both = jet_sum(&kk, &upper2);
    const struct jet open = jet_difference(&ss, &both), twice = jet_scaled(&k, 2.0 * l->c2);
    const struct jet cosine = jet_quotient(&open, &twice, &good);
    const struct jet cosine2 = jet_product(&cosine, &cosine);
    const struct jet sine2 = jet_difference(&one, &cosine2), bent = jet_root(&sine2, &good);
    const struct jet sine = jet_scaled(&bent, l->elbow);

    /* The end from axis 2, seen from the upper arm: (u, v). */
    const struct jet kc = jet_product(&k, &cosine), v = jet_product(&k, &sine);
    const struct jet u = jet_sum(&upper, &kc);
    const struct jet up = pair(&u, z, &v, &n, 1.0), forth = pair(&u, &n, &v, z, -1.0);
    out->rate[1] = jet_angle_rate(&up, &forth, &good);
    const struct jet elbow = jet_angle_rate(&cosine, &sine, &good);
    const struct jet skew = jet_angle_rate(&l->c3, &l->a2, &good);
    out->rate[2] = jet_difference(&elbow, &skew);
    const struct jet whole = jet_sum(&out->rate[1], &out->rate[2]);
    direction(l->inner[1] + l->inner[2], &whole, out->fore);
    return good;
}

/* Sides of the arm, which its lengths in the middle decide. */
static void sides(const struct part *p, const struct opw *o, struct limbs *l)
{
    double factor[3];

    opw_factors(o, p->joint, factor);
    l->shoulder = factor[0] < 0.0 ? -1.0 : 1.0;
    l->elbow = factor[1] < 0.0 ? -1.0 : 1.0;
    l->a1 = o->a1 / MM;
    l->c2 = o->c2 / MM;
    l->inner = p->inner;
}

/* Tip and orientation follow the path. */
static bool by_pose(const struct part *p, double half, struct jet rate[OPW_JOINTS])
{
    const struct opw *o = &p->g->arm->opw;
    const struct arm_move *m = p->move;
    const double *tool = p->g->arm->tool.at;
    struct opw_pose flange;
    struct jet hand[3][3], reach[3], seen[3], across[2], side[2];
    double turn[3] = { 0.0, 0.0, 0.0 }, out[3];
    struct limbs l = { .a2 = jet_constant(o->a2 / MM, half),
                       .b = jet_constant(o->b / MM, half),
                       .c3 = jet_constant(o->c3 / MM, half) };
    struct stand s;

    opw_forward(o, p->joint, &flange);
    for (int i = 0; i < 3; i++) {
        turn[i] = m->to > m->from ? m->by[i] / p->path->length : 0.0;
        out[i] = flange.turn[i][0] * tool[0] + flange.turn[i][1] * tool[1]
                 + flange.turn[i][2] * (tool[2] + o->c4 / MM);
    }
    for (int k = 0; k < 3; k++) {
        const double axis[3] = { flange.turn[0][k], flange.turn[1][k], flange.turn[2][k] };
        jet_turning(axis, turn, half, hand[k]);
    }
    tip(p, half, l.end);
    jet_turning(out, turn, half, reach);
    const struct jet height = jet_constant(o->c1 / MM, half);
    reach[2] = jet_sum(&reach[2], &height);
    for (int i = 0; i < 3; i++) {
        l.end[i] = jet_difference(&l.end[i], &reach[i]);
    }
    sides(p, o, &l);
    if (!stand_at(&l, &s)) {
        return false;
    }
    memcpy(rate, s.rate, sizeof s.rate);
    /* The hand's axes seen from the forearm: x y z of its z axis, z of the others. */
    for (int k = 0; k < 3; k++) {
        seen[0] = pair(&s.base[0], &hand[k][0], &s.base[1], &hand[k][1], 1.0);
        if (k < 2) {
            across[k] = pair(&s.fore[1], &seen[0], &s.fore[0], &hand[k][2], 1.0);
        }
    }
    seen[1] = pair(&s.base[0], &hand[2][1], &s.base[1], &hand[2][0], -1.0);
    seen[2] = pair(&s.fore[1], &seen[0], &s.fore[0], &hand[2][2], 1.0);
    seen[0] = pair(&s.fore[0], &seen[0], &s.fore[1], &hand[2][2], -1.0);
    bool good = true;
    rate[3] = jet_angle_rate(&seen[0], &seen[1], &good);
    rate[5] = jet_angle_rate(&across[0], &across[1], &good); /* but for its sign */
    direction(p->inner[3], &rate[3], side);
    const struct jet sine = pair(&side[0], &seen[0], &side[1], &seen[1], 1.0);
    rate[4] = jet_angle_rate(&seen[2], &sine, &good);
    return good;
}

/* Joints 4 to 6 go evenly; the tip belongs to the forearm, whose lengths they change. */
static bool by_wrist(const struct part *p, double half, struct jet rate[OPW_JOINTS])
{
    const struct opw *o = &p->g->arm->opw;
    const double *tool = p->g->arm->tool.at;
    struct jet v[3] = { jet_constant(tool[0], half), jet_constant(tool[1], half),
                        jet_constant(tool[2] + o->c4 / MM, half) };
    struct opw now = *o;
    struct limbs l;
    struct stand s;

    for (int i = 5; i > 2; i--) { /* Rz(th4) Ry(th5) Rz(th6) v */
        const struct el_turn t = el_sincos(p->inner[i]);
        const double at[3] = { t.cosine, t.sine, 0.0 };
        const double per = p->move->step[i] / p->path->length;
        const double turn[3] = { 0.0, 0.0, o->sign[i] * per };
        const int a = i == 4 ? 2 : 0, b = i == 4 ? 0 : 1;
        struct jet d[3];
        jet_turning(at, turn, half, d);
        const struct jet first = pair(&d[0], &v[a], &d[1], &v[b], -1.0);
        v[b] = pair(&d[1], &v[a], &d[0], &v[b], 1.0);
        v[a] = first;
        rate[i] = jet_constant(per, half);
    }
    const struct jet a2 = jet_constant(o->a2 / MM, half), b = jet_constant(o->b / MM, half);
    const struct jet c3 = jet_constant(o->c3 / MM, half), height = jet_constant(o->c1 / MM, half);
    l.a2 = jet_sum(&a2, &v[0]);
    l.b = jet_sum(&b, &v[1]);
    l.c3 = jet_sum(&c3, &v[2]);
    tip(p, half, l.end);
    l.end[2] = jet_difference(&l.end[2], &height);
    now.a2 = MM * l.a2.middle[0];
    now.b = MM * l.b.middle[0];
    now.c3 = MM * l.c3.middle[0];
    sides(p, &now, &l);
    if (!stand_at(&l, &s)) {
        return false;
    }
    memcpy(rate, s.rate, sizeof s.rate);
    return true;
}

/* The derivative of a vector that turns. */
static void turned(const double by[3], const double v[3], double rate[3])
{
    for (int i = 0; i < 3; i++) {
        const int k = (i + 1) % 3, n = (i + 2) % 3;
        rate[i] = by[k] * v[n] - by[n] * v[k];
    }
}

/* An arm that is known by its axes. */
static bool by_axes(const struct part *p, double half, struct bounds *b)
{
    struct axes_motion motion = { .half = half };
    double place[AXES], slope[AXES], arc[3];

    path_at(p->path, p->middle, place, slope);
    arc_turn(p->path, arc);
    memcpy(motion.at, place, sizeof motion.at);
    memcpy(motion.slope, slope, sizeof motion.slope);
    turned(arc, motion.slope, motion.bend);
    turned(arc, motion.bend, motion.twist);
    for (int i = 0; i < 3; i++) {
        motion.turn[i] = p->move->to > p->move->from ? p->move->by[i] / p->path->length : 0.0;
    }
    motion.swing = sqrt(arc[0] * arc[0] + arc[1] * arc[1] + arc[2] * arc[2]);
    return axes_bounds_of(p->g->arm, p->joint, &motion, b);
}

bool bounds_of(const struct arm_geometry *g, const struct path *path, double from, double to,
               const double joint[OPW_JOINTS], struct bounds *b)
{
    const struct arm_moves *c = g->moves;
    struct part p = { g,     &c->move[(c->count - 1) % ARM_MOVES_SIZE],
                      path,  0.5 * (from + to) * path->length,
                      joint, { 0.0 } };
    const double half = 0.5 * (to - from) * path->length;
    struct jet rate[OPW_JOINTS];

    for (int i = 0; i < OPW_JOINTS; i++) {
        p.inner[i] = g->arm->opw.sign[i] * joint[i] - g->arm->opw.offset[i];
    }
    if (g->arm->by_axes) {
        return by_axes(&p, half, b);
    }
    if (!(p.move->kind == ARM_MOVE_WRIST ? by_wrist(&p, half, rate) : by_pose(&p, half, rate))) {
        return false;
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        b->most.slope[i] = jet_most(&rate[i].all[0]);
        b->most.bend[i] = jet_most(&rate[i].all[1]);
        b->middle.slope[i] = fabs(rate[i].middle[0]);
        b->middle.bend[i] = fabs(rate[i].middle[1]);
    }
    return true;
}
