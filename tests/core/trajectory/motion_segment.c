/* Segments of a smooth path: derivatives against difference quotients, bounds against samples. */
#include <string.h>

#include "check.h"
#include "segment.h"

static const double PI = 3.14159265358979323846;

enum { PARTS = 64 };

/* r''' as a difference quotient of r''. */
static void third(const struct segment *p, double u, double jerk[AXES])
{
    const double du = 1e-5 * p->length;
    struct segment_state a, b;
    const double from = fmax(0.0, u - du), to = fmin(p->length, u + du);

    segment_at(p, from, &a);
    segment_at(p, to, &b);
    for (int i = 0; i < AXES; i++) {
        jerk[i] = (b.bend[i] - a.bend[i]) / (to - from);
    }
}

static double norm3(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* Both ends of a part, and the axes that move. */
static void ends(const struct segment *p, double from, double to, const struct segment_bounds *b)
{
    int32_t axes = 0;

    for (int end = 0; end < 2; end++) {
        struct segment_state s;
        segment_at(p, end ? to : from, &s);
        for (int i = 0; i < AXES; i++) {
            CHECK_NEAR(b->slope[end][i], s.slope[i], 1e-12);
            CHECK_NEAR(b->bend[end][i], s.bend[i], 1e-12 * (b->most[1] + 1.0 / p->length));
        }
    }
    for (int i = 0; i < AXES; i++) {
        const bool listed = axes < b->axes && b->axis[axes] == i;
        CHECK(listed == (b->low[0][i] != 0.0 || b->high[0][i] != 0.0));
        axes += listed;
    }
    CHECK(axes == b->axes);
}

/* Parts cut off one after another are bounded as by themselves. */
static void cuts(const struct segment *p, int32_t n)
{
    struct segment_rest rest;
    double from = 0.0;

    segment_rest_start(&rest, p);
    for (int32_t k = 1; k <= n; k++) {
        const double to = k < n ? p->length * k / n : p->length;
        struct segment_bounds a, b;
        segment_bounds(p, from, to, &a);
        segment_rest_cut(&rest, to, &b);
        for (int m = 0; m < 3; m++) {
            const double little = 1e-12 * (a.most[m] + 1.0 / pow(p->length, m));
            CHECK_NEAR(b.most[m], a.most[m], little);
            for (int i = 0; i < AXES; i++) {
                CHECK_NEAR(b.low[m][i], a.low[m][i], little);
                CHECK_NEAR(b.high[m][i], a.high[m][i], little);
            }
        }
        ends(p, from, to, &b);
        from = to;
    }
}

/* Extremes over samples of a part, beside the bounds; `slack` of |bounds| may miss. */
static void hold(const struct segment *p, double from, double to, bool tool, double slack)
{
    struct segment_bounds b, most;
    struct segment_state s;
    double jerk[AXES];

    const int samples = p->kind == SEGMENT_ARC ? 400 : 60; /* arcs of several turns */
    segment_bounds(p, from, to, &b);
    ends(p, from, to, &b);
    memset(&most, 0, sizeof most);
    for (int k = 0; k <= samples; k++) {
        const double u = from + (to - from) * k / samples;
        segment_at(p, u, &s);
        third(p, u, jerk);
        const double *d[3] = { s.slope, s.bend, jerk };
        for (int n = 0; n < 3; n++) {
            const double length = norm3(d[n] + (tool ? 0 : 3));
            const double little = (n == 2 ? 1e-5 : 1e-12) * (b.most[n] + 1.0 / pow(p->length, n));
            CHECK(length <= b.most[n] + little);
            most.most[n] = k == 0 ? length : fmax(most.most[n], length);
            for (int i = 0; i < AXES; i++) {
                CHECK(d[n][i] >= b.low[n][i] - little && d[n][i] <= b.high[n][i] + little);
                most.low[n][i] = k == 0 ? d[n][i] : fmin(most.low[n][i], d[n][i]);
                most.high[n][i] = k == 0 ? d[n][i] : fmax(most.high[n][i], d[n][i]);
            }
        }
    }
    if (slack > 0.0) {
        for (int n = 0; n < 3; n++) {
            CHECK_NEAR(most.most[n], b.most[n], slack * b.most[n] + 1e-9);
            for (int i = 0; i < AXES; i++) {
                CHECK_NEAR(most.low[n][i], b.low[n][i], slack * b.most[n] + 1e-9);
                CHECK_NEAR(most.high[n][i], b.high[n][i], slack * b.most[n] + 1e-9);
            }
        }
    }
}

/* Place, r' and r'' agree with one another. */
static void smooth(const struct segment *p)
{
    for (int k = 1; k < 20; k++) {
        const double u = p->length * k / 20.0, du = 1e-5 * p->length;
        struct segment_state a, b, s;
        segment_at(p, u - du, &a);
        segment_at(p, u + du, &b);
        segment_at(p, u, &s);
        for (int i = 0; i < AXES; i++) {
            CHECK_NEAR(s.slope[i], (b.point[i] - a.point[i]) / (2.0 * du), 1e-6 * norm3(s.slope));
            CHECK_NEAR(s.bend[i], (b.slope[i] - a.slope[i]) / (2.0 * du), 1e-6 / p->length);
        }
    }
}

static void line(void)
{
    struct segment p = { .kind = SEGMENT_LINE,
                         .length = 5.0,
                         .start = { 1, 2, 3, 4, 5, 6 },
                         .slope = { 0.6, 0.0, -0.8, 0.1, 0, 0 } };
    struct segment_state s;
    struct segment_bounds b;

    segment_at(&p, 5.0, &s);
    CHECK_NEAR(s.point[0], 4.0, 1e-15);
    CHECK_NEAR(s.point[2], -1.0, 1e-15);
    CHECK_NEAR(s.point[3], 4.5, 1e-15);
    smooth(&p);
    hold(&p, 0.0, 5.0, true, 1e-9);
    CHECK_NEAR(p.slope[2], -0.8, 0.0);
    memset(p.slope, 0, sizeof p.slope);
    p.slope[4] = 1.0;
    segment_bounds(&p, 1.0, 2.0, &b);
    CHECK_NEAR(b.most[0], 1.0, 0.0);
    CHECK_NEAR(b.most[1], 0.0, 0.0);
}

/* Planar arcs with a helix, without growth of the radius and with; and about any normal. */
static void arcs(uint64_t *random)
{
    for (int k = 0; k < 100; k++) {
        struct segment p = { .kind = SEGMENT_ARC };
        double start[AXES], end[AXES], centre[2], miss;
        for (int i = 0; i < AXES; i++) {
            start[i] = check_real(random, -10.0, 10.0);
            end[i] = check_real(random, -10.0, 10.0);
        }
        const enum path_plane plane = (enum path_plane)(k % 4);
        const bool grows = k % 8 >= 4 && plane != PATH_TILTED;
        if (plane == PATH_TILTED) {
            double middle[3], normal[3], sweep;
            CHECK(path_tilted_by_point(start, end, (double[]){ 1.0, 12.0, 3.0 }, middle, normal,
                                       &sweep)
                  == PATH_OK);
            sweep *= k % 8 == 3 ? 1.0 : -0.9;
            CHECK(path_tilted(&p.path, start, end, middle, normal, sweep) == PATH_OK);
        } else {
            const double r = check_real(random, 0.5, 20.0), turn = check_real(random, -PI, PI);
            const double angle = check_real(random, -PI, PI);
            const int x = path_first(plane), y = path_second(plane);
            const double other = grows ? r * (1.0 + 0.9e-3) : r;
            centre[0] = start[x] - r * cos(angle);
            centre[1] = start[y] - r * sin(angle);
            end[x] = centre[0] + other * cos(angle + turn);
            end[y] = centre[1] + other * sin(angle + turn);
            CHECK(path_arc(&p.path, plane, start, end, centre, k % 2, 1 + k % 3, &miss) == PATH_OK);
        }
        p.from = p.path.length * check_real(random, 0.0, 0.4);
        p.length = p.path.length - p.from;
        smooth(&p);
        const double from = p.length * check_real(random, 0.0, 0.5);
        const double to = from + (p.length - from) * check_real(random, 0.01, 1.0);
        hold(&p, from, to, true, grows ? 4e-3 : 1e-3);
        hold(&p, 0.0, p.length, true, grows ? 4e-3 : 1e-3);
        cuts(&p, 7);
    }
}

/* Cubics: the bounds of parts are as narrow as what they may change by. */
static void cubics(uint64_t *random)
{
    for (int k = 0; k < 10; k++) {
        struct segment p = { .kind = SEGMENT_CUBIC };
        double end[AXES], inner[2][3];
        const double start[AXES] = { 100.0, -200.0, 3.0, 0.0, 1.0, 2.0 };
        for (int i = 0; i < AXES; i++) {
            end[i] = start[i] + (i == 0 ? 30.0 : check_real(random, -5.0, 5.0));
        }
        for (int i = 0; i < 3; i++) {
            inner[0][i] = start[i] + (i == 0 ? 10.0 : check_real(random, -8.0, 8.0));
            inner[1][i] = start[i] + (i == 0 ? 20.0 : check_real(random, -8.0, 8.0));
        }
        CHECK_EQ(path_cubic(&p.path, start, end, (const double(*)[3])inner), PATH_OK);
        p.from = p.path.length * check_real(random, 0.0, 0.4);
        p.length = p.path.length - p.from;
        smooth(&p);
        hold(&p, 0.0, p.length, true, 0.0);
        for (int part = 0; part < PARTS; part++) {
            const double from = p.length * part / PARTS, to = p.length * (part + 1) / PARTS;
            hold(&p, from, to, true, 0.0);
            struct segment_bounds b;
            struct segment_state s;
            segment_bounds(&p, from, to, &b);
            segment_at(&p, from, &s);
            const double bend = norm3(s.bend), turn = (to - from) * b.most[1];
            CHECK(b.most[1] <= 1.2 * (bend + (to - from) * b.most[2]));
            CHECK(b.high[0][1] - b.low[0][1] <= 1.0001 * turn);
        }
    }
}

/* Curves: the hulls of many parts together are hardly wider than the samples. */
static void curves(uint64_t *random)
{
    for (int k = 0; k < 100; k++) {
        struct segment p = { .kind = SEGMENT_CURVE, .length = check_real(random, 0.01, 10.0) };
        const bool tool = k % 5 != 0;
        for (int i = tool ? 0 : 3; i < (k % 2 || !tool ? AXES : 2); i++) {
            p.origin[i] = 100.0;
            for (int c = 1; c < SEGMENT_POINTS; c++) {
                p.control[c][i] = p.length * (0.2 * c + check_real(random, -0.3, 0.3));
            }
        }
        struct segment_state s;
        segment_at(&p, p.length, &s);
        for (int i = 0; i < AXES; i++) {
            CHECK_NEAR(s.point[i], p.origin[i] + p.control[SEGMENT_POINTS - 1][i], 0.0);
        }
        if (tool) {
            smooth(&p);
        }
        hold(&p, 0.0, p.length, tool, 0.0);
        cuts(&p, 32);
        for (int part = 0; part < PARTS; part++) {
            const double from = p.length * part / PARTS, to = p.length * (part + 1) / PARTS;
            hold(&p, from, to, tool, 0.01);
        }
    }
}

int main(void)
{
    uint64_t random = 15;
    line();
    arcs(&random);
    curves(&random);
    cubics(&random);
    return check_result();
}
