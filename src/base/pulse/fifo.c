#include "fifo.h"

#include <stdlib.h>
#include <string.h>

/* Index of the n-th entry, n = 0 for the oldest. */
static int32_t place(const struct fifo *f, int32_t n)
{
    int32_t p = f->head + n;
    return p < f->depth ? p : p - f->depth;
}

void fifo_reset(struct fifo *f, int32_t depth)
{
    memset(f, 0, sizeof *f); /* clears the padding, too, so that equal states have equal bytes */
    f->depth = depth;
}

bool fifo_push(struct fifo *f, int32_t *entry, int32_t command)
{
    if (f->stock == f->depth)
        return false;
    entry[place(f, f->stock)] = command;
    f->stock++;
    return true;
}

bool fifo_pop(struct fifo *f, const int32_t *entry, int32_t *command)
{
    if (f->stock == 0)
        return false;
    *command = entry[f->head];
    f->head = place(f, 1);
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

int32_t fifo_largest(const struct fifo *f, const int32_t *entry)
{
    int32_t largest = 0;
    for (int i = 0; i < f->stock; i++) {
        int32_t size = abs(entry[place(f, i)]);
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
