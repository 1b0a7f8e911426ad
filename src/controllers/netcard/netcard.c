#include "netcard_parts.h"

#include <string.h>

static const int64_t NS_PER_US = 1000, NS_PER_MS = 1000000;

int64_t card_cycles_ns(int64_t cycles)
{
    return (cycles * 125 + 20) / 21; /* 168 MHz, rounded up */
}

int64_t card_frame_ns(const struct netcard *c, int64_t cycles)
{
    enum { WORDS = 5 };

    return card_cycles_ns(cycles) + WORDS * (int64_t)c->settings.fsmc_word_ns;
}

void card_spend(struct netcard *c, int context, int64_t ns, int step)
{
    c->step[context] = step;
    kernel_compute(&c->kernel, ns);
}

void card_work(struct netcard *c, int context, int64_t cycles, int step)
{
    card_spend(c, context, card_cycles_ns(cycles), step);
}

void card_take(struct netcard *c, enum netcard_task task, int semaphore, int step)
{
    c->step[task] = step;
    kernel_take(&c->kernel, semaphore);
}

static void start_kernel(struct netcard *c)
{
    const struct card_settings *s = &c->settings;
    struct kernel_config k = { .tasks = NETCARD_TASKS,
                               .priority = { [NETCARD_PARSER] = s->priority_parser,
                                             [NETCARD_STORAGE] = s->priority_storage,
                                             [NETCARD_HOME] = s->priority_home,
                                             [NETCARD_STOP] = s->priority_stop,
                                             [NETCARD_PAUSE] = s->priority_pause,
                                             [NETCARD_RUN] = s->priority_run },
                               .tick = s->tick_ns,
                               .tick_time = s->tick_time_ns,
                               .switch_time = s->switch_ns,
                               .entry_time = s->entry_ns };

    for (int i = 0; i < CARD_VECTORS; i++) {
        k.level[i] = 6;
    }
    k.level[NETCARD_FPGA] = 5;
    k.level[NETCARD_NETWORK] = 8;
    k.level[NETCARD_FLASH] = 7;
    k.level[NETCARD_SOFTWARE] = 9;
    kernel_start(&c->kernel, &k);
    c->boot = c->now;
}

static void start_inputs(struct netcard *c)
{
    struct card_inputs_config inputs;

    for (int i = 0; i < CARD_INPUTS; i++) {
        inputs.line[i] = (struct card_input){ (enum card_action)c->settings.in_action[i],
                                              (enum card_edge)c->settings.in_edge[i],
                                              c->settings.in_debounce_us[i] * NS_PER_US };
    }
    card_inputs_start(&c->inputs, &inputs, c->input_levels);
}

static struct player_config player_of(const struct card_settings *s)
{
    return (struct player_config){ s->fifo_depth, s->pulse_width_ns / PLAYER_CLOCK_NS,
                                   s->dir_setup_ns / PLAYER_CLOCK_NS,
                                   s->dir_hold_ns / PLAYER_CLOCK_NS };
}

/* Power-up of all parts; the flash and the pulse counts have kept their content. */
static void boot(struct netcard *c)
{
    const struct player_config player = player_of(&c->settings);
    uint32_t start_speed[JOB_AXES];

    for (int i = 0; i < JOB_AXES; i++) {
        start_speed[i] = (uint32_t)c->settings.speed_min[i];
    }
    memset(c->step, 0, sizeof c->step);
    memset(c->gives, 0, sizeof c->gives);
    memset(&c->told, 0, sizeof c->told);
    memset(&c->page, 0, sizeof c->page);
    memset(&c->load, 0, sizeof c->load);
    c->phase = JOB_NONE;
    c->approach = APPROACH_NONE;
    c->homing = HOMING_NONE;
    c->hold = HOLD_NONE;
    c->clear = CLEAR_NONE;
    c->deferred = c->asked = c->works = false;
    c->first = c->orders = 0;
    c->homed = c->latched = 0;
    c->error = NET_DONE;
    c->resumes = NET_RUNNING;
    c->credit = 0;
    c->loading = job_store_start(&c->store, &c->flash, c->settings.slots, start_speed, c->now);
    player_power(&c->player, &player);
    start_inputs(c);
    card_outputs_start(&c->outputs);
    start_kernel(c);
    c->state = NET_EMPTY;
    card_rest(c);
}

static struct flash_config flash_of(const struct card_settings *s)
{
    return (struct flash_config){
        .program = { s->program_us * NS_PER_US, s->program_most_us * NS_PER_US },
        .sector = { s->erase_ms * NS_PER_MS, s->erase_most_ms * NS_PER_MS },
        .block = { s->block_ms * NS_PER_MS, s->block_most_ms * NS_PER_MS },
        .spread = s->flash_spread,
        .read_hz = s->spi_hz,
        .seed = (uint64_t)s->seed
    };
}

