/* queue - interpolation points between the interpolation, which fills it, and the pulses, with what
 * a part program switches beside the axes. */
#ifndef QUEUE_H
#define QUEUE_H

#include <stdbool.h>
#include <stdint.h>

#include "axis_count.h"

enum { OUTPUTS_DIGITAL = 32 }; /* P0 .. P31 of M62 to M65 */
enum { OUTPUTS_ANALOG = 4 };   /* E0 .. E3 of M67, M68 */

enum outputs_coolant { OUTPUTS_MIST = 1, OUTPUTS_FLOOD = 2 }; /* bits: M7, M8 */

/* Bits that M48 to M53 set, which let overrides and the hold act or not; none at the start. */
enum outputs_overrides {
    OUTPUTS_FEED_FIXED = 1,  /* M49, M50 P0: feed override 1 */
    OUTPUTS_SPEED_FIXED = 2, /* M49, M51 P0: spindle override 1; there is none here */
    OUTPUTS_ADAPTIVE = 4,    /* M52: the adaptive feed counts */
    OUTPUTS_HOLD_OFF = 8     /* M53 P0: the hold does not act */
};

struct outputs {
    double spindle;   /* [rpm] M3 positive, M4 negative */
    uint32_t digital; /* bit n is output Pn */
    int32_t coolant;  /* enum outputs_coolant */
    double analog[OUTPUTS_ANALOG];
    int32_t tool;  /* number of the tool in the spindle, 0 none */
    bool asks;     /* the stop waits for another tool */
    int32_t asked; /* number of that tool */
};

/* Analog outputs that change: bit n of `set` is of value[n]. */
struct outputs_analog {
    uint32_t set;
    double value[OUTPUTS_ANALOG];
};

/* G96: the spindle turns so fast that the tool passes the work at a speed, but at most at the
 * speed it has without. */
struct outputs_surface {
    double speed;  /* [mm/s] 0: the spindle keeps its speed */
    double centre; /* [mm] X of the axis that the work turns about */
};

/* Speed of the spindle [rpm] with the tool at X [mm]: at most `most`, whose sign it has. */
double outputs_spindle(const struct outputs_surface *s, double most, double x);

enum { QUEUE_SIZE = 1024 };

/* What happens in one DDA time. */
struct point {
    int32_t frame[AXES];    /* [pulses] to put out */
    int32_t pulses[AXES];   /* [pulses] position at the end, without compensation */
    int32_t added[AXES];    /* [pulses] compensation in all frames up to the end */
    double place[AXES];     /* [mm] ideal position at the end */
    double left[AXES];      /* [mm] from there to the end of the command that moves; 0 at rest */
    double feed;            /* [mm/s] speed along the path at the end */
    int32_t line, command;  /* line and command that move at the end; if two are mixed, the older */
    int32_t newest;         /* command that moves at the end; if two are mixed, the newer */
    bool waits;             /* the end lies in a delay */
    struct outputs outputs; /* as they are at the end */
};

struct queue {
    struct point item[QUEUE_SIZE];
    int32_t head, count;
};

void queue_clear(struct queue *q);
void queue_push(struct queue *q, const struct point *p);          /* not when count is QUEUE_SIZE */
const struct point *queue_peek(const struct queue *q, int32_t i); /* i-th, 0 <= i < count */
void queue_drop(struct queue *q, int32_t n);                      /* the first n, n <= count */
void queue_keep(struct queue *q, int32_t n);                      /* only the first n, n <= count */

#endif
