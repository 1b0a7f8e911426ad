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

static int64_t give_order(struct net_host_order order)
{
    struct net_host_order *o = host.order;

    order.at = c.now;
    CHECK(net_host_give(&host, &order));
    while (o < host.order + NET_HOST_ORDERS - 1
           && !(o->type == order.type && o->stage != NET_HOST_ANSWERED)) {
        o++;
    }
    for (int i = 0; i < 1000 && o->stage != NET_HOST_ANSWERED; i++) {
        pass(1);
    }
    CHECK_EQ(o->stage, NET_HOST_ANSWERED);
    return o->code;
}

static int64_t give(uint8_t type)
{
    return give_order((struct net_host_order){ .type = type, .axes = 15 });
}

/* Set a setting; the code of the answer. */
static int64_t set(int id, int index, int64_t value)
{
    const struct net_config_set m = { ++host.last_number, (uint16_t)id, (uint16_t)index, value };
    struct net_host_order *o = &host.order[NET_HOST_ORDERS - 1];
    uint8_t payload[NET_BYTES_config_set];

    *o = (struct net_host_order){ .stage = NET_HOST_SENT, .number = m.number };
    net_put_config_set(payload, &m);
    CHECK(net_channel_put(&host.channel, NET_CONFIG_SET, payload, sizeof payload));
    pass(20);
    CHECK_EQ(o->stage, NET_HOST_ANSWERED);
    CHECK_EQ(o->state, c.state);
    return o->code;
}

/* Ask for a setting; INT64_MIN: the card does not know it. */
static int64_t get(int id, int index)
{
    const uint32_t before = host.settings, naks = host.naks;

    CHECK(net_host_ask(&host, (uint16_t)id, (uint16_t)index));
    pass(20);
    CHECK_EQ(host.settings - before + host.naks - naks, 1);
    if (host.settings == before) {
        return INT64_MIN;
    }
    CHECK(host.setting.id == id && host.setting.index == index);
    return host.setting.value;
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

/* Settings of each type are read and set; what is out of range, or comes while a job runs, is
 * refused and changes nothing. */
static void settings(void)
{
    const struct netcard_config config = bench_config();

    take_file(4000);
    begin(&config, true);
    CHECK(!net_host_ask(&host, CARD_SET_home_back, 0)); /* not yet up */
    pass(1000);
    CHECK_EQ(get(CARD_SET_home_back, 2), config.settings.home_back[2]);
    CHECK_EQ(get(CARD_SET_home_plus, 3), config.settings.home_plus[3]);
    CHECK_EQ(get(CARD_SET_jerk_max, 1), llround(config.settings.jerk_max[1]));
    CHECK_EQ(get(CARD_SET_home_back, 4), INT64_MIN);
    CHECK_EQ(get(CARD_SETTING_COUNT, 0), INT64_MIN);
    CHECK_EQ(set(CARD_SET_home_back, 2, 1234), NET_DONE);
    CHECK_EQ(set(CARD_SET_home_plus, 3, 1), NET_DONE);
    CHECK_EQ(set(CARD_SET_jerk_max, 1, 7000000), NET_DONE);
    CHECK(c.settings.home_back[2] == 1234 && c.settings.home_back[1] != 1234);
    CHECK(c.settings.home_plus[3] && !c.settings.home_plus[2]);
    CHECK(c.settings.jerk_max[1] == 7e6 && c.settings.jerk_max[0] == config.settings.jerk_max[0]);
    CHECK_EQ(get(CARD_SET_home_back, 2), 1234);
    const struct card_settings before = c.settings;
    CHECK_EQ(set(CARD_SET_home_back, 2, 0), NET_RANGE);
    CHECK_EQ(set(CARD_SET_home_back, 2, INT64_C(1) << 32 | 5), NET_RANGE);
    CHECK_EQ(set(CARD_SET_home_plus, 3, 2), NET_RANGE);
    CHECK_EQ(set(CARD_SET_home_plus, 4, 1), NET_RANGE);
    CHECK_EQ(set(CARD_SETTING_COUNT, 0, 1), NET_RANGE);
    CHECK_EQ(give(NET_START), NET_DONE);
    CHECK_EQ(set(CARD_SET_home_back, 2, 1235), NET_BUSY);
    CHECK(memcmp(&before, &c.settings, sizeof before) == 0);
}

/* Outputs by message: levels of several at once, a pulse that ends, a width out of range. */
static void outputs(void)
{
    const struct netcard_config config = bench_config();
    struct net_host_order o = { .type = NET_OUTPUT, .pins = 0x8005, .level = 1 };

    begin(&config, false);
    pass(1000);
    const uint32_t rest = c.outputs.levels;
    CHECK_EQ(give_order(o), NET_DONE);
    pass(200);
    CHECK_EQ(c.outputs.levels, rest | 0x8005);
    CHECK_EQ(host.status.outputs, rest | 0x8005);
    o.pins = 4;
    o.level = 0;
    CHECK_EQ(give_order(o), NET_DONE);
    pass(1);
    CHECK_EQ(c.outputs.levels, rest | 0x8001);
    o = (struct net_host_order){
        .type = NET_OUTPUT, .pins = 2, .mode = MC_PO_PULSE, .level = 1, .width = 50000
    };
    CHECK_EQ(give_order(o), NET_DONE);
    pass(40);
    CHECK_EQ(c.outputs.levels, rest | 0x8003);
    pass(20);
    CHECK_EQ(c.outputs.levels, rest | 0x8001);
    o.width = MC_PO_WIDTH_LONGEST + 1;
    CHECK_EQ(give_order(o), NET_RANGE);
    pass(1);
    CHECK_EQ(c.outputs.levels, rest | 0x8001);
}

/* HOME by message moves the axes that it names, and without a switch ends in its fault. */
static void homes(void)
{
    const struct netcard_config config = bench_config();

    begin(&config, false);
    pass(1000);
    for (int i = 0; i < CARD_AXES; i++) {
        CHECK_EQ(set(CARD_SET_home_travel, i, 4000), NET_DONE);
    }
    CHECK_EQ(give_order((struct net_host_order){ .type = NET_HOME, .axes = 2 }), NET_DONE);
    CHECK_EQ(c.state, NET_HOMING);
    pass(2000);
    CHECK_EQ(c.state, NET_FAULT);
    CHECK_EQ(host.status.error, NET_NOT_HOMED);
    CHECK(bench_count(&c, 1) <= -3900 && bench_count(&c, 1) >= -6000);
    CHECK(bench_count(&c, 0) == 0 && bench_count(&c, 2) == 0 && bench_count(&c, 3) == 0);
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
    settings();
    outputs();
    homes();
    loads();
    flooded();
    writes_while_running(false);
    writes_while_running(true);
    lost(CARD_LOSS_PAUSE, NET_PAUSED);
    lost(CARD_LOSS_STOP, NET_READY);
    lost(CARD_LOSS_GO_ON, NET_RUNNING);
    return check_result();
}
