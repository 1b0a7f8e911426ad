/* FMU of the network between a card and its host (core ethernet): it reads both ends at the
 * instants of a grid and shows the outcome at the next instant. */
#include <string.h>

#include "ethernet.h"
#include "vars.h"

struct model {
    struct ethernet link;
    int64_t period;   /* [ns] grid of the inputs */
    int64_t instant;  /* [ns] next instant of the grid */
    bool unpublished; /* the outputs of the latest instant are not shown yet */
    bool wanted;      /* both ends wanted a connection at the latest instant */
    uint32_t warned;  /* number of faults that were warned of */
};

#include "fmi_model.h"
#include "fmu_period.h"

static const double second = 1e9; /* [ns] */

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const double ticks = v->bus_period * second / FMU_TICK_NS;
    struct ethernet_config c = {
        .pipe = {
            .rate = llround(v->rate), .delay = llround(v->delay * second),
            .jitter = llround(v->jitter * second), .stall = llround(v->stall * second),
            .loss = llround(v->loss * 1e6), .segment = v->segment, .overhead = v->overhead,
        },
        .seed = (uint32_t)v->seed,
        .connect = llround(v->connect_time * second),
        .away = llround(v->away * second),
    };
    if (!fmu_is_period(ticks))
        return fmu_fail(f, "bus_period = %.17g s: not a whole number of 20 ns ticks",
                        v->bus_period);
    m->period = llround(ticks) * FMU_TICK_NS;
    for (int k = 0; k < ETHERNET_CUTS; k++) {
        c.cut_at[k] = llround(v->cut_at[k] * second);
        c.cut_behind[ETHERNET_CARD][k] = v->cut_behind_card[k];
        c.cut_behind[ETHERNET_HOST][k] = v->cut_behind_host[k];
    }
    ethernet_start(&m->link, &c);
    return 0;
}

#define END(at, end) \
    struct ethernet_seen *end = &seen[at]; \
    memcpy(end->tx_words, v->end##_tx_words, sizeof end->tx_words); \
    end->tx_count = v->end##_tx_count; \
    end->rx_taken = v->end##_rx_taken;

static void read_wires(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    struct ethernet_seen seen[ETHERNET_ENDS];
    END(ETHERNET_CARD, card)
    END(ETHERNET_HOST, host)
    card->wants = v->card_connect;
    host->wants = v->host_accept;
    m->wanted = card->wants && host->wants;
    ethernet_instant(&m->link, m->instant, m->instant + m->period, seen);
    if (m->link.faults != m->warned)
        fmu_warn(f,
                 "counts that cannot be: card_tx_count = %d, card_rx_taken = %d, "
                 "host_tx_count = %d, host_rx_taken = %d; the connection is closed",
                 (int)v->card_tx_count, (int)v->card_rx_taken, (int)v->host_tx_count,
                 (int)v->host_rx_taken);
    m->warned = m->link.faults;
}

#define SHOW(at, end) \
    memcpy(v->end##_rx_words, l->shown[at].rx_words, sizeof v->end##_rx_words); \
    v->end##_rx_count = l->shown[at].rx_count; \
    v->end##_tx_taken = l->shown[at].tx_taken; \
    v->end##_bytes = (double)l->pipe[at].passed; \
    v->on_the_way[at] = l->pipe[at].held; \
    v->stalls[at] = (int32_t)(l->pipe[at].stalls & INT32_MAX);

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    const struct model *m = &f->s.m;
    const struct ethernet *l = &m->link;
    SHOW(ETHERNET_CARD, card)
    SHOW(ETHERNET_HOST, host)
    v->connection = l->connection;
    v->wanted = m->wanted;
    v->cuts = (int32_t)(l->cuts & INT32_MAX);
    v->faults = (int32_t)(l->faults & INT32_MAX);
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    (void)t0;
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
