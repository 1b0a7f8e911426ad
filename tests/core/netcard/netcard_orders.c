/* Further sequences under the literal rules: what two packets, full semaphores, equal priorities
 * and buttons lead to. The scheme alone does the same on FreeRTOS (tasks_sequences.c). */
#include "card_tokens.h"

static void both(int unit, enum card_command first, enum card_command second)
{
    send_behind(unit, first);
    netcard_command(&c, second, 15);
}

/* Until the parser has its packet in work. */
static void parsing(void)
{
    while (c.kernel.processor.running != NETCARD_PARSER) {
        netcard_advance(&c, c.now + 100);
    }
    read_log();
}

/* Two packets at one instant: the parser takes both before anyone else runs, then the more urgent
 * task goes first, whichever packet came first. */
static void at_one_instant(void)
{
    begin();
    both(3, CARD_DO_PAUSE, CARD_DO_STOP);
    send_behind(6, CARD_DO_START);
    pass(BENCH_MS);
    shows("r3 !pause >parse >stop s4 >pause p5 p6 !start >parse >pause p7 ");
    begin();
    both(3, CARD_DO_STOP, CARD_DO_PAUSE);
    pass(100000);
    shows("r3 !stop >parse >stop s4 >pause p5 p6 ");
    begin();
    both(3, CARD_DO_PAUSE, CARD_DO_HOME); /* home lowers itself below pause */
    pass(100000);
    shows("r3 !pause >parse >home 5>2 >pause p4 p5 ");
    begin();
    both(3, CARD_DO_STOP, CARD_DO_HOME); /* and below stop, which ends it */
    pass(100000);
    shows("r3 !stop >parse >home 5>2 >stop s4 >home ");
}

/* Homing works at 2, so that stop and pause come between. */
static void stop_during_home(void)
{
    begin();
    send_behind(3, CARD_DO_HOME);
    send_behind(5, CARD_DO_STOP);
    until("2>5 ");
    pass(100000);
    shows("r3 !home >parse >home 5>2 h4 h5 !stop >parse >stop s6 >home 2>5 >run ");
    pass(50 * BENCH_MS);
    CHECK_EQ(units, 6);
    CHECK_EQ(c.state, NET_READY);
    anew(); /* the same without a job under way */
    send_behind(0, CARD_DO_HOME);
    send_behind(2, CARD_DO_STOP);
    until("2>5 ");
    pass(50 * BENCH_MS);
    shows("!home >parse >home 5>2 h1 h2 !stop >parse >stop s3 >home 2>5 ");
    CHECK_EQ(units, 3);
    CHECK_EQ(c.state, NET_READY);
    anew();
    send_behind(0, CARD_DO_HOME);
    until("2>5 ");
    CHECK(c.homed & 1);
}

static void pause_during_home(void)
{
    begin();
    send_behind(3, CARD_DO_HOME);
    send_behind(5, CARD_DO_PAUSE);
    send_behind(7, CARD_DO_START);
    until("2>5 ");
    pass(100000);
    shows("5>2 h4 h5 !pause >parse >pause p6 p7 !start >parse >pause p8 >home h9 h10 ");
    shows("2>5 >run r");
}

/* A full semaphore keeps one start, however many came; one more job follows, and no third. */
static void full_semaphore(void)
{
    begin();
    for (int i = 1; i <= 4; i++) {
        send_behind(3 * i, CARD_DO_START);
    }
    shows("r3 !start >parse >run r4 r5 r6 !start >parse >run r7 r8 r9 !start >parse >run r10 ");
    pass(900 * BENCH_MS);
    CHECK_EQ(c.jobs, 2);
    CHECK_EQ(c.state, NET_READY);
}

/* A pause given while a pause holds the processor stays: the next one follows its release. */
static void pause_twice(void)
{
    begin();
    send_behind(3, CARD_DO_PAUSE);
    send_behind(5, CARD_DO_PAUSE);
    send_behind(7, CARD_DO_START);
    send_behind(9, CARD_DO_START);
    pass(100000);
    shows("r3 !pause >parse >pause p4 p5 !pause >parse >pause p6 p7 !start >parse >pause p8 p9 "
          "!start >parse >pause p10 >run r11 ");
}

/* A button while the parser has a packet in work: its task waits for the parser's end. */
static void button_in_the_parser(void)
{
    begin();
    send_behind(3, CARD_DO_STOP);
    parsing();
    press(BUTTON_PAUSE);
    pass(100000);
    shows("r3 !stop >parse !button-pause >stop s4 >pause p5 p6 ");
    begin();
    send_behind(3, CARD_DO_PAUSE);
    parsing();
    press(BUTTON_HOME);
    pass(100000);
    shows("r3 !pause >parse !button-home >home 5>2 >pause p4 p5 ");
    begin();
    send_behind(3, CARD_DO_PAUSE); /* and while pause holds the processor */
    while (units < 5) {
        pass(500);
    }
    press(BUTTON_STOP);
    pass(100000);
    shows("r3 !pause >parse >pause p4 p5 !button-stop >stop s6 >pause p7 ");
}

/* A start is kept while its task waits for the processor: of two of them while homing works one is
 * left, and the job is done once. */
static void starts_while_homing(void)
{
    begin();
    send_behind(3, CARD_DO_STOP);
    pass(BENCH_MS);
    CHECK_EQ(c.jobs, 1);
    CHECK_EQ(c.state, NET_READY);
    anew();
    send_behind(0, CARD_DO_HOME);
    send_behind(2, CARD_DO_START);
    send_behind(4, CARD_DO_START);
    until("2>5 ");
    pass(900 * BENCH_MS);
    shows("!home >parse >home 5>2 h1 h2 !start >parse >home h3 h4 !start >parse >home h5 h6 ");
    shows(" 2>5 >run r");
    CHECK_EQ(c.jobs, 2);
    CHECK_EQ(c.state, NET_READY);
}

/* Homing lowered to the priority of run has the processor on: run was interrupted, so it had its
 * turn before. They take turns at the tick. */
static void equals(void)
{
    struct netcard_config config = bench_config();

    config.settings.priority_home_active = config.settings.priority_run = 2;
    begin_with(config);
    send_behind(3, CARD_DO_HOME);
    pass(3 * BENCH_MS);
    shows("r3 !home >parse >home 5>2 h4 h5 ");
    shows(" >run r8 ");
    shows(" >home ");
}

int main(void)
{
    at_one_instant();
    stop_during_home();
    pause_during_home();
    full_semaphore();
    pause_twice();
    button_in_the_parser();
    starts_while_homing();
    equals();
    return check_result();
}
