/* PC and card together: FIFO timing of the source document, late service, conservation. */
#include "mcc_card.h"

static const struct pc_panel calm = { .override = 1.0, .rapid = 1.0 };

/* Bus 0.1 ms, IPO 1 ms, in clocks of 25 ns. */
static struct pc_config usual(int32_t n, int32_t batch, double latency)
{
    return (struct pc_config){ .bus = 4000,
                               .ipo = 40000,
                               .latency = latency,
                               .seed = 1,
                               .min_stock = n,
                               .batch = batch,
                               .output_mode = { 1, 1, 1, 1, 1, 1 } };
}

/* Run until the program is done and the FIFO has been put out, or for so many bus periods. */
static void run(struct card *c, const char *text, int periods)
{
    int k = 0;
    for (; k < periods && !pc_done(&pc); k++) {
        card_period(c, k * pc.config.bus, &calm, text);
    }
    CHECK(k < periods);
    card_advance(c, k * pc.config.bus + PCL_FIFO * c->dda);
}

static const char line_100[] = "G1 X100 F6000\nM2\n"; /* 1.1 s at 100 pulses per ms */

/* Interrupt each N DDA times; stock n + N after the refill; no gap up to a latency of (n+1) T. */
static void fifo_timing(void)
{
    static const struct {
        int32_t n, batch;
        int dda_length;
    } cases[] = {
        { 3, 4, 12 }, { 3, 8, 11 }, { 0, 1, 12 }, { 7, 8, 11 }, { 10, 16, 10 },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        for (int late = 0; late < 2; late++) {
            struct machine m = mcc_machine();
            struct card c;
            m.dda_length = cases[i].dda_length;
            m.dda_time = ldexp(1e-3, cases[i].dda_length - 12);
            m.queue_depth = 512;
            const int64_t dda = machine_dda_clocks(&m);
            /* The write must come before the boundary that ends the n+1 DDA times. */
            const double deadline = (double)((cases[i].n + 1) * dda);
            struct pc_config config =
                usual(cases[i].n, cases[i].batch, late ? deadline + 1.0 : deadline - 1.0);
            config.bus = 400;
            config.start = 8000000; /* at 0.2 s, when the FIFO runs steadily */
            card_start(&c, &m, &config, true);
            CHECK_EQ(pc.shown_isr.page, -1); /* none is served before the first interrupt */
            run(&c, line_100, 400000);
            CHECK_EQ(c.sum[0], 100000);
            CHECK(pc_done(&pc));
            CHECK_EQ(pc.pcl.starved, 0);
            CHECK_EQ(c.shows.frames_refused, 0);
            if (late) {
                CHECK(c.underflows > 50);
            } else {
                CHECK_EQ(c.underflows, 0);
                CHECK_EQ((c.irq_last - c.irq_first) % (cases[i].batch * dda), 0);
                CHECK_EQ((c.irq_last - c.irq_first) / (cases[i].batch * dda), c.irqs - 1);
                CHECK_EQ(pc.pcl.latency, (int64_t)deadline - 1);
                /* At the deadline the FIFO is empty but for what is being put out. */
                CHECK(c.peak == cases[i].n + cases[i].batch);
            }
        }
    }
}

/* With early service the stock swings between n and n + N. */
static void stock(void)
{
    const struct machine m = mcc_machine();
    const struct pc_config config = usual(3, 4, 8000.0);
    struct card c;
    card_start(&c, &m, &config, true);
    int32_t least = 99;
    for (int k = 0; k < 5000; k++) {
        card_period(&c, k * pc.config.bus, &calm, line_100);
        least = k > 100 && c.stock < least ? c.stock : least;
    }
    CHECK_EQ(c.peak, 7);
    CHECK_EQ(least, 3);
    CHECK_EQ(pc.pcl.services, c.irqs);
}

