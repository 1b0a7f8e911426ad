/* Compensation on the way to the card: what comes out is the ideal position and the table. */
#include <stdlib.h>

#include "mcc_card.h"

static const struct pc_panel calm = { .override = 1.0, .rapid = 1.0 };
static const struct pc_config usual = {
    .bus = 4000, .ipo = 40000, .latency = 8000.0, .seed = 1, .min_stock = 3, .batch = 4
};
static struct comp_table table[AXES];

/* A screw 30 pulses off at most, and a backlash of its own for each axis. */
static void make_tables(void)
{
    uint64_t seed = 77;
    for (int i = 0; i < AXES; i++) {
        table[i] = (struct comp_table){ .interval = 1000, .home = 100 };
        for (int k = 0; k < COMP_POINTS; k++) {
            table[i].forward[k] = (int32_t)check_random(&seed, -30, 30);
            table[i].backward[k] = table[i].forward[k] - 20 - 5 * i;
        }
    }
}

/* Library and card at rest, tables in force. */
static void start(struct card *c, const struct machine *m)
{
    card_start(c, m, &usual, false);
    for (int i = 0; i < 3; i++) {
        CHECK_EQ(MCC_set_comp(&pc.mcc, i, &table[i]), MCC_NO_ERR);
    }
}

/* Run until the library rests, and the card too; every frame within the limit. Returns the time. */
static int64_t settle(struct card *c, int64_t at)
{
    const int64_t begin = at;
    int32_t seq = pc.pcl.seq;

    do {
        card_period(c, at, &calm, NULL);
        for (int i = 0; i < pc.pcl.count && pc.pcl.seq != seq; i++) {
            for (int k = 0; k < AXES; k++) {
                CHECK(abs(pc.pcl.frames[i][k]) <= pc.mcc.machine.axis[k].max_dda);
            }
        }
        seq = pc.pcl.seq;
        at += pc.config.bus;
    } while (!MCC_check_stop(&pc.mcc) && at - begin < 60 * (int64_t)CLOCK_HZ);
    CHECK(MCC_check_stop(&pc.mcc));
    for (const int64_t rest = at + 20 * c->dda; at < rest; at += pc.config.bus) {
        card_period(c, at, &calm, NULL);
    }
    return at;
}

/* The card is at the ideal position and the table there; the library's is the ideal one. */
static void at_rest(const struct card *c, const double place[3], const bool backward[3])
{
    double cpos[AXES];
    int32_t ppos[AXES];

    MCC_get_cpos(&pc.mcc, cpos);
    MCC_get_ppos(&pc.mcc, ppos);
    for (int i = 0; i < 3; i++) {
        const int32_t ideal = (int32_t)lround(place[i] * 1000.0);
        const int32_t wanted = comp_wanted(&table[i], ideal, backward[i]);
        CHECK_NEAR(cpos[i], place[i], 0.0);
        CHECK_EQ(ppos[i], ideal);
        CHECK_EQ(pc.mcc.written.added[i], wanted);
        CHECK_EQ(c->sum[i], ideal + wanted);
    }
}

/* Thousands of moves of any kind: at every rest nothing is missing and nothing adds up. */
static void no_drift(void)
{
    struct machine m = mcc_machine();
    struct card c;
    uint64_t seed = 5;
    double place[AXES] = { 0.0 };
    bool backward[3] = { false, false, false };
    int64_t at = 0;

    m.acc_time = m.dec_time = 2e-3;
    m.feed = 200.0;
    start(&c, &m);
    at = settle(&c, at);
    at_rest(&c, place, backward);
    for (int k = 0; k < 3000; k++) {
        for (int i = 0; i < 3; i++) {
            const double to = (double)check_random(&seed, -20000, 20000) / 1000.0;
            backward[i] = to == place[i] ? backward[i] : to < place[i];
            place[i] = to;
        }
        CHECK((k % 2 ? MCC_ptp(&pc.mcc, place) : MCC_line(&pc.mcc, place)) > 0);
        if (k % 7 == 0) {
            at = settle(&c, at);
            at_rest(&c, place, backward);
        } else {
            while (pc.mcc.ring.count > 60) {
                card_period(&c, at, &calm, NULL);
                at += pc.config.bus;
            }
        }
    }
    at = settle(&c, at);
    CHECK(MCC_line(&pc.mcc, (double[AXES]){ -30.0, -30.0, -30.0 }) > 0);
    CHECK(MCC_line(&pc.mcc, (double[AXES]){ 0.0, 0.0, 0.0 }) > 0);
    settle(&c, at);
    at_rest(&c, (double[3]){ 0.0, 0.0, 0.0 }, (bool[3]){ false, false, false });
}

/* At a reversal the backlash goes in at no more than the axis' acceleration allows: 500 pulses a
 * DDA time in 0.1 s, so 5 a DDA time, and with max_dda_spd not beyond it. */
