#include "outbox.h"

void outbox_put(struct outbox *o, int64_t clock, uint32_t mask, uint32_t value)
{
    if (!mask) {
        return;
    }
    if (o->count == OUTBOX_SIZE) {
        struct outbox_entry *last = &o->entry[OUTBOX_SIZE - 1];
        *last = (struct outbox_entry){ clock, last->mask | mask,
                                       (last->value & ~mask) | (value & mask) };
        return;
    }
    o->entry[o->count++] = (struct outbox_entry){ clock, mask, value & mask };
}

void outbox_post(struct outbox *o, struct fpga_host *host)
{
    const int32_t n = o->count < FPGA_ENTRIES ? o->count : FPGA_ENTRIES;

    if (n == 0) {
        return;
    }
    for (int i = 0; i < n; i++) {
        host->out_clock[i] = (double)o->entry[i].clock;
        host->out_mask[i] = (int32_t)o->entry[i].mask;
        host->out_value[i] = (int32_t)o->entry[i].value;
    }
    host->out_count = n;
    host->out_seq = ++o->seq;
    o->count -= n;
    memmove(o->entry, o->entry + n, (size_t)o->count * sizeof o->entry[0]);
}
