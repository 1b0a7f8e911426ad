/* Dry run and single block: what is reported without pulses, and what waits for the operator. */
#include "mcc_card.h"

static struct pc_panel panel;
static const struct pc_config usual = {
    .bus = 4000, .ipo = 40000, .latency = 8000.0, .seed = 1, .min_stock = 3, .batch = 4
};

/* Let so many bus periods pass. */
static int64_t wait(struct card *c, int64_t at, int periods, const char *text)
{
    for (int k = 0; k < periods; k++, at += pc.config.bus) {
        card_period(c, at, &panel, text);
    }
    return at;
}

/* The same program twice, dry and wet: the same points at the same time, but no pulses; then the
 * position is again where the axes are, and the next program runs from there. */
static void dry_equals_wet(void)
{
    static const char text[] = "F6000 G64\nG1 X10 Y-4\nG3 X12 Y-2 I1 J1\nM3 S100\nG0 Z5\nM2";
    static struct {
        double place[AXES], feed;
        int32_t pulses[AXES], line;
    } seen[2][20000];
    const struct machine m = mcc_machine();
    double place[AXES];
    int32_t pulses[AXES];
    struct card c;
    int64_t at;

    for (int dry = 0; dry < 2; dry++) {
        panel = (struct pc_panel){ .override = 1.0, .rapid = 1.0 };
        card_start(&c, &m, &usual, false);
        CHECK(MCC_line_x(&pc.mcc, -3.0) > 0);
        at = wait(&c, 0, 10000, NULL);
        CHECK_EQ(c.sum[0], -3000);
        CHECK_EQ(MCC_check_dry_run(&pc.mcc), 1);
        if (dry) {
            CHECK_EQ(MCC_enable_dry_run(&pc.mcc), 0);
            CHECK_EQ(MCC_check_dry_run(&pc.mcc), 0);
        }
        CHECK_EQ(task_start(&pc.mcc), 0);
        for (int k = 0; k < 20000; k++, at += pc.config.bus) {
            card_period(&c, at, &panel, text);
            const struct point *p = &pc.mcc.written;
            memcpy(seen[dry][k].place, p->place, sizeof p->place);
            memcpy(seen[dry][k].pulses, p->pulses, sizeof p->pulses);
            seen[dry][k].feed = p->feed;
            seen[dry][k].line = p->line;
        }
        CHECK_EQ(task_status(&pc.mcc), TASK_STOPPED);
        MCC_get_cpos(&pc.mcc, place);
        CHECK(place[0] == 12.0 && place[1] == -2.0 && place[2] == 5.0);
        CHECK_EQ(pc.mcc.written.line, 6);
        CHECK_EQ(c.sum[0], dry ? -3000 : 12000);
        CHECK_EQ(c.sum[2], dry ? 0 : 5000);
    }
    CHECK(memcmp(seen[0], seen[1], sizeof seen[0]) == 0);
    CHECK_EQ(MCC_enable_dry_run(&pc.mcc), 0); /* once more: keeps the place */
    CHECK_EQ(MCC_disable_dry_run(&pc.mcc), 0);
    CHECK_EQ(MCC_disable_dry_run(&pc.mcc), 0);
    MCC_get_cpos(&pc.mcc, place);
    MCC_get_ppos(&pc.mcc, pulses);
    CHECK(place[0] == -3.0 && place[1] == 0.0 && place[2] == 0.0);
    CHECK(memcmp(pc.mcc.trajectory.rest, place, sizeof place) == 0);
    CHECK(pulses[0] == -3000 && pulses[1] == 0 && pulses[2] == 0);
    CHECK_EQ(task_start(&pc.mcc), 0);
    wait(&c, at, 20000, text);
    CHECK(c.sum[0] == 12000 && c.sum[1] == -2000 && c.sum[2] == 5000);
}

