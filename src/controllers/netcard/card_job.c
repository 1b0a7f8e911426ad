/* A job on its way from the flash to the FPGA, for the run task under either policy. */
#include "netcard_parts.h"

static void go(struct netcard *c, enum card_run_step step)
{
    c->step[NETCARD_RUN] = step;
}

bool card_job_under_way(const struct netcard *c)
{
    return c->phase != JOB_NONE;
}

bool card_job_let_go(const struct netcard *c)
{
    return c->phase == JOB_PLAYING || c->phase == JOB_DRAINING || c->phase == JOB_PLAYED;
}

bool card_job_reads(const struct netcard *c)
{
    return c->approach == APPROACH_NONE && (c->phase == JOB_READING || c->phase == JOB_PLAYING);
}

bool card_job_given_up(const struct netcard *c)
{
    return c->phase == JOB_CUT || c->phase == JOB_OVER;
}

void card_job_give_up(struct netcard *c)
{
    if (card_job_under_way(c) && c->phase != JOB_CUT) {
        c->phase = c->phase == JOB_PLAYING && c->approach == APPROACH_NONE ? JOB_CUT : JOB_OVER;
    }
}

void card_job_leave(struct netcard *c)
{
    c->player.frames = netcard_frames(c);
    c->phase = JOB_NONE;
    c->approach = APPROACH_NONE;
    go(c, RUN_WAIT);
}

static void want(struct netcard *c, uint32_t page, enum card_run_step step)
{
    c->page.wanted = true;
    c->page.good = false;
    c->page.number = page;
    go(c, step);
    kernel_give(&c->kernel, NETCARD_GIVE_STORAGE);
}

void card_job_begin(struct netcard *c)
{
    c->phase = JOB_READING;
    c->place = c->store.job;
    c->jobs++;
    c->state = NET_RUNNING;
    want(c, 0, RUN_HEADER);
}

bool card_job_header(struct netcard *c)
{
    struct job_header h;
    struct player_job job;

    if (!c->page.good || job_header_read(&h, c->page.bytes) != JOB_GOOD
        || job_reader_start(&c->reader, &h, 0) != JOB_GOOD) {
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

bool card_job_play(struct netcard *c)
{
    c->phase = JOB_READING;
    c->approach = APPROACH_NONE;
    for (int i = 0; i < CARD_AXES; i++) {
        c->origin[i] = netcard_position(c, i);
    }
    return player_begin(&c->player, &c->plays, card_clock(c)) == PLAYER_OK;
}

bool card_job_page(struct netcard *c)
{
    return c->page.good && job_reader_page(&c->reader, c->page.bytes) == JOB_GOOD;
}

/* True if the latest frame leads to a position within the range of each axis. */
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

bool card_job_frame(struct netcard *c, struct frame *to)
{
    struct job_frame f = { .event = 0 };

    job_reader_next(&c->reader, &f);
    for (int i = 0; i < FRAME_AXES; i++) {
        to->command[i] = (int16_t)f.command[i];
    }
    to->event = (uint8_t)f.event;
    return within(c);
}

void card_job_push(struct netcard *c, const struct frame *frame)
{
    kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_RUN);
    if (player_push(&c->player, frame) != PLAYER_OK) {
        card_fault(c, NET_BAD_JOB);
    }
    go(c, RUN_NEXT);
}

void card_job_slept(struct netcard *c)
{
    if (c->deferred) {
        kernel_give(&c->kernel, NETCARD_GIVE_STORAGE);
    }
}

enum card_job_next card_job_next(struct netcard *c)
{
    const uint32_t wants = c->approach ? 0 : job_reader_wants(&c->reader);
    const bool last = c->approach ? c->approach == APPROACH_THERE
                                  : !wants && c->reader.frame == c->reader.header.frames;

    if (last) {
        player_whole(&c->player);
        return JOB_NEXT_NONE;
    }
    if (c->player.fifo.stock == c->player.config.depth) {
        return JOB_NEXT_FULL;
    }
    if (wants) {
        want(c, wants, RUN_PAGE);
    } else {
        card_spend(c, NETCARD_RUN, card_frame_ns(c, c->settings.frame_cycles), RUN_WRITTEN);
    }
    return JOB_NEXT_COMES;
}