static void start_link(struct netcard *c, const uint8_t key[NET_SHA_BYTES])
{
    struct session_config s = { .card = (uint32_t)c->settings.card_id,
                                .firmware = 1,
                                .slots = (uint8_t)c->settings.slots,
                                .axes = CARD_AXES };

    memcpy(s.key, key, sizeof s.key);
    memcpy(s.seed, &c->settings.seed, sizeof c->settings.seed);
    memcpy(s.seed + 4, &c->settings.card_id, sizeof c->settings.card_id);
    session_start(&c->session, &s, c->now);
}

enum net_code netcard_start(struct netcard *c, const struct netcard_config *config,
                            const uint8_t *job, uint32_t bytes)
{
    const struct card_settings *s = &config->settings;
    const struct flash_config flash = flash_of(s);
    const struct player_config player = player_of(s);
    enum net_code code = NET_DONE;

    memset(c, 0, offsetof(struct netcard, flash));
    c->settings = *s;
    c->power = true;
    c->least = s->fifo_depth;
    flash_start(&c->flash, &flash);
    player_start(&c->player, &player);
    c->store.slots = s->slots;
    start_link(c, config->key);
    if (bytes > 0) {
        boot(c);
        code = job_store_load(&c->store, &c->flash, job, bytes);
    }
    boot(c);
    return code;
}

void netcard_set_power(struct netcard *c, bool on)
{
    if (on == c->power) {
        return;
    }
    c->power = on;
    if (on) {
        session_power_up(&c->session, c->now);
        boot(c);
    } else {
        session_cut(&c->session, c->now);
        flash_cut(&c->flash, c->now);
        player_clear(&c->player);
        c->outputs.levels = 0;
        c->state = NET_EMPTY;
    }
}

int64_t netcard_position(const struct netcard *c, int axis)
{
    int64_t counts[FRAME_AXES];

    player_counts(&c->player, card_clock(c), counts);
    return counts[axis] - c->zero[axis];
}

int64_t netcard_frames(const struct netcard *c)
{
    return c->approach ? 0 : c->player.frames;
}

/* The drives' error clear has helped or its time is over: the parser answers the RESET. */
static void look_cleared(struct netcard *c)
{
    if (c->clear == CLEAR_GIVEN && (!c->axes.alarm || c->axes.stop || c->now >= c->clear_until)) {
        c->clear = CLEAR_OVER;
        card_pend(c, NETCARD_NETWORK);
    }
}

/* Enter FAULT at a limit switch in the way of a job, at an alarm or at the emergency stop. */
static void guard(struct netcard *c)
{
    const struct netcard_axes *a = &c->axes;
    const bool job = c->state == NET_RUNNING || c->state == NET_PAUSING || c->state == NET_STOPPING;

    if (c->state == NET_FAULT || !(a->plus | a->minus | a->alarm | a->stop)) {
        return;
    }
    if (a->stop || a->alarm) {
        card_fault(c, NET_ALARM);
    }
    for (int i = 0; job && i < CARD_AXES; i++) {
        const int way = c->player.frame.command[i];
        const uint32_t met = way > 0 ? a->plus : way < 0 ? a->minus : 0;
        if (c->player.playing && met >> i & 1) {
            card_fault(c, NET_LIMIT);
            return;
        }
    }
}

/* The last frame of homing, of the approach or of the job has been played. */
static void frames_ended(struct netcard *c)
{
    if (c->homing == HOMING_GIVEN) {
        c->homing = HOMING_PLAYED;
    } else if (c->phase == JOB_DRAINING) {
        c->phase = JOB_PLAYED;
    }
}

void card_advance_player(struct netcard *c)
{
    const bool counts = (c->phase == JOB_PLAYING && !c->approach) || c->phase == JOB_CUT;

    player_advance(&c->player, card_clock(c));
    if (counts && c->player.fifo.stock < c->least) {
        c->least = c->player.fifo.stock;
    }
    if (c->player.told.what) {
        const struct player_told t = player_take(&c->player);
        c->told.what |= t.what;
        c->told.events |= t.events;
        if (t.what & PLAYER_ENDED) {
            frames_ended(c);
        }
        card_pend(c, NETCARD_FPGA);
    }
}

/* Make interrupts of the inputs' vectors pending. One that is pending already does not count
 * twice. */
static void pend_vectors(struct netcard *c, uint32_t vectors)
{
    for (int i = 0; vectors >> i != 0; i++) {
        if (vectors >> i & 1) {
            card_pend(c, i);
        }
    }
}

