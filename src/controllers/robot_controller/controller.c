#include "controller_parts.h"

#include <math.h>

#include "controller_places.h"
#include "slots.h"

void controller_start(struct controller *s, const struct controller_config *c)
{
    memset(s, 0, sizeof *s);
    robot_start(&s->robot, &c->robot, c->zero);
    layers_start(&s->layers, &c->layers, c->seed);
    s->memory = 1;
    s->asked = -1;
    s->replaying = -1;
    robot_place(&s->robot, &c->robot, c->zero_external);
    memcpy(s->joint, c->zero, sizeof s->joint);
    s->external = c->zero_external;
    s->external_origin = (double)llround(c->zero_external * c->robot.external.scale);
    for (int i = 0; i < OPW_JOINTS; i++) {
        s->origin[i] = (double)llround(c->zero[i] * c->robot.scale[i]);
    }
}

/* Count the moves whose points the arm has passed. */
static void look_at_moves(struct controller *s)
{
    const int64_t reached = robot_idle(&s->robot) ? s->given : (int64_t)s->robot.line - 1;

    s->reached = reached > s->reached ? reached : s->reached;
}

/* Write a cycle of the arm into the slots of a memory, as pulses. */
static void make_slots(struct controller *s, const struct controller_config *c)
{
    int32_t of[OPW_JOINTS][FPGA_SLOTS], beside[FPGA_SLOTS];
    bool moves[OPW_JOINTS];

    memset(s->words, 0, (size_t)c->slots * FPGA_SLOT_WORDS * sizeof s->words[0]);
    const bool travels =
        slots_pulses(s->external, s->robot.external, c->robot.external.scale, c->slots, beside);
    bool any = travels;
    for (int i = 0; i < OPW_JOINTS; i++) {
        moves[i] = slots_pulses(s->joint[i], s->robot.joint[i], c->robot.scale[i], c->slots, of[i]);
        any |= moves[i];
    }
    for (int n = 0; n < c->slots && any; n++) {
        int32_t pulses[FPGA_SLOT_AXES] = { 0 };
        for (int i = 0; i < OPW_JOINTS; i++) {
            pulses[i] = moves[i] ? of[i][n] : 0;
        }
        pulses[FPGA_AXES] = travels ? beside[n] : 0;
        fpga_slot_pack(&s->words[n * FPGA_SLOT_WORDS], pulses, c->format);
    }
    memcpy(s->joint, s->robot.joint, sizeof s->joint);
    s->external = s->robot.external;
}

/* Measure the latency of lines whose memory has begun to play. */
static void see_lines(struct controller *s, const struct fpga_shown *card, int64_t clock)
{
    if (s->asked < 0 || card->memory != s->memory) {
        return;
    }
    s->report.line = clock - s->asked;
    if (s->report.line > s->report.line_most) {
        s->report.line_most = s->report.line;
    }
    if (clock - s->known > s->report.told_most) {
        s->report.told_most = clock - s->known;
    }
    s->asked = -1;
}

static struct robot_job_inputs inputs_of(const struct controller_places *asked,
                                         const struct fpga_shown *card, uint32_t di, int64_t clock)
{
    struct robot_job_inputs in = { .now = clock * FPGA_CLOCK_NS,
                                   .reached = asked->s->reached - asked->s->first,
                                   .di = di,
                                   .here = controller_places_here,
                                   .convert = controller_places_convert,
                                   .shift = controller_places_shift,
                                   .arm = asked };
    memcpy(in.ai, card->irq_ai, sizeof in.ai);
    return in;
}

/* Note the clocks of a run, and report its times. */
static void time_run(struct controller *s, const struct controller_config *c,
                     const struct fpga_shown *card, int64_t clock, int64_t begin, int32_t lines,
                     int32_t points)
{
    struct controller_report *r = &s->report;

    s->mark = begin + c->copy_in + lines * c->line + points * c->point + c->copy_out;
    s->free = s->mark;
    r->runs++;
    r->spare = clock + c->slots * c->slot - s->mark;
    r->late += card->memory >= 0 && r->spare <= 0;
    r->wait = begin - clock;
    r->run = s->mark - clock;
    r->wait_most = r->wait > r->wait_most ? r->wait : r->wait_most;
    r->run_most = r->run > r->run_most ? r->run : r->run_most;
    r->busy += s->mark - begin;
    r->lines += lines;
    r->points += points;
}

