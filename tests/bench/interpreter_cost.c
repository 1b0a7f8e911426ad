/* What one line of a part program costs: read, checked and planned, from text in memory.
 *
 * Prints the seconds of processor time per line, those of strtod for the line's numbers alone, and
 * the lines read.
 */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "interpreter.h"
#include "machine.h"

enum { BLOCKS = 40000, LONGEST = 512, LINES = 10 * BLOCKS }; /* each of ten lines */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Lines as a program for three axes has them: mostly lines and arcs, with and without codes. */
static size_t write_block(char *to, int n)
{
    const double x = n % 1000 * 0.1234, y = n % 777 * 0.4321, z = n % 10 * 0.25;
    return (size_t)snprintf(to, LONGEST,
                            "N%d G1 X%.4f Y%.4f Z%.4f F1500\n"
                            "X%.4f Y%.4f\n"
                            "x%.3f y%.3f ( a comment )\n"
                            "G2 X%.4f Y%.4f I2. J0\n"
                            "G3 X%.4f Y%.4f R5.5 ; on the other side\n"
                            "G0 Z5 M8 S12000\n"
                            "X0 Y0 M9\n"
                            "G91 G1 Z-4.5\n"
                            "G90 G64 X%.4f Y%.4f Z%.4f F%d\n"
                            "X-%.4f\n",
                            n, x, y, z, x + 0.5, y - 0.25, x + 0.625, y + 0.125, x + 4.625,
                            y + 0.125, x + 8.0, y, y, x, z, 600 + n % 100, y + 0.5);
}

/* The first character of the text's next number, or its end. */
static char *next_number(char *at)
{
    return at + strcspn(at, "+-.0123456789");
}

int main(void)
{
    static const double origin[INTERPRETER_SYSTEMS][AXES];
    struct machine machine = { .dda_time = 1e-3,
                               .dda_length = 12,
                               .queue_depth = 64,
                               .feed = 10.0,
                               .max_feed = 1000.0,
                               .acc_time = 0.1,
                               .dec_time = 0.1 };
    for (int i = 0; i < AXES; i++) {
        machine.axis[i] = (struct machine_axis){ .used = i < 3,
                                                 .pitch = 10.0,
                                                 .gear_ratio = 1.0,
                                                 .ppr = 10000,
                                                 .rpm = 3000.0,
                                                 .p_gain = 60 };
    }
    char *all = malloc((size_t)BLOCKS * LONGEST), *end = all;
    if (!all) {
        return 1;
    }
    for (int n = 0; n < BLOCKS; n++) {
        end += write_block(end, n);
    }

    struct source_text text = { all, end - all };
    const struct source source = source_of(&text);
    const struct program program = { .source = &source,
                                     .machine = machine_mechanism(&machine),
                                     .limits = machine_limits(&machine) };
    struct interpreter in;
    struct fault_report r;
    interpreter_start(&in, origin[0], machine.feed, origin);
    const double begin = now();
    interpreter_check(&in, &program, &r);
    const double read = now();
    double sum = 0.0;
    for (char *at = next_number(all); *at; at = next_number(at + 1)) {
        char *behind;
        sum += strtod(at, &behind);
        at = behind > at ? behind - 1 : at;
    }
    const double done = now();
    if (r.fault != FAULT_NONE || sum == 0.0) {
        fprintf(stderr, "line %d: %s\n", (int)r.line, fault_text(r.fault));
        return 1;
    }
    printf("%.9g %.9g %d\n", (read - begin) / LINES, (done - read) / LINES, LINES);
    free(all);
    return 0;
}