static void reversal(void)
{
    struct machine m = mcc_machine();
    struct card c;
    int64_t at = 0;
    int32_t before = 0, most = 0, periods = 0;

    make_tables();
    for (int k = 0; k < COMP_POINTS; k++) {
        table[0].forward[k] = k > 112 ? 40 : 0; /* from 12 to 13 mm */
        table[0].backward[k] = -60;
    }
    start(&c, &m);
    CHECK(MCC_line_x(&pc.mcc, 5.0) > 0);
    at = settle(&c, at);
    CHECK_EQ(c.sum[0], 5000);
    CHECK(MCC_line_x(&pc.mcc, 4.0) > 0); /* 10 mm/s: ramps of 1 pulse in 10 DDA times */
    for (int k = 0; k < 10000 && !MCC_check_stop(&pc.mcc); k++, at += pc.config.bus) {
        card_period(&c, at, &calm, NULL);
        if (pc.mcc.written.added[0] != before) {
            periods++;
        }
        before = pc.mcc.written.added[0];
        for (int i = 0; i < pc.mcc.queue.count; i++) {
            const struct point *p = queue_peek(&pc.mcc.queue, i);
            const int32_t last =
                i ? queue_peek(&pc.mcc.queue, i - 1)->added[0] : pc.mcc.written.added[0];
            most = abs(p->added[0] - last) > most ? abs(p->added[0] - last) : most;
        }
    }
    CHECK_EQ(most, 5);
    CHECK(periods > 0);
    at = settle(&c, at);
    CHECK_EQ(c.sum[0], 4000 - 60);
    /* At the limit itself there is no room: what the way from 12 to 13 mm wants comes behind. */
    const int32_t limit[AXES] = { 60, 60, 60, 60, 60, 60 };
    CHECK_EQ(MCC_set_max_dda_spd(&pc.mcc, limit), MCC_NO_ERR);
    CHECK_EQ(MCC_set_fspd(&pc.mcc, 58.59375), MCC_NO_ERR); /* 60 pulses in 1.024 ms */
    CHECK(MCC_line_x(&pc.mcc, 20.0) > 0);
    at = settle(&c, at);
    CHECK_EQ(c.sum[0], 20040);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
}

/* Interval 0 takes out what was in; a table is taken at rest at once; refusals change nothing. */
static void switch_off(void)
{
    static struct mcc was;
    struct machine m = mcc_machine();
    struct comp_table off = { .interval = 0 }, bad = { .interval = 1, .home = 256 };
    struct card c;
    int64_t at = 0;

    make_tables();
    start(&c, &m);
    CHECK(!MCC_check_stop(&pc.mcc)); /* the correction at the origin is to be driven in */
    was = pc.mcc;
    CHECK_EQ(MCC_set_comp(&pc.mcc, -1, &off), MCC_PARAMETER);
    CHECK_EQ(MCC_set_comp(&pc.mcc, 6, &off), MCC_PARAMETER);
    CHECK_EQ(MCC_set_comp(&pc.mcc, 3, &table[3]), MCC_PARAMETER); /* not used */
    CHECK_EQ(MCC_set_comp(&pc.mcc, 0, &bad), MCC_PARAMETER);
    CHECK(memcmp(&was, &pc.mcc, sizeof was) == 0);
    at = settle(&c, at);
    CHECK_EQ(c.sum[0], table[0].forward[100]);
    CHECK(MCC_line_x(&pc.mcc, 7.0) > 0);
    CHECK(MCC_line_x(&pc.mcc, 3.25) > 0);
    was = pc.mcc;
    CHECK_EQ(MCC_set_comp(&pc.mcc, 0, &off), MCC_COMMAND_NOTFINISHED);
    CHECK(memcmp(&was, &pc.mcc, sizeof was) == 0);
    at = settle(&c, at);
    CHECK_EQ(c.sum[0], 3250 + comp_wanted(&table[0], 3250, true));
    CHECK(c.sum[0] != 3250);
    CHECK_EQ(MCC_set_comp(&pc.mcc, 0, &off), MCC_NO_ERR);
    CHECK_EQ(task_status(&pc.mcc), TASK_RUNNING);
    at = settle(&c, at);
    CHECK_EQ(c.sum[0], 3250);
    CHECK(MCC_close_motion(&pc.mcc) == MCC_NO_ERR);
    CHECK_EQ(MCC_set_comp(&pc.mcc, 0, &off), MCC_INITIAL_MOTION);
}

/* Held in the middle of a move, the correction of the place held is complete. */
static void held(void)
{
    struct machine m = mcc_machine();
    struct pc_panel p = calm;
    struct card c;
    int64_t at = 0;

    make_tables();
    start(&c, &m);
    CHECK(MCC_line_x(&pc.mcc, 15.0) > 0);
    for (; at < 40000000; at += pc.config.bus) {
        p.hold = at > 20000000;
        card_period(&c, at, &p, NULL);
    }
    CHECK_EQ(task_status(&pc.mcc), TASK_HOLD);
    const int32_t ideal = pc.mcc.written.pulses[0];
    CHECK(ideal > 1000 && ideal < 14000);
    CHECK_EQ(c.sum[0], ideal + comp_wanted(&table[0], ideal, false));
    settle(&c, at);
    CHECK_EQ(c.sum[0], 15000 + comp_wanted(&table[0], 15000, false));
}

int main(void)
{
    make_tables();
    no_drift();
    reversal();
    switch_off();
    held();
    return check_result();
}
