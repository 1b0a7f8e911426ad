/* Geometry of lines, arcs and helices against trigonometry of its own. */
#include <string.h>

#include "check.h"
#include "path.h"

static const double PI = 3.14159265358979323846;

/* Length of the path as a sum of chords, and its direction as a difference quotient. */
static void walk(const struct path *p, double tolerance)
{
    enum { N = 20000 };
    double a[AXES], b[AXES], slope[AXES], unused[AXES], sum = 0.0;
    path_at(p, 0.0, a, slope);
    for (int k = 0; k < AXES; k++) {
        CHECK_NEAR(a[k], p->start[k], 1e-12);
    }
    for (int i = 1; i <= N; i++) {
        path_at(p, i == N ? p->length : p->length * i / N, b, unused);
        sum += sqrt(pow(b[0] - a[0], 2) + pow(b[1] - a[1], 2) + pow(b[2] - a[2], 2));
        memcpy(a, b, sizeof a);
    }
    CHECK_NEAR(sum, p->length, tolerance * p->length);
    for (int k = 0; k < AXES; k++) {
        CHECK(b[k] == p->end[k]);
    }
    for (int i = 1; i < 10; i++) {
        const double s = p->length * i / 10.0, ds = 1e-6 * p->length;
        double c[AXES];
        path_at(p, s - ds, a, unused);
        path_at(p, s + ds, b, unused);
        path_at(p, s, c, slope);
        for (int k = 0; k < AXES; k++) {
            CHECK_NEAR(slope[k], (b[k] - a[k]) / (2.0 * ds), 1e-7);
            CHECK(fabs(slope[k]) <= path_share(p, k) * (1.0 + 1e-12));
            double low, high;
            path_extent(p, k, 0.0, p->length, &low, &high);
            CHECK(c[k] >= low - 1e-12 * fabs(low) && c[k] <= high + 1e-12 * fabs(high));
        }
    }
}

static void lines(void)
{
    const double a[AXES] = { 1, 2, 3, 4, 5, 6 }, b[AXES] = { 4, 6, 15, 4, -5, 7 };
    const double c[AXES] = { 1, 2, 3, 7, 9, 18 };
    struct path p;
    double at[AXES], slope[AXES];
    path_line(&p, a, b);
    CHECK_NEAR(p.length, 13.0, 1e-14); /* 3 4 12, X Y Z alone */
    walk(&p, 1e-12);
    path_at(&p, 6.5, at, slope);
    CHECK_NEAR(at[4], 0.0, 1e-14);
    CHECK_NEAR(slope[4], -10.0 / 13.0, 1e-14);
    path_line(&p, a, c);
    CHECK_NEAR(p.length, 13.0, 1e-14); /* only U V W move */
}

/* Quarter circles from a point 10 right of the centre: counter-clockwise seen from the normal's
 * positive end turns the plane's first axis to its second: X to Y, Y to Z, Z to X. */
static void planes(void)
{
    const int first[3] = { 1, 2, 0 }, second[3] = { 2, 0, 1 }; /* by normal X, Y, Z */
    for (int n = 0; n < 3; n++) {
        const int i = first[n], k = second[n];
        double start[AXES] = { 0 }, end[AXES] = { 0 }, at[AXES], slope[AXES], miss;
        const double centre[2] = { 7.0, -2.0 };
        struct path p;
        CHECK(path_first((enum path_plane)n) == i && path_second((enum path_plane)n) == k);
        start[i] = 17.0;
        start[k] = -2.0;
        end[i] = 7.0;
        end[k] = 8.0;
        end[n] = 6.0;
        end[5] = 3.0;
        CHECK(path_arc(&p, (enum path_plane)n, start, end, centre, true, 1, &miss) == PATH_OK);
        CHECK_NEAR(p.sweep, PI / 2, 1e-15);
        CHECK_NEAR(p.length, hypot(10.0 * PI / 2, 6.0), 1e-13);
        walk(&p, 1e-8);
        path_at(&p, p.length / 3.0, at, slope);
        CHECK_NEAR(at[i], 7.0 + 10.0 * cos(PI / 6), 1e-13);
        CHECK_NEAR(at[k], -2.0 + 10.0 * sin(PI / 6), 1e-13);
        CHECK_NEAR(at[n], 2.0, 1e-14);
        CHECK_NEAR(at[5], 1.0, 1e-14);

        CHECK(path_arc(&p, (enum path_plane)n, start, end, centre, false, 3, &miss) == PATH_OK);
        CHECK_NEAR(p.sweep, -1.5 * PI - 4.0 * PI, 1e-14);
        walk(&p, 1e-6);
        path_at(&p, p.length * 0.75 / 2.75, at, slope); /* after three quarters of a turn */
        CHECK_NEAR(at[i], 7.0, 1e-13);
        CHECK_NEAR(at[k], 8.0, 1e-13);
    }
}

