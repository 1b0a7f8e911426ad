/* The card with a PC: upload, commands, a flood of packets, writes while it runs, a lost link. */
#include "card_cable.h"

static uint8_t file[BENCH_JOB]; /* the one that is sent */
static uint32_t file_bytes;
static bool cut;        /* the cable */
static bool flood;      /* JOB_DATA without end, as fast as the line */
static int64_t carried; /* [byte] to the card */

enum { STEP = 20000, LINE = 250 }; /* [ns], [byte] of a step at 100 Mbit/s */

static void carry(void)
{
    cable_plug(netcard_wants_connection(&c) && !cut && net_host_accepts(&host));
    if (!linked) {
        return;
    }
    cable_up(file, LINE);
    if (flood && host.phase == NET_HOST_UP && net_channel_room(&host.channel, 1028, 0)) {
        static uint8_t payload[1028] = { 0, 0, 4 };
        net_channel_put(&host.channel, NET_JOB_DATA, payload, sizeof payload);
    }
    carried += (int64_t)cable_down(LINE);
}

static void pass(int64_t ms)
{
    for (const int64_t end = c.now + ms * BENCH_MS; c.now < end;) {
        netcard_advance(&c, c.now + STEP);
        carry();
    }
}

static void begin(const struct netcard_config *config, bool with_job)
{
    struct net_host_config h = { .interval = 100 };

    memcpy(h.seed, "host", 4);
    CHECK_EQ(netcard_start(&c, config, bench_job, with_job ? bench_bytes : 0), NET_DONE);
    net_host_start(&host, &h);
    cut = linked = flood = false;
    carried = 0;
}

static int64_t give(uint8_t type)
{
    struct net_host_order *o = host.order;

    CHECK(net_host_give(&host, &(struct net_host_order){ .at = c.now, .type = type, .axes = 15 }));
    while (o < host.order + NET_HOST_ORDERS - 1
           && !(o->type == type && o->stage != NET_HOST_ANSWERED)) {
        o++;
    }
    for (int i = 0; i < 1000 && o->stage != NET_HOST_ANSWERED; i++) {
        pass(1);
    }
    CHECK_EQ(o->stage, NET_HOST_ANSWERED);
    return o->code;
}

static void take_file(int32_t frames)
{
    bench_make(frames, 100, NULL, 0);
    memcpy(file, bench_job, bench_bytes);
    file_bytes = bench_bytes;
}

/* A job comes over the link and runs. */
static void upload(void)
{
    const struct netcard_config config = bench_config();

    begin(&config, false);
    take_file(1500);
    pass(1000);
    CHECK_EQ(host.phase, NET_HOST_UP);
    CHECK_EQ(give(NET_START), NET_NO_JOB);
    net_host_load(&host, file, file_bytes);
    const int64_t from = c.now;
    for (int i = 0; i < 20000 && host.upload != NET_HOST_STORED; i++) {
        pass(1);
    }
    CHECK_EQ(host.upload, NET_HOST_STORED);
    printf("%u bytes stored in %.2f s\n", (unsigned)file_bytes, (double)(c.now - from) * 1e-9);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(give(NET_START), NET_DONE);
    pass(300);
    CHECK_EQ(host.status.state, NET_RUNNING);
    CHECK_EQ(give(NET_PAUSE), NET_DONE);
    pass(300);
    CHECK_EQ(host.status.state, NET_PAUSED);
    CHECK_EQ(give(NET_START), NET_DONE);
    pass(1600);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(bench_count(&c, 0), bench_end[0]);
    CHECK_EQ(bench_count(&c, 1), bench_end[1]);
    bench_times(&c);
}

/* The load that STATUS tells is that of the last second, whatever was before: each is the share of
 * the processor that run had in 1 to 1.1 s before, as sampled each ms. A card that has rested for
 * 20 s tells what its job takes, and a second behind the job nothing of it. */