/* Latencies lie in [latency, latency + width), depend on the seed alone and fill the interval. */
static void jitter(void)
{
    int64_t sum[3] = { 0 };
    for (int round = 0; round < 3; round++) {
        const struct machine m = mcc_machine();
        struct pc_config config = usual(3, 4, 10000.0);
        struct card c;
        int64_t least = INT64_MAX, most = 0;
        config.jitter = 40000.0;
        config.seed = round == 2 ? 2 : 1;
        card_start(&c, &m, &config, true);
        for (int k = 0; k < 20000; k++) {
            card_period(&c, k * pc.config.bus, &calm, line_100);
            if (pc.pcl.services > 0) {
                sum[round] += pc.pcl.latency;
                least = pc.pcl.latency < least ? pc.pcl.latency : least;
                most = pc.pcl.latency > most ? pc.pcl.latency : most;
            }
        }
        CHECK(least >= 10000 && least < 11000);
        CHECK(most <= 50000 && most > 49000);
    }
    CHECK_EQ(sum[0], sum[1]);
    CHECK(sum[0] != sum[2]);
}

/* A task slower than its queue: frames of standstill, counted; the path and its end stay. */
static void starved(void)
{
    struct machine m = mcc_machine();
    struct pc_config config = usual(3, 4, 8000.0);
    struct card c;
    m.queue_depth = 16;
    config.ipo = 800000; /* 20 ms for 16 points of 1.024 ms */
    card_start(&c, &m, &config, true);
    run(&c, line_100, 20000);
    CHECK_EQ(c.sum[0], 100000);
    CHECK(pc_done(&pc));
    /* 1.1 s are 1075 points, 16 in 20 ms of 19.53 frames; the first cycle waits in no motion. */
    CHECK_NEAR(pc.pcl.starved, 1075 * (20.0 / 1.024 - 16.0) / 16.0, 8.0);
    CHECK(c.underflows == 0);
}

/* A FIFO that holds less than n + N: frames are refused and come again, none lost. */
static void refused(void)
{
    const struct machine m = mcc_machine();
    const struct pc_config config = usual(10, 16, 8000.0);
    struct card c;
    card_start(&c, &m, &config, true);
    c.room = 20;
    run(&c, line_100, 20000);
    CHECK_EQ(c.sum[0], 100000);
    CHECK(c.shows.frames_refused > 50);
    CHECK(pc_done(&pc));
}

/* Of a transaction the card has taken all but what its counter of refused frames rose by since the
 * transaction before; no more than the transaction has, and all if the counter begins anew. */
static void frames_taken(void)
{
    static const struct {
        int32_t before, now, taken;
    } row[] = {
        { 0, 0, 8 },
        { 10, 10, 8 },
        { 10, 13, 5 },
        { 10, 18, 0 },
        { 10, 25, 0 },
        { 10, 3, 8 },
        { INT32_MIN, INT32_MAX, 0 },
        { INT32_MAX, INT32_MIN, 8 },
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct pcl p = {
            .seq = 1, .open = true, .count = 8, .prime = 20, .refused = row[i].before, .refusals = 2
        };
        const struct pcl_card other = { .cmd_ack = 0, .frames_refused = row[i].now };
        const struct pcl_card card = { .cmd_ack = 1, .frames_refused = row[i].now };
        const struct pcl_card next = { .cmd_ack = 2, .frames_refused = row[i].now };
        CHECK_EQ(pcl_acknowledged(&p, &other), -1);
        CHECK(p.open && p.refused == row[i].before);
        CHECK_EQ(pcl_acknowledged(&p, &card), row[i].taken);
        CHECK(!p.open && p.prime == 20 - row[i].taken);
        CHECK_EQ(p.refusals, row[i].taken > 0 ? 0 : 3);
        p.open = true; /* nothing more is refused: all of the next is taken */
        p.seq = 2;
        CHECK_EQ(pcl_acknowledged(&p, &next), 8);
        CHECK_EQ(p.refusals, 0);
    }
}

