#include "frame_fifo.h"

#include <string.h>

static int32_t place(const struct frame_fifo *f, int32_t n)
{
    const int32_t p = f->head + n;
    return p < f->depth ? p : p - f->depth;
}

void frame_fifo_reset(struct frame_fifo *f, int32_t depth)
{
    memset(f, 0, sizeof *f);
    f->depth = depth;
}

bool frame_fifo_push(struct frame_fifo *f, const struct frame *frame)
{
    if (f->stock == f->depth) {
        return false;
    }
    f->frame[place(f, f->stock++)] = *frame;
    return true;
}

bool frame_fifo_pop(struct frame_fifo *f, struct frame *frame)
{
    if (f->stock == 0) {
        return false;
    }
    *frame = f->frame[f->head];
    f->head = place(f, 1);
    f->stock--;
    return true;
}

const struct frame *frame_fifo_at(const struct frame_fifo *f, int32_t n)
{
    return &f->frame[place(f, n)];
}

bool frame_fifo_fell(struct frame_fifo *f)
{
    const bool was = f->high;

    f->high = f->stock > f->depth / 2;
    return was && !f->high;
}
