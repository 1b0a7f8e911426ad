/* The literal scheme of the network card's six tasks on the kernel: its traps, token for token as
 * the FreeRTOS kernel (V11.1.0+) shows them. rN is unit N of work in run, p pause, h home, s stop;
 * !x an interrupt with packet x; >t task t gets the processor; 5>2 home's priority. */
#include "check.h"

#include <stdarg.h>
#include <string.h>

#include "kernel.h"

enum task { PARSE, HOME, STOP, PAUSE, RUN, TASKS };
enum { BYTES = TASKS, UNIT = 1000, LATEST = 400000 };   /* semaphores: a task's own, and BYTES */
static const char *const name[] = { "parse", "home", "stop", "pause", "run" };
static const char letter[] = "-hspr";

/* Packets: the task each one wakes, when; `release` ends a pause. */
struct packet { int64_t clock; enum task task; };

static struct kernel k;
static struct {
    char text[4096];
    int units, at;                  /* units done, packet to come */
    int64_t seen;                   /* events of the log that are in the text */
    bool working[TASKS];            /* it has taken its semaphore, */
    bool busy[TASKS];               /* and a unit is under way */
    int left;                       /* units of homing still to do */
    int done[TASKS];
} s;

static void say(const char *format, ...)
{
    const size_t n = strlen(s.text);
    va_list list;
    va_start(list, format);
    vsnprintf(s.text + n, sizeof s.text - n, format, list);
    va_end(list);
}

/* What the kernel has logged since. */
static void read_log(const struct packet *packets)
{
    for (; s.seen < k.events; s.seen++) {
        const struct kernel_event *e = &k.log[s.seen % KERNEL_LOG];
        if (e->what == KERNEL_RUNS) {
            say(">%s ", name[e->number]);
        } else if (e->what == KERNEL_INTERRUPT) {
            say("!%s ", name[packets[s.at].task]);
        } else if (e->what == KERNEL_PRIORITY) {
            say("%s ", e->value == 2 ? "5>2" : "2>5");
        }
    }
}

/* A unit of work; true if one has ended. */
static bool unit(enum task t)
{
    const bool ended = s.busy[t];
    if (ended) {
        s.done[t]++;
        say("%c%d ", letter[t], ++s.units);
    }
    s.busy[t] = !ended;
    if (!ended) {
        kernel_compute(&k, UNIT);
    }
    return ended;
}

/* Parser: take the bytes, give the semaphore of the packet's task. Home lowers itself while it
 * works, `units` long. Pause holds the processor until `released`. Stop works one unit. Run goes
 * on. */
static void act(enum task t, const struct packet *packets, int home_units, int64_t released)
{
    if (!s.working[t]) {
        s.working[t] = true;
        kernel_take(&k, t == PARSE ? (int)BYTES : (int)t);
        s.left = t == HOME ? home_units : s.left;
        return;
    }
    switch (t) {
    case PARSE:
        s.working[PARSE] = false;
        kernel_give(&k, (int)packets[s.at++].task);
        return;
    case HOME:
        if (s.left == home_units && k.processor.task[HOME].priority == 5) {
            kernel_set_priority(&k, HOME, 2);
        } else if (s.left == 0) {
            s.working[HOME] = false;
            kernel_set_priority(&k, HOME, 5);
        } else {
            s.left -= unit(HOME);
        }
        return;
    case STOP:
        s.working[STOP] = !unit(STOP);
        return;
    case PAUSE:
        s.working[PAUSE] = !(unit(PAUSE) && k.processor.clock >= released);
        return;
    default:
        unit(RUN);
    }
}

/* The first packet comes at clock 0. */
static void play(const struct packet *packets, int n, int home_units, int64_t released)
{
    const struct kernel_config c = { .tasks = TASKS, .priority = { 6, 5, 4, 3, 1 } };
    CHECK_EQ(kernel_start(&k, &c), KERNEL_OK);
    memset(&s, 0, sizeof s);
    for (int i = 0; i < n; i++) {
        for (int context; (context = kernel_next(&k, packets[i].clock)) >= 0;) {
            read_log(packets);
            act((enum task)context, packets, home_units, released);
            read_log(packets);
        }
        kernel_pend(&k, 0, packets[i].clock);
        CHECK_EQ(kernel_next(&k, packets[i].clock + 1), KERNEL_TASKS);
        read_log(packets);
        CHECK_EQ(kernel_give(&k, BYTES), KERNEL_OK);
        CHECK_EQ(kernel_next(&k, packets[i].clock + 1), KERNEL_TASKS);
        CHECK_EQ(kernel_end_interrupt(&k, true), KERNEL_OK);
    }
    for (int context; s.units < 60 && (context = kernel_next(&k, LATEST)) >= 0;) {
        read_log(packets);
        act((enum task)context, packets, home_units, released);
        read_log(packets);
    }
}

/* The text has these tokens in a row. */
static void shows(const char *tokens)
{
    if (!strstr(s.text, tokens)) {
        printf("not in the sequence: %s\n%s\n", tokens, s.text);
        check_failures++;
    }
}

/* After homing the old job goes on, at its next unit. */
static void home_during_run(void)
{
    const struct packet p[] = { { 10, RUN }, { 3500, HOME } };
    play(p, 2, 6, 0);
    shows(">run r1 r2 r3 !home >parse >home 5>2 h4 h5 h6 h7 h8 h9 2>5 >run r10 r11 ");
}

/* Homing does not start while a pause holds the processor. */
static void home_during_pause(void)
{
    const struct packet p[] = { { 10, RUN }, { 3500, PAUSE }, { 5800, HOME } };
    play(p, 3, 6, 46000);
    shows("r3 !pause >parse >pause p4 p5 !home >parse >home 5>2 >pause p6 p7 ");
    shows("p45 p46 >home h47 h48 h49 h50 h51 h52 2>5 >run r53 ");
    CHECK_EQ(s.done[PAUSE], 43);
}

/* The second start stays in its semaphore: the machine runs again after a stop. */
static void start_twice_then_stop(void)
{
    const struct packet p[] = { { 10, RUN }, { 3500, RUN }, { 6500, STOP } };
    play(p, 3, 6, 0);
    shows("r3 !run >parse >run r4 r5 r6 !stop >parse >stop s7 >run r8 ");
    CHECK(k.full[RUN]);
}

/* A pause without a job spins for nothing. */
static void pause_while_idle(void)
{
    const struct packet p[] = { { 10, STOP }, { 2500, PAUSE } };
    play(p, 2, 6, 6000);
    shows("!pause >parse >pause p2 p3 p4 p5 ");
}

int main(void)
{
    home_during_run();
    home_during_pause();
    start_twice_then_stop();
    pause_while_idle();
    return check_result();
}
