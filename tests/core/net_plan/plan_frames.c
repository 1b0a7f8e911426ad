/* Drawings become frames: limits at every sample, whole pulses, the same whatever the pieces in
 * which vertices and frames go in and out. */
#include <string.h>

#include "check.h"
#include "net_plan.h"

enum { VERTICES = 4000, FRAMES = 200000 };

static struct net_plan plan;
static struct net_plan_vertex vertex[VERTICES];
static struct net_plan_frame frame[2][FRAMES];

static const double SCALE = 800.0, SPEED = 180.0, ACC = 1500.0, JERK = 60000.0, RESERVE = 0.1;

static struct net_plan_config config_of(enum net_plan_pen pen)
{
    struct net_plan_config c = { .period_ns = 1000000,
                                 .tolerance = 0.02,
                                 .rapid = 150.0,
                                 .reserve = RESERVE,
                                 .pen = pen,
                                 .pen_axis = 2,
                                 .up = 2.0,
                                 .down = -0.5,
                                 .dwell = 0.03 };
    for (int i = 0; i < 3; i++) {
        c.axis[i] = (struct net_plan_axis){ SCALE, SPEED, ACC, JERK };
    }
    c.axis[1].acc = 0.5 * ACC;
    return c;
}

/* Circles on a raster of 1/40 mm, a square with exact stops, a line out and back, a dot. */
static int32_t draw(void)
{
    int32_t n = 0;

    for (int k = 0; k < 3; k++) {
        const double radius = 1.0 + 4.0 * k;
        for (int i = 0; i <= 1200; i++) {
            const double a = 2.0 * 3.14159265358979 * i / 1200;
            vertex[n++] =
                (struct net_plan_vertex){ { floor(40.0 * (30.0 * k + radius * cos(a)) + 0.5) / 40.0,
                                            floor(40.0 * radius * sin(a) + 0.5) / 40.0 },
                                          80.0,
                                          i == 0 ? NET_PLAN_MOVE : NET_PLAN_DRAW };
        }
    }
    static const double square[5][2] = { { 5, 5 }, { 25, 5 }, { 25, 25 }, { 5, 25 }, { 5, 5 } };
    for (int i = 0; i < 5; i++) {
        vertex[n++] = (struct net_plan_vertex){ { square[i][0], square[i][1] },
                                                80.0,
                                                i == 0 ? NET_PLAN_MOVE : NET_PLAN_STOP };
    }
    vertex[n++] = (struct net_plan_vertex){ { 40.0, -9.0 }, 80.0, NET_PLAN_MOVE };
    vertex[n++] = (struct net_plan_vertex){ { 60.0, -9.0 }, 80.0, NET_PLAN_DRAW };
    vertex[n++] = (struct net_plan_vertex){ { 40.0, -9.0 }, 80.0, NET_PLAN_DRAW };
    vertex[n++] = (struct net_plan_vertex){ { 40.0, 1.0 }, 80.0, NET_PLAN_MOVE };
    vertex[n++] = (struct net_plan_vertex){ { 40.0, 1.0 }, 80.0, NET_PLAN_DRAW };
    return n;
}

/* All frames; `early` takes frames as soon as there are any, else as late as can be. */
static int32_t run(const struct net_plan_config *c, int32_t n, bool early, struct net_plan_frame *f)
{
    int32_t made = 0;
    enum net_plan_result r = NET_PLAN_WANTS;

    net_plan_start(&plan, c);
    for (int32_t i = 0; i < n;) {
        if (net_plan_take(&plan, &vertex[i])) {
            i++;
            while (early && made < FRAMES && net_plan_next(&plan, &f[made]) == NET_PLAN_FRAME) {
                made++;
            }
            continue;
        }
        r = net_plan_next(&plan, &f[made]);
        CHECK_EQ(r, NET_PLAN_FRAME);
        if (r != NET_PLAN_FRAME || ++made == FRAMES) {
            return made;
        }
    }
    net_plan_end(&plan);
    while (made < FRAMES && (r = net_plan_next(&plan, &f[made])) == NET_PLAN_FRAME) {
        made++;
    }
    CHECK_EQ(r, NET_PLAN_OVER);
    return made;
}

static double place(const struct net_plan_frame *f, int32_t n, int32_t k, int axis)
{
    return k < 0 ? 0.0 : f[k < n ? k : n - 1].place[axis];
}

