/* fmi_any_step - tests of communication steps of any size: the time inside the FMU must be that of
 * formulas that are independent of the layer's. Included by fmi_cases.h. */
#ifndef FMI_ANY_STEP_H
#define FMI_ANY_STEP_H

static const double TICK = FMU_TICK_NS * 1e-9; /* [s] */

static int64_t inside(const void *c)
{
    return ((const struct fmi_instance *)c)->f.s.now;
}

static void *make_strict(double start)
{
    void *c = make();
    ((struct fmi_instance *)c)->f.s.v.strict_step = true;
    CHECK(call_enter(c, start, -1.0) == 0 && call_exit(c) == 0);
    return c;
}

/* Ways in which importers compute communication points: k h; t + h; and both with the difference of
 * two points as the step size. */
enum master { MULTIPLIES, ADDS, SUBTRACTS, ADDS_AND_SUBTRACTS, MASTERS };

struct clock {
    double start, size, t;
    int64_t k;
};

static double clock_step(struct clock *m, enum master kind)
{
    const double next = m->start + (double)(m->k + 1) * m->size, sum = m->t + m->size;
    return kind == SUBTRACTS ? next - m->t : kind == ADDS_AND_SUBTRACTS ? sum - m->t : m->size;
}

static void clock_go(struct clock *m, enum master kind)
{
    m->k++;
    const bool adds = kind == ADDS || kind == ADDS_AND_SUBTRACTS;
    m->t = adds ? m->t + m->size : m->start + (double)m->k * m->size;
}

/* At every point the time inside is the nearest tick, and the model was stepped to it. */
static void check_near(double start, double size, int64_t count, enum master kind)
{
    void *c = make_running(start, -1.0);
    struct clock m = { start, size, start, 0 };
    int64_t before = 0;
    for (int64_t i = 0; i < count; i++) {
        if (call_step(c, m.t, clock_step(&m, kind)) != 0) {
            CHECK(!"a step is refused");
            break;
        }
        clock_go(&m, kind);
        const double off = (m.t - start) / TICK - (double)inside(c) / FMU_TICK_NS;
        const double rounding = 8.0 * DBL_EPSILON * (fabs(start) + fabs(m.t)) / TICK;
        if (fabs(off) > 0.5 + rounding || inside(c) < before || inside(c) % FMU_TICK_NS != 0) {
            printf("start %g, size %.17g, master %d, step %d: %g ticks off\n", start, size, kind,
                   (int)i, off);
            CHECK(!"the time inside is not the nearest tick");
            break;
        }
        before = inside(c);
    }
    CHECK(fabs(y_of(c) - 2.0 - 2.0 * (double)before) <= 1e-6 * (double)before);
    call_free(c);
}

static void test_every_step_ends_at_the_nearest_tick(void)
{
    const double sizes[] = {
        1e-3 / 3.0,
        1e-7 + 1e-12,
        1e-7 + 1e-15,
        1.4142135623730951e-5,
        3.141592653589793e-9,
        12.5e-9,
        1e-4 - 2e-11,
        12.4e-9,
        0.7e-9,
        37.5e-9,
        1.0 / 44100.0,
        1.0 / 60.0,
    };
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        for (int kind = 0; kind < MASTERS; kind++) {
            check_near(0.0, sizes[i], 20000, kind);
            check_near(1000.0, sizes[i], 20000, kind);
            check_near(-0.1, sizes[i], 20000, kind);
        }
    }
    check_near(0.0, 1e-3 / 3.0, 10800000, ADDS); /* an hour */
    for (int kind = 0; kind < MASTERS; kind++) { /* a step with two digits more than a tick has */
        check_near(1000.0, 1e-7 + 5e-13, 1000000, kind);
    }
}

/* Random steps, whole numbers of ticks and others: the time inside is always the nearest tick, and
 * at points on a tick exactly that, so a source has the same value there as with any other
 * steps. */
