/* Fourteen axes on one card: six by pulses, eight by voltage, each group moved by its own calls or
 * program, against closed formulas at every instant. The card is the epcio core, a plant a motor
 * that follows the voltage exactly. */
#include "epcio_card.h"
#include "group.h"
#include "host.h"
#include "mcc_check.h"

enum { BUS = 4000, DDA = 40960, DELAY = 3 };
#define COUNTS_PER_VOLT 50000.0 /* [counts/s] 300 rpm/V of 10000 counts a turn */
#define KP              50.0    /* [1/s] */
static const double TB = 1e-4;  /* [s] */

static struct groups set; /* 2 MB: not on the stack */
static struct epcio card;
static double place[GROUP_DACS]; /* [counts] of the motors */
static int way[GROUP_DACS];      /* of the encoder */
static int64_t now;              /* [clock] */
static struct source_text text[GROUP_MAX];
static int pulses, six, two; /* the groups */
static bool in_step;         /* the first two have the same motion */
enum { LAST_ENCODER = 8 };   /* counter of DAC 8; counter 8 has a hand wheel */

static struct machine motion(void)
{
    struct machine m = mcc_machine();
    m.acc_time = m.dec_time = 0.1;
    return m;
}

/* One card, its six channels, six DAC and the other two; inverted: axes at a DAC, a bit each. */
static void power_on(uint32_t inverted, double feed_forward, double lag, int32_t track)
{
    const struct group_config config = { .bus = BUS,
                                         .ipo = 40000,
                                         .latency = 8000.0,
                                         .jitter = 20000.0,
                                         .seed = 5,
                                         .min_stock = 3,
                                         .batch = 4 };
    const struct machine cards[GROUP_CARDS] = { mcc_machine(), mcc_machine() }, m = motion();
    struct epcio_config wired = epcio_default_config();
    wired.loop.limit = 400;
    CHECK_EQ(epcio_reset(&card, &wired), EPCIO_OK);
    groups_init(&set, &config, cards);
    memset(text, 0, sizeof text);
    now = 0;
    in_step = false;
    for (int i = 0; i < GROUP_DACS; i++) {
        struct group_dac d = { .axis = m.axis[0],
                               .encoder = i == 7 ? LAST_ENCODER : i,
                               .position_gain = KP,
                               .speed_per_volt = 300.0,
                               .feed_forward = feed_forward,
                               .lag = lag };
        place[i] = 0.0;
        way[i] = inverted >> i & 1 ? -1 : 1;
        d.axis.inverted = way[i] < 0;
        d.axis.track_limit = track;
        CHECK_EQ(groups_set_dac(&set, 0, i, &d), MCC_NO_ERR);
    }
    pulses = group_create(&set, 0, (int32_t[]){ 0, 1, 2, 3, 4, 5 }, &m);
    six = group_create_voltage(&set, 0, (int32_t[]){ 0, 1, 2, 3, 4, 5 }, &m);
    two = group_create_voltage(&set, 0, (int32_t[]){ 6, 7, -1, -1, -1, -1 }, &m);
    CHECK(pulses == 0 && six == 1 && two == 2);
}

static void program(int group, const char *lines)
{
    struct fault_report r;
    text[group] = (struct source_text){ lines, (int64_t)strlen(lines) };
    const struct source source = source_of(&text[group]);
    task_check(&set.group[group].mcc, &source, &r);
    CHECK_EQ(r.fault, FAULT_NONE);
    CHECK_EQ(group_program(&set, group, 0), MCC_NO_ERR);
}

/* The card reads what the PC published. */
static void card_reads(void)
{
    static struct mailbox taken;
    if (now == 0) {
        taken = (struct mailbox){ 0 };
    }
    struct link_host link = { .cmd_seq = taken.cmd_seq };
    groups_publish(&set, 0, &link);
    CHECK_EQ(host_take_levels(&taken, &card, &link), EPCIO_OK);
    CHECK_EQ(host_take_write(&taken, &card, &link), EPCIO_OK);
}

