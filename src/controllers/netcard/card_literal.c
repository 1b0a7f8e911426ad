/* The literal policy, the document's scheme as it is written: each packet gives its semaphore,
 * whatever the card is doing, and four tasks do what they are woken for. What they share with the
 * tasks of the safe policy, the reading of a job and the search of origins, is elsewhere. */
#include "netcard_parts.h"

int literal_order(struct netcard *c, enum card_command command, uint32_t axes)
{
    switch (command) {
    case CARD_DO_START:
        if (c->hold != HOLD_NONE) { /* a pause holds the processor: it ends, no job begins */
            c->hold = HOLD_RELEASED;
            return -1;
        }
        return NETCARD_GIVE_RUN;
    case CARD_DO_PAUSE: return NETCARD_GIVE_PAUSE;
    case CARD_DO_STOP:  return NETCARD_GIVE_STOP;
    case CARD_DO_HOME:  c->home_axes = axes; return NETCARD_GIVE_HOME;
    default:            return -1;
    }
}

/* Stop: the pulses end at once; run and home give up, each when it has the processor. */
static void stop(struct netcard *c)
{
    kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_STOP);
    player_clear(&c->player);
    if (card_job_under_way(c)) {
        card_job_give_up(c);
    } else if (c->homing != HOMING_NONE) {
        c->homing = HOMING_STOPPED;
    }
    c->step[NETCARD_STOP] = TURN_RELEASE;
}

static void stop_task(struct netcard *c)
{
    switch (c->step[NETCARD_STOP]) {
    case TURN_WAIT: card_take(c, NETCARD_STOP, NETCARD_GIVE_STOP, TURN_LOOK); break;
    case TURN_LOOK: card_work(c, NETCARD_STOP, c->settings.step_cycles, TURN_ACT); break;
    case TURN_RELEASE:
        c->step[NETCARD_STOP] = TURN_WAIT;
        kernel_give(&c->kernel, NETCARD_GIVE_FIFO);
        break;
    default: stop(c);
    }
}

/* Pause: the task keeps the processor until a START. */
static void hold(struct netcard *c)
{
    kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_PAUSE);
    if (c->hold == HOLD_NONE) {
        c->hold = HOLD_HOLDS;
        c->resumes = c->state;
    }
    c->state = NET_PAUSED;
    if (c->hold == HOLD_RELEASED) {
        c->hold = HOLD_NONE;
        c->state = c->resumes;
        c->step[NETCARD_PAUSE] = TURN_WAIT;
    } else {
        card_work(c, NETCARD_PAUSE, c->settings.step_cycles, TURN_ACT);
    }
}

static void pause_task(struct netcard *c)
{
    switch (c->step[NETCARD_PAUSE]) {
    case TURN_WAIT: card_take(c, NETCARD_PAUSE, NETCARD_GIVE_PAUSE, TURN_LOOK); break;
    case TURN_LOOK: card_work(c, NETCARD_PAUSE, c->settings.step_cycles, TURN_ACT); break;
    default:        hold(c);
    }
}

/* Run goes on with its next frame, from where homing has left the axes. The frames that were in the
 * FIFO are lost; a job of which all frames were there counts as played. */
static void go_on(struct netcard *c)
{
    c->state = NET_RUNNING;
    player_begin(&c->player, &c->plays, card_clock(c));
    player_set_target(&c->player, 1);
    if (c->phase == JOB_DRAINING) {
        c->phase = JOB_PLAYED;
    }
}

static void home_last(struct netcard *c)
{
    if (c->homing != HOMING_PLAYED) {
        card_spend(c, NETCARD_HOME, c->settings.period_ns, HOME_LAST);
        return;
    }
    if (card_home_found(c) && card_job_under_way(c)) {
        go_on(c);
    }
    c->step[NETCARD_HOME] = HOME_RAISE;
}

/* True if a stop or a fault ends homing at this step. */
static bool home_ends(const struct netcard *c, enum card_home_step at)
{
    const bool over = c->state == NET_FAULT || c->homing == HOMING_STOPPED || card_job_given_up(c);

    return (at > HOME_LOWERED && at < HOME_RAISE && over)
           || (at > HOME_CLEARED && at < HOME_RAISE && c->home.state == HOME_CYCLE_IDLE);
}

