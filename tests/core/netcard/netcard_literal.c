/* The document's scheme on the card itself, from the log of its kernel: its traps, token for token
 * as the FreeRTOS kernel (V11.1.0+) shows them (the scheme alone: tasks_sequences.c). rN is unit N
 * of work: a frame that run writes; p, s a turn of pause and stop, h a frame of homing. !x an
 * interrupt with packet x; >t task t gets the processor. What serves these only is left out: the
 * storage task, interrupts of flash and FPGA. */
#include <stdarg.h>

#include "card_bench.h"

static const char *const name[] = { "parse", "storage", "home", "stop", "pause", "run" };
static const char letter[] = "--hspr";
static const char *const command_name[] = { "run", "pause", "stop", "home" };
static struct netcard c;
static char text[200000];
static size_t length;
static int64_t seen;
static int units;
static enum card_command packet;

static void say(const char *format, ...)
{
    static char last[32];
    char token[32];
    va_list list;
    va_start(list, format);
    vsnprintf(token, sizeof token, format, list);
    va_end(list);
    const bool again = token[0] == '>' && strcmp(token, last) == 0;
    if (!again && length + strlen(token) < sizeof text) {
        strcpy(last, token);
        strcpy(text + length, token);
        length += strlen(token);
    }
}

static void read_log(void)
{
    CHECK(c.kernel.events - seen <= KERNEL_LOG);
    for (; seen < c.kernel.events; seen++) {
        const struct kernel_event *e = &c.kernel.log[seen % KERNEL_LOG];
        if (e->what == KERNEL_RUNS && e->number != NETCARD_STORAGE) {
            say(">%s ", name[e->number]);
        } else if (e->what == KERNEL_INTERRUPT && e->number == NETCARD_NETWORK) {
            say("!%s ", command_name[packet]);
        } else if (e->what == KERNEL_PRIORITY) {
            say("%s ", e->value == 2 ? "5>2" : "2>5");
        } else if (e->what == KERNEL_MARK) {
            say("%c%d ", letter[e->value], ++units);
        }
    }
}

static void pass(int64_t ns)
{
    for (const int64_t end = c.now + ns; c.now < end;) {
        const bool on = bench_count(&c, 0) <= -300;     /* the origin switch of axis X */
        if (on != (c.axes.origin & 1)) {
            netcard_set_axes(&c, &(struct netcard_axes){ .origin = on });
        }
        netcard_advance(&c, c.now + 500);
        read_log();
    }
}

/* Up to so many units in all; the packet comes behind them, within the next. */
static void send_behind(int unit, enum card_command command)
{
    while (units < unit && c.now < 1000 * BENCH_MS) {
        pass(500);
    }
    CHECK_EQ(units, unit);
    packet = command;
    netcard_command(&c, command, 15);
}

static void begin(void)
{
    struct netcard_config config = bench_config();

    config.settings.policy = CARD_LITERAL;
    config.settings.home_order[1] = config.settings.home_order[2] = 0;
    config.settings.home_order[3] = 0;
    config.settings.home_back[0] = 100;
    bench_make(300, 100, NULL, 0);
    bench_start(&c, &config);
    for (int i = 0; i < NETCARD_TASKS; i++) {       /* the document's, 7 and 6 are ours */
        static const int PRIORITY[] = { 7, 6, 5, 4, 3, 1 };
        CHECK_EQ(c.kernel.processor.task[i].priority, PRIORITY[i]);
    }
    length = 0;
    seen = units = 0;
    text[0] = '\0';
    pass(BENCH_MS);
    send_behind(0, CARD_DO_START);
}

static void shows(const char *tokens)
{
    if (!strstr(text, tokens)) {
        check_failures++;
        printf("not in the sequence: %s\n%.700s\n", tokens, text);
    }
}

/* After homing the old job goes on, at its next frame. */
static void home_during_run(void)
{
    char tokens[64];
    begin();
    send_behind(3, CARD_DO_HOME);
    for (int i = 0; i < 400 && !strstr(text, "2>5 "); i++) {
        pass(BENCH_MS);
    }
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
    CHECK(c.read && c.state == NET_RUNNING);    /* written, not yet played */
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
    for (int i = 0; i < 400 && !strstr(text, "2>5 "); i++) {
        pass(BENCH_MS);
    }
    pass(BENCH_MS);
    CHECK_EQ(c.state, NET_READY);
    CHECK(!c.job);
    pass(100000);
}

/* Homing does not start while a pause holds the processor. */
static void home_during_pause(void)
{
    begin();
    send_behind(3, CARD_DO_PAUSE);
    send_behind(5, CARD_DO_HOME);
    send_behind(46, CARD_DO_START);
    for (int i = 0; i < 400 && !strstr(text, "2>5 "); i++) {
        pass(BENCH_MS);
    }
    pass(100000);
    shows("r3 !pause >parse >pause p4 p5 !home >parse >home 5>2 >pause p6 p7 ");
    shows("p45 p46 !run >parse >pause p47 >home h48 h49 ");
    shows(" 2>5 >run r");
}

/* The second start stays in its semaphore: the machine runs again after a stop. */
static void start_twice_then_stop(void)
{
    begin();
    send_behind(3, CARD_DO_START);
    send_behind(6, CARD_DO_STOP);
    pass(10 * BENCH_MS);
    shows(">run r1 r2 r3 !run >parse >run r4 r5 r6 !stop >parse >stop s7 >run r8 r9 ");
    CHECK_EQ(c.jobs, 2);
}

/* A pause without a job spins for nothing. */
static void pause_while_idle(void)
{
    begin();
    pass(400 * BENCH_MS);
    CHECK_EQ(c.state, NET_READY);
    length = 0;
    text[0] = '\0';
    units = 0;
    send_behind(0, CARD_DO_PAUSE);
    pass(100000);
    shows("!pause >parse >pause p1 p2 p3 p4 ");
}

int main(void)
{
    home_during_run();
    home_behind_the_job();
    home_during_pause();
    start_twice_then_stop();
    pause_while_idle();
    return check_result();
}