/* One bus period of card, PC and motors. */
static void period(void)
{
    const struct group_panel calm = { .override = 1.0 };
    struct pcl_card shows[GROUP_CARDS] = { { 0 } };
    struct group_panel panel[GROUP_MAX];
    struct source source[GROUP_MAX] = { { 0 } };
    double phase[EPCIO_ENCODERS] = { 0.0 };
    struct link_card link;
    int bad;
    epcio_advance(&card, now);
    epcio_convert(&card);
    if (in_step) { /* the command is what a channel of pulses has put out */
        int64_t out[EPCIO_AXES];
        epcio_pulses(&card, out);
        for (int i = 0; i < AXES; i++) {
            CHECK_EQ(set.card[0].command[i], out[i]);
        }
    }
    host_show(&card, &link);
    shows[0] = card_of(&set.card[0].pcl, &link);
    for (int i = 0; i < GROUP_DACS; i++) {
        phase[i == 7 ? LAST_ENCODER : i] = way[i] * place[i] / 4.0;
    }
    phase[7] = (double)now / 100.0;
    CHECK_EQ(card_sample(&card, phase, &bad), EPCIO_OK);
    card_reads();
    epcio_control(&card);
    for (int n = 0; n < GROUP_MAX; n++) {
        panel[n] = calm;
        source[n] = source_of(&text[n]);
    }
    groups_counters(&set, 0, &link);
    groups_instant(&set, now, shows, panel, source);
    for (int i = 0; i < GROUP_DACS; i++) {
        place[i] += way[i] * epcio_volts(&card, i) * COUNTS_PER_VOLT * TB;
    }
    now += BUS;
}

/* Part of a straight way of length s [mm] done at t [s]: trapezium of feed f, ramps of 0.1 s. */
static double share(double t, double s, double f)
{
    const double a = f / 0.1, flat = s / f - 0.1, end = flat + 0.2;
    if (t <= 0.0 || t >= end) {
        return t > 0.0;
    }
    return (t < 0.1          ? a * t * t / 2
            : t < 0.1 + flat ? f * (t - 0.05)
                             : s - a * (end - t) * (end - t) / 2)
           / s;
}

/* Lines by calls on all three groups at once. The command at an instant is on the trapezium to a
 * pulse; the motor follows c - p = e as x(k+1) = x(k) + Kp T (c - x)(k-3); on the flat part the
 * error is v ((1 - kff) / Kp + lag). The card's seventh error counter has the error of DAC 7. */
