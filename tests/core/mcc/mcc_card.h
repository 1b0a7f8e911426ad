/* mcc_card - a simple card for the tests of the motion library's PC: one FIFO of frames, advanced
 * from one DDA boundary to the next, and the exchange of both over the bus. */
#ifndef MCC_CARD_H
#define MCC_CARD_H

#include "mcc_check.h"
#include "pc.h"

struct card {
    const struct pcl *pcl; /* position control that serves it */
    int64_t dda;           /* [clocks] DDA time */
    int64_t now;           /* [clock] events up to it are done */
    int32_t n;             /* minimum stock */
    int32_t room;          /* number of commands that the FIFO holds */
    int32_t fifo[PCL_FIFO][AXES];
    int32_t stock;
    int32_t sum[AXES]; /* [pulses] put out so far */
    bool flag;         /* the FIFO's interrupt flag, which is also the line */
    struct pcl_card shows;
    int32_t last_ack_seq;
    bool moved; /* the latest DDA time had pulses */
    int32_t underflows, irqs, peak;
    int64_t irq_first, irq_last;
    bool coming; /* a transaction on its way */
    int64_t arrives;
};

static struct pc pc; /* 300 kB: not on the stack */

/* An empty card. */
static void card_begin(struct card *c, const struct pcl *pcl, int64_t dda, int32_t n)
{
    memset(c, 0, sizeof *c);
    c->pcl = pcl;
    c->dda = dda;
    c->n = n;
    c->room = PCL_FIFO;
}

/* Start PC and card at clock 0. */
static void card_start(struct card *c, const struct machine *m, const struct pc_config *config,
                       bool program)
{
    card_begin(c, &pc.pcl, machine_dda_clocks(m), config->min_stock);
    CHECK_EQ(pc_start(&pc, m, config, program), MCC_NO_ERR);
}

static void card_boundary(struct card *c)
{
    if (c->stock == 0) {
        c->underflows += c->moved;
        c->moved = false;
        return;
    }
    c->moved = false;
    for (int i = 0; i < AXES; i++) {
        c->sum[i] += c->fifo[0][i];
        c->moved = c->moved || c->fifo[0][i] != 0;
    }
    memmove(c->fifo[0], c->fifo[1], sizeof c->fifo - sizeof c->fifo[0]);
    c->stock--;
    if (c->stock == c->n) {
        if (!c->flag) {
            c->shows.irq_seq++;
            c->shows.irq_clock = c->now;
            c->irq_last = c->now;
            c->irq_first = c->irqs++ ? c->irq_first : c->now;
        }
        c->flag = true;
        c->shows.irq_flags[0] = 63; /* the stocks of all channels fall together */
    }
}

static void card_take(struct card *c)
{
    const struct pcl *p = c->pcl;
    for (int i = 0; i < p->count; i++) {
        if (c->stock == c->room) {
            c->shows.frames_refused += p->count - i;
            break;
        }
        memcpy(c->fifo[c->stock++], p->frames[i], sizeof c->fifo[0]);
    }
    c->peak = c->stock > c->peak ? c->stock : c->peak;
    c->shows.cmd_ack = p->seq;
    c->coming = false;
}

/* Advance to a clock: DDA boundaries and the transaction in their order (at one clock: transaction
 * first). */
static void card_advance(struct card *c, int64_t to)
{
    while (c->now < to) {
        const int64_t next = (c->now / c->dda + 1) * c->dda;
        const int64_t write = c->coming ? c->arrives : INT64_MAX;
        c->now = next < write ? next : write;
        if (c->now > to) {
            c->now = to;
            return;
        }
        if (c->now == write) {
            card_take(c);
        }
        if (c->now == next) {
            card_boundary(c);
        }
    }
}

/* At an instant of the bus: the card reads what the PC has published. */
static void card_read(struct card *c)
{
    if (c->pcl->ack_seq != c->last_ack_seq) {
        c->last_ack_seq = c->pcl->ack_seq;
        if (c->pcl->ack_flags[0] & 63) {
            c->flag = false;
            c->shows.irq_flags[0] = 0;
        }
    }
    if (c->pcl->open && c->pcl->seq != c->shows.cmd_ack && !c->coming) {
        c->coming = true;
        c->arrives = c->pcl->clock > c->now ? c->pcl->clock : c->now;
        if (c->arrives == c->now) {
            card_take(c);
        }
    }
}

/* One bus period: the card reads what the PC has published, the PC sees the card's state before. */
static void card_period(struct card *c, int64_t at, const struct pc_panel *panel, const char *text)
{
    c->shows.stock = c->stock;
    const struct pcl_card seen = c->shows;
    card_read(c);
    struct source_text program = { text, text ? (int64_t)strlen(text) : 0 };
    const struct source source = source_of(&program);
    pc_instant(&pc, at, &seen, panel, &source);
    card_advance(c, at + pc.config.bus);
}

#endif
