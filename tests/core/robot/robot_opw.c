/* Kinematics of a robot with a spherical wrist: against a chain of its links, and in circles. */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "opw.h"

static const double DEGREE = 0.017453292519943295;

/* ABB IRB 2600-12/1.65 and KUKA KR 6 R700, as opw_kinematics has them; and one with a lateral
 * offset. */
static const struct opw IRB = { 0.150,
                                -0.115,
                                0.0,
                                0.445,
                                0.700,
                                0.795,
                                0.085,
                                { 0, 0, -1.5707963267948966 },
                                { 1, 1, 1, 1, 1, 1 } };
static const struct opw KUKA = { 0.025,
                                 -0.035,
                                 0.0,
                                 0.400,
                                 0.315,
                                 0.365,
                                 0.080,
                                 { 0, -1.5707963267948966 },
                                 { -1, 1, 1, -1, 1, -1 } };
static const struct opw LATERAL = { 0.10,
                                    0.05,
                                    0.035,
                                    0.30,
                                    0.40,
                                    0.35,
                                    0.06,
                                    { 0.1, 0.2, 0.3, 0.4, 0.5, 0.6 },
                                    { 1, -1, 1, -1, 1, -1 } };
static const struct opw *const ALL[] = { &IRB, &KUKA, &LATERAL };
static uint64_t seed = 5;

static void anywhere(double q[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        q[i] = check_real(&seed, -3.1, 3.1);
    }
}

/* Farthest that a number of two poses differs. [m], 1 */
static double between(const struct opw_pose *a, const struct opw_pose *b)
{
    double most = 0.0;
    for (int i = 0; i < 3; i++) {
        most = fmax(most, fabs(a->at[i] - b->at[i]));
        for (int k = 0; k < 3; k++) {
            most = fmax(most, fabs(a->turn[i][k] - b->turn[i][k]));
        }
    }
    return most;
}

/* A vector turned about x, y or z. */
static void turned(int axis, double angle, double v[3])
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    const double c = cos(angle), s = sin(angle), x = v[a], y = v[b];
    v[a] = c * x - s * y;
    v[b] = s * x + c * y;
}

/* The origins and axes of the public URDF of the IRB 2600, from the flange inwards. */
static void links(void)
{
    static const double origin[OPW_JOINTS][3] = {
        { 0, 0, 0.445 }, { 0.15, 0, 0 },  { 0, 0, 0.7 },
        { 0, 0, 0.115 }, { 0.795, 0, 0 }, { 0.085, 0, 0 }
    };
    static const int axis[OPW_JOINTS] = { 2, 1, 1, 0, 1, 0 };
    /* Its last frame has x along the tool, z up at zero. */
    static const double along[4][3] = { { 0, 0, 0 }, { 0, 0, -1 }, { 0, 1, 0 }, { 1, 0, 0 } };
    for (int n = 0; n < 1000; n++) {
        struct opw_pose pose, want;
        double q[OPW_JOINTS], v[4][3];
        anywhere(q);
        opw_forward(&IRB, q, &pose);
        memcpy(v, along, sizeof v);
        for (int k = 0; k < 4; k++) {
            for (int i = OPW_JOINTS - 1; i >= 0; i--) {
                turned(axis[i], q[i], v[k]);
                for (int c = 0; c < 3 && k == 0; c++) {
                    v[k][c] += origin[i][c];
                }
            }
        }
        memcpy(want.at, v[0], sizeof want.at);
        for (int i = 0; i < 3; i++) {
            for (int k = 0; k < 3; k++) {
                want.turn[i][k] = v[k + 1][i];
            }
        }
        CHECK(between(&pose, &want) < 1e-12);
    }
}

