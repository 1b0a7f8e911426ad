/* Closed forms: each arm's kind, all its branches, their flags, factors, singular places. */
#include "chain_rig.h"

static uint64_t seed = 11;

/* Each kind is recognised; every branch leads to the pose; the joints it was made of are among
 * them, under their flags. */
static void circles(const struct rig *r)
{
    const struct chain_form f = rig_form(r);
    int64_t found = 0;
    enum { POSES = 2000 };

    CHECK(chain_good(&f.chain));
    CHECK_EQ(f.kind, r->kind);
    CHECK_EQ(f.reversed, r->reversed);
    if (f.kind == CHAIN_ITERATED) {
        return;
    }
    CHECK(f.deviation < CHAIN_EXACT);
    for (int n = 0; n < POSES; n++) {
        double q[CHAIN_JOINTS], all[CHAIN_BRANCHES][CHAIN_JOINTS], factor[3];
        struct chain_pose pose, again;
        rig_anywhere(&f.chain, &seed, q);
        chain_forward(&f.chain, q, &pose);
        const uint32_t there = chain_inverse(&f, &pose, q, 0xff, all);
        chain_factors(&f, q, factor);
        const bool close =
            fabs(factor[0]) < 1e-2 || fabs(factor[1]) < 1e-2 || fabs(factor[2]) < 1e-2;
        for (int k = 0; k < CHAIN_BRANCHES; k++) {
            if (there >> k & 1) {
                CHECK((k & ~(int)f.flags) == 0);
                chain_forward(&f.chain, all[k], &again);
                CHECK(rig_between(&pose, &again) < 1e-9);
                chain_factors(&f, all[k], factor);
                CHECK(chain_branch(&f, all[k]) == k || fabs(factor[0]) < 1e-6
                      || fabs(factor[1]) < 1e-6 || fabs(factor[2]) < 1e-6);
                for (int i = 0; i < f.chain.joints; i++) {
                    CHECK(f.chain.joint[i].slides || fabs(all[k][i]) <= 3.141592653589794);
                }
                found++;
            }
        }
        const int own = chain_branch(&f, q);
        CHECK(there >> own & 1 || close);
        CHECK(close || rig_apart(&f.chain, all[own], q) < 1e-9);
        CHECK_EQ(chain_inverse(&f, &pose, q, 1u << own, all), there & 1u << own);
    }
    CHECK(found > POSES);
}

/* |determinant| by elimination. */
static double determinant(double m[CHAIN_JOINTS][6])
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
        det *= m[i][i];
        for (int k = i + 1; k < 6; k++) {
            const double by = m[k][i] / m[i][i];
            for (int c = i; c < 6; c++) {
                m[k][c] -= by * m[i][c];
            }
        }
    }
    return fabs(det);
}

/* The determinant of the flange's velocities is the product of the factors times lengths of the
 * arm, so it is 0 just where a factor is. */
static void factors(const struct rig *r, double lengths)
{
    const struct chain_form f = rig_form(r);

    for (int n = 0; n < 500; n++) {
        double q[CHAIN_JOINTS], column[CHAIN_JOINTS][6], factor[3];
        struct chain_pose pose;
        rig_anywhere(&f.chain, &seed, q);
        chain_factors(&f, q, factor);
        chain_jacobian(&f.chain, q, &pose, column);
        CHECK_NEAR(determinant(column), fabs(lengths * factor[0] * factor[1] * factor[2]), 1e-12);
    }
}

