#include "fifo.h"

#include <stdlib.h>

bool fifo_push(struct fifo *f, int32_t command)
{
    if (f->stock == FIFO_DEPTH)
        return false;
    f->entry[(f->head + f->stock) % FIFO_DEPTH] = command;
    f->stock++;
    return true;
}

bool fifo_pop(struct fifo *f, int32_t *command)
{
    if (f->stock == 0)
        return false;
    *command = f->entry[f->head];
    f->head = (f->head + 1) % FIFO_DEPTH;
    f->stock--;
    return true;
}

int32_t fifo_erase_last(struct fifo *f, int32_t n)
{
    int32_t erased = n < f->stock ? n : f->stock;
    f->stock -= erased;
    return erased;
}

void fifo_clear(struct fifo *f)
{
    f->head = 0;
    f->stock = 0;
}

int32_t fifo_largest(const struct fifo *f)
{
    int32_t largest = 0;
    for (int i = 0; i < f->stock; i++) {
        int32_t size = abs(f->entry[(f->head + i) % FIFO_DEPTH]);
        largest = size > largest ? size : largest;
    }
    return largest;
}

bool fifo_fell(struct fifo *f, int32_t minimum)
{
    bool was_high = f->high;
    f->high = f->stock > minimum;
    return was_high && !f->high;
}
