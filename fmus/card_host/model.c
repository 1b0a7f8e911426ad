/* FMU of the server's end of a network card's link (core net_host): it reads its inputs at the
 * instants of a grid and shows the outcome at the next instant. */
#include <string.h>

#include "byte_ring.h"
#include "net_host.h"
#include "vars.h"

struct model {
    struct net_host host;
    int64_t period;                    /* [ns] grid of the inputs */
    int64_t instant;                   /* [ns] next instant of the grid */
    bool unpublished;                  /* the outputs of the latest instant are not shown yet */
    bool stored;                       /* the job is stored in the card */
    int64_t stored_at;                 /* [ns] time at which it was */
    int32_t connection;                /* number of the connection as read last */
    int32_t tx_words[BYTE_RING_WORDS]; /* bytes to the card (byte_ring.h), */
    int32_t tx_count, rx_taken;        /* their count, count of bytes taken from the card */
    double owed;                       /* packets of the flood that are due */
    uint32_t asked;                    /* packets of the flood sent */
};

#define MODEL_BLOB
#include "fmi_model.h"
#include "fmu_period.h"
#include "job_file.h"

static const double second = 1e9; /* [ns] */

/* Check that the job file is whole pages and fits into the flash of a card. */
static int check_job(struct fmu *f, const struct job_file *job)
{
    if (job->bytes > JOB_FILE_MOST || job->bytes % NET_PAGE_BYTES)
        return fmu_fail(f, "job: %s is not 1 to 8192 pages of 256 bytes", f->s.v.job);
    return 0;
}

static int give_commands(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    for (int k = 0; k < NET_HOST_ORDERS; k++) {
        const struct net_host_order order = {
            .at = llround(v->command_at[k] * second),
            .type = (uint8_t)v->command[k],
            .axes = (uint8_t)v->command_axes[k],
            .mode = v->command_pulse[k],
            .level = v->command_high[k],
            .pins = (uint16_t)v->command_pins[k],
            .width = (uint32_t)llround(v->command_width[k] * 1e6),
        };
        if (v->command[k] == 0)
            continue;
        if (v->command[k] < NET_START)
            return fmu_fail(f, "command[%d] = %d: not 32 to 37", k + 1, (int)v->command[k]);
        net_host_give(&f->s.m.host, &order);
    }
    return 0;
}

static void publish(struct fmu *f);

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const struct job_file *job = f->blob;
    struct model *m = &f->s.m;
    const double ticks = v->bus_period * second / FMU_TICK_NS;
    struct net_host_config c = { .interval = (uint16_t)llround(v->status_interval * 1000.0) };
    if (!fmu_is_period(ticks))
        return fmu_fail(f, "bus_period = %.17g s: not a whole number of 20 ns ticks",
                        v->bus_period);
    m->period = llround(ticks) * FMU_TICK_NS;
    for (int i = 0; i < 4; i++)
        c.seed[i] = (uint8_t)((uint32_t)v->seed >> 8 * i);
    if (check_job(f, job) || job_key(f, c.key))
        return -1;
    net_host_start(&m->host, &c);
    if (job->bytes > 0)
        net_host_load(&m->host, job->byte, job->bytes);
    if (give_commands(f))
        return -1;
    publish(f);
    return 0;
}

/* When the connection's number changes, the byte streams start anew. */
static void see_connection(struct fmu *f)
{
    struct model *m = &f->s.m;
    if (f->s.v.connection == m->connection)
        return;
    if (m->connection)
        net_host_cut(&m->host);
    m->connection = f->s.v.connection;
    m->tx_count = m->rx_taken = 0;
    if (m->connection)
        net_host_connected(&m->host, m->instant);
}

/* A flood of packets: ask for the first setting at the given rate. Packets for which there is no
 * room are left out. */
static void flood(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const double now = (double)m->instant / second;
    if (now < v->flood_window[0] || now >= v->flood_window[1])
        return;
    m->owed += v->flood * (double)m->period / second;
    while (m->owed >= 1.0 && net_host_ask(&m->host, 0, 0)) {
        m->owed -= 1.0;
        m->asked++;
    }
    m->owed = m->owed < 1.0 ? m->owed : 1.0;
}