static void home_task(struct netcard *c)
{
    const enum card_home_step at = (enum card_home_step)c->step[NETCARD_HOME];

    if (home_ends(c, at)) {
        c->step[NETCARD_HOME] = HOME_RAISE;
        return;
    }
    switch (at) {
    case HOME_WAIT: card_take(c, NETCARD_HOME, NETCARD_GIVE_HOME, HOME_LOOK); break;
    case HOME_LOOK: card_home_lower(c); break;
    case HOME_LOWERED:
        c->step[NETCARD_HOME] = HOME_STILL;
        kernel_give(&c->kernel, NETCARD_GIVE_FIFO);
        break;
    case HOME_STILL:
        c->state = NET_HOMING;
        card_home_clear(c);
        break;
    case HOME_CLEARED: card_home_begin(c); break;
    case HOME_STEP:
        if (card_home_full(c)) { /* the task keeps the processor */
            card_spend(c, NETCARD_HOME, c->settings.period_ns, HOME_STEP);
        } else {
            card_home_frame(c, true);
        }
        break;
    case HOME_LAST: home_last(c); break;
    default:
        if (c->state == NET_HOMING) { /* stopped */
            card_rest(c);
        }
        card_home_raise(c);
    }
}

static void leave(struct netcard *c)
{
    card_job_leave(c);
    if (c->state == NET_RUNNING) {
        card_rest(c);
    }
}

static void read_page(struct netcard *c, enum card_run_step step)
{
    if (c->page.wanted) {
        card_take(c, NETCARD_RUN, NETCARD_GIVE_PAGE, step);
    } else if (card_job_given_up(c)) {
        leave(c);
    } else if (step == RUN_PAGE ? card_job_page(c) : card_job_header(c) && card_job_play(c)) {
        c->step[NETCARD_RUN] = RUN_NEXT;
    } else {
        card_fault(c, NET_BAD_JOB);
        leave(c);
    }
}

static void push(struct netcard *c)
{
    struct frame to;

    if (card_job_frame(c, &to)) {
        card_job_push(c, &to);
    } else {
        card_fault(c, NET_LIMIT);
    }
}

static void next(struct netcard *c)
{
    const enum card_job_next what = card_job_next(c);

    if (what == JOB_NEXT_COMES) {
        return;
    }
    if (what == JOB_NEXT_NONE || c->phase == JOB_READING) {
        c->phase = what == JOB_NEXT_NONE ? JOB_DRAINING : JOB_PLAYING;
        player_set_target(&c->player, 1);
    }
    c->step[NETCARD_RUN] = what == JOB_NEXT_NONE ? RUN_LAST : RUN_FULL;
    card_job_slept(c);
}

static void run_task(struct netcard *c)
{
    const enum card_run_step step = (enum card_run_step)c->step[NETCARD_RUN];

    if (card_job_given_up(c) && step != RUN_PAGE && step != RUN_HEADER) {
        leave(c);
        return;
    }
    switch (step) {
    case RUN_WAIT: card_take(c, NETCARD_RUN, NETCARD_GIVE_RUN, RUN_BEGIN); break;
    case RUN_BEGIN:
        if (c->store.job.slot >= 0) {
            card_job_begin(c);
        } else {
            c->dropped++;
            c->step[NETCARD_RUN] = RUN_WAIT;
        }
        break;
    case RUN_HEADER:
    case RUN_PAGE:    read_page(c, step); break;
    case RUN_WRITTEN: push(c); break;
    case RUN_FULL:    card_take(c, NETCARD_RUN, NETCARD_GIVE_FIFO, RUN_NEXT); break;
    case RUN_LAST:
        if (c->phase == JOB_PLAYED) {
            card_rest(c);
            leave(c);
        } else {
            card_take(c, NETCARD_RUN, NETCARD_GIVE_FIFO, RUN_LAST);
        }
        break;
    default: next(c);
    }
}

void literal_task(struct netcard *c, enum netcard_task task)
{
    switch (task) {
    case NETCARD_HOME:  home_task(c); break;
    case NETCARD_STOP:  stop_task(c); break;
    case NETCARD_PAUSE: pause_task(c); break;
    default:            run_task(c);
    }
}
