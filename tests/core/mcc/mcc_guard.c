/* Decisions that protect the machine: extent of paths, limits of travel, switches, pulses, error
 * counters. */
#include "guard.h"
#include "mcc_check.h"

static const double TAU = 6.283185307179586;

/* A random arc in any plane: up to two turns and a half, with the rounding a program brings. */
static struct path random_arc(uint64_t *seed, int i)
{
    struct path p;
    double a[AXES] = { 0.0 }, b[AXES] = { 0.0 }, centre[2], miss;
    const enum path_plane plane = (enum path_plane)(i % 3);
    const double r = check_real(seed, 0.1, 80.0), at = check_real(seed, 0.0, TAU);
    const double to = check_real(seed, 0.0, TAU), grown = r + check_real(seed, -1e-3, 1e-3) * r;

    centre[0] = check_real(seed, -50.0, 50.0);
    centre[1] = check_real(seed, -50.0, 50.0);
    a[path_first(plane)] = centre[0] + r * cos(at);
    a[path_second(plane)] = centre[1] + r * sin(at);
    b[path_first(plane)] = centre[0] + grown * cos(to);
    b[path_second(plane)] = centre[1] + grown * sin(to);
    b[plane] = check_real(seed, -5.0, 5.0);
    b[4] = check_real(seed, -5.0, 5.0);
    CHECK_EQ(path_arc(&p, plane, a, b, centre, i & 8, 1 + i % 2, &miss), PATH_OK);
    return p;
}

/* The exact extent against many points of the way: none outside, some within the chord's height. */
static void extent_is_exact(void)
{
    enum { PIECES = 4000 };
    uint64_t seed = 3;
    for (int i = 0; i < 400; i++) {
        const struct path p = random_arc(&seed, i);
        double from = check_real(&seed, 0.0, p.length), to = check_real(&seed, from, p.length);
        if (i % 4 == 0) {
            from = 0.0;
            to = p.length;
        }
        double low[AXES], high[AXES], at[AXES], slope[AXES];
        for (int s = 0; s <= PIECES; s++) {
            path_at(&p, from + (to - from) * s / PIECES, at, slope);
            for (int k = 0; k < AXES; k++) {
                low[k] = s == 0 ? at[k] : fmin(low[k], at[k]);
                high[k] = s == 0 ? at[k] : fmax(high[k], at[k]);
            }
        }
        const double step = fabs(p.sweep) / PIECES, chord = p.radius * step * step / 4.0;
        for (int k = 0; k < AXES; k++) {
            double a, b;
            path_extent(&p, k, from, to, &a, &b);
            CHECK(a <= low[k] + 1e-12 && a >= low[k] - chord - 1e-9);
            CHECK(b >= high[k] - 1e-12 && b <= high[k] + chord + 1e-9);
        }
    }
}

/* Many turns of a growing spiral: the last ones reach furthest. */
static void extent_of_turns(void)
{
    const double a[AXES] = { 100.0 }, b[AXES] = { 100.1 }, centre[2] = { 0.0, 0.0 };
    struct path p;
    double miss, low, high;
    CHECK_EQ(path_arc(&p, PATH_XY, a, b, centre, true, 50, &miss), PATH_OK);
    path_extent(&p, 0, 0.0, p.length, &low, &high);
    CHECK_NEAR(high, 100.1, 1e-12);
    CHECK_NEAR(low, -100.1 + 0.001, 1e-6); /* half a turn before the end */
    path_extent(&p, 1, 0.0, p.length, &low, &high);
    CHECK_NEAR(high, 100.1 - 0.0015, 1e-6);
    CHECK_NEAR(low, -100.1 + 0.0005, 1e-6);
}

static struct machine limited(double low, double high)
{
    struct machine m = mcc_machine();
    m.axis[0].check_ot = true;
    m.axis[0].high_limit = high + 2.0;
    m.axis[0].low_limit = low - 1.0;
    m.axis[0].hot_offset = 2.0;
    m.axis[0].lot_offset = -1.0; /* its sign does not matter */
    return m;
}

static struct path line_x(double from, double to)
{
    const double a[AXES] = { from }, b[AXES] = { to, 3.0 };
    struct path p;
    path_line(&p, a, b);
    return p;
}

/* What a command along the path would be. */
static enum command_status judged(const struct machine *m, const struct path *p,
                                  struct command_refusal *r)
{
    const struct mechanism machine = machine_mechanism(m);
    const struct motion_limits l = machine_limits(m);
    struct command c = { .path = *p };
    return command_move(&c, &machine, &l, COMMAND_LINE, 1.0, r);
}

static int travelled(const struct machine *m, const int32_t from[AXES], const int32_t to[AXES])
{
    const struct mechanism machine = machine_mechanism(m);
    return mechanism_outside(&machine, from, to);
}

static int reached(const struct machine *m, const int32_t from[AXES], const double low[AXES],
                   const double high[AXES])
{
    const struct mechanism machine = machine_mechanism(m);
    double at[AXES];
    int side;
    for (int i = 0; i < AXES; i++) {
        at[i] = from[i];
    }
    return mechanism_beyond(&machine, at, low, high, &side);
}

static bool bounded(const struct machine *m)
{
    const struct mechanism machine = machine_mechanism(m);
    return mechanism_bounded(&machine);
}

