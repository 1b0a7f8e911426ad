/* Port interrupt: cycles of every path as in the README's table, and no edge unaccounted for. */
#include "check.h"
#include "msp430.h"
#include "port.h"

#include <math.h>
#include <stdlib.h>

struct path {
    bool line_b, high, a, b;
    int step;
    int cleared[2], end[2];
};

/* Lines are the scale's, before the inverters; clocks count from the acceptance. */
static void paths(void)
{
    static const struct path PATHS[] = {
        /* line that changes, to what; lines A, B then; step; cleared, end: all and one */
        { false, false, false, true, +1, { 31, 16 }, { 36, 36 } },  /* A up, PGB = 0 */
        { false, false, false, false, -1, { 33, 16 }, { 38, 38 } }, /* A up, PGB = 1 */
        { false, true, true, true, -1, { 37, 22 }, { 42, 42 } },    /* A down, PGB = 0 */
        { false, true, true, false, +1, { 39, 22 }, { 44, 44 } },   /* A down, PGB = 1 */
        { true, false, true, false, -1, { 43, 30 }, { 48, 49 } },   /* B up, PGA = 0 */
        { true, false, false, false, +1, { 45, 30 }, { 50, 51 } },  /* B up, PGA = 1 */
        { true, true, true, true, +1, { 50, 37 }, { 55, 56 } },     /* B down, PGA = 0 */
        { true, true, false, true, -1, { 50, 37 }, { 55, 56 } },    /* B down, PGA = 1 */
    };
    for (int i = 0; i < 8; i++)
        for (int one = 0; one < 2; one++) {
            const struct path *w = &PATHS[i];
            struct port p = { .clear = (enum port_clear)one };
            port_edge(&p, w->line_b, w->high, w->step);
            int clock = port_begin(&p), cleared = 0, cycles;
            while ((cycles = port_go(&p, w->a, w->b)) > 0) {
                if (!p.flags && !cleared)
                    cleared = clock;
                clock += cycles;
            }
            CHECK_EQ(cleared, w->cleared[one]);
            CHECK_EQ(clock, w->end[one]);
            CHECK_EQ((int16_t)p.counter, w->step);
            CHECK_EQ((int16_t)p.counter_2, w->step);
            CHECK_EQ(p.lost + p.turned, 0);
        }
}

static void home_path(void)
{
    for (int one = 0; one < 2; one++) {
        struct port p = { .clear = (enum port_clear)one, .counter = 77, .counter_2 = 77 };
        port_home(&p);
        int clock = port_begin(&p), cycles;
        while ((cycles = port_go(&p, false, false)) > 0)
            clock += cycles;
        CHECK_EQ(clock, 6 + 6 + 6 + 7 + 7 + 6 + 4 + 4 + 5 + 4);
        CHECK_EQ(p.counter, 0);
        CHECK_EQ(p.counter_2, 77);
        CHECK_EQ(p.zeroed, 1);
        port_home(&p);
        port_home(&p);
        CHECK_EQ(p.home_lost, 1);
    }
}

/* Every edge is counted, lost or waits, and a wrong count is a turned or a lost one. */
static void accounts(void)
{
    uint64_t seed = 21;
    int lost = 0, turned = 0;
    for (int i = 0; i < 200; i++) {
        const struct msp430_config c = {
            .sequence = { .acceleration = 1, .home_way = 1, .error_limit = 1 },
            .clear = i % 2,
            .pwm = { .period = 800, .tau = 100.0, .high = 2.5, .gain = 8.0, .limit = 10.0 },
            .timer_period = 1000 + i,
            .timer_cycles = 300,
        };
        struct msp430 m;
        msp430_reset(&m, &c);
        const struct msp430_pins pins = { 0 };
        double phase = 0.1;
        int64_t clock = 0, passed = 0, before = 0;
        for (int k = 0; k < 300; k++, clock += 200) {
            /* At most 20 edges in 200 clocks; none in the last pieces. */
            const double step = 0.01 * (double)check_random(&seed, -50, 50) * (i % 10);
            CHECK_EQ(msp430_sample(&m, phase, &pins, clock), QUADRATURE_OK);
            passed += llabs(quadrature_edges(&m.scale) - before);
            before = quadrature_edges(&m.scale);
            phase += k < 290 ? step : 0.0;
        }
        CHECK(m.routine != MSP430_PORT);
        CHECK_EQ(m.port.flags, 0);
        CHECK_EQ(m.port.served + m.port.lost, passed);
        CHECK((m.port.lost + m.port.turned > 0) || (int16_t)m.port.counter == before);
        CHECK_EQ(m.port.counter, m.port.counter_2);
        lost += m.port.lost;
        turned += m.port.turned;
    }
    CHECK(lost > 1000 && turned > 1000);
}

int main(void)
{
    paths();
    home_path();
    accounts();
    return check_result();
}