static void full_circle(void)
{
    const double start[AXES] = { 50.0, 0.0 }, centre[2] = { 0.0, 0.0 };
    double at[AXES], slope[AXES], miss;
    struct path p;
    CHECK(path_arc(&p, PATH_XY, start, start, centre, false, 1, &miss) == PATH_OK);
    CHECK_NEAR(p.length, 100.0 * PI, 1e-12);
    path_at(&p, 25.0 * PI, at, slope); /* clockwise from +X: first to -Y */
    CHECK_NEAR(at[0], 0.0, 1e-13);
    CHECK_NEAR(at[1], -50.0, 1e-13);
    CHECK_NEAR(slope[0], -1.0, 1e-14);
}

/* R form: the centre is r from both ends, and the sign of r picks the arc below or above pi. */
static void by_radius(void)
{
    uint64_t seed = 3;
    for (int i = 0; i < 500; i++) {
        double start[AXES] = { 0 }, end[AXES] = { 0 }, centre[2], half, miss;
        start[0] = check_real(&seed, -50, 50);
        start[1] = check_real(&seed, -50, 50);
        end[0] = check_real(&seed, -50, 50);
        end[1] = check_real(&seed, -50, 50);
        const double chord = hypot(end[0] - start[0], end[1] - start[1]);
        const double r = chord / 2.0 * check_real(&seed, 1.001, 5.0);
        const bool ccw = check_real(&seed, 0, 1) < 0.5, large = check_real(&seed, 0, 1) < 0.5;
        struct path p;
        CHECK_EQ(path_centre_by_radius(PATH_XY, start, end, large ? -r : r, ccw, 0.005, centre,
                                       &half),
                 PATH_OK);
        CHECK_NEAR(hypot(start[0] - centre[0], start[1] - centre[1]), r, 1e-10 * r);
        CHECK(path_arc(&p, PATH_XY, start, end, centre, ccw, 1, &miss) == PATH_OK);
        const double small = 2.0 * asin(chord / 2.0 / r);
        CHECK_NEAR(fabs(p.sweep), large ? 2.0 * PI - small : small, 1e-9);
        CHECK((p.sweep > 0.0) == ccw);
    }
}

