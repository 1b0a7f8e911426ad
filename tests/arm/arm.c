#include "arm.h"

#include <string.h>

static const double FRAME = (double)ARM_TICKS / ARM_CLOCK;  /* [s] */
enum { PLANS, ROOM = 0, BOUNDARY = 0, POINT_TIME = 20000 }; /* task; semaphore; interrupt */

bool arm_start(struct arm *a, const struct mechanism *m, const double place[AXES])
{
    memset(a, 0, sizeof *a);
    trajectory_start(&a->trajectory);
    dda_reset(&a->dda, ARM_JOINTS, ARM_TICKS, 1);
    for (int i = 0; i < ARM_JOINTS; i++) {
        fifo_reset(&a->fifo[i], ARM_DEPTH);
    }
    return trajectory_stand(&a->trajectory, m, place)
           && !kernel_start(&a->kernel, &(struct kernel_config){ .tasks = 1 });
}

static void make_frame(struct arm *a, const struct mechanism *m)
{
    const struct trajectory_beside beside = arm_beside(a);
    struct point p;
    double left = FRAME;
    do {
        left = trajectory_advance(&a->trajectory, &beside, left);
    } while (left > 0.0 && !trajectory_resting(&a->trajectory, &a->ring));
    trajectory_point(&a->trajectory, &beside, m, FRAME, &p);
    for (int i = 0; i < ARM_JOINTS; i++) {
        fifo_push(&a->fifo[i], a->entry[i], p.pulses[i] - a->trajectory.pulses[i]);
    }
    trajectory_accept(&a->trajectory, &beside, &p);
}

static void task(struct arm *a, const struct mechanism *m)
{
    if (a->planned) {
        make_frame(a, m);
    }
    a->planned = a->fifo[0].stock < ARM_DEPTH;
    a->planned ? kernel_compute(&a->kernel, POINT_TIME) : kernel_take(&a->kernel, ROOM);
}

static void interrupt(struct arm *a)
{
    a->told = !a->told;
    a->told ? kernel_give(&a->kernel, ROOM) : kernel_end_interrupt(&a->kernel, true);
}

void arm_run(struct arm *a, const struct mechanism *m, int64_t until)
{
    for (;;) {
        const int64_t boundary = dda_boundary(&a->dda);
        const int who = kernel_next(&a->kernel, boundary < until ? boundary : until);
        if (who >= 0) {
            who == PLANS ? task(a, m) : interrupt(a);
        } else if (boundary < until) {
            int32_t next[ARM_JOINTS] = { 0 };
            for (int i = 0; i < ARM_JOINTS; i++) {
                fifo_pop(&a->fifo[i], a->entry[i], &next[i]);
            }
            dda_begin(&a->dda, next);
            kernel_pend(&a->kernel, BOUNDARY, boundary);
        } else {
            return;
        }
    }
}
