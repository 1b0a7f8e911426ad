/* Homing over random starts, switches, directions and triggers: pulse by pulse. */
#include "check.h"

#include <stdlib.h>
#include <string.h>

#include "home_cycle.h"

/* An axis as it is: a switch on [from, to), limit switches outside (low, high), a pulse a step. */
struct axis {
    int64_t position, from, to, low, high;
};

static struct home_cycle h;
static struct home_cycle_config config;
static struct axis axis[CARD_AXES];
static struct home_cycle_input in;

static bool within(const struct axis *a)
{
    return a->position >= a->from && a->position < a->to;
}

static void see(void)
{
    in.origin = in.plus = in.minus = 0;
    for (int i = 0; i < CARD_AXES; i++) {
        const struct axis *a = &axis[i];
        const bool high = within(a) == home_cycle_on_level(config.axis[i].trigger);
        in.position[i] = a->position;
        in.origin |= (uint32_t)high << i;
        in.plus |= (uint32_t)(a->position >= a->high) << i;
        in.minus |= (uint32_t)(a->position <= a->low) << i;
    }
}

/* A frame goes out pulse by pulse; the count at which a switch comes on is kept. */
static void play(const struct frame *f)
{
    for (int i = 0; i < CARD_AXES; i++) {
        struct axis *a = &axis[i];
        for (int n = 0; n < abs(f->command[i]); n++) {
            const bool was = within(a);
            a->position += f->command[i] < 0 ? -1 : 1;
            if (within(a) && !was) {
                in.latched |= 1u << i;
                in.latch[i] = a->position;
            }
        }
    }
}

/* What the run shows. */
struct shown {
    int periods;
    int64_t begun[CARD_AXES], ended[CARD_AXES];
};

static long long steps;
static double quickest;

/* Run it, two frames on their way; speeds and accelerations are looked at in each period. Stopped
 * at a period; -1 never. */
static struct shown run(uint32_t mask, int stop)
{
    struct shown s = { 0 };
    struct frame way[2] = { { { 0 }, 0 }, { { 0 }, 0 } };
    double last[CARD_AXES] = { 0.0 };
    in = (struct home_cycle_input){ .plus = 0 };
    see();
    home_cycle_begin(&h, &config, mask, &in);
    for (int i = 0; i < CARD_AXES; i++) {
        s.begun[i] = -1;
    }
    while (h.state == HOME_CYCLE_RUNNING || h.state == HOME_CYCLE_STOPPING) {
        if (s.periods++ == stop) {
            home_cycle_stop(&h);
        }
        see();
        const struct frame f = home_cycle_step(&h, &in);
        in.latched = 0;
        for (int i = 0; i < CARD_AXES; i++) {
            const struct home_axis *a = &config.axis[i];
            const double t = config.period, v = h.axis[i].motion.speed, dv = fabs(v - last[i]),
                         acc = a->acc * t * t, start = a->start * t + 1e-12;
            CHECK(fabs(v) <= fmax(a->fast, a->slow) * t && fabs(f.command[i] - v) <= 1.0);
            /* up to the start speed it may start and stop at once */
            CHECK(dv <= acc * (1.0 + 1e-9) || (fabs(v) <= start && last[i] == 0.0)
                  || (fabs(last[i]) <= start && fabs(v) <= fabs(last[i]) && v * last[i] >= 0.0));
            quickest = fmax(quickest, dv > start ? dv / acc : 0.0);
            last[i] = v;
            const enum home_cycle_phase phase = h.axis[i].phase;
            if (phase != HOME_CYCLE_NONE && s.begun[i] < 0) {
                s.begun[i] = s.periods;
            }
            const int64_t left = h.axis[i].place - h.axis[i].motion.commanded;
            if (phase == HOME_CYCLE_OFFSET) { /* straight to its target */
                CHECK(left == 0 || (left > 0) == (f.command[i] > 0) || f.command[i] == 0);
            }
            s.ended[i] = f.command[i] != 0 ? s.periods : s.ended[i];
            CHECK(f.command[i] == 0 || phase != HOME_CYCLE_NONE);
        }
        play(&way[0]);
        way[0] = way[1];
        way[1] = f;
        steps++;
        if (s.periods > 200000) {
            CHECK(!"it ends");
            break;
        }
    }
    play(&way[0]);
    play(&way[1]);
    return s;
}

