/* Cubic curves: length against a closed form and Simpson's rule, places by their length, bounds of
 * direction, curvature and third derivative, extents: each with two sides. */
#include <string.h>

#include "check.h"
#include "path.h"

enum { PARTS = 20000 };

static void place(const struct path *p, double t, double at[3])
{
    const double u = 1.0 - t;
    for (int i = 0; i < 3; i++) {
        at[i] = u * u * u * p->start[i] + 3.0 * u * u * t * p->bezier.inner[0][i]
                + 3.0 * u * t * t * p->bezier.inner[1][i] + t * t * t * p->end[i];
    }
}

static double speed(const struct path *p, double t)
{
    const double u = 1.0 - t;
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        const double a = p->bezier.inner[0][i], b = p->bezier.inner[1][i];
        const double v =
            3.0 * (u * u * (a - p->start[i]) + 2.0 * u * t * (b - a) + t * t * (p->end[i] - b));
        sum += v * v;
    }
    return sqrt(sum);
}

static void random_cubic(struct path *p, uint64_t *seed)
{
    double start[AXES], end[AXES], inner[2][3];
    do {
        for (int i = 0; i < AXES; i++) {
            start[i] = check_real(seed, -50.0, 50.0);
            end[i] = check_real(seed, -50.0, 50.0);
        }
        for (int i = 0; i < 6; i++) {
            inner[i / 3][i % 3] = check_real(seed, -50.0, 50.0);
        }
        if (check_random(seed, 0, 2) > 0) { /* most are flat, as G5 makes them */
            start[2] = end[2] = inner[0][2] = inner[1][2] = 3.0;
        }
    } while (path_cubic(p, start, end, (const double(*)[3])inner) != PATH_OK);
}

/* y = x^2 from -1 to 2, made of degree 3: a closed form. */
static void parabola(void)
{
    const double start[AXES] = { -1.0, 1.0 }, end[AXES] = { 2.0, 4.0, 0.0, 7.0 };
    const double corner[2] = { 0.5, -2.0 };
    double inner[2][3] = { { 0 } }, at[AXES], slope[AXES], low, high;
    struct path p;
    for (int i = 0; i < 2; i++) {
        inner[0][i] = start[i] + 2.0 / 3.0 * (corner[i] - start[i]);
        inner[1][i] = end[i] + 2.0 / 3.0 * (corner[i] - end[i]);
    }
    CHECK_EQ(path_cubic(&p, start, end, (const double(*)[3])inner), PATH_OK);
    const double length = 0.5 * (2.0 * sqrt(17.0) + sqrt(5.0)) + 0.25 * (asinh(4.0) + asinh(2.0));
    CHECK_NEAR(p.length, length, 1e-13 * length);
    CHECK_NEAR(path_bend(&p), 2.0, 2.1e-3);
    CHECK(path_bend(&p) >= 2.0 - 1e-12);
    path_extent(&p, 1, 0.0, p.length, &low, &high);
    CHECK_NEAR(low, 0.0, 1e-12);
    CHECK_NEAR(high, 4.0, 0.0);
    const double half = 0.5 * sqrt(5.0) + 0.25 * asinh(2.0); /* from x = -1 to 0 */
    path_at(&p, half, at, slope);
    CHECK_NEAR(at[0], 0.0, 1e-12);
    CHECK_NEAR(at[1], 0.0, 1e-12);
    CHECK_NEAR(at[3], 7.0 * half / length, 1e-12); /* the others go evenly */
    CHECK_NEAR(slope[0], 1.0, 1e-12);
    CHECK_NEAR(slope[3], 7.0 / length, 1e-12);
    path_extent(&p, 1, half + 0.1, p.length, &low, &high);
    CHECK(low > 0.005);
    path_at(&p, p.length, at, slope);
    CHECK(!memcmp(at, end, sizeof at));
}

static double third_difference(const struct path *p, double s)
{
    const double h = 1e-3 * p->length;
    double slope[3][AXES], at[AXES], sum = 0.0;
    for (int k = 0; k < 3; k++) {
        path_at(p, s + (k - 1) * h, at, slope[k]);
    }
    for (int i = 0; i < 3; i++) {
        const double x = (slope[0][i] - 2.0 * slope[1][i] + slope[2][i]) / (h * h);
        sum += x * x;
    }
    return sqrt(sum);
}

