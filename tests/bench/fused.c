/* The loop of scenarios/circle or of six_axes without FMI: the same models, one program, wires as
 * assignments. SCENARIO is the header with the axes USED and what is RECORDED.
 *
 *     fused PROGRAM STEPS FILE    runs STEPS steps of 100 us, writes the recorded rows to FILE and
 *                                 prints the processor seconds that the loop took
 *     fused --layout              prints name, type, elements and offset of each recorded value
 *
 * Every step first carries all wires, then steps all models (Jacobi), as the native engine does.
 */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include SCENARIO
#include "link.h"
#include "parts.h"

enum { STEP_NS = 100000, AXES = 6 };

struct row {
#define MEMBER(part, name, type, count) type part##_##name[count];
    RECORDED(MEMBER)
};

static struct mcc_vars *mcc;
static struct epcio_vars *card;
static struct servo_drives_vars *drives;
static struct ball_screw_axes_vars *machine;

#define CARRY(to, input, from, output) \
    do { \
        _Static_assert(sizeof(to)->input == sizeof(from)->output, "one type, one size"); \
        memcpy(&(to)->input, &(from)->output, sizeof(to)->input); \
    } while (0)

static void carry(void)
{
#define HOST(type, name, elements) LINK_CARRY(card->host_##name, mcc->card_##name)
    LINK_LEVELS(HOST)
    LINK_WRITE(HOST)
#define BACK(type, name, elements) LINK_CARRY(mcc->card_##name, card->name)
    LINK_SHOWN(BACK)
    LINK_SHOWN_MACHINE(BACK)
    CARRY(card, enc_phase, machine, motor_phase);
    CARRY(drives, dac, card, dac);
    CARRY(drives, phase, machine, motor_phase);
    CARRY(machine, torque_command, drives, torque);
}

static void record(struct row *row)
{
#define KEEP(part, name, type, count) memcpy(&row->part##_##name, &part->name, sizeof part->name);
    RECORDED(KEEP)
}

static void prepare(const char *program)
{
    mcc = mcc_open();
    card = epcio_open();
    drives = servo_drives_open();
    machine = ball_screw_axes_open();
    snprintf(mcc->program, sizeof mcc->program, "%s", program);
    for (int i = 0; i < AXES; i++) {
        mcc->p_gain[i] = 200;
        mcc->active[i] = card->active[i] = drives->active[i] = machine->active[i] = i < USED;
    }
    mcc_start();
    epcio_start();
    servo_drives_start();
    ball_screw_axes_start();
}

static double seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void loop(struct row *rows, long steps)
{
    for (long k = 0; k < steps; k++) {
        const int64_t t0 = (int64_t)k * STEP_NS, t1 = t0 + STEP_NS;
        carry();
        record(&rows[k]);
        mcc_step(t0, t1);
        epcio_step(t0, t1);
        servo_drives_step(t0, t1);
        ball_screw_axes_step(t0, t1);
    }
}

static int layout(void)
{
#define LINE(part, name, type, count) \
    printf("%s.%s %s %d %zu\n", #part, #name, #type, count, offsetof(struct row, part##_##name));
    RECORDED(LINE)
    printf("row %zu\n", sizeof(struct row));
    return 0;
}

int main(int argc, char **argv)
{
    if (argc == 2 && strcmp(argv[1], "--layout") == 0) {
        return layout();
    }
    if (argc != 4) {
        fputs("usage: fused PROGRAM STEPS FILE | fused --layout\n", stderr);
        return 2;
    }
    const long steps = atol(argv[2]);
    struct row *rows = calloc((size_t)steps, sizeof *rows);
    FILE *file = fopen(argv[3], "wb");
    if (!rows || !file) {
        perror(argv[3]);
        return 2;
    }
    prepare(argv[1]);
    const double start = seconds();
    loop(rows, steps);
    printf("%.9f\n", seconds() - start);
    mcc_end();
    const size_t written = fwrite(rows, sizeof *rows, (size_t)steps, file);
    return fclose(file) || written != (size_t)steps ? 2 : 0;
}
