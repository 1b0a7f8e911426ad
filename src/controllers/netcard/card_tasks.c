/* The storage task, and the interrupts' routines. */
#include "netcard_parts.h"

#include <string.h>

/* Time that run gets to read and write frames until the FIFO is full again. */
static const int64_t ERASE_MARGIN_NS = 10000000;

/* True if the FIFO could run dry while the chip erases a sector, so that run must read first. */
static bool must_wait(const struct netcard *c)
{
    const struct flash_config *f = &c->flash.config;
    const int64_t erase =
        f->sector.typical + (f->sector.longest - f->sector.typical) / 1000 * f->spread;
    const int64_t stock = c->player.fifo.stock * (int64_t)c->player.job.period;

    return stock * PLAYER_CLOCK_NS < erase + ERASE_MARGIN_NS;
}

void card_store(struct netcard *c)
{
    enum { WAIT, LOOK, READ };
    struct netcard_page *p = &c->page;
    int64_t ns;

    switch (c->step[NETCARD_STORAGE]) {
    case WAIT: card_take(c, NETCARD_STORAGE, NETCARD_GIVE_STORAGE, LOOK); return;
    case READ:
        p->wanted = false;
        p->good = p->good && job_page_whole(p->bytes);
        c->step[NETCARD_STORAGE] = LOOK;
        kernel_give(&c->kernel, NETCARD_GIVE_PAGE);
        return;
    default: break;
    }
    if (p->wanted) {
        ns = job_store_read(&c->place, &c->flash, p->number, p->bytes, c->now);
        p->good = ns > 0;
        card_spend(c, NETCARD_STORAGE, ns + card_cycles_ns(c->settings.page_cycles), READ);
        return;
    }
    c->store.hurried = card_job_reads(c);
    c->deferred = c->store.phase != STORE_REST && card_job_reads(c) && must_wait(c);
    ns = c->deferred ? 0 : job_store_step(&c->store, &c->flash, c->now);
    card_tell_store(c);
    if (ns > 0) { /* nobody reads while it writes */
        kernel_pend(&c->kernel, NETCARD_FLASH, c->now + ns - c->boot);
        card_take(c, NETCARD_STORAGE, NETCARD_GIVE_FLASH, LOOK);
    } else {
        card_take(c, NETCARD_STORAGE, NETCARD_GIVE_STORAGE, LOOK);
    }
}

/* Semaphores to be given for what the FPGA tells, a bit each. */
static uint32_t told(struct netcard *c)
{
    const uint32_t what = c->told.what, events = c->told.events;
    uint32_t gives = 0;

    memset(&c->told, 0, sizeof c->told);
    if (what & (PLAYER_HALF | PLAYER_DRY | PLAYER_ENDED | PLAYER_REST)) {
        gives |= 1u << NETCARD_GIVE_FIFO;
    }
    if (what & (PLAYER_REST | PLAYER_ENDED) && !card_literal(c)) {
        gives |= c->state == NET_PAUSING ? 1u << NETCARD_GIVE_PAUSE : 0;
        gives |= c->state == NET_STOPPING ? 1u << NETCARD_GIVE_STOP : 0;
        gives |= c->homing != HOMING_NONE && (c->state == NET_HOMING || c->state == NET_FAULT)
                     ? 1u << NETCARD_GIVE_HOME
                     : 0;
    }
    for (uint32_t i = 1; events && i <= c->reader.header.events; i++) {
        const struct job_event *e = &c->reader.header.event[i - 1];
        if (events >> i & 1) {
            card_outputs_flag_pins(&c->outputs, e->pins,
                                   &(struct mc_po){ 0, e->mode, e->level, e->width_us });
        }
    }
    if (events) {
        card_pend(c, NETCARD_SOFTWARE);
    }
    return gives;
}

/* The routine of an input's vector. Its action is a command like any other. Returns the semaphores
 * to be given, a bit each. */
static uint32_t served(struct netcard *c, int vector)
{
    static const enum card_command COMMAND[] = { [CARD_START] = CARD_DO_START,
                                                 [CARD_PAUSE] = CARD_DO_PAUSE,
                                                 [CARD_STOP] = CARD_DO_STOP,
                                                 [CARD_HOME] = CARD_DO_HOME };
    const struct card_input_served s = card_inputs_serve(&c->inputs, vector, c->now);
    enum net_code code;

    if (s.line < 0 || s.action == CARD_NONE || s.action == CARD_EVENT) {
        return 0;
    }
    const int give = card_order(c, COMMAND[s.action], (1u << CARD_AXES) - 1, &code);
    return give >= 0 ? 1u << give : 0;
}

void card_interrupt(struct netcard *c, int interrupt)
{
    enum { ENTER, SERVE, GIVE };
    int32_t *step = &c->step[NETCARD_TASKS + interrupt];
    uint32_t *gives = &c->gives[interrupt];

    if (*step == ENTER) {
        c->served[interrupt]++;
        card_work(c, NETCARD_TASKS + interrupt, c->settings.isr_cycles, SERVE);
        return;
    }
    if (*step == SERVE) {
        *step = GIVE;
        if (interrupt < CARD_VECTORS) {
            *gives = served(c, interrupt);
        } else if (interrupt == NETCARD_FPGA) {
            *gives = told(c);
        } else if (interrupt == NETCARD_SOFTWARE) {
            card_outputs_serve(&c->outputs, c->now);
        } else {
            *gives = 1u << (interrupt == NETCARD_FLASH ? NETCARD_GIVE_FLASH : NETCARD_GIVE_BYTES);
        }
    }
    for (int i = 0; *gives; i++) {
        if (*gives >> i & 1) {
            *gives &= ~(1u << i);
            kernel_give(&c->kernel, i);
            return;
        }
    }
    if (interrupt < CARD_VECTORS && card_inputs_vectors(&c->inputs) >> interrupt & 1) {
        card_work(c, NETCARD_TASKS + interrupt, c->settings.isr_cycles, SERVE);
        return;
    }
    *step = ENTER;
    kernel_end_interrupt(&c->kernel, true);
}
