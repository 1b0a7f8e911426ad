#include "soft.h"

/* As of a library: what waits, and what is under way. Moves of the course are those of the latest
 * COURSE_SIZE, pieces of the way those that are no command yet. */
static void robot_unused(const struct robot *r, struct spans *s)
{
    struct robot *robot = (struct robot *)(uintptr_t)r;
    const struct mover_beside beside = { &robot->ring, &robot->mean, NULL };

    mover_unused(&r->mover, &beside, s);
    if (r->course.count < COURSE_SIZE) {
        spans_leave(s, &r->course.move[r->course.count], r->course.move + COURSE_SIZE);
    }
    spans_leave(s, &r->way.piece[r->way.count], r->way.piece + WAY_PIECES);
}

void soft_unused(const struct soft *f, struct spans *s)
{
    robot_unused(&f->robot, s);
    interpreter_unused(&f->orders.gcode, s);
    spans_ring(s, f->queue, sizeof f->queue[0], SOFT_QUEUE, f->heads, f->count);
    spans_leave(s, &f->taught[f->taught_count], f->taught + SOFT_TAUGHT);
}
