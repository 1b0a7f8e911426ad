/* The IPO's trigger, timer and event, and the document's rule for its cycle. */
#include "mcc_check.h"
#include "station.h"

static struct station s; /* 170 kB: not on the stack */

static struct station_reading reading(void)
{
    struct station_reading r;
    station_read(&s, &r);
    return r;
}

/* Cycle of 20 ms, for which a queue of 8 points is too short. */
static struct station_config slow(bool event)
{
    struct station_config c = station_defaults();
    c.pc.ipo = 20 * (STATION_HZ / 1000);
    c.pc.ipo_event = event;
    c.machine.queue_depth = 8;
    return c;
}

/* A command given in the middle of a cycle: points at once, or when the next cycle begins. */
static void start_of_motion(bool event)
{
    const struct station_config c = slow(event);
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(station_run(&s, 5 * (STATION_HZ / 1000), NULL), STATION_OK);
    CHECK_EQ(MCC_line_x(&s.pc.mcc, 1.0), 1);
    const int64_t given = s.clock;
    while (reading().queue == 0 && s.clock < STATION_HZ) {
        CHECK_EQ(station_run(&s, s.clock + c.pc.bus, NULL), STATION_OK);
    }
    /* What an instant decides comes before the end of the second period from there. */
    const int64_t due = event ? given : c.pc.ipo;
    CHECK(s.clock >= due - 2 * c.pc.bus && s.clock <= due + c.pc.bus);
    CHECK_EQ(s.pc.modules.task[PC_IPO].use.missed, 0);
}

/* 12.5 mm at 10 mm/s with ramps of 0.1 s: 1.35 s if the queue never runs dry. */
static void motion(bool event)
{
    struct station_config c = slow(event);
    int dry = 0;
    c.pc.unit[PC_IPO] = 2000; /* 50 us a point */
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(MCC_line_x(&s.pc.mcc, 12.5), 1);
    while (!reading().stopped && s.clock < 10 * (int64_t)STATION_HZ) {
        CHECK_EQ(station_run(&s, s.clock + c.pc.bus, NULL), STATION_OK);
        dry += trajectory_moving(&s.pc.mcc.trajectory) && reading().queue == 0;
    }
    const struct station_reading r = reading();
    const double seconds = (double)r.clock / STATION_HZ, frames = 1.35 / 1.024e-3;
    CHECK(r.stopped && r.pulses[0] == 12500);
    CHECK_EQ(r.missed, 0);
    if (event) {
        CHECK(seconds > 1.35 && seconds < 1.35 + 0.03);
        CHECK(dry < 10 && r.starved == 0); /* before the first point */
    } else {
        CHECK_NEAR(seconds, frames / 8.0 * 20e-3, 0.1); /* 8 points a cycle */
        CHECK(dry > 1000 && r.starved > 500);
    }
}

/* With more time for a point than events leave, a run the timer asks for is late, and told. */
static void late(void)
{
    struct station_config c = slow(true);
    c.pc.ipo = 40000;
    c.pc.unit[PC_IPO] = 50000;
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(MCC_line_x(&s.pc.mcc, 12.5), 1);
    CHECK_EQ(station_run(&s, 5 * (int64_t)STATION_HZ, NULL), STATION_OK);
    CHECK(reading().stopped && reading().missed > 100);
    CHECK_EQ(reading().pulses[0], 12500);
}

/* Cycle against the DDA time and the time of a run that makes a point, to the clock. */
static void rule(void)
{
    const int64_t dda = 40960, run = 3000 + 500 + 200 + 100;
    const struct {
        int64_t ipo, interpreter, process;
        enum pc_cycle want;
    } cases[] = {
        { dda, 0, 0, PC_CYCLE_KEPT },          { dda + 1, 0, 0, PC_CYCLE_LONG },
        { run, 0, 0, PC_CYCLE_KEPT },          { run - 1, 0, 0, PC_CYCLE_SHORT },
        { run - 1, 40000, 0, PC_CYCLE_KEPT },  { run - 1, 0, 40000, PC_CYCLE_KEPT },
        { 3500, 40000, 40000, PC_CYCLE_KEPT }, { 3499, 40000, 40000, PC_CYCLE_SHORT },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct station_config c = station_defaults();
        c.pc.time[PC_IPO] = 3000;
        c.pc.unit[PC_IPO] = 500;
        c.pc.time[PC_INTERPRETER] = 200;
        c.pc.time[PC_PROCESS] = 100;
        c.pc.ipo = cases[i].ipo;
        c.pc.interpreter = cases[i].interpreter;
        c.pc.process = cases[i].process;
        CHECK_EQ(station_start(&s, &c), STATION_OK);
        CHECK_EQ(reading().ipo_cycle, cases[i].want);
    }
    struct station_config c = station_defaults();
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(reading().ipo_cycle, PC_CYCLE_KEPT);
    CHECK_EQ(MCC_set_dda(&s.pc.mcc, 0.512), MCC_NO_ERR);
    CHECK_EQ(reading().ipo_cycle, PC_CYCLE_LONG);
}

int main(void)
{
    start_of_motion(false);
    start_of_motion(true);
    motion(false);
    motion(true);
    late();
    rule();
    return check_result();
}
