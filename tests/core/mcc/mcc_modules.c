/* The PC's modules at work: times of writes and points, deadlines, and no pulse lost whatever their
 * cycles, priorities and times are. */
#include "mcc_card.h"

static const struct pc_panel calm = { .override = 1.0, .rapid = 1.0 };

/* Bus 0.1 ms, IPO 1 ms, latency 0.25 ms; the usual priorities. [clocks] */
static struct pc_config usual(void)
{
    return (struct pc_config){ .bus = 4000,
                               .ipo = 40000,
                               .latency = 10000.0,
                               .seed = 1,
                               .min_stock = 3,
                               .batch = 4,
                               .priority = { 4, 3, 1, 2 },
                               .output_mode = { 1, 1, 1, 1, 1, 1 } };
}

static void run(struct card *c, const char *text, int periods)
{
    for (int k = 0; k < periods && !pc_done(&pc); k++) {
        card_period(c, k * pc.config.bus, &calm, text);
    }
}

static const char line_100[] = "G1 X100 F6000\nM2\n"; /* 1.1 s at 100 pulses per ms */

/* The frames arrive when the last of them has been written, however busy the rest is. */
static void time_of_a_write(void)
{
    const struct machine m = mcc_machine();
    struct pc_config config = usual();
    struct card c;
    config.time[PC_PCL] = 1000;
    config.unit[PC_PCL] = 300;
    config.time[PC_IPO] = 20000;
    card_start(&c, &m, &config, true);
    run(&c, line_100, 20000);
    CHECK(pc_done(&pc) && pc.pcl.services > 200);
    CHECK_EQ(pc.pcl.latency, 10000 + 1000 + 4 * 300);
    CHECK_EQ(pc.modules.task[PC_PCL].use.missed, 0);
    CHECK_EQ(pc.pcl.starved + c.underflows, 0);
    /* Nothing keeps the service itself waiting: it begins the latency after its interrupt. */
    CHECK_EQ(pc.modules.task[PC_PCL].use.latency, 10000);
    /* An IPO that must not be interrupted keeps the write waiting. */
    config.priority[PC_PCL] = 5;
    card_start(&c, &m, &config, true);
    run(&c, line_100, 20000);
    CHECK(pc_done(&pc));
    const int64_t latency = pc.modules.task[PC_PCL].use.latency;
    CHECK(latency > 10000 && latency < 30000);
}

/* The deadline of a write is (n + 1) T from the interrupt: boundary first, so less than it. */
static void deadline_of_a_write(void)
{
    const struct machine m = mcc_machine();
    for (int late = 0; late < 2; late++) {
        struct pc_config config = usual();
        struct card c;
        config.time[PC_PCL] = 4 * 40960 - 10000 - 1 + late;
        card_start(&c, &m, &config, false);
        for (int k = 0; k < 2000; k++) {
            card_period(&c, k * config.bus, &calm, NULL);
        }
        CHECK_EQ(pc.modules.task[PC_PCL].use.missed > 0, late);
    }
}

/* A point is in the queue when its own time is over, not before. */
static void time_of_a_point(void)
{
    const struct machine m = mcc_machine();
    struct pc_config config = usual();
    struct card c;
    config.time[PC_IPO] = 500;
    config.unit[PC_IPO] = 2000;
    config.start = 1; /* the second cycle, at clock 40000 */
    card_start(&c, &m, &config, true);
    /* A bus instant settles what comes before two periods from there. */
    for (int k = 0; k < 14; k++) {
        card_period(&c, k * config.bus, &calm, line_100);
        const int64_t done = (k + 2) * config.bus;
        const int64_t points = done <= 40500 ? 0 : (done - 40500 - 1) / 2000;
        CHECK_EQ(pc.mcc.queue.count, points);
    }
    CHECK_EQ(pc.mcc.queue.count, 9);
}

/* The frames with pulses that were written, up to so many. */
struct stream {
    int n;
    int32_t frame[4000][AXES];
};

static void record(struct stream *s, const char *text, const struct card *c)
{
    static const int32_t still[AXES];
    struct card card = *c;
    int32_t seen = 0;
    s->n = 0;
    for (int k = 0; k < 40000 && !pc_done(&pc); k++) {
        card_period(&card, k * pc.config.bus, &calm, text);
        for (int i = 0; pc.pcl.seq != seen && i < pc.pcl.count; i++) {
            if (s->n < 4000 && memcmp(pc.pcl.frames[i], still, sizeof still)) {
                memcpy(s->frame[s->n++], pc.pcl.frames[i], sizeof still);
            }
        }
        seen = pc.pcl.seq;
    }
    CHECK(pc_done(&pc) && card.shows.frames_refused == 0);
}