/* Differences of places are means of the derivatives, so the limits hold for them. */
static void check_limits(const struct net_plan_config *c, const struct net_plan_frame *f, int32_t n)
{
    const double t = 1e-9 * c->period_ns, rounding = 1e-6;
    double most[3][JOB_AXES] = { { 0.0 } };

    for (int32_t k = 0; k < n + 3; k++) {
        for (int i = 0; i < 3; i++) {
            const double p[4] = { place(f, n, k, i), place(f, n, k - 1, i), place(f, n, k - 2, i),
                                  place(f, n, k - 3, i) };
            const double v = (p[0] - p[1]) / t, a = (p[0] - 2 * p[1] + p[2]) / t / t;
            const double j = (p[0] - 3 * p[1] + 3 * p[2] - p[3]) / t / t / t;
            most[0][i] = fmax(most[0][i], fabs(v));
            most[1][i] = fmax(most[1][i], fabs(a));
            most[2][i] = fmax(most[2][i], fabs(j));
        }
    }
    for (int i = 0; i < 3; i++) {
        const double acc = c->axis[i].acc * (1.0 - RESERVE), jerk = JERK * (1.0 - RESERVE);
        CHECK(most[0][i] <= SPEED * (1.0 + rounding));
        CHECK(most[1][i] <= acc * (1.0 + rounding));
        CHECK(most[2][i] <= jerk * (1.0 + rounding));
        if (i < 2) {
            CHECK(most[1][i] > 0.97 * acc);
            CHECK(most[2][i] > 0.97 * jerk);
        }
    }
}

static void check_pulses(const struct net_plan_frame *f, int32_t n)
{
    int64_t sum[JOB_AXES] = { 0 };

    for (int32_t k = 0; k < n; k++) {
        for (int i = 0; i < JOB_AXES; i++) {
            sum[i] += f[k].job.command[i];
            CHECK(fabs((double)sum[i] - SCALE * f[k].place[i]) <= 0.5 + 1e-9);
        }
    }
    CHECK_EQ(sum[0], 40 * 800);
    CHECK_EQ(sum[1], 1 * 800);
    CHECK_EQ(sum[3], 0);
}

static void test_output_pen(void)
{
    const struct net_plan_config c = config_of(NET_PLAN_OUTPUT);
    const int32_t n = run(&c, draw(), false, frame[0]);
    int32_t lowered = 0, raised = 0, rest = 0;
    bool down = false;

    CHECK(n > 5000 && n < FRAMES);
    check_limits(&c, frame[0], n);
    check_pulses(frame[0], n);
    for (int32_t k = 0; k < n; k++) {
        const struct net_plan_frame *f = &frame[0][k];
        lowered += f->job.event == NET_PLAN_LOWER;
        raised += f->job.event == NET_PLAN_RAISE;
        down = f->job.event ? f->job.event == NET_PLAN_LOWER : down;
        rest = f->job.event ? 30 : rest;
        CHECK(f->step != NET_PLAN_DRAWS || down);
        CHECK(f->step != NET_PLAN_SLIDES || !down);
        CHECK_EQ(f->step == NET_PLAN_RESTS, rest > 0);
        rest -= rest > 0;
    }
    CHECK_EQ(lowered, 6);
    CHECK_EQ(raised, 7); /* at the begin, too */
    CHECK(!down);
    CHECK_EQ(plan.stops, 4);
    CHECK(sizeof plan < 1000000);
    int32_t at[4]; /* exactly at the corners, for the first time */
    for (int32_t k = 0; k < 4; k++) {
        for (at[k] = 0; at[k] < n; at[k]++) {
            const double *p = frame[0][at[k]].place, *q = vertex[3603 + k].point;
            if (hypot(p[0] - q[0], p[1] - q[1]) < 1e-9) {
                break;
            }
        }
        CHECK(at[k] < n);
    }
    /* From rest to rest at 80 mm/s: L / v + v / a + a / j, of Y and of X; the line twice. */
    const double a = (1.0 - RESERVE) * ACC, j = (1.0 - RESERVE) * JERK;
    const double y = 1e3 * (20.0 / 80.0 + 80.0 / (0.5 * a) + 0.5 * a / j);
    const double x = 1e3 * (20.0 / 80.0 + 80.0 / a + a / j);
    int32_t line = 0;
    for (int32_t k = 0; k < n; k++) {
        line += frame[0][k].step == NET_PLAN_DRAWS && fabs(frame[0][k].place[1] + 9.0) < 1e-9;
    }
    CHECK_NEAR(at[2] - at[1], y, 2.0);
    CHECK_NEAR(at[3] - at[2], x, 2.0);
    CHECK_NEAR(line, 2.0 * x, 4.0);
}

/* The pen's rest is the smallest whole number of periods that is not shorter, one at least. */
static void test_dwell(void)
{
    static const struct {
        double dwell;
        int32_t period_ns, rest;
    } CASES[] = { { 0.03, 1000000, 30 },
                  { 0.0301, 1000000, 31 },
                  { 0.0309999, 1000000, 31 },
                  { 0.0005, 1000000, 1 },
                  { 0.0, 1000000, 1 },
                  { 0.007, 2000000, 4 },
                  { 0.1, 300000, 334 },
                  /* 0.0105: the quotient is above 15 in double precision */
                  { 0.0105, 700000, 15 } };
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        struct net_plan_config c = config_of(NET_PLAN_OUTPUT);
        c.dwell = CASES[i].dwell;
        c.period_ns = CASES[i].period_ns;
        const int32_t n = run(&c, draw(), false, frame[0]);
        int32_t rests = 0, events = 0;
        for (int32_t k = 0; k < n; k++) {
            rests += frame[0][k].step == NET_PLAN_RESTS;
            events += frame[0][k].job.event != 0;
        }
        CHECK_EQ(events, 13);
        CHECK_EQ(rests, events * CASES[i].rest);
    }
}

