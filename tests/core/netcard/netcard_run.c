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

/* A page of the job is damaged in the flash after it was stored, each of them once. Nothing of it
 * is played: the card says why and stands, and takes no start until the fault is cleared. */
static void damaged_pages_are_told(void)
{
    const struct netcard_config config = bench_config();

    bench_make(2000, 150, NULL, 0);
    for (uint32_t page = 0; page < bench_bytes / FLASH_PAGE; page++) {
        bench_start(&c, &config);
        uint8_t *stored = NULL;
        for (size_t at = 0; at < FLASH_BYTES && !stored; at += FLASH_PAGE) {
            if (!memcmp(c.flash.array + at, bench_job, FLASH_PAGE)) {
                stored = c.flash.array + at + page * FLASH_PAGE;
            }
        }
        CHECK(stored && !memcmp(stored, bench_job + page * FLASH_PAGE, FLASH_PAGE));
        stored[100] ^= 1;
        CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
        until(NET_FAULT, 3000);
        CHECK_EQ(c.error, NET_BAD_JOB);
        CHECK(page > 0 || bench_count(&c, 0) == 0);
        const int64_t stood = bench_count(&c, 0);
        bench_pass(&c, 50);
        CHECK_EQ(bench_count(&c, 0), stood);
        CHECK(bench_order(&c, CARD_DO_START) != NET_DONE);
    }
}

/* A job that is given up while frames are still to be read counts until run has left it: the FIFO
 * that stop empties is its least stock. One whose frames are all read counts no more. */
static void least_stock_of_a_stop(void)
{
    const struct netcard_config config = bench_config();

    bench_make(2000, 100, NULL, 0);
    for (int all = 0; all < 2; all++) {
        bench_start(&c, &config);
        CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
        bench_pass(&c, all ? 1800 : 700);
        CHECK_EQ(c.phase, all ? JOB_DRAINING : JOB_PLAYING);
        const int32_t before = c.least;
        CHECK(before > 0);
        CHECK_EQ(bench_order(&c, CARD_DO_STOP), NET_DONE);
        until(NET_READY, 300);
        bench_pass(&c, 1);
        CHECK_EQ(c.phase, JOB_NONE);
        CHECK_EQ(c.least, all ? before : 0);
    }
}

int main(void)
{
    least_stock_of_a_stop();
    damaged_pages_are_told();
    words_take_their_time();
    plays_to_its_end();
    pauses_leave_the_path();
    return check_result();
}
