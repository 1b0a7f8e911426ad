#include "manipulator.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"
#include "vector3.h"

static const double MM = 1e-3; /* [m] */

static const double TURN = 6.283185307179586, DEGREE = 0.017453292519943295;

/* An elbow whose sine is below this may leave its side: the arm is stretched. */
static const double STRETCHED = 1e-6;

/* A joint may be beyond a limit by so much. [rad] */
static const double ROUNDING = 1e-9;

static const double UNIT[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };

/* Axes that are no further than this from each other are in parallel. [rad] */
static const double PARALLEL = 1e-9;

/* Share of the largest pivot below which a pivot is 0: the place is singular. */
static const double PIVOT = 1e-13;

static const double ANY_LOW[OPW_JOINTS] = { -INFINITY, -INFINITY, -INFINITY,
                                            -INFINITY, -INFINITY, -INFINITY };
static const double ANY_HIGH[OPW_JOINTS] = { INFINITY, INFINITY, INFINITY,
                                             INFINITY, INFINITY, INFINITY };

/* Joints as the chain counts them. */
static void whole(const double joint[OPW_JOINTS], double q[CHAIN_JOINTS])
{
    memset(q, 0, CHAIN_JOINTS * sizeof *q);
    memcpy(q, joint, OPW_JOINTS * sizeof *q);
}

void manipulator_flange(const struct manipulator *m, const double joint[OPW_JOINTS],
                        struct opw_pose *flange)
{
    struct chain_pose end;
    double q[CHAIN_JOINTS];

    if (!m->by_axes) {
        opw_forward(&m->opw, joint, flange);
        return;
    }
    whole(joint, q);
    chain_forward(&m->axes.chain, q, &end);
    memcpy(flange->at, end.at, sizeof flange->at);
    memcpy(flange->turn, end.turn, sizeof flange->turn);
}

int manipulator_joints_of(const struct manipulator *m)
{
    return m->by_axes ? m->axes.chain.joints : OPW_JOINTS;
}

bool manipulator_slides(const struct manipulator *m, int joint)
{
    return m->by_axes && m->axes.chain.joint[joint].slides;
}

double manipulator_unit(const struct manipulator *m, int joint)
{
    return manipulator_slides(m, joint) ? MM : DEGREE;
}

int manipulator_flags(const struct manipulator *m)
{
    return m->by_axes ? (int)m->axes.flags : OPW_BACK | OPW_ELBOW | OPW_FLIP;
}

static struct pose flange_pose(const struct manipulator *m, const double joint[OPW_JOINTS])
{
    struct opw_pose flange;
    struct pose p;

    manipulator_flange(m, joint, &flange);
    for (int i = 0; i < 3; i++) {
        p.at[i] = flange.at[i] / MM;
    }
    quaternion_of_matrix((const double(*)[3])flange.turn, p.turn);
    return p;
}

void manipulator_with(const struct manipulator *m, const struct pose *tool, struct manipulator *arm)
{
    memcpy(arm, m, m->by_axes ? sizeof *m : offsetof(struct manipulator, axes));
    arm->tool = *tool;
}

struct pose manipulator_pose(const struct manipulator *m, const double joint[OPW_JOINTS])
{
    const struct pose flange = flange_pose(m, joint);
    return pose_product(&flange, &m->tool);
}

int manipulator_branch(const struct manipulator *m, const double joint[OPW_JOINTS])
{
    double q[CHAIN_JOINTS];

    if (!m->by_axes) {
        return opw_branch(&m->opw, joint);
    }
    whole(joint, q);
    return chain_branch(&m->axes, q);
}

int manipulator_factors(const struct manipulator *m, const double joint[OPW_JOINTS],
                        double factor[3])
{
    double q[CHAIN_JOINTS];

    if (!m->by_axes) {
        return opw_factors(&m->opw, joint, factor);
    }
    whole(joint, q);
    return chain_factors(&m->axes, q, factor);
}