/* Make the polls of the user program up to a clock. */
static void poll(struct controller *s, const struct controller_config *c,
                 const struct orders_text *t, const struct fpga_shown *card, int64_t until)
{
    const struct controller_places asked = { s, c, t };
    struct layers_copy seen;

    for (int64_t at = s->layers.poll; layers_poll(&s->layers, &c->layers, until, &seen);
         at = s->layers.poll) {
        if (c->user && controller_running(s)) {
            const struct robot_job_inputs in = inputs_of(&asked, card, seen.inputs, at);
            controller_program_poll(s, c, t, &in, at);
        }
    }
    s->report.polls = s->layers.polls;
}

/* Act on keys and on the program's orders; returns how many lines are done. */
static int32_t decide(struct controller *s, const struct controller_config *c,
                      const struct orders_text *t, const struct fpga_shown *card,
                      const struct controller_panel *panel, int64_t clock)
{
    controller_panel_run(s, c, t, panel, clock);
    look_at_moves(s);
    const struct controller_places asked = { s, c, t };
    const struct robot_job_inputs in = inputs_of(&asked, card, (uint32_t)card->irq_inputs, clock);
    s->known = -1;
    const int32_t lines = s->stopped ? 0 : controller_program_run(s, c, t, panel, &in);
    s->start.pressed = s->replay.pressed = false;
    if (s->known >= 0) {
        s->asked = clock;
    }
    return lines;
}

/* Move the arm by a cycle and write its pulses; returns how many points had their kinematics
 * computed. */
static int32_t move_arm(struct controller *s, const struct controller_config *c)
{
    const double way = s->robot.solved;

    robot_cycle(&s->robot, &c->robot);
    if (s->robot.lost && s->trouble.error == CONTROLLER_OK) {
        s->trouble.error = CONTROLLER_LOST;
        s->trouble.line = s->move_line[s->given % CONTROLLER_MOVES];
        controller_program_drop(s);
    }
    make_slots(s, c);
    return (int32_t)(floor(s->robot.solved / c->pitch) - floor(way / c->pitch));
}

/* The driver's run for the interrupt at a clock: wait, copy in, lines, points, copy out. */
static void run(struct controller *s, const struct controller_config *c,
                const struct orders_text *t, const struct fpga_shown *card,
                const struct controller_panel *panel)
{
    const int64_t clock = (int64_t)card->irq_clock;
    const int64_t begin = clock + layers_wait(&s->layers, &c->layers);
    const uint32_t di = (uint32_t)card->irq_inputs;

    see_lines(s, card, clock);
    poll(s, c, t, card, begin);
    layers_copied(&s->layers, begin + c->copy_in, di);
    const int32_t lines = decide(s, c, t, card, panel, clock);
    const int32_t points = move_arm(s, c);
    time_run(s, c, card, clock, begin, lines, points);
    controller_program_outputs(s, s->mark);
    layers_put(&s->layers, &c->layers, di, s->mark, &s->outbox);
    s->memory = 1 - s->memory;
    s->posts = !s->stopped;
}

/* The card has stopped. Once it is let go its counters say where the arm is. */
static void look_at_stop(struct controller *s, const struct controller_config *c,
                         const struct fpga_shown *card)
{
    if (card->stopped && !s->stopped) {
        controller_program_drop(s);
        s->replaying = -1;
        robot_stop(&s->robot);
    }
    if (s->stopped && !card->stopped) {
        for (int i = 0; i < OPW_JOINTS; i++) {
            s->joint[i] = (s->origin[i] + card->pulse_count[i]) / c->robot.scale[i];
        }
        robot_start(&s->robot, &c->robot, s->joint);
        if (c->robot.external.kind != EXTERNAL_NONE) {
            s->external = (s->external_origin + card->external_count) / c->robot.external.scale;
            robot_place(&s->robot, &c->robot, s->external);
        }
        s->reached = s->given;
    }
    s->stopped = card->stopped;
    if (controller_key_take(&s->reset)) {
        s->reset_seq++;
    }
}

static void look_at_keys(struct controller *s, const struct controller_panel *panel)
{
    controller_key_look(&s->start, panel->start);
    controller_key_look(&s->abort, panel->abort);
    controller_key_look(&s->reset, panel->reset);
    controller_key_look(&s->teach, panel->teach);
    controller_key_look(&s->replay, panel->replay);
}

