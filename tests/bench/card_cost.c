/* What the card alone costs: pulse rate and axes against time, at instants of 100 us.
 *
 *     card_cost AXES HERTZ EDGES      AXES move at HERTZ pulses/s for SECONDS; encoders follow;
 *                                     EDGES 1: the clock of every single pulse is asked for too
 *
 * Prints the seconds of processor time per simulated second.
 */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "registers.h"

enum { PERIOD = 4000, SECONDS = 2, LENGTH = 15, DIVIDER = 1 };

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Clocks of all pulses of the DDA times that passed, summed so that none is left out. */
static int64_t all_edges(const struct epcio *card, int axes, int64_t from)
{
    int64_t sum = 0, clock = from;
    for (int i = 0; i < axes; i++)
        for (int32_t j = 1; (clock = dda_edge_clock(&card->dda, i, j)) >= 0 && clock <= card->clock;
             j++)
            sum += clock > from ? clock : 0;
    return sum;
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: card_cost AXES HERTZ EDGES\n");
        return 2;
    }
    int axes = atoi(argv[1]), edges = atoi(argv[3]);
    int32_t frame[EPCIO_AXES] = { 0 };
    struct epcio card;
    struct epcio_config config = epcio_default_config();
    struct epcio_host host = { .gain = { 0 } };
    for (int i = 0; i < EPCIO_AXES; i++) {
        config.active[i] = i < axes;
        host.gain[i] = 60;
        host.loop_on[i] = host.dac_loop[i] = i < axes;
        if (i < axes)
            frame[i] = (int32_t)(atof(argv[2]) * 25e-9 * DIVIDER * (1 << LENGTH) + 0.5);
    }
    if (epcio_reset(&card, &config) || epcio_set_dda(&card, LENGTH, DIVIDER)
        || epcio_set_host(&card, &host))
        return 1;
    struct epcio_lines lines = { .local.power = true };
    int64_t pulses[EPCIO_AXES], sum = 0;
    int bad = 0;
    double begin = now();
    for (int64_t clock = 0; clock < (int64_t)SECONDS * EPCIO_CLOCK_HZ; clock += PERIOD) {
        epcio_advance(&card, clock);
        epcio_convert(&card);
        if (edges)
            sum += all_edges(&card, axes, clock - PERIOD);
        epcio_pulses(&card, pulses);
        for (int i = 0; i < axes; i++)
            lines.phase[i] = 0.25 * (double)pulses[i];
        if (epcio_sample(&card, &lines, &bad))
            return 1;
        while (card.fifo[0].stock < 4)
            epcio_write_frame(&card, frame);
        epcio_control(&card);
    }
    double spent = now() - begin;
    epcio_pulses(&card, pulses);
    printf("%.9g %lld %lld\n", spent / SECONDS, (long long)pulses[0], (long long)sum);
    return 0;
}
