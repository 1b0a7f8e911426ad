/* The run task: a job from flash to the FPGA. */
#include "netcard_parts.h"

enum { WAIT, BEGIN, HEADER, NEXT, PAGE, DECODED, WRITTEN, FULL, LAST, ARRIVED };

static void go(struct netcard *c, int step)
{
    c->step[NETCARD_RUN] = step;
}

/* Give the job up, or end it. */
static void leave(struct netcard *c)
{
    c->player.frames = netcard_frames(c);
    c->job = c->primed = c->over = c->approach = false;
    go(c, WAIT);
    if (card_literal(c) && c->state == NET_RUNNING) {
        card_rest(c);
    }
}

static void want(struct netcard *c, uint32_t page, int step)
{
    c->page.wanted = true;
    c->page.good = false;
    c->page.number = page;
    go(c, step);
    kernel_give(&c->kernel, NETCARD_GIVE_STORAGE);
}

/* The job is let go: its first frames are in the FIFO. */
static void prime(struct netcard *c)
{
    c->primed = true;
    if (card_literal(c) || c->state == NET_RUNNING) {
        player_set_target(&c->player, 1);
    }
}

/* Frames are given from now on, those of the approach if there is one. */
static bool begin(struct netcard *c)
{
    c->primed = c->approach = false;
    if (!card_literal(c) && card_approach_due(c)) {
        c->works = true;
        card_put_rest(c);
        return card_approach_begin(c);
    }
    for (int i = 0; i < CARD_AXES; i++) {
        c->origin[i] = netcard_position(c, i);
    }
    c->works = !card_literal(c);
    c->read = c->ended = false;
    return player_begin(&c->player, &c->plays, card_clock(c)) == PLAYER_OK;
}

static bool header(struct netcard *c)
{
    struct job_header h;
    struct player_job job;

    if (!c->page.good || job_header_read(&h, c->page.bytes) != JOB_GOOD ||
        job_reader_start(&c->reader, &h, 0) != JOB_GOOD) {
        return false;
    }
    job = (struct player_job){ .period = (int32_t)(h.period_ns / PLAYER_CLOCK_NS),
                               .reserve = c->settings.reserve };
    for (int i = 0; i < CARD_AXES; i++) {
        job.speed[i] = h.speed_max[i];
        job.acc[i] = h.acc_max[i];
        job.jerk[i] = (double)h.jerk_max[i];
    }
    c->plays = job;
    c->played_id = h.id;
    return true;
}

/* Does the frame taken last lead to a position that the axes may have? */
static bool within(const struct netcard *c)
{
    for (int i = 0; i < CARD_AXES; i++) {
        const int64_t at = c->origin[i] + c->reader.position[i];
        if (at < c->settings.position_low[i] || at > c->settings.position_high[i]) {
            return false;
        }
    }
    return true;
}

/* A page has come. */
static void page(struct netcard *c)
{
    if (!c->page.good || job_reader_page(&c->reader, c->page.bytes) != JOB_GOOD) {
        card_fault(c, NET_BAD_JOB);
        leave(c);
    } else {
        go(c, NEXT);
    }
}

/* The job leads out of the range: it is stopped while its frames in stock still lie within. */
static void stop(struct netcard *c)
{
    if (card_literal(c)) {
        card_fault(c, NET_LIMIT);
        return;
    }
    c->error = NET_LIMIT;
    c->state = NET_STOPPING;
    leave(c);
    kernel_give(&c->kernel, NETCARD_GIVE_STOP);
}

static void push(struct netcard *c)
{
    struct job_frame f = { .event = 0 };
    struct frame to;

    if (c->approach) {
        to = card_approach_next(c);
    } else {
        job_reader_next(&c->reader, &f);
        if (!within(c)) {
            stop(c);
            return;
        }
        for (int i = 0; i < FRAME_AXES; i++) {
            to.command[i] = (int16_t)f.command[i];
        }
        to.event = (uint8_t)f.event;
    }
    kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_RUN);
    if (player_push(&c->player, &to) != PLAYER_OK) {
        card_fault(c, NET_BAD_JOB);
    }
    go(c, NEXT);
}

/* What comes behind a frame: another one, a page, or nothing more. */
static void next(struct netcard *c)
{
    const uint32_t wants = c->approach ? 0 : job_reader_wants(&c->reader);
    const bool full = c->player.fifo.stock == c->player.config.depth;
    const bool last = c->approach ? card_approach_given(c)
                                  : !wants && c->reader.frame == c->reader.header.frames;

    if (last) {
        c->read = true;
        player_whole(&c->player);
        prime(c);
        go(c, c->approach ? ARRIVED : LAST);
    } else if (full) {
        if (!c->primed) {
            prime(c);
        }
        go(c, FULL);
    } else if (wants) {
        want(c, wants, PAGE);
        return;
    } else {
        card_spend(c, NETCARD_RUN, card_frame_ns(c, c->settings.frame_cycles), WRITTEN);
        return;
    }
    if (c->deferred) {
        kernel_give(&c->kernel, NETCARD_GIVE_STORAGE);
    }
}

void card_run(struct netcard *c)
{
    const int step = c->step[NETCARD_RUN];

    if (c->job && c->over && step != PAGE && step != HEADER) {
        leave(c);
        return;
    }
    switch (step) {
    case WAIT:
        card_take(c, NETCARD_RUN, NETCARD_GIVE_RUN, BEGIN);
        return;
    case BEGIN:
        if ((!card_literal(c) && c->state != NET_RUNNING) || c->store.job.slot < 0) {
            c->dropped++;
            go(c, WAIT);
            return;
        }
        c->job = true;
        c->primed = c->over = false;
        c->place = c->store.job;
        c->jobs++;
        c->state = NET_RUNNING;
        want(c, 0, HEADER);
        return;
    case HEADER:
    case PAGE:
        if (c->page.wanted) {
            card_take(c, NETCARD_RUN, NETCARD_GIVE_PAGE, step);
        } else if (c->over) {
            leave(c);
        } else if (step == PAGE) {
            page(c);
        } else if (header(c) && begin(c)) {
            go(c, NEXT);
        } else {
            card_fault(c, NET_BAD_JOB);
            leave(c);
        }
        return;
    case WRITTEN:
        push(c);
        return;
    case FULL:
        card_take(c, NETCARD_RUN, NETCARD_GIVE_FIFO, NEXT);
        return;
    case LAST:
        if (c->ended && (card_literal(c) || c->state == NET_RUNNING)) {
            c->works = false;
            card_rest(c);
            leave(c);
            return;
        }
        card_take(c, NETCARD_RUN, NETCARD_GIVE_FIFO, LAST);
        return;
    case ARRIVED:
        if (!c->ended || c->state != NET_RUNNING) {
            card_take(c, NETCARD_RUN, NETCARD_GIVE_FIFO, ARRIVED);
        } else if (begin(c)) {
            go(c, NEXT);
        } else {
            card_fault(c, NET_RANGE);
            leave(c);
        }
        return;
    default:
        next(c);
    }
}
