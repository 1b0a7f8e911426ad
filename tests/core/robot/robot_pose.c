/* Attitudes, frames, tools: against matrices written out, and in circles. */
#include <string.h>

#include "check.h"
#include "pose.h"
#include "tip.h"

static const double DEGREE = 0.017453292519943295;
static uint64_t seed = 9;

static void anyhow(double q[4])
{
    for (int i = 0; i < 4; i++) {
        q[i] = check_real(&seed, -1, 1);
    }
    quaternion_normalise(q);
}

static struct pose anywhere(void)
{
    struct pose p;
    for (int i = 0; i < 3; i++) {
        p.at[i] = check_real(&seed, -1000, 1000);
    }
    anyhow(p.turn);
    return p;
}

static void axis_turn(int axis, double angle, double m[3][3])
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    memset(m, 0, 9 * sizeof m[0][0]);
    m[axis][axis] = 1.0;
    m[a][a] = m[b][b] = cos(angle * DEGREE);
    m[b][a] = sin(angle * DEGREE);
    m[a][b] = -m[b][a];
}

static void times(double a[3][3], double b[3][3], double c[3][3])
{
    double m[3][3];
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            m[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k];
        }
    }
    memcpy(c, m, sizeof m);
}

static double differs(double a[3][3], double b[3][3])
{
    double most = 0.0;
    for (int i = 0; i < 9; i++) {
        most = fmax(most, fabs(a[i / 3][i % 3] - b[i / 3][i % 3]));
    }
    return most;
}

/* R = Rz(C) Ry(B) Rx(A), there and back, upright too. */
static void angles(void)
{
    for (int n = 0; n < 2000; n++) {
        double abc[3], back[3], q[4], m[3][3], r[3][3], x[3][3];
        for (int i = 0; i < 3; i++) {
            abc[i] = check_real(&seed, -180, 180);
        }
        abc[1] = n % 10 == 0 ? (n % 20 ? 90.0 : -90.0) : 0.5 * abc[1];
        quaternion_by_angles(abc, q);
        quaternion_matrix(q, m);
        axis_turn(2, abc[2], r);
        axis_turn(1, abc[1], x);
        times(r, x, r);
        axis_turn(0, abc[0], x);
        times(r, x, r);
        CHECK(differs(m, r) < 1e-14);
        quaternion_angles(q, back);
        for (int i = 0; i < 3 && n % 10; i++) {
            CHECK_NEAR(back[i], abc[i], 1e-10);
        }
        quaternion_by_angles(back, q);
        quaternion_matrix(q, x);
        CHECK(differs(x, r) < (n % 10 ? 1e-11 : 1e-7));
        quaternion_of_matrix((const double(*)[3])r, q);
        quaternion_matrix(q, x);
        CHECK(differs(x, r) < 1e-14);
    }
}

/* Of products, rotation vectors, arcs. */
static void attitudes(void)
{
    for (int n = 0; n < 2000; n++) {
        double a[4], b[4], c[4], d[4], v[3], ma[3][3], mb[3][3], mc[3][3];
        anyhow(a);
        anyhow(b);
        quaternion_product(a, b, c);
        quaternion_matrix(a, ma);
        quaternion_matrix(b, mb);
        times(ma, mb, mb);
        quaternion_matrix(c, mc);
        CHECK(differs(mb, mc) < 1e-14);
        quaternion_vector(a, v);
        CHECK(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] <= 9.8696044010893580 + 1e-9);
        quaternion_by_vector(v, d);
        quaternion_matrix(d, mb);
        CHECK(differs(ma, mb) < 1e-14);
        /* Half of the arc twice is all of it, by the shorter way. */
        const double near = n % 4 ? 1.0 : 1e-9;
        for (int i = 0; i < 4; i++) {
            b[i] = a[i] + near * b[i];
        }
        quaternion_normalise(b);
        quaternion_slerp(a, b, 0.5, c);
        quaternion_inverse(a, d);
        quaternion_product(c, d, d);
        quaternion_product(d, c, d);
        quaternion_matrix(d, mc);
        quaternion_matrix(b, mb);
        CHECK(differs(mb, mc) < 1e-14);
        CHECK(fabs(c[0] * a[0] + c[1] * a[1] + c[2] * a[2] + c[3] * a[3]) > 0.7071);
    }
}

static void frames(void)
{
    for (int n = 0; n < 500; n++) {
        const struct pose a = anywhere(), b = anywhere(), ab = pose_product(&a, &b);
        const struct pose back = pose_inverse(&a), again = pose_product(&back, &ab);
        const double point[3] = { 1.0, -2.0, 3.0 };
        double in_a[3], out[3], twice[3];
        pose_point(&b, point, in_a);
        pose_point(&a, in_a, twice);
        pose_point(&ab, point, out);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(out[i], twice[i], 1e-11);
            CHECK_NEAR(again.at[i], b.at[i], 1e-11);
        }
        /* A user's frame by three points of it. */
        struct pose f;
        double x[3], xy[3];
        pose_point(&a, (double[]){ 250.0, 0.0, 0.0 }, x);
        pose_point(&a, (double[]){ -40.0, 90.0, 0.0 }, xy);
        CHECK_EQ(pose_by_points(a.at, x, xy, &f), 0);
        pose_point(&f, point, out);
        pose_point(&a, point, twice);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(out[i], twice[i], 1e-11);
        }
        CHECK_EQ(pose_by_points(a.at, x, x, &f), 1);
        CHECK_EQ(pose_by_points(a.at, a.at, x, &f), 1);
    }
}

/* One point touched in four attitudes tells the tip; in attitudes about one axis it does not. */
static void tips(void)
{
    for (int n = 0; n < 200; n++) {
        struct pose flange[4];
        const double tip[3] = { check_real(&seed, -50, 50), check_real(&seed, -50, 50),
                                check_real(&seed, 50, 200) };
        const double point[3] = { 900.0, 100.0, 300.0 };
        double found[3], rms, reach[3];
        for (int round = 0; round < 3; round++) {
            for (int k = 0; k < 4; k++) {
                const double about[3] = { 0.0, 0.0, 0.4 * k };
                flange[k] = anywhere();
                if (round == 2) {
                    quaternion_by_vector(about, flange[k].turn);
                }
                quaternion_turn(flange[k].turn, tip, reach);
                for (int i = 0; i < 3; i++) {
                    flange[k].at[i] =
                        point[i] - reach[i] + (round == 1 ? check_real(&seed, -0.1, 0.1) : 0.0);
                }
            }
            CHECK_EQ(tip_solve(flange, 4, found, &rms), round == 2);
            for (int i = 0; i < 3 && round < 2; i++) {
                CHECK_NEAR(found[i], tip[i], round ? 3.0 : 1e-9);
            }
            CHECK(round == 2 || (round == 0 ? rms < 1e-9 : rms > 1e-4 && rms < 0.2));
        }
        CHECK_EQ(tip_solve(flange, 2, found, &rms), 1);
    }
}

int main(void)
{
    angles();
    attitudes();
    frames();
    tips();
    return check_result();
}
