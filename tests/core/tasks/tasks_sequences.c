/* The document's scheme of the network card's tasks on the kernel: its traps, token for token as
 * the FreeRTOS kernel V11.1.0 shows them (freertos_scheme.h). */
#include "task_scheme.h"

#include "freertos_scheme.h"
#include "kernel.h"

static struct kernel k;
static struct {
    int64_t seen;        /* events of the log that are in the text */
    bool working[TASKS]; /* it has taken its semaphore, */
    bool busy[TASKS];    /* and a unit is under way */
    int left[TASKS];     /* units still to do */
} s;

static void read_log(const struct scenario *c)
{
    for (; s.seen < k.events; s.seen++) {
        const struct kernel_event *e = &k.log[s.seen % KERNEL_LOG];
        if (e->what == KERNEL_RUNS) {
            say(">%s ", NAME[e->number]);
        } else if (e->what == KERNEL_INTERRUPT) {
            say_packets(c, e->clock);
        } else if (e->what == KERNEL_PRIORITY) {
            say_priority(c, e->value == c->home_priority);
        }
    }
}

/* A unit of work; true if one has ended. */
static bool unit(enum task t)
{
    const bool ended = s.busy[t];

    if (ended) {
        say_unit(t);
    } else {
        kernel_compute(&k, UNIT);
    }
    s.busy[t] = !ended;
    return ended;
}

static void begin(const struct scenario *c, enum task t)
{
    s.working[t] = true;
    s.left[t] = t == HOME ? c->home_units : t == RUN ? c->job_units : 1;
    kernel_take(&k, t == PARSE ? (int)BYTES : (int)t);
}

static void home(const struct scenario *c)
{
    if (s.left[HOME] == c->home_units && kernel_priority(&k, HOME) == PRIORITY[HOME]) {
        kernel_set_priority(&k, HOME, c->home_priority);
    } else if (s.left[HOME] == 0) {
        s.working[HOME] = false;
        kernel_set_priority(&k, HOME, PRIORITY[HOME]);
    } else {
        s.left[HOME] -= unit(HOME);
    }
}

static void act(const struct scenario *c, enum task t)
{
    if (!s.working[t]) {
        begin(c, t);
    } else if (t == PARSE && scheme.taken < scheme.arrived) {
        kernel_give(&k, (int)c->packet[scheme.taken++].task);
    } else if (t == PARSE) {
        s.working[t] = false;
    } else if (t == HOME) {
        home(c);
    } else if (t == PAUSE) {
        s.working[t] = !(unit(t) && k.processor.clock >= c->released);
    } else {
        s.left[t] -= unit(t);
        s.working[t] = s.left[t] > 0;
    }
}

static void interrupt(void)
{
    static bool given;

    given ? kernel_end_interrupt(&k, true) : kernel_give(&k, BYTES);
    given = !given;
}

static void play(const struct scenario *c)
{
    struct kernel_config config = { .tasks = TASKS, .tick = c->tick };

    for (int i = 0; i < TASKS; i++) {
        config.priority[i] = PRIORITY[i];
    }
    memset(&s, 0, sizeof s);
    memset(&scheme, 0, sizeof scheme);
    CHECK_EQ(kernel_start(&k, &config), KERNEL_OK);
    for (int next = 0; k.processor.clock < LATEST && scheme.units < UNITS;) {
        const int64_t until = next < c->packets ? c->packet[next].clock : LATEST;
        for (int who; scheme.units < UNITS && (who = kernel_next(&k, until)) >= 0;) {
            read_log(c);
            if (who < KERNEL_TASKS) {
                act(c, (enum task)who);
            } else {
                interrupt();
            }
            read_log(c);
        }
        read_log(c);
        if (next < c->packets) {
            kernel_pend(&k, 0, c->packet[next++].clock);
        }
    }
}

static const char *recorded(const char *scenario)
{
    for (size_t i = 0; i < sizeof RECORDED / sizeof *RECORDED; i++) {
        if (strcmp(RECORDED[i].scenario, scenario) == 0) {
            return RECORDED[i].tokens;
        }
    }
    return "nothing";
}

int main(void)
{
    for (int i = 0; i < SCENARIOS; i++) {
        const char *want = recorded(SCENARIO[i].name);
        play(&SCENARIO[i]);
        if (strcmp(scheme.text, want) != 0) {
            printf("%s:\n%s\non FreeRTOS:\n%s\n", SCENARIO[i].name, scheme.text, want);
            check_failures++;
        }
    }
    return check_result();
}