static void lines_by_calls(uint32_t inverted, double feed_forward, double lag)
{
    enum { LAST = 12000 };
    static const double to[AXES] = { 20.0, -15.0, 10.0, 30.0, -2.0, 0.5 };
    static const double other[AXES] = { -12.0, 16.0 };
    static double x[LAST + 1][GROUP_DACS], c[LAST + 1][GROUP_DACS];
    const double s6 = sqrt(725.0), s2 = 20.0, f = 40.0;
    int32_t watched = 0;
    int flat = 0;
    power_on(inverted, feed_forward, lag, 0);
    CHECK_EQ(groups_start(&set), MCC_NO_ERR);
    for (int g = 0; g < 3; g++) {
        struct mcc *m = &set.group[g].mcc;
        CHECK_EQ(MCC_set_fspd(m, f), MCC_NO_ERR);
        CHECK(MCC_line(m, g == two ? other : to) > 0);
        CHECK(MCC_check_stop(m) == 0);
    }
    memset(x, 0, sizeof x);
    memset(c, 0, sizeof c);
    for (int k = 0; k < LAST; k++) {
        /* the first frame is put out from the first boundary on */
        const double t = (double)(now - DDA) / CLOCK_HZ;
        const double part6 = share(t, s6, f), part2 = share(t, s2, f);
        for (int i = 0; i < GROUP_DACS; i++) {
            const double *end = i < 6 ? &to[i] : &other[i - 6];
            const struct servo *servo = &set.group[i < 6 ? six : two].servo;
            const double v = *end / (i < 6 ? s6 : s2) * f * 1000.0; /* [counts/s] */
            c[k][i] = 1000.0 * *end * (i < 6 ? part6 : part2);
            CHECK_NEAR(servo->next[i % 6], c[k][i], 1.1);
            const int32_t e = way[i] * set.card[0].error[i];
            if (t > 0.38 && t < (i < 6 ? s6 : s2) / f) {
                CHECK_NEAR(e, v * ((1.0 - feed_forward) / KP + lag), 2.1);
                flat++;
            }
            if (feed_forward == 0.0 && lag == 0.0) {
                CHECK_NEAR(place[i], x[k][i], 1.5);
                const int old = k < DELAY ? 0 : k - DELAY;
                x[k + 1][i] = x[k][i] + KP * TB * (c[old][i] - x[old][i]);
            }
        }
        period();
        CHECK_EQ(set.card[0].error[6], watched); /* the card has it an instant before */
        watched = card.loop[6].error;
    }
    CHECK(flat > 10000);
    const double largest = 24000.0 * ((1.0 - feed_forward) / KP + lag);
    CHECK_EQ(card.irq.flags[IRQ_PCL], largest > 400.0 ? 1u << (IRQ_PCL_OV + 6) : 0);
    for (int i = 0; i < GROUP_DACS; i++) {
        const double end = 1000.0 * (i < 6 ? to[i] : other[i - 6]);
        CHECK_NEAR(place[i], end, 1.0);
        CHECK_EQ(set.card[0].command[i], way[i] * end);
    }
    int64_t out[EPCIO_AXES];
    epcio_pulses(&card, out);
    for (int i = 0; i < EPCIO_AXES; i++) {
        CHECK_EQ(out[i], 1000.0 * to[i]);
        CHECK_EQ(card.underflows[i], 0);
    }
    for (int g = 0; g < 3; g++) {
        int32_t ppos[AXES], error[AXES];
        int in[AXES];
        struct mcc *m = &set.group[g].mcc;
        CHECK_EQ(MCC_check_stop(m), 1);
        CHECK_EQ(MCC_get_ppos(m, ppos), MCC_NO_ERR);
        CHECK_EQ(ppos[0], 1000.0 * (g == two ? other[0] : to[0]));
        CHECK_EQ(MCC_get_errcnt(m, error), MCC_NO_ERR);
        CHECK_NEAR(error[0], 0.0, 1.0);
        CHECK_EQ(set.group[g].starved, 0);
        if (g != pulses) {
            CHECK_EQ(MCC_set_inpos_tol(m, (double[]){ 0.01, 0.01, 0.01, 0.01, 0.01, 0.01 }), 0);
            CHECK_EQ(MCC_check_in_pos(m, in), MCC_NO_ERR);
            CHECK_EQ(in[1], 1);
        }
    }
}

