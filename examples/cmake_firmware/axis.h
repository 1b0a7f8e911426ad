/* axis - firmware of one axis: a timer's interrupt plans each millisecond, and the pulse generator
 * takes its commands from a FIFO. A command is the pulses of a millisecond, so it is a speed. */
#ifndef AXIS_H
#define AXIS_H

#include <motionfmu/dda.h>
#include <motionfmu/fifo.h>
#include <motionfmu/short_names.h>

enum {
    AXIS_DEPTH = 4,       /* commands that wait for the pulse generator */
    AXIS_TOP_SPEED = 100, /* [pulses/ms] */
    AXIS_TICKS = 1000     /* of the pulse generator in a millisecond */
};

struct axis {
    struct dda dda;
    struct fifo fifo;
    int32_t waiting[AXIS_DEPTH]; /* [pulses/ms] */
    int32_t speed;               /* the latest command [pulses/ms] */
    int32_t left;                /* way that is not commanded yet [pulses] */
    int32_t underflows;          /* milliseconds for which there was no command */
};

/* At rest, with nothing to do. */
void axis_start(struct axis *a);

/* Go so far forwards [pulses]. */
void axis_go(struct axis *a, int32_t way);

/* The timer's interrupt: fill the FIFO. Called once a millisecond, before the next function. */
void axis_plan(struct axis *a);

/* The pulse generator's interrupt, at the end of its millisecond: it takes the next command. */
void axis_begin(struct axis *a);

/* Pulses put out until a tick [ticks since the start]. */
int64_t axis_pulses(const struct axis *a, int64_t tick);

#endif
