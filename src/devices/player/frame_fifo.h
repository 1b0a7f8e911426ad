/* frame_fifo - frames on their way to the pulse generator, in the RAM of the FPGA.
 *
 * A frame is 72 bits: four commands and the number of an output event. */
#ifndef FRAME_FIFO_H
#define FRAME_FIFO_H

#include <stdbool.h>
#include <stdint.h>

enum { FRAME_AXES = 4, FRAME_FIFO_LARGEST = 2304 };

struct frame {
    int16_t command[FRAME_AXES]; /* [pulses] of one period */
    uint16_t event;              /* at its begin; 0 none; 16 bits, as 8 would leave padding */
};

struct frame_fifo {
    int32_t depth; /* 1 .. FRAME_FIFO_LARGEST */
    int32_t head;  /* place of the oldest frame */
    int32_t stock;
    bool high; /* the stock was above half the depth at the last look */
    struct frame frame[FRAME_FIFO_LARGEST];
};

/* Empty, of this depth. */
void frame_fifo_reset(struct frame_fifo *f, int32_t depth);

/* False, and nothing changed: full; empty. */
bool frame_fifo_push(struct frame_fifo *f, const struct frame *frame);
bool frame_fifo_pop(struct frame_fifo *f, struct frame *frame);

/* The n-th oldest frame, n = 0 .. stock - 1. */
const struct frame *frame_fifo_at(const struct frame_fifo *f, int32_t n);

/* True once each time that the stock falls to half the depth. Call it after every change. */
bool frame_fifo_fell(struct frame_fifo *f);

#endif
