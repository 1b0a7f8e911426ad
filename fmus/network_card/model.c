/* FMU of the network card (core netcard): grid, byte stream of the link, terminals, job file. */
#include <string.h>

#include "byte_ring.h"
#include "netcard.h"
#include "vars.h"

struct model {
    struct netcard card;
    int64_t period;     /* [ns] grid of the inputs */
    int64_t instant;    /* [ns] next instant of that grid */
    int32_t connection; /* number of the connection as read last */
    int32_t seq;        /* sequence number of the command taken last */
    int64_t events;     /* events of the kernel, */
    int64_t worked;     /* [ns] and time that it was not idle, as shown last */
};

#define MODEL_BLOB
#define MODEL_IN_USE FMU_FLAGS(card.flash.array, FLASH_SECTOR, card.flash.written)
#include "fmi_model.h"
#include "fmu_period.h"
#include "job_file.h"

_Static_assert(FLASH_SECTORS / 2 < FMU_SPANS, "every other sector may be left out");
_Static_assert(sizeof((struct job_file *)0)->byte == FLASH_BYTES + 1, "a whole flash");
_Static_assert(NET_RESET - NET_START == (int)CARD_DO_RESET, "commands are those of the link");

static int read_settings(struct fmu *f, struct netcard_config *c)
{
    const struct vars *v = &f->s.v;
    struct card_wrong w;

#define SETTING(type, name, elements, unit, start, low, high, words) \
    _Static_assert(sizeof c->settings.name == sizeof v->name, #name); \
    memcpy(&c->settings.name, &v->name, sizeof v->name);
    CARD_SETTINGS(SETTING)
    if (!card_settings_good(&c->settings, &w)) {
        return fmu_fail(f, "%s[%d] = %.17g: %s", w.name, (int)w.index + 1, w.value,
                        w.why ? w.why : "out of range");
    }
    return job_key(f, c->key);
}

static int32_t whole(int64_t value)
{
    return (int32_t)(uint32_t)(uint64_t)value;
}

static void publish_axes(struct vars *v, const struct netcard *c)
{
    int64_t counts[FRAME_AXES];

    player_counts(&c->player, c->now / PLAYER_CLOCK_NS, counts);
    for (int i = 0; i < CARD_AXES; i++) {
        v->pulse_count[i] = whole(counts[i]);
        v->pulse_rate[i] = player_velocity(&c->player, i);
        v->position[i] = whole(counts[i] - c->zero[i]);
        v->enable[i] = c->power && c->state != NET_FAULT;
        v->error_clear[i] = c->power && c->now < c->clear_until;
    }
    v->frame = whole(netcard_frames(c));
    v->approach = c->approach != APPROACH_NONE;
    v->stock = c->player.fifo.stock;
    v->stock_least = c->least;
    v->underflows = whole(c->player.dry);
    v->rate = player_rate(&c->player);
}

/* Times of tasks and interrupts change only while the processor is not idle. */
static void publish_times(struct vars *v, struct model *m)
{
    const struct netcard *c = &m->card;
    const struct kernel *k = &c->kernel;
    const int64_t worked = k->processor.clock - kernel_idle(k);
    int64_t interrupts = 0;

    v->idle = (double)kernel_idle(k) * 1e-9;
    if (k->events == m->events && worked == m->worked) {
        return;
    }
    m->events = k->events;
    m->worked = worked;
    for (int i = 0; i < NETCARD_TASKS; i++) {
        v->task_busy[i] = (double)kernel_busy(k, i) * 1e-9;
    }
    for (int i = 0; i < NETCARD_INTERRUPTS; i++) {
        interrupts += kernel_busy(k, KERNEL_TASKS + i);
        v->interrupts[i] = whole(c->served[i]);
    }
    v->interrupt_busy = (double)interrupts * 1e-9;
    v->kernel_busy = (double)kernel_overhead(k) * 1e-9;
    v->task = k->current;
}

static void publish(struct fmu *f)
{
    const struct netcard *c = &f->s.m.card;
    struct vars *v = &f->s.v;

    publish_axes(v, c);
    publish_times(v, &f->s.m);
    v->connect = netcard_wants_connection(c);
    v->link_up = c->power && session_up(&c->session);
    v->link_losses = c->session.losses;
    v->out = (int32_t)c->outputs.levels;
    v->state = (int32_t)c->state;
    v->error = (int32_t)c->error;
    v->homed = (int32_t)c->homed;
    v->jobs = c->jobs;
    v->results = c->result.count;
    v->result = (int32_t)c->result.code;
    v->receiving = c->store.phase != STORE_REST;
    v->flash_programs = whole(c->flash.programs);
    v->flash_erases = whole((int64_t)c->flash.sector_erases + c->flash.block_erases);
    v->flash_wear = whole(flash_wear(&c->flash));
    v->flash_slot = c->store.job.slot;
}

static int model_start(struct fmu *f)
{
    const struct job_file *b = f->blob;
    const double clocks = f->s.v.bus_period * 1e9 / FMU_TICK_NS;
    struct model *m = &f->s.m;
    struct netcard_config config;

    if (!fmu_is_period(clocks)) {
        return fmu_fail(f, "bus_period = %.17g s: not a whole number of 20 ns clocks",
                        f->s.v.bus_period);
    }
    if (read_settings(f, &config)) {
        return -1;
    }
    m->period = llround(clocks) * FMU_TICK_NS;
    m->events = -1; /* nothing has been shown */
    const enum net_code code = netcard_start(&m->card, &config, b->byte, b->bytes);
    if (code == NET_TOO_LONG) {
        return fmu_fail(f, "job: %s is too long for a slot of the flash", f->s.v.job);
    }
    if (code != NET_DONE) {
        return fmu_fail(f, "job: %s: page %d, frame %d: %s", f->s.v.job,
                        (int)m->card.store.check.page, (int)m->card.store.check.frame,
                        job_fault_text(m->card.store.fault));
    }
    publish(f);
    return 0;
}

/* Read the byte stream of the connection; a new number of the connection starts a new stream. */
static void read_stream(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    uint8_t bytes[BYTE_RING_BYTES];

    if (v->connection != m->connection) {
        if (m->connection) {
            netcard_connected(&m->card, false);
        }
        m->connection = v->connection;
        v->tx_count = v->rx_taken = 0;
        if (m->connection) {
            netcard_connected(&m->card, true);
        }
    }
    if (!m->connection) {
        return;
    }
    size_t n = byte_ring_look(v->rx_words, v->rx_count, v->rx_taken, bytes, sizeof bytes);
    v->rx_taken = byte_ring_on(v->rx_taken, netcard_receive(&m->card, bytes, n));
    const int32_t held = byte_ring_held(v->tx_count, v->tx_taken);
    if (held >= 0) {
        n = netcard_send(&m->card, bytes, (size_t)(BYTE_RING_BYTES - held));
        byte_ring_put(v->tx_words, &v->tx_count, v->tx_taken, bytes, n);
    }
}

static void read_command(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;

    if (v->command_seq == m->seq) {
        return;
    }
    m->seq = v->command_seq;
    if (!netcard_command(&m->card, (enum card_command)(v->command - NET_START),
                         (uint8_t)v->command_axes)) {
        fmu_warn(f, "command_seq = %d: the card does not take it", (int)v->command_seq);
    }
}

static void read_terminals(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct netcard *c = &f->s.m.card;
    struct netcard_axes a = { .stop = v->emergency_stop };

    for (int i = 0; i < CARD_AXES; i++) {
        a.origin |= (uint32_t)v->origin[i] << i;
        a.plus |= (uint32_t)v->limit_plus[i] << i;
        a.minus |= (uint32_t)v->limit_minus[i] << i;
        a.alarm |= (uint32_t)(v->alarm[i] != 0) << i;
    }
    netcard_set_axes(c, &a);
    netcard_set_inputs(c, (uint32_t)v->in & 0xFFFFu);
}

/* Inputs are read at the instants in [t0, t1); the outputs show the state at t1. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;

    (void)t0;
    for (; m->instant < t1; m->instant += m->period) {
        netcard_advance(&m->card, m->instant);
        netcard_set_power(&m->card, f->s.v.power);
        read_terminals(f);
        read_stream(f);
        read_command(f);
    }
    netcard_advance(&m->card, t1);
    publish(f);
    return 0;
}