/* Let the hardware do all that is due at c->now. */
static void hardware(struct netcard *c)
{
    card_advance_player(c);
    guard(c);
    look_cleared(c);
    const uint32_t before = card_inputs_vectors(&c->inputs);
    pend_vectors(c, card_inputs_advance(&c->inputs, c->now) & ~before);
    card_outputs_advance(&c->outputs, c->now);
    if (session_next_time(&c->session) <= c->now) {
        session_tick(&c->session, c->now);
        card_pend(c, NETCARD_NETWORK);
    }
    if (session_status_time(&c->session) == c->now) {
        card_pend(c, NETCARD_NETWORK);
    }
}

static int64_t earlier(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

/* Time after c->now at which the hardware next has something to do. [ns] */
static int64_t horizon(const struct netcard *c, int64_t until)
{
    const int64_t clock = player_next(&c->player);
    const int64_t status = session_status_time(&c->session);

    if (clock < INT64_MAX / PLAYER_CLOCK_NS) {
        until = earlier(until, clock * PLAYER_CLOCK_NS);
    }
    if (status > c->now) {
        until = earlier(until, status);
    }
    if (c->clear == CLEAR_GIVEN) {
        until = earlier(until, c->clear_until);
    }
    until = earlier(until, card_inputs_next(&c->inputs));
    until = earlier(until, card_outputs_next(&c->outputs));
    until = earlier(until, session_next_time(&c->session));
    return until;
}

/* A task that moves the axes, by the table of states and commands. */
static void table_task(struct netcard *c, enum netcard_task task)
{
    switch (task) {
    case NETCARD_HOME:  card_home(c); break;
    case NETCARD_STOP:  card_stop(c); break;
    case NETCARD_PAUSE: card_pause(c); break;
    default:            card_run(c);
    }
}

static void answer(struct netcard *c, int who)
{
    if (who >= KERNEL_TASKS) {
        card_interrupt(c, who - KERNEL_TASKS);
    } else if (who == NETCARD_PARSER) {
        card_parse(c);
    } else if (who == NETCARD_STORAGE) {
        card_store(c);
    } else if (card_literal(c)) {
        literal_task(c, (enum netcard_task)who);
    } else {
        table_task(c, (enum netcard_task)who);
    }
}

void netcard_advance(struct netcard *c, int64_t until)
{
    while (c->power && c->now < until) {
        const int64_t to = horizon(c, until);
        const int who = to > c->now ? kernel_next(&c->kernel, to - c->boot) : -1;
        c->now = to > c->now ? c->boot + c->kernel.processor.clock : c->now;
        if (who >= 0) {
            card_advance_player(c);
            answer(c, who);
            card_advance_player(c); /* an answer makes it tell, too */
        } else {
            hardware(c);
        }
    }
    c->now = until;
    if (!c->power) {
        card_advance_player(c);
    }
}

void netcard_set_inputs(struct netcard *c, uint32_t levels)
{
    c->input_levels = levels;
    if (!c->power) {
        return;
    }
    const uint32_t before = card_inputs_vectors(&c->inputs);
    pend_vectors(c, card_inputs_set(&c->inputs, levels, c->now) & ~before);
}

/* Latch the counts of axes whose origin has an edge of the trigger's kind now, as the FPGA does. */
static void latch(struct netcard *c, uint32_t origin)
{
    int64_t counts[FRAME_AXES];

    if (origin == c->axes.origin) {
        return;
    }
    player_counts(&c->player, card_clock(c), counts);
    for (int i = 0; i < CARD_AXES; i++) {
        const enum card_trigger t = (enum card_trigger)c->settings.origin_trigger[i];
        const bool was = c->axes.origin >> i & 1, is = origin >> i & 1;
        if (was != is && is == home_cycle_on_level(t)) {
            c->latched |= 1u << i;
            c->latch[i] = counts[i];
        }
    }
}

void netcard_set_axes(struct netcard *c, const struct netcard_axes *axes)
{
    struct netcard_axes a = *axes;

    for (int i = 0; i < CARD_AXES; i++) { /* what is active is 1 from here on */
        if (!c->settings.limit_high[i]) {
            a.plus ^= 1u << i;
            a.minus ^= 1u << i;
        }
        if (!c->settings.alarm_high[i]) {
            a.alarm ^= 1u << i;
        }
    }
    if (c->power) {
        latch(c, a.origin);
    }
    c->axes = a;
    if (c->power) {
        guard(c);
        look_cleared(c);
        card_advance_player(c);
    }
}

bool netcard_command(struct netcard *c, enum card_command command, uint8_t axes)
{
    if (!c->power || c->orders == NETCARD_ORDERS) {
        return false;
    }
    c->order[(c->first + c->orders++) % NETCARD_ORDERS] =
        (struct netcard_order){ (uint8_t)command, axes };
    card_pend(c, NETCARD_NETWORK);
    return true;
}