static void random_axis(uint64_t *seed, int i)
{
    struct home_axis *a = &config.axis[i];
    struct axis *x = &axis[i];
    *a = (struct home_axis){ .order = (int)check_random(seed, 1, 4),
                             .trigger = (enum card_trigger)check_random(seed, 0, 3),
                             .plus = check_random(seed, 0, 1),
                             .fast = check_real(seed, 5e3, 1e5),
                             .slow = check_real(seed, 100.0, 3e3),
                             .acc = check_real(seed, 2e5, 5e6),
                             .start = check_random(seed, 0, 1) ? check_real(seed, 0.0, 1e3) : 0.0,
                             .travel = 200000,
                             .offset = (int)check_random(seed, -500, 500) };
    /* A level is only seen once a period. */
    const int least = a->trigger >= CARD_HIGH ? (int)(a->fast * config.period) + 2 : 1;
    const int rest = (int)(a->fast * a->fast / (2.0 * a->acc) + 4.0 * a->fast * config.period) + 2;
    a->back = (int)check_random(seed, 1, 1000) + rest / 4;
    x->from = check_random(seed, -20000, 20000);
    x->to = x->from + check_random(seed, least, check_random(seed, 0, 1) ? 20 + least : 6000);
    x->low = x->from - 3 * rest - a->back - 1200 - check_random(seed, 0, 20000);
    x->high = x->to + 3 * rest + a->back + 1200 + check_random(seed, 0, 20000);
    x->position = check_random(seed, x->low + 1, x->high - 1);
}

static void any_start(void)
{
    uint64_t seed = 31;
    long long on = 0, turned = 0;
    for (int n = 0; n < 300 && !check_failures; n += CHECK_EACH) {
        config =
            (struct home_cycle_config){ .period = 1e-3, .settle = (int)check_random(&seed, 3, 30) };
        for (int i = 0; i < CARD_AXES; i++) {
            random_axis(&seed, i);
            on += within(&axis[i]);
        }
        config.axis[3].order = 0;
        const int64_t stands = axis[3].position;
        CHECK(home_cycle_valid(&config));
        const struct shown s = run(15, -1);
        CHECK_EQ(h.state, HOME_CYCLE_ENDED);
        CHECK_EQ(h.fault, HOME_CYCLE_OK);
        CHECK_EQ(axis[3].position, stands);
        for (int i = 0; i < 3; i++) {
            const struct home_axis *a = &config.axis[i];
            const int64_t edge = a->plus ? axis[i].from : axis[i].to - 1;
            const double seen =
                (double)(home_cycle_zero(&h, i) - a->offset - edge) * (a->plus ? 1.0 : -1.0);
            turned += h.axis[i].turned;
            if (a->trigger < CARD_HIGH) {
                CHECK_EQ(home_cycle_zero(&h, i), edge + a->offset); /* to the pulse */
            } else {
                CHECK(seen >= 0.0 && seen <= ceil(a->slow * config.period));
            }
            CHECK_EQ(axis[i].position, home_cycle_zero(&h, i));
            for (int k = 0; k < 3; k++) { /* orders one behind the other, equals together */
                CHECK(a->order >= config.axis[k].order || s.ended[i] < s.begun[k]);
                CHECK(a->order != config.axis[k].order || s.begun[i] == s.begun[k]);
            }
        }
    }
    printf("home: %lld periods, %lld starts on the switch, %lld axes turned at a limit, speed "
           "changes up to %.6f of the acceleration\n",
           steps, on, turned, quickest);
    CHECK(CHECK_EACH > 1 || (on > 50 && turned > 100));
}

static void plain(int i)
{
    config.axis[i] = (struct home_axis){ .order = 1,
                                         .trigger = CARD_RISING,
                                         .fast = 2e4,
                                         .slow = 1e3,
                                         .acc = 1e6,
                                         .back = 500,
                                         .travel = 100000 };
    axis[i] = (struct axis){ 10000, 0, 300, -20000, 20000 };
}