/* Every branch leads to the pose; the joints it was made of are among them, under their flags. */
static void circles(const struct opw *o)
{
    int64_t found = 0;
    enum { POSES = 20000 };
    for (int n = 0; n < POSES; n++) {
        double q[OPW_JOINTS], all[OPW_BRANCHES][OPW_JOINTS], factor[3];
        struct opw_pose pose, again;
        anywhere(q);
        opw_forward(o, q, &pose);
        const uint32_t there = opw_inverse(o, &pose, q, all);
        opw_factors(o, q, factor);
        const bool close =
            fabs(factor[0]) < 1e-3 || fabs(factor[1]) < 1e-3 || fabs(factor[2]) < 1e-3;
        for (int k = 0; k < OPW_BRANCHES; k++) {
            if (there >> k & 1) {
                opw_forward(o, all[k], &again);
                CHECK(between(&pose, &again) < 1e-12 || close);
                CHECK(between(&pose, &again) < 1e-9);
                CHECK(opw_branch(o, all[k]) == k || close);
                for (int i = 0; i < OPW_JOINTS; i++) {
                    CHECK(fabs(all[k][i]) <= 180.0 * DEGREE + 1e-12);
                }
                found++;
            }
        }
        const int own = opw_branch(o, q);
        CHECK(there >> own & 1 || close);
        for (int i = 0; i < OPW_JOINTS && (there >> own & 1) && !close; i++) {
            CHECK(fabs(remainder(all[own][i] - q[i], 360.0 * DEGREE)) < 1e-9);
        }
    }
    CHECK(found > 5 * POSES && found < 8 * POSES);
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) {
        c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static double determinant(double m[6][6])
{
    double det = 1.0;
    for (int i = 0; i < 6; i++) {
        int p = i;
        for (int k = i + 1; k < 6; k++) {
            p = fabs(m[k][i]) > fabs(m[p][i]) ? k : p;
        }
        for (int c = 0; c < 6; c++) {
            const double x = m[i][c];
            m[i][c] = m[p][c];
            m[p][c] = x;
        }
        det *= p == i ? m[i][i] : -m[i][i];
        for (int k = i + 1; k < 6; k++) {
            const double f = m[k][i] / m[i][i];
            for (int c = i; c < 6; c++) {
                m[k][c] -= f * m[i][c];
            }
        }
    }
    return det;
}

/* The product of the factors is the determinant of velocities found by differences. */
static void factors(const struct opw *o)
{
    const double h = 1e-6;
    for (int n = 0; n < 500; n++) {
        double q[OPW_JOINTS], m[6][6], factor[3];
        anywhere(q);
        for (int j = 0; j < OPW_JOINTS; j++) {
            struct opw_pose up, down;
            double omega[3] = { 0.0 };
            q[j] += h;
            opw_forward(o, q, &up);
            q[j] -= 2.0 * h;
            opw_forward(o, q, &down);
            q[j] += h;
            for (int c = 0; c < 3; c++) { /* omega = sum of axes x their rates / 2 */
                double a[3], rate[3], part[3];
                for (int i = 0; i < 3; i++) {
                    a[i] = 0.5 * (up.turn[i][c] + down.turn[i][c]);
                    rate[i] = (up.turn[i][c] - down.turn[i][c]) / (2.0 * h);
                }
                cross(a, rate, part);
                for (int i = 0; i < 3; i++) {
                    omega[i] += 0.5 * part[i];
                }
            }
            for (int i = 0; i < 3; i++) {
                m[i][j] = (up.at[i] - down.at[i]) / (2.0 * h);
                m[i + 3][j] = omega[i];
            }
        }
        opw_factors(o, q, factor);
        const double want = o->c2 * hypot(o->a2, o->c3) * factor[0] * factor[1] * factor[2];
        CHECK(fabs(fabs(determinant(m)) - fabs(want)) < 1e-8);
    }
}

/* Axes 4 and 6 in line: joint 4 stays, the pose is kept, straight and folded back. */
static void in_line(void)
{
    for (int n = 0; n < 1000; n++) {
        for (int k = 0; k < 3; k++) {
            double q[OPW_JOINTS], all[OPW_BRANCHES][OPW_JOINTS];
            struct opw_pose pose, again;
            anywhere(q);
            q[4] = ALL[k]->sign[4] * ALL[k]->offset[4] + (n % 2 ? 180.0 * DEGREE : 0.0);
            opw_forward(ALL[k], q, &pose);
            const uint32_t there = opw_inverse(ALL[k], &pose, q, all);
            const int own = opw_branch(ALL[k], q) & ~OPW_FLIP;
            CHECK(there >> own & 1);
            CHECK(fabs(remainder(all[own][3] - q[3], 360.0 * DEGREE)) < 1e-12);
            opw_forward(ALL[k], all[own], &again);
            CHECK(between(&pose, &again) < 1e-9);
        }
    }
}

/* At the edge of reach there is a solution, a micrometre beyond none; none on axis 1 with b. */
static void reach(void)
{
    const double zero[OPW_JOINTS] = { 0.0 };
    double all[OPW_BRANCHES][OPW_JOINTS];
    for (int n = 0; n < 1000; n++) {
        const double most = IRB.c2 + hypot(IRB.a2, IRB.c3), a = check_real(&seed, 0.0, 1.5);
        struct opw_pose pose = { .turn = { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
        const double r = n % 2 ? most - 1e-6 : most + 1e-6;
        pose.at[0] = IRB.a1 + r * cos(a);
        pose.at[2] = IRB.c1 + IRB.c4 + r * sin(a);
        const uint32_t there = opw_inverse(&IRB, &pose, zero, all);
        CHECK((there & 0x0f) == (n % 2 ? 0x0fu : 0u));
    }
    const struct opw_pose inside = { { 0.02, 0.02, 0.5 },
                                     { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    CHECK_EQ(opw_inverse(&LATERAL, &inside, zero, all), 0);
}

/* Nearest in the joint that differs most, by whole turns, within limits: all turns are tried. */
static void nearest(void)
{
    for (int n = 0; n < 5000; n++) {
        double q[OPW_JOINTS], near[OPW_JOINTS], low[OPW_JOINTS], high[OPW_JOINTS];
        double all[OPW_BRANCHES][OPW_JOINTS], got[OPW_JOINTS], least = INFINITY;
        struct opw_pose pose;
        anywhere(q);
        for (int i = 0; i < OPW_JOINTS; i++) {
            near[i] = check_real(&seed, -6.0, 6.0);
            low[i] = check_real(&seed, -8.0, -1.0);
            high[i] = check_real(&seed, 1.0, 8.0);
        }
        opw_forward(&IRB, q, &pose);
        const uint32_t there = opw_inverse(&IRB, &pose, near, all);
        for (int k = 0; k < OPW_BRANCHES; k++) {
            double most = there >> k & 1 ? 0.0 : INFINITY;
            for (int i = 0; i < OPW_JOINTS; i++) {
                double best = INFINITY;
                for (int t = -3; t <= 3; t++) {
                    const double x = all[k][i] + 360.0 * DEGREE * t;
                    best = x >= low[i] && x <= high[i] ? fmin(best, fabs(x - near[i])) : best;
                }
                most = fmax(most, best);
            }
            least = fmin(least, most);
        }
        const int branch =
            opw_nearest(there, (const double(*)[OPW_JOINTS])all, near, low, high, got);
        CHECK((branch >= 0) == isfinite(least));
        double most = 0.0;
        for (int i = 0; i < OPW_JOINTS && branch >= 0; i++) {
            CHECK(got[i] >= low[i] && got[i] <= high[i]);
            CHECK(fabs(remainder(got[i] - all[branch][i], 360.0 * DEGREE)) < 1e-12);
            most = fmax(most, fabs(got[i] - near[i]));
        }
        CHECK(branch < 0 || fabs(most - least) < 1e-12);
    }
}

int main(void)
{
    links();
    for (int k = 0; k < 3; k++) {
        circles(ALL[k]);
        factors(ALL[k]);
    }
    in_line();
    reach();
    nearest();
    return check_result();
}