int manipulator_open(const struct manipulator *m)
{
    return m->by_axes ? chain_form_open(&m->axes) : 3;
}

double manipulator_reach(const struct manipulator *m)
{
    const struct opw *o = &m->opw;

    return 1e3
           * (m->by_axes ? m->axes.size
                         : fabs(o->a1) + fabs(o->a2) + fabs(o->b) + o->c1 + o->c2 + o->c3 + o->c4);
}

/* Branches on the same side of the elbow as `near`. */
static uint32_t same_elbow(const struct manipulator *m, const double near[OPW_JOINTS])
{
    double factor[3];

    if (m->by_axes) {
        manipulator_factors(m, near, factor);
    } else {
        factor[1] = opw_elbow(&m->opw, near);
    }
    const double elbow = factor[1];
    return fabs(elbow) < STRETCHED ? 0xff : elbow < 0.0 ? 0xcc : 0x33;
}

uint32_t manipulator_branches(const struct manipulator *m, const struct opw_pose *flange,
                              const double near[OPW_JOINTS], uint32_t wanted,
                              double all[OPW_BRANCHES][OPW_JOINTS])
{
    double q[CHAIN_JOINTS], joint[CHAIN_BRANCHES][CHAIN_JOINTS];
    struct chain_pose pose;

    if (!m->by_axes) {
        return opw_inverse_of(&m->opw, flange, near, wanted, all);
    }
    whole(near, q);
    memcpy(pose.at, flange->at, sizeof pose.at);
    memcpy(pose.turn, flange->turn, sizeof pose.turn);
    const uint32_t there = chain_inverse(&m->axes, &pose, q, wanted, joint);
    for (int n = 0; n < OPW_BRANCHES; n++) {
        memcpy(all[n], joint[n], sizeof all[n]);
        for (int i = m->axes.chain.joints; i < OPW_JOINTS; i++) {
            all[n][i] = 0.0;
        }
    }
    return there;
}

int manipulator_nearest(const struct manipulator *m, uint32_t there,
                        const double all[OPW_BRANCHES][OPW_JOINTS], const double near[OPW_JOINTS],
                        const double low[OPW_JOINTS], const double high[OPW_JOINTS],
                        double joint[OPW_JOINTS])
{
    double every[CHAIN_BRANCHES][CHAIN_JOINTS], q[CHAIN_JOINTS];
    double from[CHAIN_JOINTS], least[CHAIN_JOINTS], most[CHAIN_JOINTS];

    if (!m->by_axes || m->axes.chain.joints == OPW_JOINTS) {
        bool turns = true;
        for (int i = 0; i < OPW_JOINTS; i++) {
            turns = turns && !manipulator_slides(m, i);
        }
        if (turns) {
            return opw_nearest(there, all, near, low, high, joint);
        }
    }
    whole(near, from);
    whole(low, least);
    whole(high, most);
    for (int n = 0; n < CHAIN_BRANCHES; n++) {
        whole(all[n], every[n]);
    }
    const int best =
        chain_nearest(&m->axes, there, (const double(*)[CHAIN_JOINTS])every, from, least, most, q);
    if (best >= 0) {
        memcpy(joint, q, OPW_JOINTS * sizeof *joint);
    }
    return best;
}

/* Pose of the flange for one of the tip. */
static void flange_of(const struct manipulator *m, const struct pose *tip, struct opw_pose *flange)
{
    const struct pose off = pose_inverse(&m->tool);
    const struct pose p = pose_product(tip, &off);

    for (int i = 0; i < 3; i++) {
        flange->at[i] = p.at[i] * MM;
    }
    quaternion_matrix(p.turn, flange->turn);
}