void controller_instant(struct controller *s, const struct controller_config *c,
                        const struct orders_text *t, const struct fpga_shown *card,
                        const struct controller_panel *panel, int64_t now)
{
    s->posts = false;
    look_at_keys(s, panel);
    look_at_stop(s, c, card);
    /* The card's timer has interrupted a driver that is late: what it asks for is being done. */
    if (link_new(&s->irq_seq, card->irq_seq) && (int64_t)card->irq_clock > s->free) {
        run(s, c, t, card, panel);
    }
    poll(s, c, t, card, now);
    layers_look(&s->layers, &c->layers, card, now + 2 * c->bus, &s->outbox);
}

void controller_post(struct controller *s, const struct controller_config *c,
                     struct fpga_host *host)
{
    outbox_post(&s->outbox, host);
    if (s->posts) {
        host->write_seq = ++s->write_seq;
        host->write_clock = (double)s->mark;
        host->write_memory = s->memory;
        host->write_slots = c->slots;
        memcpy(host->write_words, s->words, sizeof host->write_words);
        host->run = true;
    }
    if (s->posts && s->posts_ao) {
        host->ao_seq = ++s->ao_seq;
        host->ao_clock = (double)s->mark;
        memcpy(host->ao, s->volt, sizeof host->ao);
        s->posts_ao = false;
    }
    s->posts = false;
    host->servo = (int32_t)c->servo;
    host->reset_seq = s->reset_seq;
}

bool controller_running(const struct controller *s)
{
    return s->program >= PROGRAM_RUNS;
}

/* Status of a program, or of a replay, that nothing holds. */
static enum controller_status program_status(const struct controller *s,
                                             const struct controller_panel *panel)
{
    const bool idle = robot_idle(&s->robot),
               held = panel->single && s->next.kind == ORDER_MOVE && idle && !s->leave;

    if (s->program == PROGRAM_PAUSED || held) {
        return CONTROLLER_PAUSED;
    }
    if (s->program == PROGRAM_DELAYS) {
        return CONTROLLER_DELAY;
    }
    return s->program == PROGRAM_WAITS && idle ? CONTROLLER_WAITING : CONTROLLER_RUNNING;
}

enum controller_status controller_status(const struct controller *s,
                                         const struct controller_panel *panel)
{
    const bool idle = !controller_running(s) && s->replaying < 0 && robot_idle(&s->robot);

    return s->stopped                          ? CONTROLLER_STOPPED
           : s->trouble.error != CONTROLLER_OK ? CONTROLLER_ERROR
           : s->jogs                           ? CONTROLLER_JOG
           : idle                              ? CONTROLLER_IDLE
           : panel->hold                       ? CONTROLLER_HOLD
                                               : program_status(s, panel);
}

struct limited controller_limited(struct controller *s, const struct controller_config *c,
                                  const struct controller_panel *panel)
{
    const enum controller_status status = controller_status(s, panel);
    const double feed = s->move_feed[s->robot.line % CONTROLLER_MOVES];
    struct limited told = { 0 };

    if (status == CONTROLLER_HOLD || status == CONTROLLER_WAITING || status == CONTROLLER_PAUSED) {
        told.by = LIMITED_WAIT;
    } else if (status == CONTROLLER_DELAY) {
        told.by = LIMITED_DWELL;
    } else if (status == CONTROLLER_RUNNING) {
        told = robot_limited(&s->robot, &c->robot, feed);
    }
    return told;
}

bool controller_done(const struct controller *s)
{
    return s->program == PROGRAM_ENDED && robot_idle(&s->robot);
}

bool controller_failed(const struct controller *s)
{
    return s->trouble.error != CONTROLLER_OK && robot_idle(&s->robot);
}

void controller_rehearse(struct controller *s, const struct controller_config *c,
                         const struct orders_text *t)
{
    const struct robot_job_inputs in = { 0 };
    struct order order;

    controller_program_start(s, c, t);
    s->orders.passes = true;
    while (s->orders.on && s->trouble.error == CONTROLLER_OK) {
        orders_next(&s->orders, &c->orders, t, &in, &order);
        if (order.kind != ORDER_MOVE || !controller_program_move(s, c, &order)) {
            continue;
        }
        double end[OPW_JOINTS];
        const double beside = robot_end_external(&s->robot);
        robot_end(&s->robot, end);
        robot_start(&s->robot, &c->robot, end);
        robot_place(&s->robot, &c->robot, beside);
    }
}
