/* arm - a controller in sixty lines: the tool of an arm draws straight lines.
 *
 *     command ──trajectory──> frame ──fifo──> dda ──> pulses of both joints
 *     task, when there is room           hardware, whose interrupt tells of room
 */
#ifndef ARM_H
#define ARM_H

#include <stddef.h>

#include "dda.h"
#include "fifo.h"
#include "kernel.h"
#include "trajectory.h"

enum { ARM_JOINTS = 2, ARM_DEPTH = 8, ARM_CLOCK = 50000000, ARM_TICKS = 100000 }; /* 2 ms */

struct arm {
    struct kernel kernel;
    struct trajectory trajectory;
    struct ring ring;
    struct lookahead_mean mean;
    struct dda dda;
    struct fifo fifo[ARM_JOINTS];
    int32_t entry[ARM_JOINTS][ARM_DEPTH];
    bool planned, told; /* of the task: the time of a point is over; of the interrupt */
};

static inline struct trajectory_beside arm_beside(struct arm *a)
{
    return (struct trajectory_beside){ &a->ring, &a->mean, NULL };
}

/* At rest with the tool at a place; false if it is out of reach. */
bool arm_start(struct arm *a, const struct mechanism *m, const double place[AXES]);

/* All that happens before a clock. */
void arm_run(struct arm *a, const struct mechanism *m, int64_t until);

#endif