static void test_steps_at_random(void)
{
    void *c = make_running(0.0, -1.0);
    unsigned random = 1; /* as above */
    double t = 0.0;
    for (int64_t i = 1; i <= 100000; i++) {
        const double whole = (double)i * 1e-5; /* a common point each 10 us */
        for (int k = 0; k < 3; k++) {
            random = random * 1103515245u + 12345u;
            const double share = (double)(random >> 8) / 0x1p24;
            const double h = k < 2 ? share * (whole - t) : whole - t;
            if (h > 0.0) {
                CHECK(call_step(c, t, k == 1 ? round(h / TICK) * TICK + 1e-21 : h) == 0);
                t += k == 1 ? round(h / TICK) * TICK + 1e-21 : h;
                CHECK(fabs(t / TICK - (double)inside(c) / FMU_TICK_NS) <= 0.5 + 1e-6);
            }
        }
        t = whole;
        if (inside(c) != 10000 * i) {
            CHECK(!"another tick at a common point");
            break;
        }
    }
    call_free(c);
}

/* Steps of whole ticks count as those ticks, however far the importer's sum has drifted. After a
 * step of 0.4 ticks they keep that offset, and the rest of the tick removes it. */
static void check_whole(double start, enum master kind)
{
    void *c = make_running(start, -1.0);
    CHECK(call_step(c, start, 0.4 * TICK) == 0 && inside(c) == 0);
    const double begin = start + 0.4 * TICK;
    struct clock m = { begin, 1e-4, begin, 0 };
    for (int i = 1; i <= 4000000; i++) {
        if (call_step(c, m.t, clock_step(&m, kind)) != 0 || inside(c) != INT64_C(100000) * i) {
            CHECK(!"a whole step is other ticks");
            break;
        }
        clock_go(&m, kind);
    }
    CHECK(kind == MULTIPLIES || kind == SUBTRACTS || fabs(m.t - begin - 400.0) > TICK);
    void *other = make(), *state = NULL;
    CHECK(call_get_state(c, &state) == 0 && call_set_state(other, state) == 0);
    CHECK(call_step(c, m.t, 0.6 * TICK) == 0 && call_step(other, m.t, 0.6 * TICK) == 0);
    CHECK(inside(c) == INT64_C(400000000000) + FMU_TICK_NS && inside(other) == inside(c));
    call_free_state(c, &state);
    call_free(c);
    call_free(other);
}

static void test_whole_ticks_stay_whole(void)
{
    for (int kind = 0; kind < MASTERS; kind++) {
        check_whole(0.0, kind);
        check_whole(5.0, kind);
    }
}

/* Steps below half a tick: the time inside stands, the model is not called, and the remainders are
 * not lost. */
static void test_a_step_below_half_a_tick(void)
{
    void *c = make_running(1.0, -1.0);
    double y = 0.0;
    for (int i = 0; i < 8; i++) { /* 0.29, 0.58, 0.87 ... 2.32 ticks */
        static const int ticks[8] = { 0, 1, 1, 1, 1, 2, 2, 2 };
        CHECK(call_step(c, 1.0 + 0.29 * i * TICK, 0.29 * TICK) == 0);
        CHECK(inside(c) == ticks[i] * FMU_TICK_NS);
        CHECK(y_of(c) == 2.0 + 2.0 * (double)inside(c) && y_of(c) >= y);
        y = y_of(c);
    }
    CHECK(call_step(c, 1.0 + 2.32 * TICK, 1e-300) == 0 && inside(c) == 2 * FMU_TICK_NS);
    CHECK_REFUSED(call_step(c, 1.0 + 3.0 * TICK, 1e-3), "is not where the previous step ended");
    CHECK(call_step(c, 1.0 + 2.32 * TICK, 0.68 * TICK) == 0 && inside(c) == 3 * FMU_TICK_NS);
    call_free(c);
}

/* The time that an FMU reports is the importer's between ticks, and exactly that of the tick on
 * one. */
static void test_the_time_that_is_told(void)
{
    void *c = make_running(0.0, -1.0);
    CHECK(call_step(c, 0.0, 0.1) == 0 && call_step(c, 0.1, 0.2) == 0);
    CHECK(call_last(c) == 0.3 && 0.1 + 0.2 > 0.3);
    CHECK(call_step(c, 0.1 + 0.2, 1e-3 / 3.0) == 0 && call_last(c) == 0.1 + 0.2 + 1e-3 / 3.0);
    call_free(c);
}