double manipulator_tilt(const struct manipulator *m, const struct pose *pose)
{
    const struct chain *c = &m->axes.chain;
    const double *axis = NULL;
    struct opw_pose flange;
    double at_zero[3], turned[3], side[3];
    double most = 0.0;

    if (!m->by_axes || c->joints == OPW_JOINTS) {
        return 0.0;
    }
    for (int k = 0; k < c->joints; k++) {
        if (c->joint[k].slides || chain_levelled(c, k) >= 0) {
            continue;
        }
        vector3_cross(axis ? axis : c->joint[k].axis, c->joint[k].axis, side);
        if (vector3_length(side) > PARALLEL) {
            return 0.0;
        }
        axis = c->joint[k].axis;
    }
    flange_of(m, pose, &flange);
    for (int i = 0; i < 3; i++) { /* what the flange keeps: the axis, or if none turns it, all */
        const double *kept = axis ? axis : UNIT[i];
        vector3_back(c->flange.turn, kept, at_zero);
        vector3_by((const double(*)[3])flange.turn, at_zero, turned);
        vector3_cross(kept, turned, side);
        most = el_max(most, el_atan2(vector3_length(side), vector3_dot(kept, turned)));
    }
    return most;
}

static uint32_t branches(const struct manipulator *m, const struct pose *pose,
                         const double near[OPW_JOINTS], uint32_t wanted,
                         double all[OPW_BRANCHES][OPW_JOINTS])
{
    struct opw_pose flange;

    flange_of(m, pose, &flange);
    return manipulator_branches(m, &flange, near, wanted, all);
}

bool manipulator_joints(const struct manipulator *m, const struct pose *pose,
                        double joint[OPW_JOINTS])
{
    double all[OPW_BRANCHES][OPW_JOINTS], found[OPW_JOINTS];
    const uint32_t there = branches(m, pose, joint, same_elbow(m, joint), all);

    if (manipulator_nearest(m, there, (const double(*)[OPW_JOINTS])all, joint, ANY_LOW, ANY_HIGH,
                            found)
        < 0) {
        return false;
    }
    memcpy(joint, found, sizeof found);
    return true;
}

enum manipulator_status manipulator_solve(const struct manipulator *m, const struct pose *pose,
                                          uint32_t wanted, const int *turn,
                                          double joint[OPW_JOINTS], int *which)
{
    double all[OPW_BRANCHES][OPW_JOINTS], low[OPW_JOINTS], high[OPW_JOINTS], found[OPW_JOINTS];
    double near[OPW_JOINTS];
    uint32_t there = branches(m, pose, joint, wanted, all);

    for (int i = 0; i < OPW_JOINTS; i++) {
        const bool told = turn && turn[i] != MANIPULATOR_ANY_TURN && !manipulator_slides(m, i);
        near[i] = told ? TURN * turn[i] : joint[i];
        low[i] = el_min(m->joint[i].low, joint[i]);
        high[i] = el_max(m->joint[i].high, joint[i]);
        for (int n = 0; n < OPW_BRANCHES && told; n++) { /* within half a turn of them */
            all[n][i] += TURN * round((near[i] - all[n][i]) / TURN);
            there &=
                all[n][i] > high[i] + ROUNDING || all[n][i] < low[i] - ROUNDING ? ~(1u << n) : ~0u;
        }
        low[i] = told ? ANY_LOW[i] : low[i];
        high[i] = told ? ANY_HIGH[i] : high[i];
    }
    if (manipulator_nearest(m, there, (const double(*)[OPW_JOINTS])all, near, low, high, found)
        >= 0) {
        memcpy(joint, found, sizeof found);
        return MANIPULATOR_OK;
    }
    there = branches(m, pose, joint, wanted, all);
    if (manipulator_nearest(m, there, (const double(*)[OPW_JOINTS])all, near, ANY_LOW, ANY_HIGH,
                            found)
        < 0) {
        return MANIPULATOR_FAR;
    }
    *which = manipulator_outside(m, joint, found);
    memcpy(joint, found, sizeof found);
    return MANIPULATOR_OUTSIDE;
}

/* The tip belongs to the forearm while joints 4 to 6 stand: an arm of three joints with lengths of
 * its own, whose end is the wrist centre of an opw without a hand. */
