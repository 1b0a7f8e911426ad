/* The document's scheme on the card itself: its traps, token for token as the FreeRTOS kernel
 * (V11.1.0+) shows them (the scheme alone: tasks_sequences.c). */
#include "card_tokens.h"

static void priorities(void)
{
    begin();
    for (int i = 0; i < NETCARD_TASKS; i++) { /* the document's, 7 and 6 are ours */
        static const int PRIORITY[] = { 7, 6, 5, 4, 3, 1 };
        CHECK_EQ(kernel_priority(&c.kernel, i), PRIORITY[i]);
    }
}

/* After homing the old job goes on, at its next frame. */
static void home_during_run(void)
{
    char tokens[64];
    begin();
    send_behind(3, CARD_DO_HOME);
    until("2>5 ");
    pass(100000);
    shows(">run r1 r2 r3 !home >parse >home 5>2 h4 h5 ");
    const char *end = strstr(text, " 2>5");
    int last = 0;
    for (const char *at = strstr(text, "h4"); end && at < end; last++) {
        CHECK_EQ(at[0], 'h');
        CHECK_EQ(atoi(at + 1), 4 + last);
        at = strchr(at, ' ') + 1;
    }
    pass(BENCH_MS);
    CHECK(c.phase == JOB_DRAINING && c.state == NET_RUNNING); /* written, not yet played */
    pass(350 * BENCH_MS);
    CHECK_EQ(c.state, NET_READY);
    snprintf(tokens, sizeof tokens, "h%d 2>5 >run r%d r%d ", 3 + last, 4 + last, 5 + last);
    shows(tokens);
}

/* Homing behind the last frame that run writes leaves nothing of the job. */
static void home_behind_the_job(void)
{
    begin();
    send_behind(300, CARD_DO_HOME);
    until("2>5 ");
    pass(BENCH_MS);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(c.phase, JOB_NONE);
    pass(100000);
}

/* Homing does not start while a pause holds the processor; a start by its button releases it. */
static void home_during_pause(void)
{
    begin();
    send_behind(3, CARD_DO_PAUSE);
    send_behind(5, CARD_DO_HOME);
    hidden = true;
    while (units < 45) {
        pass(500);
    }
    press(BUTTON_START);
    until("2>5 ");
    pass(100000);
    shows("r3 !pause >parse >pause p4 p5 !home >parse >home 5>2 >pause p6 p7 ");
    shows("p45 p46 >home h47 h48 ");
    shows(" 2>5 >run r");
}

/* A start gives back what the pause has held. */
static void start_behind_a_pause(void)
{
    begin();
    send_behind(3, CARD_DO_PAUSE);
    send_behind(5, CARD_DO_START);
    CHECK_EQ(c.state, NET_PAUSED);
    until("r7 ");
    CHECK_EQ(c.state, NET_RUNNING);
    shows("r3 !pause >parse >pause p4 p5 !start >parse >pause p6 >run r7 ");
    CHECK_EQ(c.jobs, 1);
}

/* The second start stays in its semaphore: the machine runs again after a stop. */
static void start_twice_then_stop(void)
{
    begin();
    send_behind(3, CARD_DO_START);
    send_behind(6, CARD_DO_STOP);
    pass(10 * BENCH_MS);
    shows(">run r1 r2 r3 !start >parse >run r4 r5 r6 !stop >parse >stop s7 >run r8 r9 ");
    CHECK_EQ(c.jobs, 2);
}

/* A pause without a job spins for nothing. */
static void pause_while_idle(void)
{
    begin();
    pass(400 * BENCH_MS);
    CHECK_EQ(c.state, NET_READY);
    anew();
    send_behind(0, CARD_DO_STOP);
    send_behind(1, CARD_DO_STOP);
    send_behind(2, CARD_DO_PAUSE);
    hidden = true;
    while (units < 5) {
        pass(500);
    }
    press(BUTTON_START);
    pass(BENCH_MS);
    shows("!pause >parse >pause p3 p4 p5 p6 ");
    CHECK_EQ(units, 6);
    CHECK_EQ(c.state, NET_READY);
}

int main(void)
{
    priorities();
    home_during_run();
    home_behind_the_job();
    home_during_pause();
    start_behind_a_pause();
    start_twice_then_stop();
    pause_while_idle();
    return check_result();
}
