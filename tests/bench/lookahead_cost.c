/* What one short segment costs by look-ahead: planned as a command, waited in the ring, joined,
 * planned in its chain, made into points.
 *
 *     lookahead_cost <filling> <DDA time [ms]> <T or S> [<jerk [mm/s^3]> [<segments>]]
 *
 * A random walk of 100,000 steps of 0.1 mm, or so many, with a constant number of commands in the
 * ring. With a jerk the walk is a curve with that of each axis, 0 no limit, and an acceleration of
 * 2 m/s^2. Prints the seconds of processor time per segment and the points made per segment.
 */
#define _POSIX_C_SOURCE 199309L /* clock_gettime */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "task.h"

enum { MOST = 100000 }; /* segments */

static const double STEP = 0.1; /* [mm] */
static const double FEED
= 100.0; /* [mm/s] */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static struct machine machine_at(double dda_time, char ramps)
{
    struct machine m = {
        .dda_time = dda_time,
        .dda_length = 15,
        .queue_depth = 1,
        .feed = FEED,
        .max_feed = 1000.0,
        .acc_time = 0.05,
        .dec_time = 0.05,
        .acc_type = ramps,
        .dec_type = ramps
    };
    for (int i = 0; i < AXES; i++) {
        m.axis[i] = (struct machine_axis){ .used = i < 3,
                                           .pitch = 10.0,
                                           .gear_ratio = 1.0,
                                           .ppr = 1000,
                                           .rpm = 6000.0,
                                           .p_gain = 60 };
    }
    return m;
}

/* Uniform in -1 .. 1 (xorshift64). */
static double uniform(uint64_t *state)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return (double)(*state >> 11) * 0x1p-52 - 1.0;
}

/* The walk: each step turns by up to 0.1 rad, and round in the long run, so not far off. */
static void make(double walk[][AXES], int segments)
{
    double angle = 0.0, x = 0.0, y = 0.0;
    uint64_t seed = 1;

    for (int i = 0; i < segments; i++) {
        angle += 0.1 * uniform(&seed) + 1e-3;
        walk[i][0] = x += STEP * cos(angle);
        walk[i][1] = y += STEP * sin(angle);
    }
}

int main(int argc, char **argv)
{
    static struct mcc m;
    static double walk[MOST][AXES];
    const int segments = argc > 5 && atoi(argv[5]) < MOST ? atoi(argv[5]) : MOST;
    const int filling = argc > 1 ? atoi(argv[1]) : RING_SIZE;
    const double dda_time = argc > 2 ? 1e-3 * atof(argv[2]) : 1e-3;
    struct machine machine = machine_at(dda_time, argc > 3 ? argv[3][0] : 'T');
    int sent = 0;
    long points = 0;

    for (int i = 0; i < AXES && argc > 4; i++) {
        machine.axis[i].acc = 2000.0;
        machine.axis[i].jerk = atof(argv[4]);
    }
    if (MCC_init_motion(&m, &machine) || mcc_set_tolerance(&m, 0.01)
        || mcc_set_curve(&m, argc > 4, 0.01)) {
        return 1;
    }
    make(walk, segments);
    const double begin = now();
    do {
        for (; sent < segments && m.ring.count < filling; sent++) {
            if (MCC_line(&m, walk[sent]) < 0) {
                return 1;
            }
        }
        task_run(&m, NULL);
        points += m.queue.count;
        queue_drop(&m.queue, m.queue.count);
    } while (sent < segments || !MCC_check_stop(&m));
    const double used = now() - begin;
    if (m.error || sent != segments) {
        fprintf(stderr, "error 0x%X after %d segments\n", (unsigned)m.error, sent);
        return 1;
    }
    printf("%.9g %.9g\n", used / segments, (double)points / segments);
    return 0;
}
