/* robot_job_changed - positions while a program runs: as the files have them, or as the program has
 * set them. */
#include <math.h>
#include <string.h>

#include "robot_job_values.h"

enum { AXES = 6 };

/* Elements count in micrometres and ten thousandths of a degree. */
#define PER_MM  1000.0
#define PER_DEG 10000.0

/* Number by which all jobs know a position; -1: it is one job's own. */
static int32_t common(const struct robot_job_program *p, int32_t number)
{
    if (number < ROBOT_JOB_POINTS) {
        return number;
    }
    const struct robot_job_position *q = &p->position[number - ROBOT_JOB_POINTS];
    return q->job < 0 ? q->number : -1;
}

const struct robot_job_point *robot_job_place(const struct robot_job_run *run,
                                              const struct robot_job_program *p,
                                              const struct robot_job_points *points, int32_t number)
{
    const int32_t n = common(p, number);
    for (int32_t i = 0; i < run->changes && n >= 0; i++) {
        if (run->changed[i].number == n) {
            return &run->changed[i].point;
        }
    }
    return robot_job_point(p, points, number);
}

/* The number of a position that P[..] means: that of the points file, or of a job. */
static int32_t settled(const struct robot_job_program *p, const struct robot_job_points *points,
                       int32_t number)
{
    for (int32_t i = 0; i < p->positions && number < ROBOT_JOB_POINTS
                        && points->point[number].kind == ROBOT_JOB_NO_POINT;
         i++) {
        if (p->position[i].job < 0 && p->position[i].number == number) {
            return ROBOT_JOB_POINTS + i;
        }
    }
    return number;
}

enum robot_job_fault robot_job_which(struct robot_job_run *run, const struct robot_job_program *p,
                                     const struct robot_job_points *points, int32_t number,
                                     const struct robot_job_by *by, int32_t *which)
{
    *which = settled(p, points, robot_job_element(run, by, number, ROBOT_JOB_POINTS));
    return run->fault != ROBOT_JOB_OK ? run->fault
           : robot_job_place(run, p, points, *which)->kind == ROBOT_JOB_NO_POINT
               ? ROBOT_JOB_BAD_UNSET
               : ROBOT_JOB_OK;
}

/* Where a position is kept that is set: at first as it is. NULL: there is no room. */
static struct robot_job_point *kept(struct robot_job_run *run, const struct robot_job_program *p,
                                    const struct robot_job_points *points, int32_t number)
{
    for (int32_t i = 0; i < run->changes; i++) {
        if (run->changed[i].number == number) {
            return &run->changed[i].point;
        }
    }
    if (run->changes == ROBOT_JOB_CHANGED) {
        return NULL;
    }
    const struct robot_job_point *was = robot_job_point(p, points, settled(p, points, number));
    struct robot_job_changed *now = &run->changed[run->changes++];
    *now = (struct robot_job_changed){ .number = number, .point = *was };
    return &now->point;
}

/* What one of an element counts, in the unit of a position's value. */
static double per(const struct robot_job_point *q, int32_t element)
{
    return q->kind == ROBOT_JOB_PULSES                ? 1.0
           : q->kind == ROBOT_JOB_POSE && element < 3 ? PER_MM
                                                      : PER_DEG;
}

/* A position that has no value yet is, to what adds to it, that of zeros. */
static void begin(struct robot_job_point *q, const struct robot_job_point *like)
{
    if (q->kind == ROBOT_JOB_NO_POINT) {
        *q = robot_job_point_open();
        q->kind = like ? like->kind : ROBOT_JOB_POSE;
        q->tool = like ? like->tool : ROBOT_JOB_ANY;
        q->user = like ? like->user : 0;
    }
}

/* Whether elements of a position are numbers that D variables can have. */
static enum robot_job_fault checked(const struct robot_job_point *q)
{
    bool good = true;
    for (int i = 0; i < AXES; i++) {
        good &= fabs(q->value[i]) * per(q, i) <= -(double)INT32_MIN;
    }
    return good ? ROBOT_JOB_OK : ROBOT_JOB_BAD_RANGE;
}

/* ADD, SUB: element by element; the first keeps its tool, frame and configuration. */
static enum robot_job_fault add(struct robot_job_point *q, const struct robot_job_point *by,
                                double sign)
{
    begin(q, by);
    if (q->kind != by->kind) {
        return ROBOT_JOB_BAD_PLACES;
    }
    for (int i = 0; i < AXES; i++) {
        q->value[i] += sign * by->value[i];
    }
    return checked(q);
}

/* GETE: an element of a position, rounded, into a variable. */
static enum robot_job_fault take(struct robot_job_run *run, const struct robot_job_point *q,
                                 const struct robot_job_instruction *c)
{
    return robot_job_store(run, &c->left, round(q->value[c->level] * per(q, c->level)));
}

