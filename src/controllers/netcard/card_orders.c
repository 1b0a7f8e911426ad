#include "netcard_parts.h"

/* Time for which the drives get their error clear. [ns] */
static const int64_t CLEAR_NS = 20000000;

static bool has_job(const struct netcard *c)
{
    return c->store.job.slot >= 0;
}

void card_rest(struct netcard *c)
{
    c->state = has_job(c) ? NET_READY : NET_EMPTY;
}

/* The event of a frame that still waits for its interrupt must not be put out after the rest
 * event. */
void card_put_rest(struct netcard *c)
{
    const struct job_header *h = &c->reader.header;

    if (c->works && h->rest) {
        const struct job_event *e = &h->event[h->rest - 1];
        c->told.events = 0;
        card_outputs_flag_pins(&c->outputs, e->pins,
                               &(struct mc_po){ 0, e->mode, e->level, e->width_us });
        card_pend(c, NETCARD_SOFTWARE);
    }
    c->works = false;
}

void card_fault(struct netcard *c, enum net_code error)
{
    if (c->state != NET_FAULT) {
        player_clear(&c->player);
        card_put_rest(c);
        c->state = NET_FAULT;
        c->error = error;
        card_job_give_up(c);
        c->told.what |= PLAYER_REST; /* all that wait for the player look again */
        card_pend(c, NETCARD_FPGA);
    }
}

/* Why a START is refused although the state allows it; NET_DONE: it is not. */
static enum net_code startable(const struct netcard *c)
{
    if (!c->settings.write_during_run && c->store.phase != STORE_REST) {
        return NET_BUSY;
    }
    for (int i = 0; c->settings.must_home && i < CARD_AXES; i++) {
        if (c->settings.home_order[i] > 0 && !(c->homed >> i & 1)) {
            return NET_NOT_HOMED;
        }
    }
    return has_job(c) ? NET_DONE : NET_NO_JOB;
}

/* The states that an accepted command leads to. */
static int accepted(struct netcard *c, enum card_command command, uint32_t axes)
{
    switch (command) {
    case CARD_DO_START:
        if (c->state == NET_READY) {
            c->state = NET_RUNNING;
            return NETCARD_GIVE_RUN;
        }
        c->state = c->resumes;
        return NETCARD_GIVE_PAUSE;
    case CARD_DO_PAUSE:
        c->resumes = c->state;
        c->state = NET_PAUSING;
        return NETCARD_GIVE_PAUSE;
    case CARD_DO_STOP:
        c->state = NET_STOPPING;
        card_job_give_up(c);
        return NETCARD_GIVE_STOP;
    case CARD_DO_HOME:
        c->state = NET_HOMING;
        c->home_axes = axes;
        card_job_give_up(c);
        return NETCARD_GIVE_HOME;
    default:
        c->error = NET_DONE;
        card_rest(c);
        return -1;
    }
}

int card_order(struct netcard *c, enum card_command command, uint32_t axes, enum net_code *code)
{
    const struct card_rule rule = card_rule(c->state, command);

    *code = rule.code;
    if (command == CARD_DO_RESET && c->state == NET_FAULT) {
        if (c->clear != CLEAR_NONE) {
            *code = NET_BUSY;
            return -1;
        }
        c->clear_until = c->now + CLEAR_NS;
        *code = c->axes.stop ? NET_ALARM : c->axes.alarm ? NET_CODES : NET_DONE;
    }
    if (card_literal(c) && c->state != NET_FAULT) {
        *code = NET_DONE;
        return literal_order(c, command, axes);
    }
    if (*code == NET_DONE && command == CARD_DO_START && c->state == NET_READY) {
        *code = startable(c);
    }
    return *code == NET_DONE && rule.acts ? accepted(c, command, axes) : -1;
}
