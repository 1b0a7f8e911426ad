/* gcode_reader - for the tests of the interpreter: reads a part program in memory command by
 * command, and finds its faults. */
#ifndef GCODE_READER_H
#define GCODE_READER_H

#include "interpreter.h"
#include "mcc_check.h"

static const double origins[INTERPRETER_SYSTEMS][AXES] = { { 0 }, { 100.0, 10.0, 1.0 } };

struct reader {
    struct machine machine;
    struct interpreter in;
    struct source_text text;
    struct source source;
    struct program program;
    struct command c;
    struct fault_report r;
};

static inline void begin(struct reader *x, const char *text)
{
    const double zero[AXES] = { 0.0 };
    memset(x, 0, sizeof *x);
    x->machine = mcc_machine();
    x->machine.axis[2].check_ot = true; /* Z from -700 mm to 700 mm */
    x->machine.axis[2].high_limit = 701.0;
    x->machine.axis[2].low_limit = -700.0;
    x->machine.axis[2].hot_offset = -1.0;
    x->text = (struct source_text){ text, (int64_t)strlen(text) };
    x->source = source_of(&x->text);
    x->program = (struct program){ .source = &x->source,
                                   .strict_feed = true,
                                   .machine = machine_mechanism(&x->machine),
                                   .limits = machine_limits(&x->machine) };
    interpreter_start(&x->in, zero, x->machine.feed, origins);
}

/* Read the next command. Returns its type, -1 at the end, or -2 for a fault. */
static inline int next(struct reader *x)
{
    const enum interpreter_result got = interpreter_next(&x->in, &x->program, &x->c, &x->r);
    return got == INTERPRETER_END ? -1 : got == INTERPRETER_FAULT ? -2 : (int)x->c.type;
}

static inline void expect_end(struct reader *x, double a, double b, double c)
{
    CHECK_NEAR(x->c.path.end[0], a, 1e-12);
    CHECK_NEAR(x->c.path.end[1], b, 1e-12);
    CHECK_NEAR(x->c.path.end[2], c, 1e-12);
}

/* Whether the first fault of a text is this one, in this line and at this part of it. */
static inline bool fault_is(const char *text, int line, const char *at, enum fault fault)
{
    struct reader x;
    struct fault_report r;
    begin(&x, text);
    const struct interpreter before = x.in;
    interpreter_check(&x.in, &x.program, &r);
    CHECK(!memcmp(&before, &x.in, sizeof before));
    while (next(&x) >= 0) {
    }
    CHECK_EQ(next(&x), -1); /* a fault ends the program */
    const char *found = text + r.offset + r.at;
    const bool good = r.fault == fault && r.line == line && (size_t)r.length == strlen(at)
                      && !memcmp(found, at, strlen(at));
    CHECK(good);
    if (!good) {
        printf("    '%s': line %d: %s '%.*s'\n", text, (int)r.line, fault_text(r.fault),
               (int)r.length, found);
    }
    return good;
}

#endif