/* A position that a line looks at, in *q: a copy, as it may be the one that changes. */
static enum robot_job_fault look(struct robot_job_run *run, const struct robot_job_program *p,
                                 const struct robot_job_points *points, int32_t number,
                                 const struct robot_job_by *by, struct robot_job_point *q)
{
    int32_t which;
    const enum robot_job_fault fault = robot_job_which(run, p, points, number, by, &which);
    *q = *robot_job_place(run, p, points, which);
    return fault;
}

/* The positions that a line looks at: none, one, or of MSHIFT where it begins and ends. */
static enum robot_job_fault sources(struct robot_job_run *run, const struct robot_job_program *p,
                                    const struct robot_job_points *points,
                                    const struct robot_job_instruction *c,
                                    struct robot_job_point of[2])
{
    memset(of, 0, 2 * sizeof *of);
    if (c->op == ROBOT_JOB_OP_SETE || c->op == ROBOT_JOB_OP_GETS) {
        return ROBOT_JOB_OK;
    }
    const enum robot_job_fault fault = look(run, p, points, c->via, &c->via_by, &of[0]);
    if (fault == ROBOT_JOB_BAD_UNSET
        && (c->op == ROBOT_JOB_OP_PLACE_ADD || c->op == ROBOT_JOB_OP_PLACE_SUB)) {
        begin(&of[0], NULL); /* SUB P001 P001 */
        return ROBOT_JOB_OK;
    }
    return fault == ROBOT_JOB_OK && c->op == ROBOT_JOB_OP_MSHIFT
               ? look(run, p, points, c->end, &c->end_by, &of[1])
               : fault;
}

/* The tool and user frame of a position are those in force where it names none. */
static void settle(const struct robot_job_run *run, struct robot_job_point *q)
{
    q->tool = q->tool != ROBOT_JOB_ANY ? q->tool : run->tool;
    q->user = q->user != ROBOT_JOB_ANY ? q->user : run->user;
}

/* CNVRT: a position as a pose in a frame. */
static enum robot_job_fault convert(const struct robot_job_run *run,
                                    const struct robot_job_inputs *in,
                                    const struct robot_job_instruction *c,
                                    struct robot_job_point *from, struct robot_job_point *q)
{
    settle(run, from);
    *q = robot_job_point_open();
    q->kind = ROBOT_JOB_POSE;
    q->tool = c->level != ROBOT_JOB_ANY ? c->level : from->tool;
    q->user = c->increment;
    in->convert(in->arm, from, q);
    return checked(q);
}

/* MSHIFT: what leads from a position to another, in a frame. Turns that no element can say are
 * none, so that what a shift may be is not up to rounding. */
static enum robot_job_fault difference(const struct robot_job_run *run,
                                       const struct robot_job_inputs *in,
                                       const struct robot_job_instruction *c,
                                       struct robot_job_point *from, struct robot_job_point *to,
                                       struct robot_job_point *q)
{
    settle(run, from);
    settle(run, to);
    *q = robot_job_point_open();
    q->kind = ROBOT_JOB_POSE;
    q->user = 0;
    in->shift(in->arm, from, to, c->increment, q->value);
    for (int i = AXES / 2; i < AXES; i++) {
        q->value[i] = fabs(q->value[i]) * PER_DEG < 0.5 ? 0.0 : q->value[i];
    }
    return checked(q);
}

enum robot_job_fault robot_job_change(struct robot_job_run *run, const struct robot_job_program *p,
                                      const struct robot_job_points *points,
                                      const struct robot_job_inputs *in,
                                      const struct robot_job_instruction *c)
{
    struct robot_job_point of[2], here[2];
    const enum robot_job_fault fault = sources(run, p, points, c, of);
    if (fault != ROBOT_JOB_OK) {
        return fault;
    }
    if (c->op == ROBOT_JOB_OP_GETE) {
        return take(run, &of[0], c);
    }
    const int32_t number = robot_job_element(run, &c->to_by, c->to, ROBOT_JOB_POINTS);
    struct robot_job_point *q = run->fault == ROBOT_JOB_OK ? kept(run, p, points, number) : NULL;
    if (!q) {
        return run->fault != ROBOT_JOB_OK ? run->fault : ROBOT_JOB_BAD_CHANGED;
    }
    switch (c->op) {
    case ROBOT_JOB_OP_PLACE_SET: *q = of[0]; return ROBOT_JOB_OK;
    case ROBOT_JOB_OP_GETS:
        in->here(in->arm, here);
        *q = here[c->level];
        return ROBOT_JOB_OK;
    case ROBOT_JOB_OP_CNVRT:  return convert(run, in, c, &of[0], q);
    case ROBOT_JOB_OP_MSHIFT: return difference(run, in, c, &of[0], &of[1], q);
    case ROBOT_JOB_OP_SETE:
        begin(q, NULL);
        q->value[c->level] = robot_job_value(run, in, &c->right) / per(q, c->level);
        return run->fault;
    default: return add(q, &of[0], c->op == ROBOT_JOB_OP_PLACE_ADD ? 1.0 : -1.0);
    }
}