static void test_pen_axis(void)
{
    const struct net_plan_config c = config_of(NET_PLAN_AXIS);
    const int32_t n = run(&c, draw(), false, frame[0]);

    check_limits(&c, frame[0], n);
    check_pulses(frame[0], n);
    for (int32_t k = 1; k < n; k++) {
        const double *p = frame[0][k].place, *q = frame[0][k - 1].place;
        const bool moves = hypot(p[0] - q[0], p[1] - q[1]) > 1e-9;
        CHECK_EQ(frame[0][k].job.event, 0);
        CHECK(frame[0][k].step != NET_PLAN_DRAWS || fabs(p[2] + 0.5) < 1e-9);
        CHECK(frame[0][k].step != NET_PLAN_SLIDES || !moves || fabs(p[2] - 2.0) < 1e-9);
    }
    CHECK_NEAR(frame[0][n - 1].place[2], 2.0, 1e-9);
}

/* When frames are taken makes no difference, but where the motion would wait for vertices. */
static void test_order_of_calls(void)
{
    const struct net_plan_config c = config_of(NET_PLAN_OUTPUT);
    const int32_t n = draw();
    const int32_t late = run(&c, n, false, frame[0]), early = run(&c, n, true, frame[1]);

    CHECK_EQ(late, early);
    for (int32_t k = 0; k < late; k++) {
        CHECK_EQ(memcmp(&frame[0][k].job, &frame[1][k].job, sizeof frame[0][k].job), 0);
    }
}

/* A crawl through sharp corners that comes to rest beyond the end of a plan, though not of what is
 * known by then: frames of 0.25 ms show 20 nm that were left out. */
static void test_rests_beyond_a_plan(void)
{
    static const double to[][2] = {
        { 34.0, 0.0 }, { -33.725, 4.175 }, { -33.875, 2.65 }, { -33.925, -1.925 }
    };
    struct net_plan_config c = config_of(NET_PLAN_OUTPUT);
    c.period_ns = 250000;
    c.tolerance = 0.911312;
    for (int i = 0; i < 2; i++) {
        c.axis[i] = (struct net_plan_axis){ 1000.0, 83.7941, 2316.9, 37535.5 };
    }
    for (int i = 0; i < 4; i++) {
        vertex[i] = (struct net_plan_vertex){ { to[i][0], to[i][1] },
                                              2.37185,
                                              i == 0 ? NET_PLAN_MOVE : NET_PLAN_DRAW };
    }
    const int32_t n = run(&c, 4, false, frame[0]);
    const double dt = 1e-9 * c.period_ns;
    CHECK(n > 100000 && n < FRAMES);
    for (int32_t k = 3; k < n; k++) {
        for (int i = 0; i < 2; i++) {
            const struct net_plan_frame *f = &frame[0][k];
            const double j =
                (f[0].place[i] - 3.0 * f[-1].place[i] + 3.0 * f[-2].place[i] - f[-3].place[i])
                / (dt * dt * dt);
            CHECK(fabs(j) < (1.0 - RESERVE) * 37535.5 + 50.0); /* places are rounded */
        }
    }
}

/* Where a line turns back on itself no curve has room: the motion rests there and goes on. */
static void test_line_that_turns_back(void)
{
    static const double to[] = { 5.0, 25.0, 10.0, 20.0, 30.0 };
    const struct net_plan_config c = config_of(NET_PLAN_OUTPUT);
    const double t = 1e-9 * c.period_ns, jerk = JERK * (1.0 - RESERVE);

    for (int i = 0; i < 5; i++) {
        vertex[i] = (struct net_plan_vertex){ { to[i], 5.0 },
                                              80.0,
                                              i == 0 ? NET_PLAN_MOVE : NET_PLAN_DRAW };
    }
    const int32_t n = run(&c, 5, false, frame[0]);
    CHECK_EQ(plan.stops, 2);
    CHECK_NEAR(place(frame[0], n, n, 0), 30.0, 1e-9);
    int turns = 0;
    for (int32_t k = 3; k < n; k++) {
        const double p[4] = { place(frame[0], n, k, 0), place(frame[0], n, k - 1, 0),
                              place(frame[0], n, k - 2, 0), place(frame[0], n, k - 3, 0) };
        CHECK(fabs(p[0] - 3 * p[1] + 3 * p[2] - p[3]) <= jerk * t * t * t * (1.0 + 1e-6));
        CHECK(frame[0][k].step != NET_PLAN_DRAWS || frame[0][k].place[1] == 5.0);
        if (turns < 2 && (p[0] - p[1]) * (to[turns + 1] - to[turns]) < 0.0) {
            turns++; /* within what a frame's rounding of the instant leaves out */
            CHECK_NEAR(p[1], to[turns], jerk * t * t * t);
        }
    }
    CHECK_EQ(turns, 2);
}

int main(void)
{
    test_output_pen();
    test_line_that_turns_back();
    test_dwell();
    test_rests_beyond_a_plan();
    test_pen_axis();
    test_order_of_calls();
    return check_result();
}