/* The Jacobian is what differences of poses say. */
static void jacobian(const struct rig *r)
{
    const struct chain c = rig_chain(r);
    const double h = 1e-6;

    for (int n = 0; n < 50; n++) {
        double q[CHAIN_JOINTS], column[CHAIN_JOINTS][6];
        struct chain_pose pose, up, down;
        rig_anywhere(&c, &seed, q);
        chain_jacobian(&c, q, &pose, column);
        for (int j = 0; j < c.joints; j++) {
            double omega[3] = { 0.0 };
            q[j] += h;
            chain_forward(&c, q, &up);
            q[j] -= 2.0 * h;
            chain_forward(&c, q, &down);
            q[j] += h;
            for (int k = 0; k < 3; k++) { /* omega = sum of axes x their rates / 2 */
                for (int i = 0; i < 3; i++) {
                    const int a = (i + 1) % 3, b = (i + 2) % 3;
                    const double rate_b = (up.turn[b][k] - down.turn[b][k]) / (2.0 * h);
                    const double rate_a = (up.turn[a][k] - down.turn[a][k]) / (2.0 * h);
                    omega[i] += 0.5 * (pose.turn[a][k] * rate_b - pose.turn[b][k] * rate_a);
                }
            }
            for (int i = 0; i < 3; i++) {
                CHECK_NEAR(column[j][i], (up.at[i] - down.at[i]) / (2.0 * h), 1e-8);
                CHECK_NEAR(column[j][i + 3], omega[i], 1e-8);
            }
        }
    }
}

/* Where joint `middle` is at an angle two axes are in line: joint `kept` stays, so does the
 * pose. */
static void in_line(const struct rig *r, int middle, double angle, int kept)
{
    const struct chain_form f = rig_form(r);

    for (int n = 0; n < 300; n++) {
        double q[CHAIN_JOINTS], all[CHAIN_BRANCHES][CHAIN_JOINTS];
        struct chain_pose pose, again;
        rig_anywhere(&f.chain, &seed, q);
        q[middle] = angle;
        chain_forward(&f.chain, q, &pose);
        const uint32_t there = chain_inverse(&f, &pose, q, 0xff, all);
        double least = INFINITY;
        for (int k = 0; k < CHAIN_BRANCHES; k++) {
            if (there >> k & 1) {
                chain_forward(&f.chain, all[k], &again);
                CHECK(rig_between(&pose, &again) < 1e-8);
                least = fmin(least, rig_apart(&f.chain, all[k], q));
                CHECK(fabs(remainder(all[k][kept] - q[kept], 6.283185307179586)) < 1e-12
                      || rig_apart(&f.chain, all[k], q) > 1e-3);
            }
        }
        CHECK(least < 1e-6);
    }
}

/* Straight up the wrist of the IRB 2600 is 1.61 m above axis 2: there is a solution, and a
 * micrometre further none. */
static void edge(void)
{
    const struct chain_form f = rig_form(&RIGS[0]);
    double all[CHAIN_BRANCHES][CHAIN_JOINTS], zero[CHAIN_JOINTS] = { 0.0 };
    struct chain_pose pose;

    chain_forward(&f.chain, zero, &pose);
    const double reach = 0.7 + hypot(0.115, 0.795);
    for (int out = 0; out < 2; out++) {
        pose.at[0] = 0.15 + 0.085;
        pose.at[1] = 0.0;
        pose.at[2] = 0.445 + reach + (out ? 1e-6 : 0.0);
        const uint32_t there = chain_inverse(&f, &pose, zero, 0xff, all);
        CHECK_EQ(there != 0, out == 0);
    }
}

/* An arm whose axes miss its form by what calibration finds has branches that lead to its poses. */
static void calibrated(const struct rig *r, double by)
{
    struct chain c = rig_chain(r);
    struct chain_form f;
    int found = 0, all_of_them = 0;

    for (int i = 0; i < c.joints; i++) {
        for (int k = 0; k < 3; k++) {
            c.joint[i].origin[k] += check_real(&seed, -by, by);
            c.joint[i].axis[k] += check_real(&seed, -by, by);
        }
        const double *a = c.joint[i].axis, l = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        for (int k = 0; k < 3; k++) {
            c.joint[i].axis[k] /= l;
        }
    }
    chain_form_of(&c, r->held, &f);
    CHECK_EQ(f.kind, r->kind);
    CHECK(f.deviation > 0.1 * by);
    for (int n = 0; n < 300; n++) {
        double q[CHAIN_JOINTS], all[CHAIN_BRANCHES][CHAIN_JOINTS], factor[3], least = INFINITY;
        struct chain_pose pose, again;
        rig_anywhere(&c, &seed, q);
        chain_forward(&c, q, &pose);
        chain_factors(&f, q, factor);
        const uint32_t there = chain_inverse(&f, &pose, q, 0xff, all);
        for (int k = 0; k < CHAIN_BRANCHES; k++) {
            if (there >> k & 1) {
                chain_forward(&c, all[k], &again);
                CHECK(rig_between(&pose, &again) < 1e-11);
                least = fmin(least, rig_apart(&c, all[k], q));
            }
        }
        if (fabs(factor[0]) > 0.1 && fabs(factor[1]) > 0.1 && fabs(factor[2]) > 0.1) {
            all_of_them++;
            found += least < 1e-9;
        }
    }
    CHECK(all_of_them > 100);
    CHECK(found > 0.95 * all_of_them);
}

