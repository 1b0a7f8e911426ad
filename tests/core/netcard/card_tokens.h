/* card_tokens - for the tests: tokens, made from the kernel's log, of what the tasks of a network
 * card do under the literal rules of the source document.
 *
 * rN is unit N of work: a frame that run writes; p, s a turn of pause and stop, h a frame of
 * homing. !x an interrupt with packet x, !button one of an input; >t task t gets the processor;
 * 5>2 home's priority. What serves these only is left out: the storage task, interrupts of flash
 * and FPGA. */
#ifndef CARD_TOKENS_H
#define CARD_TOKENS_H

#include <stdarg.h>

#include "card_bench.h"

static const char *const name[] = { "parse", "storage", "home", "stop", "pause", "run" };
static const char letter[] = "--hspr";
static const char *const command_name[] = { "start", "pause", "stop", "home" };
enum { BUTTON_START, BUTTON_PAUSE, BUTTON_STOP, BUTTON_HOME }; /* inputs, and their vectors */
static struct netcard c;
static char text[200000];
static size_t length;
static int64_t seen;
static int units;
static enum card_command packet;
static bool hidden; /* the interrupts of buttons are left out */

static inline void say(const char *format, ...)
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

static inline void read_log(void)
{
    CHECK(c.kernel.events - seen <= KERNEL_LOG);
    for (; seen < c.kernel.events; seen++) {
        const struct kernel_event *e = &c.kernel.log[seen % KERNEL_LOG];
        if (e->what == KERNEL_RUNS && e->number != NETCARD_STORAGE) {
            say(">%s ", name[e->number]);
        } else if (e->what == KERNEL_INTERRUPT && e->number == NETCARD_NETWORK) {
            say("!%s ", command_name[packet]);
        } else if (e->what == KERNEL_INTERRUPT && e->number <= BUTTON_HOME && !hidden) {
            say("!button-%s ", command_name[e->number]);
        } else if (e->what == KERNEL_PRIORITY) {
            say("%s ", e->value == 2 ? "5>2" : "2>5");
        } else if (e->what == KERNEL_MARK) {
            say("%c%d ", letter[e->value], ++units);
        }
    }
}

static inline void pass(int64_t ns)
{
    for (const int64_t end = c.now + ns; c.now < end;) {
        const bool on = bench_count(&c, 0) <= -300; /* the origin switch of axis X */
        if (on != (c.axes.origin & 1)) {
            netcard_set_axes(&c, &(struct netcard_axes){ .origin = on });
        }
        netcard_advance(&c, c.now + 500);
        read_log();
        bench_urgent(&c.kernel);
    }
    bench_times(&c);
}

/* Run until a number of units are done, then send a packet, within the next unit. */
static inline void send_behind(int unit, enum card_command command)
{
    while (units < unit && c.now < 1000 * BENCH_MS) {
        pass(500);
    }
    CHECK_EQ(units, unit);
    packet = command;
    netcard_command(&c, command, 15);
}

/* A short press of a button. */
static inline void press(int button)
{
    netcard_set_inputs(&c, 1u << button);
    pass(500);
    netcard_set_inputs(&c, 0);
}

static inline void begin_with(struct netcard_config config)
{
    config.settings.policy = CARD_LITERAL;
    for (int i = BUTTON_START; i <= BUTTON_HOME; i++) {
        config.settings.in_action[i] = CARD_START + i;
        config.settings.in_debounce_us[i] = 0;
    }
    config.settings.home_order[1] = config.settings.home_order[2] = 0;
    config.settings.home_order[3] = 0;
    config.settings.home_back[0] = 100;
    bench_make(300, 100, NULL, 0);
    bench_start(&c, &config);
    hidden = false;
    length = 0;
    seen = units = 0;
    text[0] = '\0';
    pass(BENCH_MS);
    send_behind(0, CARD_DO_START);
}

static inline void begin(void)
{
    begin_with(bench_config());
}

/* Forget the tokens so far; units count from 0 again. */
static inline void anew(void)
{
    length = 0;
    units = 0;
    text[0] = '\0';
}

/* Run until the text has this token, for a limited time. */
static inline void until(const char *token)
{
    for (int i = 0; i < 400 && !strstr(text, token); i++) {
        pass(BENCH_MS);
    }
}

static inline void shows(const char *tokens)
{
    if (!strstr(text, tokens)) {
        check_failures++;
        printf("not in the sequence: %s\n%.700s\n", tokens, text);
    }
}

#endif