/* Three points: the arc passes through the middle one. */
static void by_point(void)
{
    uint64_t seed = 4;
    for (int i = 0; i < 500; i++) {
        const double r = check_real(&seed, 0.5, 80.0), a0 = check_real(&seed, -3.0, 3.0);
        const double turn = check_real(&seed, 0.1, 6.0) * (i % 2 ? 1.0 : -1.0);
        const double part = check_real(&seed, 0.1, 0.9), c0 = check_real(&seed, -9, 9);
        double start[AXES] = { 0 }, end[AXES] = { 0 }, centre[2], miss;
        const double via[2] = { c0 + r * cos(a0 + part * turn), r * sin(a0 + part * turn) };
        bool ccw;
        struct path p;
        start[0] = c0 + r * cos(a0);
        start[1] = r * sin(a0);
        end[0] = c0 + r * cos(a0 + turn);
        end[1] = r * sin(a0 + turn);
        CHECK(path_centre_by_point(PATH_XY, start, via, end, centre, &ccw) == PATH_OK);
        CHECK_NEAR(centre[0], c0, 1e-9 * r / (part * part));
        CHECK_NEAR(centre[1], 0.0, 1e-9 * r / (part * part));
        CHECK(ccw == (turn > 0.0));
        CHECK(path_arc(&p, PATH_XY, start, end, centre, ccw, 1, &miss) == PATH_OK);
        CHECK_NEAR(p.sweep, turn, 1e-8);
    }
    const double a[AXES] = { 0 }, b[AXES] = { 2.0, 2.0 };
    double centre[2];
    bool ccw;
    CHECK(path_centre_by_point(PATH_XY, a, (double[]){ 1.0, 1.0 }, b, centre, &ccw) == PATH_OPEN);
    for (double r = 10.0; r < 1e9; r *= 10.0) { /* flat arcs with a chord of 2 mm */
        const double from[AXES] = { -1.0 }, to[AXES] = { 1.0 };
        const double via[2] = { 0.0, 1.0 / (r + sqrt(r * r - 1.0)) };
        CHECK(path_centre_by_point(PATH_XY, from, via, to, centre, &ccw) == PATH_OK);
        CHECK_NEAR(centre[1], -sqrt(r * r - 1.0), 1e-6 * r);
        CHECK(!ccw);
    }
}

/* The tolerance of E1: 0.005 mm always, 0.5 mm never more, 0.1 % between. */
static void tolerance(void)
{
    const struct {
        double r, error;
        enum path_status want;
    } cases[] = {
        { 1.0, 0.0049, PATH_OK },  { 1.0, 0.0051, PATH_MISSES_END },
        { 100.0, 0.099, PATH_OK }, { 100.0, 0.101, PATH_MISSES_END },
        { 1000.0, 0.49, PATH_OK }, { 1000.0, 0.51, PATH_MISSES_END },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const double start[AXES] = { cases[i].r }, end[AXES] = { 0.0, cases[i].r + cases[i].error };
        const double centre[2] = { 0.0, 0.0 };
        double miss;
        struct path p;
        CHECK(path_arc(&p, PATH_XY, start, end, centre, true, 1, &miss) == cases[i].want);
        CHECK_NEAR(miss, cases[i].error, 1e-12 * cases[i].r);
        if (cases[i].want == PATH_OK) {
            walk(&p, 1e-6); /* start and end are met; speed errs by less than 0.1 % */
        }
    }
    const double zero[AXES] = { 0.0 }, centre[2] = { 0.0, 0.0 }, tiny[2] = { 5e-324, 0.0 };
    double miss;
    struct path p;
    CHECK(path_arc(&p, PATH_XY, zero, zero, centre, true, 1, &miss) == PATH_NO_RADIUS);
    CHECK(path_arc(&p, PATH_XY, zero, zero, tiny, true, 1, &miss) == PATH_NO_RADIUS);
}