/* Kinova's Gen3 (maker's URDF), whose axes 5 and 7 miss each other by 0.35 mm. */
static const struct rig GEN3 = {
    "Gen3, joint 3 held",
    7,
    2,
    CHAIN_WRIST_SHOULDER,
    false,
    { { 0, 0, .15643 },
      { 0, -.005375, .12838 },
      { 0, -.006375, .21038 },
      { 0, -.006375, .21038 },
      { 0, -.006375, .20843 },
      { 0, -.00017505, .10593 },
      { 0, -.00017505, .10593 } },
    { { 0, 0, -1 }, Y, { 0, 0, -1 }, Y, { 0, 0, -1 }, Y, { 0, 0, -1 } },
    0,
    0,
    { 0, 0, .0615 },
    0
};

/* An arm that nearly has a form comes to the joints of a pose beside singular places, too, where
 * the branches of its form are too far away: from joints within `off` of them, or, of a `share`,
 * from any; the held joint is the one asked for. Each branch is the same asked for alone. */
static void nearly(const struct rig *r, double off, double share)
{
    const struct chain_form f = rig_form(r);
    int back = 0;
    enum { POSES = 2000 };

    CHECK_EQ(f.kind, r->kind);
    CHECK(f.deviation > CHAIN_EXACT);
    for (int n = 0; n < POSES; n++) {
        double q[CHAIN_JOINTS], near[CHAIN_JOINTS], all[CHAIN_BRANCHES][CHAIN_JOINTS];
        double alone[CHAIN_BRANCHES][CHAIN_JOINTS], least = INFINITY;
        struct chain_pose pose, again;
        rig_anywhere(&f.chain, &seed, q);
        chain_forward(&f.chain, q, &pose);
        for (int i = 0; i < CHAIN_JOINTS; i++) {
            near[i] = q[i] + (i == f.held ? 0.3 : check_real(&seed, -off, off));
        }
        const double held = q[f.held];
        const uint32_t there = chain_inverse_held(&f, &pose, near, held, 0xff, all);
        CHECK(there != 0 || off > 1.0);
        for (int k = 0; k < CHAIN_BRANCHES; k++) {
            CHECK_EQ(chain_inverse_held(&f, &pose, near, held, 1u << k, alone), there & 1u << k);
            if (there >> k & 1) {
                chain_forward(&f.chain, all[k], &again);
                CHECK(rig_between(&pose, &again) < 1e-11);
                CHECK(memcmp(alone[k], all[k], sizeof all[k]) == 0);
                CHECK_EQ(all[k][f.held], held);
                least = fmin(least, rig_apart(&f.chain, all[k], q));
            }
        }
        back += least < 1e-9;
    }
    CHECK(back >= share * POSES);
}

/* The arm angle is what was asked for, and turns the elbow while the flange stands. */
static void arm_angles(const struct rig *r)
{
    const struct chain_form f = rig_form(r);

    for (int n = 0; n < 500; n++) {
        double q[CHAIN_JOINTS], all[CHAIN_BRANCHES][CHAIN_JOINTS];
        struct chain_pose pose, again;
        rig_anywhere(&f.chain, &seed, q);
        chain_forward(&f.chain, q, &pose);
        const double angle = check_real(&seed, -3.0, 3.0);
        const uint32_t there = chain_inverse_held(&f, &pose, q, angle, 0xff, all);
        CHECK_EQ(there, 0xff);
        for (int k = 0; k < CHAIN_BRANCHES; k++) {
            chain_forward(&f.chain, all[k], &again);
            CHECK(rig_between(&pose, &again) < 1e-9);
            CHECK_NEAR(remainder(chain_arm_angle(&f, all[k]) - angle, 6.283185307179586), 0.0,
                       1e-9);
        }
    }
}

