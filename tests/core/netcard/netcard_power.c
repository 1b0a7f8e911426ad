/* The power of the card goes in each operation of its flash while a job comes over the link: behind
 * it the old job is there or the new one, whole, and the upload goes on by itself to its end. */
#include "card_cable.h"

enum { STEP = 200000, LINE = 2500, SHARES = 3 }; /* [ns], [byte] of a step at 100 Mbit/s */

static struct netcard first;
static struct net_host first_host;
static uint8_t old[BENCH_JOB], new[BENCH_JOB];
static uint32_t old_bytes, new_bytes;

static void pass(void)
{
    cable_plug(netcard_wants_connection(&c) && net_host_accepts(&host));
    if (linked) {
        cable_up(new, LINE);
        cable_down(LINE);
    }
    netcard_advance(&c, c.now + STEP);
}

static uint32_t operations(void)
{
    return c.flash.programs + c.flash.sector_erases + c.flash.block_erases;
}

/* The job in force: 1 the new one, 0 the old one, -1 none or neither. */
static int which(void)
{
    const int32_t slot = c.store.job.slot;
    const uint8_t *at = c.flash.array + FLASH_BYTES / 2 * (slot > 0);

    return slot < 0 ? -1 : !memcmp(at, new, new_bytes) ? 1 : !memcmp(at, old, old_bytes) ? 0 : -1;
}

/* Up to the new job's end. */
static void arrives(void)
{
    for (int i = 0; i < 50000 && host.upload != NET_HOST_STORED; i++) {
        pass();
    }
    CHECK_EQ(host.upload, NET_HOST_STORED);
    CHECK_EQ(which(), 1);
    CHECK_EQ(c.state, NET_READY);
}

static void connect_and_load(void)
{
    const struct netcard_config config = bench_config();
    struct net_host_config h = { .interval = 100 };

    bench_make(2500, 50, NULL, 0);
    memcpy(new, bench_job, new_bytes = bench_bytes);
    bench_make(1500, 80, NULL, 0);
    memcpy(old, bench_job, old_bytes = bench_bytes);
    memcpy(h.seed, "host", 4);
    bench_start(&c, &config);
    net_host_start(&host, &h);
    while (host.phase != NET_HOST_UP && c.now < 2000 * BENCH_MS) {
        pass();
    }
    CHECK_EQ(which(), 0);
    net_host_load(&host, new, new_bytes);
    first = c;
    first_host = host;
}

int main(void)
{
    uint32_t all, olds = 0, news = 0;

    connect_and_load();
    arrives();
    all = operations();
    for (uint32_t k = 1; k <= all; k++) {
        for (int share = 0; share < SHARES; share++) {
            c = first;
            host = first_host;
            linked = true;
            waiting.count = 0;
            while (operations() < k) {
                pass();
            }
            if (flash_busy(&c.flash, c.now)) {
                const int64_t left = c.flash.end - c.now;
                netcard_advance(&c, c.now + (left - 1) * share / (SHARES - 1));
            }
            netcard_set_power(&c, false);
            netcard_advance(&c, c.now + BENCH_MS);
            netcard_set_power(&c, true);
            netcard_advance(&c, c.now + 400 * BENCH_MS);
            const int got = which();
            CHECK_EQ(c.state, NET_READY);
            CHECK(got >= 0 && (got == 0 || k == all));
            olds += got == 0;
            news += got == 1;
            arrives();
        }
    }
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    printf("%u operations, %u cuts: %u times the old job, %u the new one\n", (unsigned)all,
           (unsigned)(olds + news), (unsigned)olds, (unsigned)news);
    CHECK(all >= 30 && olds >= SHARES * (all - 1) && news > 0);
    return check_result();
}
