#include "netcard_parts.h"

static const int64_t LARGEST = (int64_t)1 << 61;    /* sums of two are numbers */

static bool between(int64_t value, int64_t low, int64_t high)
{
    return value >= low && value <= high;
}

static bool place_sound(const struct netcard *c, const struct job_place *p)
{
    return between(p->slot, -1, c->settings.slots - 1) && p->bytes <= FLASH_BYTES;
}

static bool reader_sound(const struct job_reader *r)
{
    return between(r->page.frames, 0, JOB_PAGE_FRAMES) && between(r->at, 0, r->page.frames) &&
           r->header.events <= JOB_EVENTS &&
           r->header.rest <= r->header.events && r->frame <= r->header.frames;
}

static bool counts_sound(const struct netcard *c)
{
    bool ok = between(c->first, 0, NETCARD_ORDERS - 1) && between(c->orders, 0, NETCARD_ORDERS) &&
              between(c->jobs, 0, INT32_MAX - 1) && between(c->dropped, 0, INT32_MAX - 1) &&
              between(c->result.count, 0, INT32_MAX - 1) && c->state < NET_STATES &&
              (c->resumes == NET_RUNNING || c->resumes == NET_HOMING || card_literal(c)) &&
              c->resumes < NET_STATES && between(c->loading, 0, LARGEST);

    for (int i = 0; i < NETCARD_ORDERS; i++) {
        ok = ok && c->order[i].command < CARD_COMMANDS;
    }
    for (int i = 0; i < CARD_AXES; i++) {
        ok = ok && between(c->zero[i], -LARGEST, LARGEST) &&
             between(c->latch[i], -LARGEST, LARGEST) && between(c->origin[i], -LARGEST, LARGEST) &&
             home_motion_sound(&c->way[i], INT16_MAX - 1);
    }
    for (int i = 0; i < NETCARD_INTERRUPTS; i++) {
        ok = ok && between(c->served[i], 0, LARGEST);
    }
    return ok;
}

const char *netcard_damage(const struct netcard *c, int64_t now)
{
    struct card_wrong wrong;
    int64_t busy[CARD_LOADS];

    if (!card_settings_good(&c->settings, &wrong)) {
        return "its settings";
    }
    if (c->now != now || c->player.clock != card_clock(c) || !between(c->boot, 0, now) ||
        (c->power && c->kernel.processor.clock != now - c->boot)) {
        return "its clock is another one";
    }
    if (!kernel_sound(&c->kernel, NETCARD_TASKS, NETCARD_INTERRUPTS)) {
        return "its kernel";
    }
    if (flash_damage(&c->flash) || job_store_damage(&c->store) || !place_sound(c, &c->place) ||
        (c->page.wanted && c->place.slot < 0) || !reader_sound(&c->reader)) {
        return "its flash";
    }
    if (!player_sound(&c->player)) {
        return "its player";
    }
    if (!home_cycle_sound(&c->home) || !card_inputs_sound(&c->inputs) ||
        !card_outputs_sound(&c->outputs)) {
        return "its inputs, outputs or homing";
    }
    card_busy(c, busy);
    if (c->power && !card_load_sound(&c->load, c->kernel.processor.clock, busy)) {
        return "its loads";
    }
    if (!session_sound(&c->session)) {
        return "its link";
    }
    return counts_sound(c) ? NULL : "its counts";
}