/* A key counts once however often it went down, and not for being held. */
static void keys(void)
{
    struct key k = { .down = false };
    for (int i = 0; i < 4; i++) {
        key_look(&k, i % 2 == 0);
    }
    CHECK(key_take(&k) && !key_take(&k));
    key_look(&k, true);
    CHECK(key_take(&k));
    key_look(&k, true);
    CHECK(!key_take(&k));
}

/* The panel: a held program does not start, an abort before the start drops it. */
static void panel(void)
{
    const struct machine m = mcc_machine();
    struct pc_config config = usual(3, 4, 8000.0);
    struct pc_panel p = calm;
    struct card c;
    card_start(&c, &m, &config, true);
    p.hold = true;
    int k = 0;
    for (; k < 1000; k++) {
        card_period(&c, k * config.bus, &p, line_100);
    }
    CHECK_EQ(c.sum[0], 0);
    CHECK_EQ(task_status(&pc.mcc), TASK_HOLD);
    p.hold = false;
    int changes = 0;
    for (bool was = false; k < 15000; k++) {
        card_period(&c, k * config.bus, &p, line_100);
        changes += was != pc_done(&pc);
        was = pc_done(&pc);
    }
    CHECK_EQ(c.sum[0], 100000);
    CHECK(pc_done(&pc) && changes == 1);

    config.start = 40000000;
    card_start(&c, &m, &config, true);
    for (k = 0; k < 30000; k++) {
        p.abort = k >= 1000;
        card_period(&c, k * config.bus, &p, line_100);
    }
    CHECK_EQ(c.sum[0], 0);
    CHECK(pc_done(&pc));
}

/* M0 rests until a rising edge that comes while it rests; one that comes earlier is not kept. */
static void program_stop(void)
{
    static const char text[] = "M64 P3\nG1 X10 F6000 M0\n/Y9\nM3 S500 X20\nM1\nM2";
    const struct machine m = mcc_machine();
    struct pc_config config = usual(3, 4, 8000.0);
    struct pc_panel p = calm;
    struct card c;
    p.block_delete = config.block_delete = true;
    card_start(&c, &m, &config, true);
    int turned = 0;
    for (int k = 0; k < 8000; k++) {
        p.cycle_start = k < 500 || k >= 6000;
        card_period(&c, k * config.bus, &p, text);
        const struct outputs *o = &pc.mcc.written.outputs;
        CHECK(o->digital == 8 || k < 200);
        turned += o->spindle == 500.0;
        if (k >= 4000 && k < 6000) {
            CHECK_EQ(task_status(&pc.mcc), TASK_HOLD);
            CHECK(c.sum[0] == 10000 && o->spindle == 0.0 && !pc_done(&pc));
            CHECK_EQ(pc.mcc.written.line, 2);
        }
    }
    CHECK(c.sum[0] > 12000 && turned > 1000 && turned < 2000);
    CHECK_EQ(c.sum[1], 0);
    for (int k = 8000; k < 12000; k++) {
        card_period(&c, k * config.bus, &p, text); /* M1 is not asked for */
    }
    CHECK(pc_done(&pc) && c.sum[0] == 20000 && pc.mcc.written.outputs.spindle == 0.0);
}

static void software_voltage(void)
{
    const struct machine m = mcc_machine();
    struct pc_config config = usual(3, 4, 8000.0);
    struct pc_panel p = calm;
    struct card c;
    config.output_mode[0] = 0;
    config.output_mode[1] = 2;
    card_start(&c, &m, &config, false);
    for (int i = 0; i < AXES; i++) {
        p.software_gain[i] = 0.01;
        p.signals.err[i] = 250;
    }
    card_period(&c, 0, &p, NULL);
    CHECK_NEAR(pc.volts[0], 0.0, 0.0);
    CHECK_NEAR(pc.volts[1], 2.5, 1e-15);
    p.signals.err[1] = -5000;
    card_period(&c, config.bus, &p, NULL);
    CHECK_NEAR(pc.volts[1], -10.0, 0.0);
    struct link_host link = { 0 };
    pc_publish(&pc, &link);
    CHECK(!link.loop_on[0] && link.loop_on[1] && link.loop_on[2] && !link.loop_on[4]);
    CHECK(link.dac_source[0] == 0 && link.dac_source[1] == 0 && link.dac_source[2] == 1);
    CHECK_NEAR(link.dac_volts[1], -10.0, 0.0);
}

