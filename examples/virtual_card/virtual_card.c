/* A program of the MCC library on the virtual card: lines and a circle by calls of the API, then a
 * part program. motionfmu.virtual.mcc.card_example does the same.
 *
 *     cc -O2 virtual_card.c $(pkg-config --cflags --libs motionfmu-station) -o virtual_card
 *     ./virtual_card part.ngc
 */
#include <stdio.h>

#include <motionfmu/short_names.h>
#include <motionfmu/station.h>

static struct station station; /* 400 kB: not on the stack */

/* Run and print ten times a second until all rests. */
static int run(const struct source *program)
{
    struct station_reading r;
    do {
        if (station_run(&station, station.clock + STATION_HZ / 10, program) != STATION_OK) {
            return 1;
        }
        station_read(&station, &r);
        printf("%6.1f s  X %9.4f  Y %9.4f  Z %9.4f mm  F %6.2f mm/s  stock %d\n",
               (double)r.clock / STATION_HZ, r.table[0], r.table[1], r.table[2], r.path_feed,
               (int)r.stock[0]);
    } while (!r.stopped);
    printf("pulses %lld %lld %lld, interrupts %d, underflows %d\n", (long long)r.pulses[0],
           (long long)r.pulses[1], (long long)r.pulses[2], (int)r.interrupts, (int)r.underflows[0]);
    return 0;
}

/* Calls of the library: each returns the command's index, or a code below 0. */
static int calls(struct mcc *mcc)
{
    MCC_set_abs(mcc);
    MCC_set_fspd(mcc, 25.0);
    MCC_set_acc_type(mcc, 'S');
    MCC_enable_quit(mcc);
    if (MCC_line(mcc, (double[AXES]){ 20.0, 10.0 }) < 0 || MCC_circle_xy(mcc, 20.0, 15.0, 1) < 0
        || MCC_ptp(mcc, (double[AXES]){ 0.0 }) < 0) {
        return 1;
    }
    printf("a feed of 0 is refused: %d\n", MCC_set_fspd(mcc, 0.0));
    return run(NULL);
}

static int part_program(const char *name)
{
    static char text[65536];
    FILE *file = fopen(name, "r");
    if (!file) {
        perror(name);
        return 1;
    }
    struct source_text t = { text, (int64_t)fread(text, 1, sizeof text, file) };
    const struct source program = source_of(&t);
    struct fault_report report;
    fclose(file);
    task_check(&station.pc.mcc, &program, &report);
    if (report.fault != FAULT_NONE) {
        printf("%s: line %d: %s\n", name, (int)report.line, fault_text(report.fault));
        return 1;
    }
    return task_start(&station.pc.mcc) < 0 || run(&program);
}

int main(int argc, char **argv)
{
    struct station_config config = station_defaults();
    config.pc.output_mode[0] = STATION_LOOP; /* X: the card's position loop */
    config.machine.axis[0].p_gain = 200;
    if (station_start(&station, &config) != STATION_OK) {
        return 1;
    }
    return calls(&station.pc.mcc) || (argc > 1 && part_program(argv[1]));
}