static void one_axis(void)
{
    config = (struct home_cycle_config){ .period = 1e-3, .settle = 5 };
    for (int i = 0; i < CARD_AXES; i++) {
        plain(i);
        config.axis[i].order = i == 1;
    }
}

static void faults(void)
{
    one_axis();
    axis[1].from = axis[1].to = 100000; /* no switch */
    run(15, -1);
    CHECK(h.state == HOME_CYCLE_FAILED && h.fault == HOME_CYCLE_NO_ORIGIN && h.fault_axis == 1);
    CHECK(axis[1].position > 20000 && axis[1].position < 20400); /* v^2 / 2a behind the limit */

    one_axis();
    axis[1].from = axis[1].to = 100000; /* nor limits */
    axis[1].low = -1000000;
    config.axis[1].travel = 30000;
    run(15, -1);
    CHECK(h.state == HOME_CYCLE_FAILED && h.fault == HOME_CYCLE_NO_ORIGIN);
    CHECK(axis[1].position < 10000 - 30000 && axis[1].position > 10000 - 30400);

    one_axis();
    axis[1] = (struct axis){ 10000, -1000000, 1000000, -20000, 1000000 };
    run(15, -1); /* always on */
    CHECK(h.state == HOME_CYCLE_FAILED && h.fault == HOME_CYCLE_STUCK);

    one_axis();
    axis[1].to = axis[1].high + 1000; /* on as far as the limit */
    run(15, -1);
    CHECK(h.state == HOME_CYCLE_FAILED && h.fault == HOME_CYCLE_LIMIT);

    one_axis();
    axis[1].low = 100; /* the limit behind the edge, met at speed */
    config.axis[1].offset = -400;
    run(15, -1);
    CHECK(h.state == HOME_CYCLE_FAILED && h.fault == HOME_CYCLE_LIMIT);

    one_axis();
    run(13, -1); /* a mask without it: nothing to do */
    CHECK(h.state == HOME_CYCLE_ENDED && axis[1].position == 10000);

    one_axis();
    config.axis[1].trigger = (enum card_trigger)4;
    CHECK(!home_cycle_valid(&config));
    one_axis();
    config.axis[1].fast = 4e7;
    CHECK(!home_cycle_valid(&config));
    one_axis();
    config.axis[1].acc = NAN;
    CHECK(!home_cycle_valid(&config));
}

/* A switch that is on again before the slow approach: its edge cannot be found. */
static void on_again(enum card_trigger trigger)
{
    one_axis();
    config.axis[1].trigger = trigger;
    in = (struct home_cycle_input){ .origin = home_cycle_on_level(trigger) ? 2 : 0 };
    home_cycle_begin(&h, &config, 2, &in);
    CHECK_EQ(h.axis[1].phase, HOME_CYCLE_BACK);
    for (int n = 0; n < 5000 && h.state != HOME_CYCLE_FAILED; n++) {
        const bool on = n < 10 || h.axis[1].phase == HOME_CYCLE_EDGE;
        in.origin = on == home_cycle_on_level(trigger) ? 2 : 0;
        home_cycle_step(&h, &in);
    }
    CHECK(h.state == HOME_CYCLE_FAILED && h.fault == HOME_CYCLE_STUCK);
    CHECK_EQ(h.axis[1].phase, HOME_CYCLE_EDGE);
}

/* Stopped at any period: at rest within v^2 / 2a and what is on its way. */
static void stopped(void)
{
    for (int at = 0; at < 1400; at += 7 * CHECK_EACH) {
        one_axis();
        run(15, at);
        if (h.state == HOME_CYCLE_ENDED) {
            CHECK(at > 500);
            continue;
        }
        CHECK(h.state == HOME_CYCLE_STOPPED && h.fault == HOME_CYCLE_OK);
        CHECK_EQ(axis[1].position, h.axis[1].motion.commanded);
        CHECK_EQ(h.axis[1].motion.speed, 0.0);
    }
}

int main(void)
{
    any_start();
    faults();
    on_again(CARD_RISING);
    on_again(CARD_LOW);
    stopped();
    return check_result();
}