static void loads(void)
{
    enum { CYCLES = 40000, FRAMES = 3000, LONGEST = 30000 };
    static int64_t had[LONGEST]; /* [ns] by run, each ms */
    struct netcard_config config = bench_config();
    int statuses = 0, most = 0;

    config.settings.frame_cycles = CYCLES;
    bench_make(FRAMES, 100, NULL, 0);
    begin(&config, true);
    pass(20000);
    CHECK_EQ(host.status.load[NETCARD_RUN], 0);
    CHECK_EQ(give(NET_START), NET_DONE);
    for (int ms = 0; ms < 6000; ms++) {
        const uint32_t before = host.statuses;
        pass(1);
        had[ms] = kernel_busy(&c.kernel, NETCARD_RUN);
        if (ms < 1200 || host.statuses == before) {
            continue;
        }
        double low = 1000.0, high = 0.0;
        for (int way = 995; way <= 1105; way++) {
            for (int late = 0; late <= 2; late++) {
                const int64_t share = had[ms - late] - had[ms - late - way];
                low = fmin(low, (double)share * 1e-3 / way);
                high = fmax(high, (double)share * 1e-3 / way);
            }
        }
        CHECK(host.status.load[NETCARD_RUN] >= low - 1.0);
        CHECK(host.status.load[NETCARD_RUN] <= high + 1.0);
        most = host.status.load[NETCARD_RUN] > most ? host.status.load[NETCARD_RUN] : most;
        statuses++;
    }
    CHECK(statuses > 40);
    CHECK_NEAR(most, CYCLES / 168.0, 80.0); /* a frame each ms, in batches of half a FIFO */
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(host.status.load[NETCARD_RUN], 0);
    CHECK(host.status.load[NETCARD_TASKS] <= 1);
}

/* Packets at the rate of the line take the processor from run, but not so much that the FIFO falls
 * below half. */
static void flooded(void)
{
    const struct netcard_config config = bench_config();

    take_file(1500);
    begin(&config, true);
    pass(1000);
    CHECK_EQ(give(NET_START), NET_DONE);
    flood = true;
    const int64_t from = carried;
    pass(1600);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(c.player.dry, 0);
    CHECK(c.least >= c.settings.fifo_depth / 2 - 8);
    CHECK(c.least <= c.settings.fifo_depth / 2);
    CHECK_EQ(bench_count(&c, 0), bench_end[0]);
    bench_times(&c);
    printf("flood: %.1f MB/s taken, least stock %d, parser %.1f %%\n",
           (double)(carried - from) / 1.6e6, (int)c.least,
           100.0 * (double)kernel_busy(&c.kernel, NETCARD_PARSER) / (double)c.now);
}

/* Each erase takes its longest time while a job runs: refused, unless the card may write then. */
static void writes_while_running(bool may)
{
    struct netcard_config config = bench_config();

    config.settings.write_during_run = may;
    config.settings.erase_ms = 400;
    config.settings.block_ms = 400;
    take_file(4000);
    begin(&config, true);
    take_file(6000);
    pass(1000);
    CHECK_EQ(give(NET_START), NET_DONE);
    pass(50);
    net_host_load(&host, file, file_bytes);
    pass(3800);
    CHECK_EQ(c.state, NET_RUNNING);
    CHECK(may ? c.flash.sector_erases >= 2 : c.flash.sector_erases == 0);
    pass(200);
    CHECK_EQ(c.player.dry, 0);
    CHECK_EQ(c.jobs, 1);
    printf("write_during_run %d: %u erases of 400 ms, least stock %d\n", may,
           (unsigned)c.flash.sector_erases, (int)c.least);
    for (int i = 0; i < 20000 && host.upload != NET_HOST_STORED; i++) {
        pass(1);
    }
    CHECK_EQ(host.upload, NET_HOST_STORED);
    CHECK(c.least >= 50);
    bench_times(&c);
}

/* The link is lost: pause, stop or nothing. */
static void lost(enum card_link_loss loss, enum net_state state)
{
    struct netcard_config config = bench_config();

    config.settings.on_link_loss = loss;
    take_file(8000);
    begin(&config, true);
    pass(1000);
    CHECK_EQ(give(NET_START), NET_DONE);
    pass(200);
    cut = true;
    pass(500);
    CHECK_EQ(c.state, state);
    cut = false;
    pass(2000);
    CHECK_EQ(host.phase, NET_HOST_UP);
    CHECK_EQ(c.state, state);
}

int main(void)
{
    upload();
    loads();
    flooded();
    writes_while_running(false);
    writes_while_running(true);
    lost(CARD_LOSS_PAUSE, NET_PAUSED);
    lost(CARD_LOSS_STOP, NET_READY);
    lost(CARD_LOSS_GO_ON, NET_RUNNING);
    return check_result();
}
