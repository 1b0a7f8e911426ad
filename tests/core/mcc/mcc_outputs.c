/* Outputs and stops among the motion: at which point each changes, in hold, abort and rest. */
#include "mcc_record.h"

static struct source_text text;
static struct source source;

static void load(const char *lines)
{
    text = (struct source_text){ lines, (int64_t)strlen(lines) };
    source = source_of(&text);
    program = &source;
    struct fault_report r;
    task_check(&m, program, &r);
    CHECK_EQ(r.fault, FAULT_NONE);
    CHECK_EQ(task_start(&m), MCC_NO_ERR);
}

/* A program from the origin at 100 mm/s: a line of 20 mm is 0.3 s, its deceleration begins at
 * 0.2 s. The DDA time is 1.024 ms. */
static void start_program(const char *lines)
{
    begin(mcc_machine());
    load(lines);
}

/* The point in which a time lies, counted from 1. [s] */
static int point_at(double time)
{
    return (int)floor(time / 1.024e-3) + 1;
}

/* Point after point until the outputs are so, or the axes rest. Returns the point's number. */
static int until(struct record *r, double spindle, uint32_t digital)
{
    while (point(r)) {
        const struct outputs *o = &r->last.outputs;
        if (o->spindle == spindle && o->digital == digital) {
            return r->n;
        }
    }
    return -1;
}

/* M62 and M63 with the start of a motion, which with G64 comes before the end of the other. */
static void with_the_motion(void)
{
    struct record r = { 0 };
    start_program("F6000 G61 G1 X20\nM62 P0\nM62 P5 X40\nM63 P5\nG4 P0.1\nX60\n");
    CHECK_EQ(until(&r, 0.0, 0x21), point_at(0.3));
    CHECK(r.last.place[0] > 20.0); /* the first point of that motion */
    CHECK_EQ(until(&r, 0.0, 0x01), point_at(0.7));
    run(&r);
    CHECK_EQ(r.last.outputs.digital, 1);
    CHECK_EQ(r.sum[0], 60000);

    r = (struct record){ 0 };
    start_program("F6000 G64 G1 X20\nM62 P0\nX40\nM63 P0 Y20\n");
    CHECK_EQ(until(&r, 0.0, 1), point_at(0.2));
    CHECK_EQ(r.last.command, 1); /* still under way, beside it */
    CHECK_EQ(until(&r, 0.0, 0), point_at(0.4));
    run(&r);
    CHECK(r.sum[0] == 40000 && r.sum[1] == 20000);
    CHECK_NEAR(r.n, 0.7 / 1.024e-3, 1.0); /* no time was lost to them */

    r = (struct record){ 0 };
    start_program("F6000 G1 X20\nM62 P1\n"); /* no motion follows */
    run(&r);
    CHECK_EQ(r.last.outputs.digital, 0);
}

/* All others when the motion before them has ended, with G64 as with G61. */
static void behind_the_motion(void)
{
    static const char *const modes[] = { "G61", "G64" };
    static const struct {
        const char *words;
        double spindle;
        uint32_t digital;
        int32_t coolant;
    } all[] = { { "M3 S1200", 1200.0, 0, 0 },
                { "M4 S80", -80.0, 0, 0 },
                { "M64 P31", 0.0, 1u << 31, 0 },
                { "M8", 0.0, 0, 2 },
                { "M7", 0.0, 0, 1 } };

    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        for (int k = 0; k < 2; k++) {
            struct record r = { 0 };
            char lines[80];
            snprintf(lines, sizeof lines, "F6000 %s G1 X20\n%s\nX40\n", modes[k], all[i].words);
            start_program(lines);
            while (point(&r)) {
                const struct outputs *o = &r.last.outputs;
                const bool on = r.n >= point_at(0.3);
                CHECK_NEAR(o->spindle, on ? all[i].spindle : 0.0, 0.0);
                CHECK_EQ(o->digital, on ? all[i].digital : 0);
                CHECK_EQ(o->coolant, on ? all[i].coolant : 0);
                CHECK_EQ(r.last.command, r.n < point_at(0.3) ? 1 : 2);
            }
            CHECK_EQ(r.sum[0], 40000);
            CHECK_NEAR(r.n, 0.6 / 1.024e-3, 1.0); /* the axes came to rest between */
        }
    }
}

/* G96: at every point the tool passes the work at S, unless D is reached. */
static void by_radius(void)
{
    struct record r = { 0 };
    int limited = 0, free = 0;

    start_program("F6000 G0 X50\nG96 S60 D1000 M4\nG1 X-5\nG97\nM5\n");
    while (point(&r)) {
        const double x = fabs(r.last.place[0]), speed = -r.last.outputs.spindle;
        if (r.last.command < 2 || r.last.place[0] == -5.0 || r.last.place[0] == 50.0) {
            continue;
        }
        const bool bound = x < 60e3 / (6.283185307179586 * 1000.0);
        CHECK_NEAR(speed, bound ? 1000.0 : 60e3 / (6.283185307179586 * x), 1e-9 * 1000.0);
        limited += bound;
        free += !bound;
    }
    CHECK(limited > 50 && free > 200);
    CHECK(r.last.outputs.spindle == 0.0);
}