static void carry(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const struct job_file *job = f->blob;
    struct model *m = &f->s.m;
    uint8_t bytes[BYTE_RING_BYTES];
    const size_t got = byte_ring_look(v->rx_words, v->rx_count, m->rx_taken, bytes, sizeof bytes);
    const int32_t held = byte_ring_held(m->tx_count, v->tx_taken);
    net_host_bytes(&m->host, bytes, got, m->instant);
    m->rx_taken = byte_ring_on(m->rx_taken, got);
    net_host_tick(&m->host, job->byte, m->instant);
    flood(f);
    if (held < 0)
        return;
    const size_t n = net_host_out(&m->host, bytes, (size_t)(BYTE_RING_BYTES - held));
    byte_ring_put(m->tx_words, &m->tx_count, v->tx_taken, bytes, n);
}

static void read_wires(struct fmu *f)
{
    struct model *m = &f->s.m;
    see_connection(f);
    if (m->connection)
        carry(f);
    if (m->host.upload == NET_HOST_STORED && !m->stored) {
        m->stored = true;
        m->stored_at = m->instant;
    }
}

static void publish_commands(struct vars *v, const struct net_host *h)
{
    const struct net_host_order *o = h->order;
    v->commands_sent = v->commands_again = v->commands_done = v->commands_refused = 0;
    for (int k = 0; k < NET_HOST_ORDERS; k++) {
        v->command_code[k] = -1;
        if (v->command[k] == 0)
            continue;
        v->command_stage[k] = o->stage;
        v->command_number[k] = (int32_t)(o->number & INT32_MAX);
        v->command_tries[k] = (int32_t)(o->times & INT32_MAX);
        v->command_sent[k] = (double)o->first / second;
        v->command_answered[k] = (double)o->answered / second;
        if (o->times > 0) {
            v->commands_sent++;
            v->commands_again += v->command_tries[k] - 1;
        }
        if (o->stage == NET_HOST_ANSWERED) {
            v->commands_done += o->code == NET_DONE;
            v->commands_refused += o->code != NET_DONE;
            v->command_code[k] = o->code;
            v->command_state[k] = o->state;
        }
        o++;
    }
}

static void publish_card(struct vars *v, const struct net_host *h)
{
    const struct net_status *s = &h->status;
    v->statuses = (int32_t)(h->statuses & INT32_MAX);
    v->card_id = (int32_t)h->card;
    v->card_state = h->statuses ? s->state : h->hello.state;
    v->card_error = s->error;
    v->card_inputs = s->inputs;
    v->card_outputs = s->outputs;
    v->card_stock = s->stock;
    v->card_job = (int32_t)s->job;
    v->card_frame = (int32_t)s->frame;
    v->card_underflows = (int32_t)s->underflows;
    v->card_switches = (int32_t)s->switches;
    v->card_rate = s->rate / 1000.0;
    v->card_wear = (int32_t)s->wear;
    for (int i = 0; i < NET_AXES; i++)
        v->card_position[i] = s->position[i];
    for (int i = 0; i < 7; i++)
        v->card_load[i] = s->load[i] / 1000.0;
}

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    const struct model *m = &f->s.m;
    const struct net_host *h = &m->host;
    memcpy(v->tx_words, m->tx_words, sizeof v->tx_words);
    v->tx_count = m->tx_count;
    v->rx_taken = m->rx_taken;
    v->accept = net_host_accepts(h);
    v->up = h->phase == NET_HOST_UP;
    v->connections = (int32_t)(h->connections & INT32_MAX);
    v->losses = (int32_t)(h->losses & INT32_MAX);
    v->fault = h->fault;
    v->upload = h->upload;
    v->upload_code = h->code;
    v->stored_at = (double)m->stored_at / second;
    v->pages = (int32_t)(h->job.bytes / NET_PAGE_BYTES);
    v->pages_sent = (int32_t)(h->pages_sent & INT32_MAX);
    v->pages_again = (int32_t)(h->pages_again & INT32_MAX);
    v->refusals = (int32_t)(h->naks & INT32_MAX);
    v->asked = (int32_t)(m->asked & INT32_MAX);
    v->told = (int32_t)(h->settings & INT32_MAX);
    publish_commands(v, h);
    publish_card(v, h);
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    const struct job_file *job = f->blob;
    struct model *m = &f->s.m;
    (void)t0;
    if (m->host.job.bytes != job->bytes)
        return fmu_fail(f, "the job of the state has %u bytes, not %u", (unsigned)m->host.job.bytes,
                        (unsigned)job->bytes);
    for (;;) {
        if (m->unpublished && m->instant <= t1) {
            publish(f);
            m->unpublished = false;
        }
        if (m->instant >= t1)
            return 0;
        read_wires(f);
        m->instant += m->period;
        m->unpublished = true;
    }
}