/* About any normal: the same as an arc of a plane where it is one, turned where it is not. */
static void tilted(void)
{
    static const double normal[3] = { 2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0 };
    static const double middle[3] = { 5.0, -3.0, 8.0 };
    uint64_t seed = 3;
    struct path p, flat;
    double miss;

    for (int plane = 0; plane < 3; plane++) {
        for (int n = 0; n < 50; n++) {
            const double sweep = check_real(&seed, -12.0, 12.0), r = check_real(&seed, 1.0, 50.0);
            const int a = path_first((enum path_plane)plane);
            const int b = path_second((enum path_plane)plane);
            double start[AXES] = { 1, 2, 3, 4, 5, 6 }, end[AXES] = { 1, 2, 3, 9, 5, 6 };
            double up[3] = { 0 }, centre[2] = { 7.0, -2.0 }, c[3] = { 1, 2, 3 };
            up[plane] = 1.0;
            c[a] = centre[0];
            c[b] = centre[1];
            start[a] = centre[0] + r;
            start[b] = centre[1];
            end[a] = centre[0] + r * cos(sweep);
            end[b] = centre[1] + r * sin(sweep);
            const int turns = 1 + (int)floor(fabs(sweep) / (2.0 * PI));
            CHECK(path_arc(&flat, (enum path_plane)plane, start, end, centre, sweep > 0.0, turns,
                           &miss)
                  == PATH_OK);
            CHECK(path_tilted(&p, start, end, c, up, sweep) == PATH_OK);
            CHECK_NEAR(p.length, flat.length, 1e-9);
            CHECK_NEAR(path_bend(&p), path_bend(&flat), 1e-9);
            for (int i = 0; i < AXES; i++) {
                double low[2], high[2], at[2][AXES], slope[2][AXES];
                const double from = check_real(&seed, 0.0, 0.5) * p.length;
                const double to = from + check_real(&seed, 0.0, 0.5) * p.length;
                path_extent(&p, i, from, to, &low[0], &high[0]);
                path_extent(&flat, i, from, to, &low[1], &high[1]);
                CHECK_NEAR(low[0], low[1], 1e-9);
                CHECK_NEAR(high[0], high[1], 1e-9);
                path_at(&p, from, at[0], slope[0]);
                path_at(&flat, from, at[1], slope[1]);
                CHECK_NEAR(at[0][i], at[1][i], 1e-9);
                CHECK_NEAR(slope[0][i], slope[1][i], 1e-9);
            }
        }
    }
    /* In a plane of its own, with a middle found by a point on the way. */
    const double out[3] = { 1.0 / 3.0, -2.0 / 3.0, -2.0 / 3.0 };
    const double on[3] = { 2.0 / 3.0, 2.0 / 3.0, -1.0 / 3.0 }; /* normal x out */
    for (double sweep = 0.5; sweep < 6.2; sweep += 0.7) {
        double start[AXES] = { 0 }, via[3], end[AXES] = { 0, 0, 0, 2, 1, 0 }, m[3], n[3], found;
        for (int i = 0; i < 3; i++) {
            start[i] = middle[i] + 10.0 * out[i];
            via[i] = middle[i] + 10.0 * (cos(0.3 * sweep) * out[i] + sin(0.3 * sweep) * on[i]);
            end[i] = middle[i] + 10.0 * (cos(sweep) * out[i] + sin(sweep) * on[i]);
        }
        CHECK(path_tilted_by_point(start, via, end, m, n, &found) == PATH_OK);
        CHECK_NEAR(found, sweep, 1e-12);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(m[i], middle[i], 1e-12);
            CHECK_NEAR(n[i], normal[i], 1e-12);
        }
        CHECK(path_tilted(&p, start, end, m, n, found) == PATH_OK);
        CHECK_NEAR(p.length, 10.0 * sweep, 1e-11);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(p.end[i], end[i], 1e-12);
        }
        walk(&p, 1e-6);
    }
    const double a[AXES] = { 1, 2, 3 }, b[3] = { 2, 4, 6 }, c[3] = { 3, 6, 9 };
    double m[3], n[3], sweep;
    for (double r = 10.0; r < 1e9; r *= 10.0) { /* flat arcs with a chord of 2 mm */
        const double high = sqrt(r * r - 1.0), rise = 1.0 / (r + high);
        const double from[3] = { -1.0, 0, 0 }, to[3] = { 1.0, 0, 0 };
        const double via[3] = { 0, 0.6 * rise, 0.8 * rise };
        CHECK(path_tilted_by_point(from, via, to, m, n, &sweep) == PATH_OK);
        CHECK_NEAR(m[1], -0.6 * high, 1e-6 * r);
        CHECK_NEAR(m[2], -0.8 * high, 1e-6 * r);
        CHECK_NEAR(sweep, 2.0 * asin(1.0 / r), 1e-6 / r);
    }
    CHECK(path_tilted_by_point(a, b, c, m, n, &sweep) == PATH_OPEN);
    CHECK(path_tilted_by_point(a, b, a, m, n, &sweep) == PATH_OPEN);
    CHECK(path_tilted(&p, a, a, a, normal, 1.0) == PATH_NO_RADIUS);
}

int main(void)
{
    lines();
    tilted();
    planes();
    full_circle();
    by_radius();
    by_point();
    tolerance();
    return check_result();
}