/* What takes no time takes no point but the one that tells. */
static void without_motion(void)
{
    struct record r = { 0 };
    start_program("M3 S100\nM64 P1\nM64 P2\nM65 P1\nM7\nM8\n");
    run(&r);
    CHECK_EQ(r.n, 1);
    CHECK(r.last.outputs.spindle == 100.0 && r.last.outputs.digital == 4);
    CHECK_EQ(r.last.outputs.coolant, 3);
    CHECK(MCC_check_stop(&m));
    load("S200\nM30\n"); /* what is on outlives the program, S does not turn it again */
    run(&r);
    CHECK_EQ(r.n, 2);
    CHECK(r.last.outputs.spindle == 0.0 && r.last.outputs.coolant == 0);
    CHECK_EQ(r.last.outputs.digital, 4);
    CHECK_EQ(m.commands, 0);
}

/* A hold lets nothing pass; then all goes on in its order. */
static void held(void)
{
    struct record r = { 0 };
    start_program("F6000 G1 X20\nM3 S100\nM62 P0 X40\n");
    for (int i = 0; i < 100; i++) {
        point(&r);
    }
    CHECK_EQ(MCC_motion_hold(&m), MCC_NO_ERR);
    run(&r);
    CHECK(r.sum[0] < 20000 && r.last.outputs.spindle == 0.0);
    CHECK_EQ(task_status(&m), TASK_HOLD);
    CHECK_EQ(task_continue(&m), MCC_CONTI_ILLEGAL);
    CHECK_EQ(MCC_motion_conti(&m), MCC_NO_ERR);
    CHECK(until(&r, 100.0, 1) > 0);
    CHECK_NEAR(r.last.place[0], 20.0, 0.1);
    run(&r);
    CHECK_EQ(r.sum[0], 40000);
}

/* An abort: spindle and coolant go off when the axes have come to rest, digital outputs stay. */
static void aborted(void)
{
    struct record r = { 0 };
    start_program("F6000 M64 P7 M3 S100 M8\nG1 X20\nM64 P1\nX40\n");
    for (int i = 0; i < 150; i++) {
        point(&r);
    }
    CHECK_EQ(MCC_motion_abort(&m), MCC_NO_ERR);
    while (point(&r)) {
        CHECK_EQ(r.last.outputs.spindle == 0.0, r.last.feed == 0.0);
        CHECK_EQ(r.last.outputs.coolant == 0, r.last.feed == 0.0);
    }
    CHECK_EQ(r.last.outputs.digital, 0x80);
    CHECK(r.sum[0] > 10000 && r.sum[0] < 20000 && MCC_check_stop(&m));
    load("G1 X0 F600\nM30\n");
    const int before = r.n;
    CHECK_EQ(until(&r, 0.0, 0x80), before + 1);
    run(&r);

    r = (struct record){ 0 };
    start_program("M4 S100\nM0\nG1 X1\n");
    run(&r);
    CHECK_NEAR(r.last.outputs.spindle, -100.0, 0.0);
    CHECK_EQ(MCC_motion_abort(&m), MCC_NO_ERR);
    CHECK(!MCC_check_stop(&m)); /* the card does not know yet */
    run(&r);
    CHECK(MCC_check_stop(&m) && r.last.outputs.spindle == 0.0);
    CHECK_EQ(r.sum[0], 0);
}

/* M0 rests behind the motion before it and lets nothing pass. */
static void stopped(void)
{
    struct record r = { 0 };
    start_program("F6000 G64 G1 X20\nM0 X30\nM3 S100 X40\nM0\n");
    run(&r);
    CHECK_EQ(r.sum[0], 30000);
    CHECK_EQ(r.last.line, 2);
    CHECK(r.last.feed == 0.0 && r.last.outputs.spindle == 0.0);
    CHECK_EQ(task_status(&m), TASK_HOLD);
    CHECK(!MCC_check_stop(&m) && !task_moving(&m));
    CHECK_EQ(task_continue(&m), MCC_NO_ERR);
    CHECK_EQ(task_continue(&m), MCC_CONTI_ILLEGAL);
    CHECK(point(&r));
    CHECK_NEAR(r.last.outputs.spindle, 100.0, 0.0);
    run(&r);
    CHECK_EQ(r.sum[0], 40000);
    CHECK(!MCC_check_stop(&m));                /* a stop at the very end waits too */
    CHECK_EQ(MCC_motion_hold(&m), MCC_NO_ERR); /* held and stopped: both are needed */
    CHECK_EQ(task_continue(&m), MCC_NO_ERR);
    CHECK_EQ(task_status(&m), TASK_STOPPED);
    m.open = false;
    CHECK_EQ(task_continue(&m), MCC_INITIAL_MOTION);
}

int main(void)
{
    with_the_motion();
    behind_the_motion();
    by_radius();
    without_motion();
    held();
    aborted();
    stopped();
    return check_result();
}
