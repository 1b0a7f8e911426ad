#include "opw.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

static const double TURN = 6.283185307179586; /* [rad] 2 pi */

/* So much may a cosine exceed 1 by rounding at the edge of reach. */
static const double EDGE = 1e-12;

/* Sine of joint 5 below which axes 4 and 6 are in line: rounding decides what is left. */
static const double IN_LINE = 1e-9;

/* Inner angles th of the maker's joints: sign * joint - offset. [rad] */
static void inner(const struct opw *o, const double joint[OPW_JOINTS], double th[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        th[i] = o->sign[i] * joint[i] - o->offset[i];
    }
}

/* Rz(a) Ry(p), whose columns are the axes of the forearm's frame in the base frame. */
static void forearm(double a, double p, double m[3][3])
{
    const struct el_turn ta = el_sincos(a), tp = el_sincos(p);
    const double ca = ta.cosine, sa = ta.sine, cp = tp.cosine, sp = tp.sine;
    const double turn[3][3] = { { ca * cp, -sa, ca * sp },
                                { sa * cp, ca, sa * sp },
                                { -sp, 0.0, cp } };
    memcpy(m, turn, sizeof turn);
}

static void product(const double a[3][3], const double b[3][3], double c[3][3])
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            c[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k];
        }
    }
}

/* Rotation of the wrist: Rz(th4) Ry(th5) Rz(th6). */
static void wrist(const double th[OPW_JOINTS], double m[3][3])
{
    const struct el_turn t = el_sincos(th[5]);
    const double last[3][3] = { { t.cosine, -t.sine, 0.0 },
                                { t.sine, t.cosine, 0.0 },
                                { 0.0, 0.0, 1.0 } };
    double first[3][3];
    forearm(th[3], th[4], first);
    product((const double(*)[3])first, last, m);
}

/* Wrist centre in the plane of the arm: x from axis 1, z above axis 2. [m] With k the distance from
 * elbow to wrist centre, `lean` its angle from the forearm's axis and p that from upright:
 *     x = a1 + c2 sin th2 + k sin p     z = c2 cos th2 + k cos p */
static void centre(const struct opw *o, const double th[OPW_JOINTS], double lean, double *x,
                   double *z)
{
    const double k = el_hypot(o->a2, o->c3), p = th[1] + th[2] + lean;
    const struct el_turn lower = el_sincos(th[1]), upper = el_sincos(p);
    *x = o->c2 * lower.sine + k * upper.sine + o->a1;
    *z = o->c2 * lower.cosine + k * upper.cosine;
}

void opw_forward(const struct opw *o, const double joint[OPW_JOINTS], struct opw_pose *pose)
{
    double th[OPW_JOINTS], arm[3][3], hand[3][3], x, z;

    inner(o, joint, th);
    forearm(th[0], th[1] + th[2], arm);
    wrist(th, hand);
    product((const double(*)[3])arm, (const double(*)[3])hand, pose->turn);
    centre(o, th, el_atan2(o->a2, o->c3), &x, &z);
    const struct el_turn base = el_sincos(th[0]);
    const double c = base.cosine, s = base.sine;
    pose->at[0] = x * c - o->b * s + o->c4 * pose->turn[0][2];
    pose->at[1] = x * s + o->b * c + o->c4 * pose->turn[1][2];
    pose->at[2] = z + o->c1 + o->c4 * pose->turn[2][2];
}

/* acos of a cosine that may exceed 1 by rounding; false if it exceeds it further or is NaN. */
static bool angle(double cosine, double *a)
{
    *a = el_acos(el_max(-1.0, el_min(1.0, cosine)));
    return fabs(cosine) <= 1.0 + EDGE;
}

/* Both solutions th4 .. th6 for the rotation w of the wrist; the second has it flipped. Where axes
 * 4 and 6 are in line th4 stays `near`, and both are the same. */
static void solve_wrist(const double w[3][3], double near, double th[2][OPW_JOINTS])
{
    const double sine = sqrt(w[0][2] * w[0][2] + w[1][2] * w[1][2]);
    double first = el_atan2(w[1][2], w[0][2]), last = el_atan2(w[2][1], -w[2][0]);

    if (sine < IN_LINE) {
        first = near;
        last =
            w[2][2] > 0.0 ? el_atan2(w[1][0], w[0][0]) - near : near - el_atan2(-w[0][1], -w[0][0]);
    }
    th[0][3] = first;
    th[0][4] = el_atan2(sine, w[2][2]);
    th[0][5] = last;
    th[1][3] = sine < IN_LINE ? first : first + 0.5 * TURN;
    th[1][4] = sine < IN_LINE ? th[0][4] : -th[0][4];
    th[1][5] = sine < IN_LINE ? last : last - 0.5 * TURN;
}

/* The maker's joints for inner angles, each within half a turn of 0. [rad] */
static void outer(const struct opw *o, const double th[OPW_JOINTS], double joint[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        double q = o->sign[i] * (th[i] + o->offset[i]);
        if (fabs(q) > 0.5 * TURN) {
            q -= TURN * round(q / TURN);
        }
        joint[i] = q;
    }
}