/* One program for a group of pulses and one of voltages: frame by frame the same. */
static void frames_are_those_of_pulses(void)
{
    static const char lines[] = "G91 F3000 G64\nG1 X5 Y3 U-4\nG3 X4 Y4 J4 W2\nG61 G1 Z-7.5 V3\n"
                                "G4 P0.02\nG0 X-3 Y1 Z2\nM30\n";
    enum { FRAMES = 4000 };
    static int32_t put[2][FRAMES][AXES];
    int count[2] = { 0 };
    int64_t begun = 0;
    power_on(0, 0.0, 0.0, 0);
    in_step = true;
    program(pulses, lines);
    program(six, lines);
    program(two, "G91 F3000\nG2 I5\nG2 X5 Y5 I5\nM30\n");
    CHECK_EQ(groups_start(&set), MCC_NO_ERR);
    for (int k = 0; k < 25000; k++) {
        const struct dda *soft = &set.group[six].servo.dda;
        const int64_t start = card.dda.start;
        const bool new_soft = soft->start > begun;
        begun = soft->start;
        if (new_soft && (count[1] || memcmp(soft->command, put[1][0], sizeof put[1][0]))) {
            memcpy(put[1][count[1]++], soft->command, sizeof put[1][0]);
        }
        period();
        if (card.dda.start > start && (count[0] || card.dda.command[0] || card.dda.command[1])) {
            memcpy(put[0][count[0]++], card.dda.command, sizeof put[0][0]);
        }
    }
    CHECK(count[0] > 2100 && count[1] > 2100);
    int shift = 0; /* frames of standstill at the begin */
    while (shift < 10 && memcmp(put[0][0], put[1][shift], sizeof put[0][0])) {
        shift++;
    }
    for (int k = 0; k < 2100; k++) {
        CHECK(!memcmp(put[0][k], put[1][k + shift], sizeof put[0][0]));
    }
    for (int g = 0; g < 3; g++) {
        CHECK(group_done(&set, g));
    }
    CHECK_NEAR(place[0], 6000.0, 1.0);
    CHECK_NEAR(place[2], -5500.0, 1.0);
    CHECK_NEAR(place[6], 5000.0, 1.0);
    CHECK_NEAR(place[7], 5000.0, 1.0);
}

/* An encoder that is dead: the error grows to the limit, that group stops with 0xF802, the others
 * end their programs. */
static void a_dead_encoder(void)
{
    power_on(0, 0.0, 0.0, 2000);
    for (int g = 0; g < 3; g++) {
        program(g, "G91 F1200\nG1 X20 Y10\nM30\n");
    }
    CHECK_EQ(groups_start(&set), MCC_NO_ERR);
    for (int k = 0; k < 20000; k++) {
        place[7] = 0.0;
        period();
    }
    CHECK_EQ(MCC_get_errcode(&set.group[two].mcc), MCC_ERROR_TRACK + 1);
    CHECK(!group_done(&set, two));
    const int32_t stood = set.card[0].command[7];
    CHECK(stood > 2000 && stood < 4500); /* the ramp of 0.1 s and the queue behind it */
    CHECK_EQ(MCC_clear_error(&set.group[two].mcc), MCC_RUN_TIME);
    CHECK(group_done(&set, pulses) && group_done(&set, six));
    CHECK_NEAR(place[0], 20000.0, 1.0);
}

/* An IPO too slow for its queue: standstill in the middle of a motion is counted, and nothing of
 * the way is lost. Another DDA time holds from the next boundary on. */
static void a_slow_ipo(void)
{
    power_on(0, 1.0, 0.0, 0);
    set.config.ipo = 400000; /* 10 ms for 5 points of 1 ms */
    set.group[two].mcc.machine.queue_depth = 5;
    program(two, "G91 F1200\nG1 X8\nM30\n");
    CHECK_EQ(groups_start(&set), MCC_NO_ERR);
    for (int k = 0; k < 20000; k++) {
        period();
    }
    CHECK(set.group[two].starved > 200 && set.group[two].starved < 600);
    CHECK_NEAR(place[6], 8000.0, 1.0);
    CHECK_EQ(MCC_set_dda(&set.group[two].mcc, 2.0), MCC_NO_ERR);
    CHECK(MCC_line_x(&set.group[two].mcc, 3.0) > 0);
    for (int k = 0; k < 20000; k++) {
        period();
        CHECK(k < 100 || set.group[two].servo.dda.divider == 20);
        if (k > 1500 && k < 2500) { /* the speed fed forward is right */
            CHECK_NEAR(set.card[0].error[6], 0.0, 3.0);
        }
    }
    CHECK_NEAR(place[6], 3000.0, 1.0);
}

int main(void)
{
    lines_by_calls(0, 0.0, 0.0);
    lines_by_calls(0xA5, 0.0, 0.0);
    lines_by_calls(0, 1.0, 0.0);
    lines_by_calls(0, 0.5, 0.01);
    frames_are_those_of_pulses();
    a_dead_encoder();
    a_slow_ipo();
    return check_result();
}