/* Interpreter, IPO and process control apart move the axes by the same frames as in one. */
static void apart(void)
{
    static const char text[] = "G64 F3000\nG1 X5 Y1\nX6\nG3 X8 I1\nM3 S100\nG1 Y3\nG4 P0.05\nX0\n";
    static struct stream s[2];
    const struct machine m = mcc_machine();
    for (int k = 0; k < 2; k++) {
        struct pc_config config = usual();
        struct card c;
        config.interpreter = k ? 160000 : 0;
        config.process = k ? 80000 : 0;
        config.most[PC_INTERPRETER] = 3;
        config.time[PC_INTERPRETER] = k ? 900 : 0;
        config.unit[PC_INTERPRETER] = k ? 5000 : 0;
        card_start(&c, &m, &config, true);
        record(&s[k], text, &c);
        CHECK_EQ(pc.modules.task[PC_INTERPRETER].use.runs > 0, k);
        CHECK_EQ(pc.modules.task[PC_PROCESS].use.runs > 0, k);
    }
    CHECK(s[0].n > 400 && s[0].n < 4000);
    CHECK(s[0].n == s[1].n && !memcmp(&s[0], &s[1], sizeof s[0]));
}

/* A program of short moves; its end is added to *end. */
static void random_program(uint64_t *seed, char *text, size_t size, double end[2])
{
    strcpy(text, "G91 F3000\n");
    for (int k = 0; k < 20; k++) {
        const int a = (int)check_random(seed, -3000, 3000);
        const int b = (int)check_random(seed, -3000, 3000);
        const size_t n = strlen(text);
        snprintf(text + n, size - n, "%s G1 X%.3f Y%.3f\n", k % 2 ? "G61" : "G64", a / 1000.0,
                 b / 1000.0);
        end[0] += a / 1000.0;
        end[1] += b / 1000.0;
    }
}

static struct pc_config random_config(uint64_t *seed)
{
    struct pc_config c = usual();
    c.bus = check_random(seed, 1, 8) * 1000;
    c.ipo = check_random(seed, 4000, 100000);
    c.interpreter = check_random(seed, 0, 2) ? check_random(seed, 4000, 300000) : 0;
    c.process = check_random(seed, 0, 2) ? check_random(seed, 4000, 300000) : 0;
    c.min_stock = (int32_t)check_random(seed, 0, 30);
    c.batch = (int32_t)check_random(seed, 1, 16);
    c.isr.service = check_random(seed, 0, 3000);
    for (int i = 0; i < PC_MODULES; i++) {
        c.priority[i] = (int32_t)check_random(seed, 0, 4);
        c.offset[i] = i == PC_PCL ? 0 : check_random(seed, 0, 100000);
        c.time[i] = check_random(seed, 0, 4000);
        c.unit[i] = check_random(seed, 0, 1500);
        c.most[i] = (int32_t)check_random(seed, 0, 5);
    }
    return c;
}

/* Whatever the schedule: each pulse of the program once, and the clocks add up. */
static void conservation(void)
{
    uint64_t seed = 11;
    long long missed = 0;
    for (int i = 0; i < 60; i++) {
        const struct machine m = mcc_machine();
        const struct pc_config config = random_config(&seed);
        char text[2048];
        double end[2] = { 0.0, 0.0 };
        struct card c;
        random_program(&seed, text, sizeof text, end);
        card_start(&c, &m, &config, true);
        struct pc_panel p = calm;
        int64_t at = 0;
        for (; at < 60 * (int64_t)CLOCK_HZ && !pc_done(&pc); at += config.bus) {
            const int64_t die = check_random(&seed, 0, 2000000);
            p.hold = die < 2000 ? !p.hold : p.hold && die > 60000;
            card_period(&c, at, &p, text);
        }
        card_advance(&c, at + 64 * c.dda);
        CHECK(pc_done(&pc));
        for (int k = 0; k < 2; k++) {
            CHECK_EQ(c.sum[k], (int32_t)lround(end[k] * 1000.0));
        }
        struct cyclic_report r = { .clock = 0 };
        cyclic_tell(&pc.modules, &r);
        CHECK(r.all.busy <= r.clock && r.all.runs > 0);
        missed += r.all.missed;
    }
    CHECK(missed > 100);
}

int main(void)
{
    time_of_a_write();
    deadline_of_a_write();
    time_of_a_point();
    apart();
    conservation();
    return check_result();
}
