/* A job runs from flash to pulses: to its end, with pauses, stops, faults between. */
#include "card_bench.h"

static struct netcard c;

static void until(enum net_state state, int64_t ms)
{
    for (int64_t i = 0; i < ms && c.state != state; i++) {
        bench_pass(&c, 1);
    }
    CHECK_EQ(c.state, state);
}

static void plays_to_its_end(void)
{
    const struct netcard_config config = bench_config();

    bench_make(2000, 100, NULL, 0);
    bench_start(&c, &config);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    until(NET_READY, 2100);
    CHECK_EQ(bench_count(&c, 0), bench_end[0]);
    CHECK_EQ(bench_count(&c, 1), bench_end[1]);
    CHECK_EQ(c.player.dry, 0);
    CHECK(c.least >= 250);
    bench_times(&c);
    printf("least stock %d frames, busy %.3f %%\n", (int)c.least,
           100.0 - 100.0 * (double)kernel_idle(&c.kernel) / (double)c.now);
}

static void pauses_leave_the_path(void)
{
    const struct netcard_config config = bench_config();

    bench_make(2000, 100, NULL, 0);
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    for (int i = 0; i < 5; i++) {
        bench_pass(&c, 100 + 77 * i);
        CHECK_EQ(bench_order(&c, CARD_DO_PAUSE), NET_DONE);
        until(NET_PAUSED, 200);
        const int64_t at = bench_count(&c, 0);
        bench_pass(&c, 50);
        CHECK_EQ(bench_count(&c, 0), at);
        CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    }
    until(NET_READY, 2500);
    CHECK_EQ(bench_count(&c, 0), bench_end[0]);
    CHECK_EQ(bench_count(&c, 1), bench_end[1]);
    CHECK_EQ(c.player.dry, 0);
    CHECK_EQ(c.jobs, 1);
    bench_times(&c);
}

int main(void)
{
    plays_to_its_end();
    pauses_leave_the_path();
    return check_result();
}