/* The nearest branch within limits, by whole turns, which a slide has none of. */
static void nearest(void)
{
    const struct chain_form f = rig_form(&RIGS[8]);
    const double all[CHAIN_BRANCHES][CHAIN_JOINTS] = { { 0.1, 0.2, 0.05, 3.0 },
                                                       { 0 },
                                                       { 0.3, -0.2, 0.05, -3.0 } };
    const double near[CHAIN_JOINTS] = { 6.3, 0.1, 0.0, 3.0 };
    double low[CHAIN_JOINTS] = { -9, -9, -9, -9 }, high[CHAIN_JOINTS] = { 9, 9, 9, 9 };
    double got[CHAIN_JOINTS];

    CHECK_EQ(chain_nearest(&f, 5, all, near, low, high, got), 0);
    CHECK_NEAR(got[0], 0.1 + 6.283185307179586, 1e-12);
    high[1] = 0.0;
    CHECK_EQ(chain_nearest(&f, 5, all, near, low, high, got), 2);
    CHECK_NEAR(got[3], -3.0 + 6.283185307179586, 1e-12);
    high[2] = 0.04;
    CHECK_EQ(chain_nearest(&f, 5, all, near, low, high, got), -1);
}

/* A parallelogram elsewhere than in a palletizer leaves no closed form. */
static void levels(void)
{
    static const struct {
        int rig, joint, level;
    } ELSEWHERE[] = { { 0, 3, 2 },  { 8, 3, 1 },  { 10, 3, 1 }, { 10, 3, 3 },
                      { 10, 2, 2 }, { 10, 1, 1 }, { 0, 2, 1 } };

    for (int n = 0; n < (int)(sizeof ELSEWHERE / sizeof ELSEWHERE[0]); n++) {
        struct chain c = rig_chain(&RIGS[ELSEWHERE[n].rig]);
        struct chain_form f;
        c.joint[ELSEWHERE[n].joint].level = ELSEWHERE[n].level;
        chain_form_of(&c, CHAIN_NONE, &f);
        CHECK_EQ(f.kind, CHAIN_ITERATED);
    }
}

/* Numbers that are no arm. */
static void unsound(void)
{
    struct chain c = rig_chain(&RIGS[0]);
    CHECK(chain_good(&c));
    c.joint[2].axis[0] = 0.1;
    CHECK(!chain_good(&c));
    c = rig_chain(&RIGS[0]);
    c.flange.turn[0][0] = -1.0;
    CHECK(!chain_good(&c));
    c = rig_chain(&RIGS[0]);
    c.joint[1].origin[2] = NAN;
    CHECK(!chain_good(&c));
    c = rig_chain(&RIGS[0]);
    c.joint[1].level = 2;
    CHECK(!chain_good(&c));
    c = rig_chain(&RIGS[0]);
    c.joints = 8;
    CHECK(!chain_good(&c));
}

int main(void)
{
    for (int n = 0; n < RIG_COUNT; n++) {
        circles(&RIGS[n]);
        jacobian(&RIGS[n]);
    }
    factors(&RIGS[0], 0.7 * hypot(0.115, 0.795));
    factors(&RIGS[1], 0.425 * 0.3922);
    in_line(&RIGS[0], 4, 0.0, 3);
    in_line(&RIGS[0], 4, 3.141592653589793, 3);
    in_line(&RIGS[1], 4, 0.0, 5);
    in_line(&RIGS[11], 4, 0.0, 3);
    in_line(&RIGS[13], 1, 0.0, 0);
    in_line(&RIGS[13], 5, 0.0, 4);
    edge();
    for (int n = 0; n < 8; n++) {
        if (n != 2) {
            calibrated(&RIGS[n], 2e-4);
        }
    }
    nearly(&GEN3, 0.0, 1.0);
    nearly(&GEN3, 5e-3, 0.999);
    nearly(&GEN3, 3.0, 0.985);
    arm_angles(&RIGS[13]);
    nearest();
    levels();
    unsound();
    return check_result();
}