/* Errors are found as well; allowed at standstill only; a refused call changes nothing. */
static void dry_refusals(void)
{
    static struct mcc was;
    const struct machine m = mcc_machine();
    const int32_t limit[AXES] = { 90, 90, 90, 90, 90, 90 };
    struct card c;
    int64_t at;

    panel = (struct pc_panel){ .override = 1.0, .rapid = 1.0 };
    card_start(&c, &m, &usual, false);
    CHECK(MCC_line_x(&pc.mcc, 1.0) > 0);
    was = pc.mcc;
    CHECK_EQ(MCC_enable_dry_run(&pc.mcc), MCC_COMMAND_NOTFINISHED);
    CHECK(memcmp(&was, &pc.mcc, sizeof was) == 0);
    at = wait(&c, 0, 10000, NULL);
    CHECK_EQ(MCC_enable_dry_run(&pc.mcc), 0);
    CHECK_EQ(MCC_set_max_dda_spd(&pc.mcc, limit), 0);
    CHECK_EQ(MCC_set_fspd(&pc.mcc, 100.0), 0);
    CHECK(MCC_line_x(&pc.mcc, 50.0) > 0);
    was = pc.mcc;
    CHECK_EQ(MCC_disable_dry_run(&pc.mcc), MCC_COMMAND_NOTFINISHED);
    CHECK(memcmp(&was, &pc.mcc, sizeof was) == 0);
    wait(&c, at, 10000, NULL);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_SPEED);
    CHECK_EQ(c.sum[0], 1000);
    CHECK_EQ(MCC_disable_dry_run(&pc.mcc), 0);
    MCC_close_motion(&pc.mcc);
    CHECK_EQ(MCC_enable_dry_run(&pc.mcc), MCC_INITIAL_MOTION);
    CHECK_EQ(MCC_disable_dry_run(&pc.mcc), MCC_INITIAL_MOTION);
    CHECK_EQ(task_set_single_block(&pc.mcc, true), MCC_INITIAL_MOTION);
}

/* A program block by block: the first has leave, then each waits; a block is a line. */
static void blocks(void)
{
    static const char text[] = "G64 F6000\nG91 G1 X1\nX1\nM3 S9\n(none)\nX1 M0\nG4 P.01\nX1\nM2";
    static const int32_t x[] = { 1000, 2000, 2000, 3000, 3000, 4000 };
    static const int32_t line[] = { 2, 3, 4, 6, 7, 8 };
    const struct machine m = mcc_machine();
    struct card c;
    int64_t at;

    panel = (struct pc_panel){ .override = 1.0, .rapid = 1.0 };
    card_start(&c, &m, &usual, true);
    panel.single_block = true;
    at = wait(&c, 0, 3000, text);
    for (int k = 0; k < 6; k++) {
        CHECK_EQ(c.sum[0], x[k]);
        CHECK_EQ(pc.mcc.written.line, line[k]);
        CHECK_EQ(pc.mcc.written.outputs.spindle == 9.0, k >= 2);
        /* behind X1 M0 stands the stop, and one task_continue is enough for both */
        CHECK_EQ(task_status(&pc.mcc), k == 3 ? TASK_HOLD : TASK_BLOCK_HOLD);
        CHECK(!pc_done(&pc));
        CHECK_EQ(task_continue(&pc.mcc), 0);
        at = wait(&c, at, 3000, text);
    }
    CHECK_EQ(c.sum[0], x[5]);
    CHECK(pc_done(&pc));
    CHECK_EQ(task_continue(&pc.mcc), MCC_CONTI_ILLEGAL);
    /* The leave of a program without a block does not pass to what comes behind it. */
    CHECK_EQ(task_start(&pc.mcc), 0);
    at = wait(&c, at, 100, "F100\nM2");
    CHECK(MCC_line_x(&pc.mcc, 9.0) > 0);
    wait(&c, at, 1000, NULL);
    CHECK_EQ(task_status(&pc.mcc), TASK_BLOCK_HOLD);
}

/* Switched on in the middle: the block under way ends. Switched off while one waits: it still
 * waits, and the others run on. Calls of the API are a block each. An abort drops them. */