bool manipulator_arm(const struct manipulator *m, const double at[3], double joint[OPW_JOINTS])
{
    static const double upright[3][3] = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    double all[OPW_BRANCHES][OPW_JOINTS], zero[OPW_JOINTS], found[OPW_JOINTS];
    struct manipulator forearm = { .opw = m->opw };
    struct opw o = m->opw;
    struct opw_pose tip, wrist;

    if (m->by_axes) {
        return false;
    }

    /* The tip from the wrist centre in the forearm's frame: forward with joints 1 to 3 of the inner
     * zero and no lengths. */
    o.a1 = o.a2 = o.b = o.c1 = o.c2 = o.c3 = 0.0;
    memcpy(zero, joint, sizeof zero);
    for (int i = 0; i < 3; i++) {
        zero[i] = o.sign[i] * o.offset[i];
    }
    opw_forward(&o, zero, &wrist);
    double v[3];
    for (int i = 0; i < 3; i++) {
        const double *r = wrist.turn[i], *t = m->tool.at;
        v[i] = wrist.at[i] + MM * (r[0] * t[0] + r[1] * t[1] + r[2] * t[2]);
        tip.at[i] = MM * at[i];
    }
    o = m->opw;
    o.a2 += v[0];
    o.b += v[1];
    o.c3 += v[2];
    o.c4 = 0.0;
    memcpy(tip.turn, upright, sizeof upright);
    forearm.opw = o;
    const uint32_t there = opw_inverse_of(&o, &tip, joint, same_elbow(&forearm, joint), all);
    for (int n = 0; n < OPW_BRANCHES; n++) {
        memcpy(&all[n][3], &joint[3], 3 * sizeof joint[0]);
    }
    if (opw_nearest(there, (const double(*)[OPW_JOINTS])all, joint, ANY_LOW, ANY_HIGH, found) < 0) {
        return false;
    }
    memcpy(joint, found, 3 * sizeof joint[0]);
    return true;
}

static void jacobian_by_axes(const struct manipulator *m, const double joint[OPW_JOINTS],
                             const struct pose *tip, double column[OPW_JOINTS][6])
{
    struct chain_axes axes;
    struct chain_pose end;
    double q[CHAIN_JOINTS];
    const double at[3] = { MM * tip->at[0], MM * tip->at[1], MM * tip->at[2] };

    whole(joint, q);
    chain_axes_at(&m->axes.chain, q, &axes, &end);
    memset(column, 0, OPW_JOINTS * sizeof *column);
    for (int i = 0; i < m->axes.chain.joints; i++) {
        chain_column(&m->axes.chain, &axes, i, at, column[i]);
        for (int k = 0; k < 3; k++) {
            column[i][k] /= MM;
        }
    }
}

