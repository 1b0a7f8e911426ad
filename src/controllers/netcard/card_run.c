/* The run task: the axes go to where the job begins, then the job is played. */
#include "netcard_parts.h"

static void go(struct netcard *c, enum card_run_step step)
{
    c->step[NETCARD_RUN] = step;
}

/* Let the player go, as the first frames are in the FIFO, unless a pause or a stop has come. */
static void let_go(struct netcard *c, enum card_job_phase phase)
{
    c->phase = phase;
    if (c->state == NET_RUNNING) {
        player_set_target(&c->player, 1);
    }
}

/* From now on frames are given: those of the approach first, if the axes need one. */
static void give(struct netcard *c, enum net_code else_code)
{
    const bool due = card_approach_due(c);

    c->works = true;
    if (due) {
        card_put_rest(c);
    }
    if (due ? card_approach_begin(c) : card_job_play(c)) {
        go(c, RUN_NEXT);
    } else {
        card_fault(c, else_code);
        card_job_leave(c);
    }
}

static void begin(struct netcard *c)
{
    if (c->state == NET_RUNNING && c->store.job.slot >= 0) {
        card_job_begin(c);
    } else {
        c->dropped++;
        go(c, RUN_WAIT);
    }
}

/* Go on once the page that was asked for has come. */
static void read_page(struct netcard *c, enum card_run_step step)
{
    if (c->page.wanted) {
        card_take(c, NETCARD_RUN, NETCARD_GIVE_PAGE, step);
    } else if (card_job_given_up(c)) {
        card_job_leave(c);
    } else if (step == RUN_HEADER && card_job_header(c)) {
        give(c, NET_BAD_JOB);
    } else if (step == RUN_PAGE && card_job_page(c)) {
        go(c, RUN_NEXT);
    } else {
        card_fault(c, NET_BAD_JOB);
        card_job_leave(c);
    }
}

/* The job leads out of the range of positions: stop it, while the frames in stock are still
 * within. */
static void stop(struct netcard *c)
{
    c->error = NET_LIMIT;
    c->state = NET_STOPPING;
    card_job_leave(c);
    kernel_give(&c->kernel, NETCARD_GIVE_STOP);
}

static void push(struct netcard *c)
{
    struct frame to;

    if (c->approach) {
        to = card_approach_next(c);
    } else if (!card_job_frame(c, &to)) {
        stop(c);
        return;
    }
    card_job_push(c, &to);
}

/* Go on after a frame: with another one, a page, or nothing more. */
static void next(struct netcard *c)
{
    switch (card_job_next(c)) {
    case JOB_NEXT_NONE:
        let_go(c, JOB_DRAINING);
        go(c, c->approach ? RUN_ARRIVED : RUN_LAST);
        card_job_slept(c);
        break;
    case JOB_NEXT_FULL:
        if (c->phase == JOB_READING) {
            let_go(c, JOB_PLAYING);
        }
        go(c, RUN_FULL);
        card_job_slept(c);
        break;
    case JOB_NEXT_COMES: break;
    }
}

void card_run(struct netcard *c)
{
    const enum card_run_step step = (enum card_run_step)c->step[NETCARD_RUN];
    const bool played = c->phase == JOB_PLAYED && c->state == NET_RUNNING;

    if (card_job_given_up(c) && step != RUN_PAGE && step != RUN_HEADER) {
        card_job_leave(c);
        return;
    }
    switch (step) {
    case RUN_WAIT:    card_take(c, NETCARD_RUN, NETCARD_GIVE_RUN, RUN_BEGIN); break;
    case RUN_BEGIN:   begin(c); break;
    case RUN_HEADER:
    case RUN_PAGE:    read_page(c, step); break;
    case RUN_WRITTEN: push(c); break;
    case RUN_FULL:    card_take(c, NETCARD_RUN, NETCARD_GIVE_FIFO, RUN_NEXT); break;
    case RUN_LAST:
        if (played) {
            c->works = false;
            card_rest(c);
            card_job_leave(c);
        } else {
            card_take(c, NETCARD_RUN, NETCARD_GIVE_FIFO, RUN_LAST);
        }
        break;
    case RUN_ARRIVED:
        if (played) {
            give(c, NET_RANGE);
        } else {
            card_take(c, NETCARD_RUN, NETCARD_GIVE_FIFO, RUN_ARRIVED);
        }
        break;
    default: next(c);
    }
}