/* The remainder of a tick is part of an FMU state, also of a serialized one. */
static void test_a_state_between_ticks(void)
{
    const double h = 1e-3 / 3.0;
    void *c = make_running(0.0, -1.0), *other = make(), *state = NULL, *copy = NULL;
    char bytes[4096];
    int64_t seen[50];
    for (int i = 0; i < 100; i++) {
        if (i == 50) {
            CHECK(call_get_state(c, &state) == 0);
        }
        CHECK(call_step(c, i * h, h) == 0);
        seen[i % 50] = inside(c);
    }
    const size_t size = call_state_size(c, state);
    CHECK(size <= sizeof bytes && call_serialize(c, state, bytes, size) == 0);
    CHECK(call_deserialize(other, bytes, size, &copy) == 0 && call_set_state(other, copy) == 0);
    CHECK(call_set_state(c, state) == 0 && call_last(c) == call_last(other));
    for (int i = 50; i < 100; i++) {
        CHECK(call_step(c, i * h, h) == 0 && call_step(other, i * h, h) == 0);
        CHECK(inside(c) == seen[i - 50] && inside(other) == seen[i - 50]);
    }
    call_free_state(c, &state);
    call_free_state(c, &copy);
    call_free(c);
    call_free(other);
}

static void test_strict_steps(void)
{
    void *c = make_strict(10.0);
    const double bad[] = { 0.0, -1e-3, 1e-9, 12e-9, 1e-3 + 1e-9, 1e-3 / 3.0, NAN, INFINITY };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        CHECK_REFUSED(call_step(c, 10.0, bad[i]), "s is not a positive whole multiple of 25 ns");
    }
    CHECK_REFUSED(call_step(c, 10.0 + 0.3 * TICK, 1e-3), "is not where");
    CHECK(y_of(c) == 2.0 && call_step(c, 10.0, 1e-3 + 1e-12) == 0 && inside(c) == 1000000);
    void *state = NULL, *copy = NULL;
    char bytes[4096];
    for (int i = 1; i < 10000; i++) { /* a step with an error in its last decimal digits */
        CHECK(call_step(c, 10.0 + i * (1e-3 + 1e-12), 1e-3 + 1e-12) == 0);
    }
    CHECK(inside(c) == INT64_C(10000000000) && call_get_state(c, &state) == 0);
    const size_t size = call_state_size(c, state);
    CHECK(call_serialize(c, state, bytes, size) == 0);
    CHECK(call_deserialize(c, bytes, size, &copy) == 0);
    call_free_state(c, &state);
    call_free_state(c, &copy);
    call_free(c);
}

/* A step that ends half a tick after the stop time is allowed. */
static void test_any_step_and_the_stop_time(void)
{
    const double h = 1e-3 / 3.0;
    void *c = make_running(0.0, 2.0 * h);
    CHECK(call_step(c, 0.0, h) == 0);
    CHECK_REFUSED(call_step(c, h, h + 0.6 * TICK), "passes stopTime");
    CHECK(call_step(c, h, h) == 0 && inside(c) == 666675);
    call_free(c);
}

/* A reset clears the drift of the importer's time. */
static void test_reset_forgets_the_drift(void)
{
    void *c = make_strict(0.0);
    const double h = 1e-3 + 1e-12;
    double t = 0.0;
    for (int i = 0; i < 20000; i++, t += h) { /* 0.8 ticks in all */
        CHECK(call_step(c, t, h) == 0);
    }
    CHECK(inside(c) == INT64_C(20000000000) && call_reset(c) == 0);
    CHECK(call_enter(c, 0.0, -1.0) == 0 && call_exit(c) == 0);
    CHECK(call_step(c, 0.0, 0.6 * TICK) == 0 && inside(c) == FMU_TICK_NS);
    CHECK(call_step(c, 0.6 * TICK, 0.6 * TICK) == 0 && inside(c) == FMU_TICK_NS);
    call_free(c);
}

static void test_any_step(void)
{
    test_every_step_ends_at_the_nearest_tick();
    test_steps_at_random();
    test_whole_ticks_stay_whole();
    test_a_step_below_half_a_tick();
    test_the_time_that_is_told();
    test_a_state_between_ticks();
    test_strict_steps();
    test_any_step_and_the_stop_time();
    test_reset_forgets_the_drift();
}

#endif
