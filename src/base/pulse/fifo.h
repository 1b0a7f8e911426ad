/* fifo - ring buffer of the commands that wait in a card's channel, with the minimum-stock
 * comparator that asks the host for more. The entries are in an array of the caller's, `depth`
 * long, which each function gets beside the FIFO's state. */
#ifndef FIFO_H
#define FIFO_H

#include <stdbool.h>
#include <stdint.h>

struct fifo {
    int32_t depth; /* entries it can hold */
    int32_t head;  /* index of the oldest entry */
    int32_t stock; /* number of entries held */
    bool high;     /* comparator: the stock was above the minimum at the latest fifo_fell */
};

/* An empty FIFO of this depth. */
void fifo_reset(struct fifo *f, int32_t depth);

/* Append a command; false, and nothing changed, if the FIFO is full (overflow). */
bool fifo_push(struct fifo *f, int32_t *entry, int32_t command);

/* Take the oldest command; false, and *command untouched, if the FIFO is empty (underflow). */
bool fifo_pop(struct fifo *f, const int32_t *entry, int32_t *command);

/* Remove the n newest commands, or all if there are fewer; returns the number removed. */
int32_t fifo_erase_last(struct fifo *f, int32_t n);

/* Remove all commands. */
void fifo_clear(struct fifo *f);

/* Largest |command| in stock [pulses]. */
int32_t fifo_largest(const struct fifo *f, const int32_t *entry);

/* Comparator: true once each time the condition stock <= minimum becomes true. Call it after every
 * change of the stock or the minimum. An empty FIFO starts with the condition true. */
bool fifo_fell(struct fifo *f, int32_t minimum);

#endif