uint32_t opw_inverse_of(const struct opw *o, const struct opw_pose *pose,
                        const double near[OPW_JOINTS], uint32_t wanted,
                        double joint[OPW_BRANCHES][OPW_JOINTS])
{
    const double x = pose->at[0] - o->c4 * pose->turn[0][2];
    const double y = pose->at[1] - o->c4 * pose->turn[1][2];
    const double z = pose->at[2] - o->c4 * pose->turn[2][2] - o->c1;
    const double reach = x * x + y * y - o->b * o->b;
    const double k2 = o->a2 * o->a2 + o->c3 * o->c3, k = sqrt(k2), psi = el_atan2(o->a2, o->c3);
    double known[OPW_JOINTS];
    uint32_t there = 0;

    if (reach < 0.0) {
        return 0; /* the wrist centre is nearer to axis 1 than the lateral offset b */
    }
    inner(o, near, known);
    const double out = sqrt(reach), aside = el_atan2(o->b, out), way = el_atan2(y, x);
    for (int shoulder = 0; shoulder <= OPW_BACK; shoulder += OPW_BACK) {
        const double n = (shoulder ? -out : out) - o->a1; /* [m] of the wrist centre from axis 2 */
        const double s2 = n * n + z * z, s = sqrt(s2);
        double th[2][OPW_JOINTS], seen[3][3], at2, at3;
        if (!angle((s2 + o->c2 * o->c2 - k2) / (2.0 * s * o->c2), &at2)
            || !angle((s2 - o->c2 * o->c2 - k2) / (2.0 * o->c2 * k), &at3)) {
            continue;
        }
        const double first = shoulder ? way + aside - 0.5 * TURN : way - aside;
        const struct el_turn base = el_sincos(first);
        const double c = base.cosine, d = base.sine, up = el_atan2(n, z);
        for (int i = 0; i < 3; i++) { /* the orientation, seen from the arm's plane */
            seen[0][i] = c * pose->turn[0][i] + d * pose->turn[1][i];
            seen[1][i] = c * pose->turn[1][i] - d * pose->turn[0][i];
            seen[2][i] = pose->turn[2][i];
        }
        for (int elbow = 0; elbow <= OPW_ELBOW; elbow += OPW_ELBOW) {
            const int branch = shoulder + elbow;
            double w[3][3];
            if (!(wanted >> branch & 3)) {
                continue;
            }
            th[0][0] = th[1][0] = first;
            th[0][1] = th[1][1] = up + (elbow ? at2 : -at2);
            th[0][2] = th[1][2] = (elbow ? -at3 : at3) - psi;
            const struct el_turn fore = el_sincos(th[0][1] + th[0][2]);
            const double cp = fore.cosine, sp = fore.sine;
            for (int i = 0; i < 3; i++) {
                w[0][i] = cp * seen[0][i] - sp * seen[2][i];
                w[1][i] = seen[1][i];
                w[2][i] = sp * seen[0][i] + cp * seen[2][i];
            }
            solve_wrist((const double(*)[3])w, known[3], th);
            outer(o, th[0], joint[branch]);
            outer(o, th[1], joint[branch + OPW_FLIP]);
            there |= 3u << branch;
        }
    }
    return there & wanted;
}

uint32_t opw_inverse(const struct opw *o, const struct opw_pose *pose,
                     const double near[OPW_JOINTS], double joint[OPW_BRANCHES][OPW_JOINTS])
{
    return opw_inverse_of(o, pose, near, 0xff, joint);
}

int opw_nearest(uint32_t branches, const double all[OPW_BRANCHES][OPW_JOINTS],
                const double near[OPW_JOINTS], const double low[OPW_JOINTS],
                const double high[OPW_JOINTS], double joint[OPW_JOINTS])
{
    double least = INFINITY;
    int best = -1;

    for (int n = 0; n < OPW_BRANCHES; n++) {
        double q[OPW_JOINTS], most = 0.0;
        bool within = branches >> n & 1;
        for (int i = 0; i < OPW_JOINTS && within && most < least; i++) {
            double turns = round((near[i] - all[n][i]) / TURN);
            const double up = ceil((low[i] - all[n][i]) / TURN);
            const double down = floor((high[i] - all[n][i]) / TURN);
            within = up <= down;
            turns = el_max(up, el_min(down, turns));
            q[i] = all[n][i] + TURN * turns;
            most = el_max(most, fabs(q[i] - near[i]));
        }
        if (within && most < least) {
            least = most;
            best = n;
            memcpy(joint, q, sizeof q);
        }
    }
    return best;
}

double opw_elbow(const struct opw *o, const double joint[OPW_JOINTS])
{
    return el_sin(o->sign[2] * joint[2] - o->offset[2] + el_atan2(o->a2, o->c3));
}

int opw_factors(const struct opw *o, const double joint[OPW_JOINTS], double factor[3])
{
    const double lean = el_atan2(o->a2, o->c3);
    double th[OPW_JOINTS], z;

    inner(o, joint, th);
    centre(o, th, lean, &factor[0], &z);
    factor[1] = el_sin(th[2] + lean);
    factor[2] = el_sin(th[4]);
    return (factor[0] < 0.0 ? OPW_BACK : 0) | (factor[1] < 0.0 ? OPW_ELBOW : 0)
           | (factor[2] < 0.0 ? OPW_FLIP : 0);
}

int opw_branch(const struct opw *o, const double joint[OPW_JOINTS])
{
    double factor[3];

    return opw_factors(o, joint, factor);
}
