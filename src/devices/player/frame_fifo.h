/* frame_fifo - FIFO of frames for the network card's pulse generator, in the RAM of the FPGA, with
 * the half-empty interrupt. A frame has 72 bits: commands of four axes and the number of an output
 * event. */
#ifndef FRAME_FIFO_H
#define FRAME_FIFO_H

#include <stdbool.h>
#include <stdint.h>

enum { FRAME_AXES = 4, FRAME_FIFO_LARGEST = 2304 };

struct frame {
    int16_t command[FRAME_AXES]; /* [pulses] of each axis in one period */
    uint16_t event;              /* event at its begin; 0 none; 16 bits to avoid padding */
};

struct frame_fifo {
    int32_t depth; /* [frames] that it can hold, 1 .. FRAME_FIFO_LARGEST */
    int32_t head;  /* index of the oldest frame */
    int32_t stock; /* number of frames held */
    bool high;     /* the stock was above half the depth at the latest frame_fifo_fell */
    struct frame frame[FRAME_FIFO_LARGEST];
};

/* An empty FIFO of this depth. */
void frame_fifo_reset(struct frame_fifo *f, int32_t depth);

/* Append a frame; take the oldest one. False, and nothing changed, if it is full; empty. */
bool frame_fifo_push(struct frame_fifo *f, const struct frame *frame);
bool frame_fifo_pop(struct frame_fifo *f, struct frame *frame);

/* The n-th oldest frame, n = 0 .. stock - 1. */
const struct frame *frame_fifo_at(const struct frame_fifo *f, int32_t n);

/* True once each time that the stock falls to half the depth. Call it after every change. */
bool frame_fifo_fell(struct frame_fifo *f);

#endif
