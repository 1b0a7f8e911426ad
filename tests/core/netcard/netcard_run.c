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

/* A frame is five words on the bus to the FPGA: run's time grows by that, to the ns. */
static void words_take_their_time(void)
{
    int64_t busy[2];

    bench_make(2000, 100, NULL, 0);
    for (int i = 0; i < 2; i++) {
        struct netcard_config config = bench_config();
        config.settings.fsmc_word_ns += 300 * i;
        bench_start(&c, &config);
        CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
        until(NET_READY, 2100);
        busy[i] = kernel_busy(&c.kernel, NETCARD_RUN);
    }
    CHECK_EQ(busy[1] - busy[0], 2000 * 5 * 300);
    printf("run: %.0f ns a frame\n", (double)busy[0] / 2000);
}

int main(void)
{
    words_take_their_time();
    plays_to_its_end();
    pauses_leave_the_path();
    return check_result();
}