static void on_and_off(void)
{
    struct machine m = mcc_machine();
    struct card c;
    int64_t at;

    m.queue_depth = 16; /* the task is not far ahead of the card */
    panel = (struct pc_panel){ .override = 1.0, .rapid = 1.0 };
    card_start(&c, &m, &usual, false);
    CHECK_EQ(MCC_enable_quit(&pc.mcc), 0);
    for (int k = 1; k <= 6; k++) {
        CHECK(MCC_line_x(&pc.mcc, k) > 0);
    }
    at = wait(&c, 0, 500, NULL);
    CHECK(c.sum[0] > 100 && c.sum[0] < 1000);
    CHECK_EQ(task_continue(&pc.mcc), MCC_CONTI_ILLEGAL);
    panel.single_block = true;
    at = wait(&c, at, 4000, NULL);
    CHECK_EQ(c.sum[0], 1000);
    CHECK_EQ(task_status(&pc.mcc), TASK_BLOCK_HOLD);
    CHECK_EQ(task_continue(&pc.mcc), 0);
    at = wait(&c, at, 4000, NULL);
    CHECK_EQ(c.sum[0], 2000);
    panel.single_block = false;
    at = wait(&c, at, 4000, NULL);
    CHECK_EQ(c.sum[0], 2000);
    CHECK_EQ(task_status(&pc.mcc), TASK_HOLD);
    CHECK_EQ(task_continue(&pc.mcc), 0);
    at = wait(&c, at, 20000, NULL);
    CHECK_EQ(c.sum[0], 6000);
    panel.single_block = true;
    CHECK(MCC_line_x(&pc.mcc, 9.0) > 0);
    at = wait(&c, at, 2000, NULL);
    CHECK_EQ(task_status(&pc.mcc), TASK_BLOCK_HOLD);
    CHECK_EQ(c.sum[0], 6000);
    CHECK_EQ(MCC_motion_abort(&pc.mcc), 0);
    wait(&c, at, 2000, NULL);
    CHECK_EQ(task_status(&pc.mcc), TASK_STOPPED);
    CHECK_EQ(c.sum[0], 6000);
}

/* Let so many bus periods pass; the speed changes by at most so much in a DDA time. [mm/s] */
static int64_t wait_smooth(struct card *c, int64_t at, int periods, const char *text, double most)
{
    double worst = 0.0;
    for (int k = 0; k < periods; k++) {
        at = wait(c, at, 1, text);
        for (int i = 1; i < pc.mcc.queue.count; i++) {
            worst = fmax(worst, fabs(queue_peek(&pc.mcc.queue, i)->feed
                                     - queue_peek(&pc.mcc.queue, i - 1)->feed));
        }
    }
    CHECK(worst <= most && worst > 0.5 * most);
    return at;
}

/* Switched on in the middle of a chain of look-ahead: it ends with a block, as soon as it can be
 * brought to rest there; then block by block, and off again the rest of the chain. */
static void chain(char type)
{
    static const char text[] = "G64 P.02 F6000 G91 G1 X1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\n"
                               "X1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nX1\nM2";
    struct machine m = mcc_machine();
    struct card c;
    int64_t at;

    panel = (struct pc_panel){ .override = 1.0, .rapid = 1.0 };
    m.acc_type = m.dec_type = type;
    m.queue_depth = 16;
    card_start(&c, &m, &usual, true);
    at = wait(&c, 0, 1400, text);
    const int32_t before = c.sum[0];
    CHECK(before > 5000 && before < 12000);
    panel.single_block = true;
    /* 1 m/s^2 in 1.024 ms, with S-shaped ramps a third more */
    at = wait_smooth(&c, at, 4000, text, type == 'S' ? 1.366 : 1.025);
    /* braking from 100 mm/s takes 5 mm; the task is some 20 points of 0.1 mm ahead */
    CHECK(c.sum[0] > before + 5000 && c.sum[0] < before + 5000 + 2500 + 4000);
    CHECK_EQ(c.sum[0] % 1000, 0);
    CHECK_EQ(pc.mcc.written.line, c.sum[0] / 1000);
    for (int k = 0; k < 2; k++) {
        const int32_t rest = c.sum[0];
        CHECK_EQ(task_status(&pc.mcc), TASK_BLOCK_HOLD);
        CHECK_EQ(task_continue(&pc.mcc), 0);
        at = wait(&c, at, 4000, text);
        CHECK_EQ(c.sum[0], rest + 1000);
    }
    panel.single_block = false;
    at = wait(&c, at, 10, text);
    CHECK_EQ(task_continue(&pc.mcc), 0);
    wait(&c, at, 20000, text);
    CHECK_EQ(c.sum[0], 24000);
    CHECK(pc_done(&pc));
}

int main(void)
{
    dry_equals_wet();
    dry_refusals();
    blocks();
    on_and_off();
    chain('T');
    chain('S');
    return check_result();
}