static void lines(void)
{
    const struct machine m = limited(-10.0, 20.0);
    struct command_refusal r;
    struct path p = line_x(0.0, 20.0004); /* less than half a pulse of 1 um */
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OK);
    p = line_x(0.0, 20.0006);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OUTSIDE);
    CHECK_EQ(r.joint, 0);
    CHECK_NEAR(r.value, 20.0006, 0.0);
    CHECK_NEAR(r.limit, 20.0, 1e-15);
    p = line_x(0.0, -10.001);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OUTSIDE);
    CHECK_NEAR(r.value, -10.001, 0.0);
    CHECK_NEAR(r.limit, -10.0, 1e-15);
    p = line_x(25.0, 22.0); /* on the way back */
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OK);
    p = line_x(25.0, 25.001);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OUTSIDE);
    p = line_x(25.0, -10.0);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OK);
    p = line_x(25.0, -10.001);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OUTSIDE);
    p = line_x(-15.0, -12.0); /* and at the other end */
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OK);
    p = line_x(-15.0, -15.001);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OUTSIDE);
    p = line_x(-15.0, 20.0);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OK);
    p = line_x(-15.0, 20.001);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OUTSIDE);
    CHECK(bounded(&m));
    const struct machine off = mcc_machine();
    CHECK_EQ(judged(&off, &p, &r), COMMAND_OK);
    CHECK(!bounded(&off));
}

/* An arc over the top touches the limit with its extent; its circle is far beyond below. */
static void arcs(void)
{
    const double a[AXES] = { 3.0, -4.0 }, b[AXES] = { 3.0, 4.0 }, centre[2] = { 0.0, 0.0 };
    struct path p;
    struct command_refusal r;
    double miss;
    CHECK_EQ(path_arc(&p, PATH_XY, a, b, centre, true, 1, &miss), PATH_OK);
    struct machine m = limited(2.999, 5.0);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OK);
    m = limited(2.999, 4.999);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OUTSIDE);
    CHECK_NEAR(r.value, 5.0, 1e-12);
    CHECK_EQ(path_arc(&p, PATH_XY, a, b, centre, false, 1, &miss), PATH_OK);
    m = limited(-4.999, 5.0);
    CHECK_EQ(judged(&m, &p, &r), COMMAND_OUTSIDE);
    CHECK_NEAR(r.value, -5.0, 1e-12);
}

static void travel(void)
{
    const struct machine m = limited(-10.0, 20.0);
    const int32_t in[AXES] = { 19990, 900000 }, on[AXES] = { 20000 }, out[AXES] = { 20001 };
    const int32_t further[AXES] = { 20002 };
    CHECK_EQ(travelled(&m, in, on), -1);
    CHECK_EQ(travelled(&m, on, out), 0);
    CHECK_EQ(travelled(&m, out, further), 0);
    CHECK_EQ(travelled(&m, further, out), -1);
    CHECK_EQ(travelled(&m, further, further), -1);
    const double low[AXES] = { -10.001 }, high[AXES] = { 20.0 };
    CHECK_EQ(reached(&m, in, high, high), -1);
    CHECK_EQ(reached(&m, in, low, high), 0);
}

/* Every mode, both switches, both directions. */
static void switches(void)
{
    const double up[AXES] = { 0, 0, 1e-6 }, down[AXES] = { 0, 0, -1e-6 }, none[AXES] = { 0 };
    struct machine m = mcc_machine();
    const struct signals upper = { .upper = 4 }, lower = { .lower = 4 }, other = { .upper = 3 };
    CHECK_EQ(guard_switch(&m, &upper, up), -1); /* not looked at */
    m.limit_check = true;
    for (int mode = 0; mode < 4; mode++) {
        const int both = mode % 2 == 0 ? 2 : -1;
        m.limit_mode = mode;
        CHECK_EQ(guard_switch(&m, &upper, up), 2);
        CHECK_EQ(guard_switch(&m, &lower, down), 2);
        CHECK_EQ(guard_switch(&m, &upper, down), both);
        CHECK_EQ(guard_switch(&m, &lower, up), both);
        CHECK_EQ(guard_switch(&m, &upper, none), -1);
        CHECK_EQ(guard_switch(&m, &other, up), -1);
        CHECK_EQ(guard_switch_error(&m), mode >= 2);
    }
    m.axis[2].used = false;
    CHECK_EQ(guard_switch(&m, &upper, up), -1);
}

static void numbers(void)
{
    struct machine m = mcc_machine();
    struct signals s = { .err = { 0, -51, 20 } };
    const int32_t a[AXES] = { 0, -40 }, b[AXES] = { 0, 61 };
    for (int i = 0; i < AXES; i++) {
        m.axis[i].max_dda_acc = 101;
    }
    CHECK_EQ(guard_change(&m, a, b), -1);
    m.axis[1].max_dda_acc = 100;
    CHECK_EQ(guard_change(&m, a, b), 1);
    CHECK_EQ(guard_change(&m, b, a), 1);
    CHECK_EQ(guard_track(&m, &s), -1);
    m.axis[1].track_limit = 51;
    CHECK_EQ(guard_track(&m, &s), -1);
    m.axis[1].track_limit = 50;
    CHECK_EQ(guard_track(&m, &s), 1);
    CHECK_EQ(guard_watched(&m), 0);
    m.axis[1].in_pos = m.axis[2].in_pos = m.axis[5].in_pos = true;
    CHECK_EQ(guard_watched(&m), 6); /* W is not used */
    m.axis[1].inpos_tol = 0.050;    /* 50 counts */
    m.axis[2].inpos_tol = 0.020;
    CHECK_EQ(guard_within(&m, &s), 5);
    s.err[1] = 50;
    CHECK_EQ(guard_within(&m, &s), 7);
}

int main(void)
{
    extent_is_exact();
    extent_of_turns();
    lines();
    arcs();
    travel();
    switches();
    numbers();
    return check_result();
}