void manipulator_jacobian(const struct manipulator *m, const double joint[OPW_JOINTS],
                          double column[OPW_JOINTS][6])
{
    const struct opw *o = &m->opw;
    double th[OPW_JOINTS], axis[OPW_JOINTS][3], origin[OPW_JOINTS][3];
    const struct pose tip = manipulator_pose(m, joint), flange = flange_pose(m, joint);

    if (m->by_axes) {
        jacobian_by_axes(m, joint, &tip, column);
        return;
    }

    for (int i = 0; i < OPW_JOINTS; i++) {
        th[i] = o->sign[i] * joint[i] - o->offset[i];
    }
    const struct el_turn base = el_sincos(th[0]), lower = el_sincos(th[1]);
    const struct el_turn fore = el_sincos(th[1] + th[2]), roll = el_sincos(th[3]);
    const double c = base.cosine, s = base.sine, cp = fore.cosine, sp = fore.sine;
    const double c4 = roll.cosine, s4 = roll.sine;
    const double x2 = o->a1 + o->c2 * lower.sine, z2 = o->c1 + o->c2 * lower.cosine;
    double hand[3];
    quaternion_turn(flange.turn, (const double[]){ 0.0, 0.0, 1.0 }, hand);
    for (int k = 0; k < 3; k++) {
        const double side[3] = { -s, c, 0.0 }, out[3] = { c, s, 0.0 }, up[3] = { 0.0, 0.0, 1.0 };
        const double fore_x = cp * out[k] - sp * up[k];
        axis[0][k] = up[k];
        axis[1][k] = axis[2][k] = side[k];
        axis[3][k] = sp * out[k] + cp * up[k];
        axis[4][k] = -s4 * fore_x + c4 * side[k];
        axis[5][k] = hand[k];
        origin[0][k] = 0.0;
        origin[1][k] = (o->a1 * out[k] + o->c1 * up[k]) / MM;
        origin[2][k] = (x2 * out[k] + z2 * up[k]) / MM;
        origin[3][k] = origin[4][k] = origin[5][k] = flange.at[k] - o->c4 / MM * hand[k];
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        for (int k = 0; k < 3; k++) {
            const int a = (k + 1) % 3, b = (k + 2) % 3;
            column[i][k] = o->sign[i]
                           * (axis[i][a] * (tip.at[b] - origin[i][b])
                              - axis[i][b] * (tip.at[a] - origin[i][a]));
            column[i][k + 3] = o->sign[i] * axis[i][k];
        }
    }
}

bool manipulator_rates(const struct manipulator *m, const double joint[OPW_JOINTS],
                       const double motion[6], double rate[OPW_JOINTS])
{
    double column[OPW_JOINTS][6], a[6][OPW_JOINTS + 1];
    const int joints = manipulator_joints_of(m);

    manipulator_jacobian(m, joint, column);
    for (int i = 0; i < 6; i++) {
        /* [m] and [rad]: of one size */
        const double unit = i < 3 ? MM : 1.0;
        for (int k = 0; k < joints; k++) {
            a[i][k] = unit * column[k][i];
        }
        a[i][joints] = unit * motion[i];
    }
    for (int n = 0; n < joints; n++) {
        int best = n;
        for (int i = n + 1; i < 6; i++) {
            best = fabs(a[i][n]) > fabs(a[best][n]) ? i : best;
        }
        if (fabs(a[best][n]) < PIVOT) {
            return false;
        }
        for (int k = n; k <= joints; k++) {
            const double x = a[n][k];
            a[n][k] = a[best][k];
            a[best][k] = x;
        }
        for (int i = n + 1; i < 6; i++) {
            const double f = a[i][n] / a[n][n];
            for (int k = n; k <= joints; k++) {
                a[i][k] -= f * a[n][k];
            }
        }
    }
    memset(rate, 0, OPW_JOINTS * sizeof *rate);
    for (int n = joints - 1; n >= 0; n--) {
        rate[n] = a[n][joints];
        for (int k = n + 1; k < joints; k++) {
            rate[n] -= a[n][k] * rate[k];
        }
        rate[n] /= a[n][n];
    }
    return true;
}

int manipulator_outside(const struct manipulator *m, const double from[OPW_JOINTS],
                        const double joint[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        const struct manipulator_joint *j = &m->joint[i];
        if (joint[i] > el_max(j->high, from[i]) + ROUNDING
            || joint[i] < el_min(j->low, from[i]) - ROUNDING) {
            return i;
        }
    }
    return -1;
}

int manipulator_factor(const struct manipulator *m, const double joint[OPW_JOINTS], double *value)
{
    double factor[3];
    int least = 0;

    manipulator_factors(m, joint, factor);
    const double arm = m->by_axes ? m->axes.size : m->opw.c2 + m->opw.c3;
    for (int i = 1; i < 3; i++) {
        const double other = least == 0 ? fabs(factor[0]) / arm : fabs(factor[least]);
        least = fabs(factor[i]) < other ? i : least;
    }
    *value = factor[least];
    return least;
}
