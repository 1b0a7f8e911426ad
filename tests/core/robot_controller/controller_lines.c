/* Lines of a program: a cycle from the interrupt that executes them to their first slot, outputs
 * with the point of their move, delays of whole cycles, a user program that polls too seldom. */
#include <stdlib.h>

#include "controller_rig.h"

static const char POINTS[] = "P000 J1=0.1 J2=0 J3=0 J4=0 J5=90 J6=0\n"
                             "P001 J1=-0.1 J2=0 J3=0 J4=0 J5=90 J6=0\n";
static const char OUTPUTS[] = "//JOB\nMOVJ P000 VJ=50.00\nDOUT OT#(1) ON\nMOVJ P001 VJ=50.00\n"
                              "DOUT OT#(1) OFF\nTIMER T=0.06\nDOUT OT#(2) ON\nEND\n";
enum { MOVES = 20 };

static int64_t rested; /* [clock] of the latest interrupt that began a memory of pulses */

/* Until the program is over; the clock of its end. */
static void drive(int64_t most)
{
    rested = 0;
    while (!controller_done(&controller) && now < most) {
        rig_instant();
        if (card.playing >= 0 && card.rate[0] != 0.0) {
            rested = card.start + INTERVAL;
        }
    }
    CHECK(controller_done(&controller));
    CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
}

static void outputs(void)
{
    rig_document();
    rig_program(OUTPUTS, POINTS);
    config.start = 10 * INTERVAL; /* while the card plays */
    rig_power_on();
    int64_t on = 0, off = 0, at[2] = { 0 };
    while (!controller_done(&controller) && now < 40000000) {
        const bool before = card.outputs & 1;
        rig_instant();
        on = !before && (card.outputs & 1) ? card.output_clock[0] : on;
        off = before && !(card.outputs & 1) ? card.output_clock[0] : off;
        for (int i = 0; i < 2; i++) {
            const bool there = fabs(controller.joint[0] - (i ? -0.1 : 0.1) * DEGREE) < 1e-12;
            at[i] = there && !at[i] ? card.irq.clock : at[i];
        }
    }
    /* The run of an interrupt brings the arm to the point an interval later: out with the copy of
     * the run that is then, at the next exchange. */
    CHECK_EQ(on - at[0], INTERVAL + (RUN / SLOT + 1) * SLOT);
    const int64_t behind = off - at[1] - (on - at[0]);
    CHECK(behind == 0 || behind == INTERVAL); /* that rest is seen a cycle later */
    /* 600 cycles from the run of the delay, which is the one after that of the output, at rest. */
    CHECK_EQ(card.output_clock[1] - off, 600 * INTERVAL);
    CHECK_EQ(controller.report.line_most, INTERVAL);
    CHECK_EQ(controller.report.told_most, INTERVAL);
}

/* A dwell of a part program, though 0.02 s less 200 times 0.1 ms is not 0. */
static void dwell(void)
{
    static struct source_text gcode = { .text = "G4 P0.005\nM64 P0\nG4 P0.02\nM65 P0\nM2\n" };
    struct source source = source_of(&gcode);
    int64_t on = 0;

    rig_document();
    gcode.length = (int64_t)strlen(gcode.text);
    config.orders.feed = config.orders.feed_most = 100.0;
    text.gcode = &source;
    rig_power_on();
    while (!controller_done(&controller) && now < 4000000) {
        rig_instant();
        on = card.outputs & 1 ? card.output_clock[0] : on;
    }
    CHECK(controller_done(&controller));
    CHECK_EQ(card.outputs, 0);
    CHECK_EQ(card.output_clock[0] - on, 200 * INTERVAL);
}

/* Short moves, each with an exact stop. */
static void short_lines(void)
{
    static char job[MOVES * 32];

    strcpy(job, "//JOB\n");
    for (int i = 0; i < MOVES; i++) {
        snprintf(job + strlen(job), sizeof job - strlen(job), "MOVJ P00%d VJ=100.00 PL=0\n", i % 2);
    }
    strcat(job, "END\n");
    rig_program(job, POINTS);
}

/* Time of the moves, from the first to the last pulse, and how often the queue starved. */
static int64_t takes(int32_t depth, int64_t poll)
{
    rig_document();
    short_lines();
    config.bus = 500;
    config.robot.smooth = 0.002;
    config.user = depth > 0;
    config.depth = depth;
    config.layers.poll = poll;
    rig_power_on();
    drive((int64_t)40 * FPGA_CLOCK_HZ);
    return rested - (config.user ? poll : 0);
}

static void starving(void)
{
    const int64_t at_once = takes(0, 1440000), move = at_once / MOVES;

    CHECK_EQ(controller.report.starved, 0);
    CHECK_EQ(controller.report.line_most, INTERVAL);
    /* All lines fit into the queue. */
    CHECK(llabs(takes(64, 1440000) - at_once) <= 2 * INTERVAL);
    /* Two lines a poll, which is as long as four: as many polls as there are pairs. */
    const int64_t poll = 4 * move + 77;
    const double slow = (double)takes(2, poll);
    CHECK_NEAR(slow, (MOVES / 2 - 1) * (double)poll + 2.0 * move, 0.2 * move);
    /* The queue is empty from the start to the poll behind the last pair, but for the moves. */
    CHECK_NEAR(controller.report.starved, ((MOVES / 2 + 1) * (double)poll - at_once) / INTERVAL,
               3.0 * MOVES);
    CHECK(controller.report.told_most > INTERVAL && controller.report.told_most <= 2 * INTERVAL);
    CHECK_EQ(controller.report.line_most, INTERVAL);
}

/* A queue that is never full: the first line waits for the run behind its poll. */
static void known(void)
{
    for (int64_t phase = 0; phase < INTERVAL; phase += 37) {
        rig_document();
        rig_program("//JOB\nMOVJ P000 VJ=100.00\nEND\n", POINTS);
        config.user = true;
        config.layers.poll = 40000 + phase;
        rig_power_on();
        drive(40000000);
        const int64_t run = card.irq.clock % INTERVAL, poll = 40000 + phase;
        /* the first run that begins at the poll or later, and a cycle */
        const int64_t wait = (run - (poll - WAIT) % INTERVAL + INTERVAL) % INTERVAL - WAIT;
        CHECK_EQ(controller.report.told_most, wait + INTERVAL);
    }
}

int main(void)
{
    outputs();
    dwell();
    starving();
    known();
    return check_result();
}
