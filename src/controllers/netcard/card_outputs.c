#include "card_outputs.h"

#include <string.h>

void card_outputs_start(struct card_outputs *c)
{
    memset(c, 0, sizeof *c);
}

static bool good(const struct mc_po *po)
{
    return po->pin < CARD_OUTPUTS && po->active <= 1
           && (po->mode == MC_PO_LEVEL
               || (po->mode == MC_PO_PULSE && po->width_us >= 1
                   && po->width_us <= MC_PO_WIDTH_LONGEST));
}

bool card_outputs_flag(struct card_outputs *c, const struct mc_po *po)
{
    if (!good(po)) {
        return false;
    }
    c->merged += c->flag[po->pin];
    c->po[po->pin] = *po;
    c->flag[po->pin] = true;
    return true;
}

bool card_outputs_flag_pins(struct card_outputs *c, uint32_t pins, const struct mc_po *po)
{
    struct mc_po each = *po;

    each.pin = 0;
    if (!good(&each) || pins >> CARD_OUTPUTS != 0) {
        return false;
    }
    for (; each.pin < CARD_OUTPUTS; each.pin++) {
        if (pins >> each.pin & 1) {
            card_outputs_flag(c, &each);
        }
    }
    return true;
}

uint32_t card_outputs_serve(struct card_outputs *c, int64_t now)
{
    uint32_t served = 0, high = 0, pulses = 0;

    card_outputs_advance(c, now);
    for (int pin = 0; pin < CARD_OUTPUTS; pin++) {
        const struct mc_po *po = &c->po[pin];
        if (c->flag[pin]) {
            served |= (uint32_t)1 << pin;
            high |= (uint32_t)po->active << pin;
            c->pulse_end[pin] = now + 1000 * (int64_t)po->width_us;
            pulses |= (uint32_t)(po->mode == MC_PO_PULSE) << pin;
            c->flag[pin] = false;
        }
    }
    c->levels = (c->levels & ~served) | high;
    c->pulses = (c->pulses & ~served) | pulses;
    c->stores += served != 0;
    return served;
}

int64_t card_outputs_next(const struct card_outputs *c)
{
    int64_t next = INT64_MAX;

    for (int i = 0; c->pulses >> i != 0; i++) {
        next = c->pulses >> i & 1 && c->pulse_end[i] < next ? c->pulse_end[i] : next;
    }
    return next;
}

void card_outputs_advance(struct card_outputs *c, int64_t now)
{
    for (int i = 0; c->pulses >> i != 0; i++) {
        if (c->pulses >> i & 1 && c->pulse_end[i] <= now) {
            c->pulses &= ~((uint32_t)1 << i);
            c->levels ^= (uint32_t)1 << i;
        }
    }
}