/* Simpson's rule over so many parts is good to 1e-10 where the curve is not nearly a cusp. */
static void at_random(void)
{
    uint64_t seed = 5;
    double worst_place = 0.0, least_bend = 9.0, most_bend = 0.0, most_twist = 0.0;
    for (int n = 0; n < 200; n++) {
        struct path p;
        double length = 0.0, at[AXES], slope[AXES], want[3], share[3] = { 0.0 }, bend = 0.0;
        double low[3], high[3];
        random_cubic(&p, &seed);
        CHECK(p.cubic && !p.arc);
        const bool sharp = path_bend(&p) > 5.0;
        for (int i = 0; i < 3; i++) {
            low[i] = high[i] = p.start[i];
        }
        for (int k = 0; k < PARTS; k++) {
            const double t = (double)k / PARTS, h = 1.0 / PARTS;
            length += h / 6.0 * (speed(&p, t) + 4.0 * speed(&p, t + 0.5 * h) + speed(&p, t + h));
            place(&p, t + h, want);
            for (int i = 0; i < 3; i++) {
                low[i] = fmin(low[i], want[i]);
                high[i] = fmax(high[i], want[i]);
            }
            if (k % 100 == 37 && !sharp) {
                double before[AXES], after[AXES];
                path_at(&p, fmin(length, p.length), at, slope);
                double miss = 0.0, norm = 0.0, turn = 0.0;
                for (int i = 0; i < 3; i++) {
                    miss = fmax(miss, fabs(at[i] - want[i]));
                    norm += slope[i] * slope[i];
                    share[i] = fmax(share[i], fabs(slope[i]));
                }
                worst_place = fmax(worst_place, miss);
                CHECK_NEAR(norm, 1.0, 1e-12);
                const double d = 1e-5 * p.length, s = fmin(fmax(length, d), p.length - d);
                path_at(&p, s - d, at, before);
                path_at(&p, s + d, at, after);
                for (int i = 0; i < 3; i++) {
                    turn += (after[i] - before[i]) * (after[i] - before[i]);
                }
                bend = fmax(bend, sqrt(turn) / (2.0 * d));
                const double m = 1.1e-3 * p.length, mid = fmin(fmax(s, m), p.length - m);
                const double ratio = third_difference(&p, mid) / path_twist(&p);
                CHECK(ratio < 1.0 + 1e-3);
                most_twist = fmax(most_twist, ratio);
            }
        }
        CHECK_NEAR(p.length, length, 1e-9 * length);
        for (int i = 0; i < 3; i++) {
            double a, b;
            path_extent(&p, i, 0.0, p.length, &a, &b);
            CHECK(a <= low[i] + 1e-12 && a >= low[i] - 1e-6);
            CHECK(b >= high[i] - 1e-12 && b <= high[i] + 1e-6);
            if (!sharp) {
                CHECK(path_share(&p, i) >= share[i] - 1e-12);
                CHECK(path_share(&p, i) <= share[i] * 1.02 + 1e-2);
            }
        }
        if (!sharp) {
            CHECK(bend <= path_bend(&p) * (1.0 + 1e-6));
            least_bend = fmin(least_bend, bend / path_bend(&p));
            most_bend = fmax(most_bend, bend / path_bend(&p));
        }
    }
    CHECK(worst_place < 1e-8);
    CHECK(least_bend > 0.7 && most_bend > 0.998); /* the rest is between two places looked at */
    CHECK(most_twist > 0.2);
    printf("places %.1e mm; bend seen %.3f to %.5f of its bound, third derivative up to %.2f\n",
           worst_place, least_bend, most_bend, most_twist);
}

/* A length, there and back. */
static void lengths(void)
{
    uint64_t seed = 77;
    double worst = 0.0;
    for (int n = 0; n < 200; n++) {
        struct path p;
        double at[AXES], next[AXES], slope[AXES];
        random_cubic(&p, &seed);
        for (int k = 1; k < 50; k++) {
            const double s = p.length * k / 50.0, d = 1e-3 / fmax(1.0, path_bend(&p));
            double chord = 0.0;
            path_at(&p, s - 0.5 * d, at, slope);
            path_at(&p, s + 0.5 * d, next, slope);
            for (int i = 0; i < 3; i++) {
                chord += (next[i] - at[i]) * (next[i] - at[i]);
            }
            worst = fmax(worst, fabs(sqrt(chord) / d - 1.0));
        }
    }
    CHECK(worst < 1e-6);
    printf("steps of 1 um are as long as they are said to %.1e\n", worst);
}

static void degenerate(void)
{
    const double start[AXES] = { 0.0 }, end[AXES] = { 9.0 };
    const double line[2][3] = { { 2.0 }, { 8.0 } }, back[2][3] = { { 12.0 }, { -3.0 } };
    const double cusp[2][3] = { { 10.0, 5.0 }, { -1.0, 5.0 } };
    const double still[2][3] = { { 0.0 }, { 4.0, 4.0 } };
    const double loop[2][3] = { { 8.0, 5.0 }, { 1.0, 5.0 } };
    struct path p;
    CHECK_EQ(path_cubic(&p, start, end, line), PATH_OK);
    CHECK(!p.cubic && p.length == 9.0);
    CHECK_EQ(path_cubic(&p, start, end, back), PATH_CUSP);
    CHECK_EQ(path_cubic(&p, start, end, still), PATH_CUSP); /* B' is 0 at its start */
    CHECK_EQ(path_cubic(&p, start, (const double[AXES]){ 9.0, 0.0 }, loop), PATH_OK);
    /* x: B' is 0 at t = 1/2 if 2 (a - b) = end - start: a point where it turns round */
    const double point[2][3] = { { 9.0, 6.0 }, { 0.0, 6.0 } };
    CHECK_EQ(path_cubic(&p, start, end, point), PATH_CUSP);
    CHECK_EQ(path_cubic(&p, start, end, cusp), PATH_OK);
    const double closed[2][3] = { { 10.0, 5.0 }, { -10.0, 5.0 } };
    CHECK_EQ(path_cubic(&p, start, start, closed), PATH_OK); /* from a point back to it */
    double sum = 0.0;
    for (int k = 0; k < PARTS; k++) {
        sum += speed(&p, (k + 0.5) / PARTS) / PARTS;
    }
    CHECK_NEAR(p.length, sum, 1e-6);
}

int main(void)
{
    parabola();
    at_random();
    lengths();
    degenerate();
    return check_result();
}
