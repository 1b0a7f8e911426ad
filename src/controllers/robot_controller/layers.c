#include "layers.h"

void layers_start(struct layers *l, const struct layers_config *c, int32_t seed)
{
    memset(l, 0, sizeof *l);
    l->random = (uint64_t)(int64_t)seed;
    l->tick = c->tick;
    l->poll = c->poll;
}

int64_t layers_wait(struct layers *l, const struct layers_config *c)
{
    return latency_draw(&c->interrupt, &l->random);
}

/* Outputs of a layer whose inputs have changed; they count as put out from now on. */
static uint32_t changes(struct layers *l, const struct layers_config *c, enum layer layer,
                        uint32_t inputs)
{
    const uint32_t mask = (inputs ^ l->shown[layer]) & c->follow[layer];

    l->shown[layer] ^= mask;
    return mask;
}

bool layers_poll(struct layers *l, const struct layers_config *c, int64_t until,
                 struct layers_copy *seen)
{
    if (l->poll > until) {
        return false;
    }
    *seen = l->copy[l->copy[0].clock > l->poll];
    const uint32_t mask = changes(l, c, LAYER_USER, seen->inputs);
    l->mask |= mask;
    l->value = (l->value & ~mask) | (seen->inputs & mask);
    l->polls++;
    l->poll += c->poll + (latency_uniform(&l->random) < c->crowded ? c->quantum : 0);
    return true;
}

void layers_look(struct layers *l, const struct layers_config *c, const struct fpga_shown *card,
                 int64_t until, struct outbox *out)
{
    if (link_new(&l->changes, card->input_irq_seq)) {
        const int64_t at = (int64_t)card->input_irq_clock + layers_wait(l, c) + c->access;
        const uint32_t image = (uint32_t)card->input_irq_image;
        outbox_put(out, at, changes(l, c, LAYER_INTERRUPT, image), image);
    }
    for (; l->tick + c->access < until; l->tick += c->tick) {
        const uint32_t image = (uint32_t)card->inputs;
        outbox_put(out, l->tick + c->access, changes(l, c, LAYER_TIMER, image), image);
    }
}

void layers_copied(struct layers *l, int64_t clock, uint32_t inputs)
{
    l->copy[1] = l->copy[0];
    l->copy[0] = (struct layers_copy){ clock, inputs };
}

void layers_put(struct layers *l, const struct layers_config *c, uint32_t inputs, int64_t done,
                struct outbox *out)
{
    outbox_put(out, done, changes(l, c, LAYER_DRIVER, inputs), inputs);
    outbox_put(out, done, l->mask, l->value);
    l->mask = 0;
}