/* Any program, FIFO setting, latency, hold and abort: what the card puts out is what the library
 * commanded, and without an abort the end of the program. */
static void conservation(void)
{
    uint64_t seed = 9;
    for (int i = 0; i < 40; i++) {
        struct machine m = mcc_machine();
        struct card c;
        char text[4096] = "G91 F3000\n";
        double end[2] = { 0.0, 0.0 };
        m.acc_time = m.dec_time = 0.02;
        m.queue_depth = (int32_t)check_random(&seed, 1, 100);
        m.dda_length = (int32_t)check_random(&seed, 10, 13);
        m.dda_time = 1e-4 * (double)check_random(&seed, 1, 20);
        for (int k = 0; k < 20; k++) {
            const int a = (int)check_random(&seed, -3000, 3000);
            const int b = (int)check_random(&seed, -3000, 3000);
            const size_t n = strlen(text);
            const char *mode = k % 2 ? "G61" : "G64";
            if (k % 3 == 0) {
                snprintf(text + n, sizeof text - n, "%s G3 I%.3f J1.5\n", mode, a / 1000.0);
            } else {
                snprintf(text + n, sizeof text - n, "%s G1 X%.3f Y%.3f\n", mode, a / 1000.0,
                         b / 1000.0);
                end[0] += a / 1000.0;
                end[1] += b / 1000.0;
            }
        }
        const int32_t n = (int32_t)check_random(&seed, 0, 30);
        struct pc_config config =
            usual(n, (int32_t)check_random(&seed, 1, 16), (double)check_random(&seed, 0, 300000));
        config.jitter = (double)check_random(&seed, 0, 300000);
        config.bus = check_random(&seed, 1, 8) * 1000;
        config.ipo = check_random(&seed, 4000, 400000);
        config.seed = i;
        card_start(&c, &m, &config, true);
        c.room = i % 4 ? PCL_FIFO : (int32_t)check_random(&seed, n + 1, 63);
        struct pc_panel p = calm;
        const bool aborts = i % 5 == 0;
        int64_t at = 0;
        for (; at < 60 * (int64_t)CLOCK_HZ && !pc_done(&pc); at += config.bus) {
            const int64_t die = check_random(&seed, 0, 2000000);
            p.hold = die < 2000 ? !p.hold : p.hold && die > 60000;
            p.override = die > 1995000 ? (double)(die % 200) / 100.0
                         : die < 20000 ? 1.0
                                       : p.override;
            p.abort = aborts && at > CLOCK_HZ / 2;
            card_period(&c, at, &p, text);
        }
        card_advance(&c, at + 64 * c.dda);
        CHECK(pc_done(&pc));
        int32_t ppos[AXES];
        MCC_get_ppos(&pc.mcc, ppos);
        for (int k = 0; k < 2; k++) {
            CHECK_EQ(c.sum[k], ppos[k]);
            CHECK_EQ(c.sum[k], pc.mcc.trajectory.pulses[k]);
            CHECK(aborts || c.sum[k] == (int32_t)lround(end[k] * 1000.0));
        }
    }
}

int main(void)
{
    fifo_timing();
    stock();
    jitter();
    starved();
    refused();
    frames_taken();
    keys();
    panel();
    program_stop();
    software_voltage();
    conservation();
    return check_result();
}
