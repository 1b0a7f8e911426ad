#include "pcl.h"

#include <string.h>

void pcl_start(struct pcl *p, const struct machine *m, int32_t min_stock, int32_t batch,
               const struct isr_config *isr)
{
    memset(p, 0, sizeof *p);
    p->min_stock = min_stock;
    p->batch = batch;
    p->prime = min_stock + batch;
    p->raised = -1;
    for (int i = AXES - 1; i >= 0; i--) {
        if (m->axis[i].used) {
            p->axis = i;
        }
    }
    p->mask = 1 << p->axis;
    isr_start(&p->isr, isr);
}

int32_t pcl_mask(const struct pcl *p, int page)
{
    return p->isr.config.mask[page] | (page == ISR_FIFO_PAGE ? p->mask : 0);
}

bool pcl_interrupt(const struct pcl *p, const struct pcl_card *card)
{
    return card->irq_seq > p->irq_seq;
}

/* The card has taken the transaction but for the frames it refused. */
static void acknowledged(struct pcl *p, struct mcc *m, int64_t refused)
{
    const int32_t taken = refused < 0 ? p->count
                        : refused > p->count ? 0 : (int32_t)(p->count - refused);
    const int32_t points = taken < p->points ? taken : p->points;

    if (points > 0) {
        m->written = *queue_peek(&m->queue, points - 1);
        queue_drop(&m->queue, points);
    }
    if (taken > points) {
        m->written.feed = 0.0;
        p->starved += p->late ? taken - points : 0;
    }
    p->prime = p->prime > taken ? p->prime - taken : 0;
    p->refusals = taken > 0 ? 0 : p->refusals + 1;
    p->open = false;
}

void pcl_look(struct pcl *p, struct mcc *m, const struct pcl_card *card, int64_t now,
              int64_t latency)
{
    if (p->open && card->cmd_ack == p->seq) {
        acknowledged(p, m, (int64_t)card->frames_refused - p->refused);
        p->refused = card->frames_refused;
    }
    if (pcl_interrupt(p, card)) {
        const bool fifo = (card->irq_flags[ISR_FIFO_PAGE] & p->mask) != 0;
        isr_read(&p->isr, card->irq_flags, p->mask, card->irq_clock, card->irq_clock + latency);
        if (fifo && p->pending == 0) {
            p->due = INT64_MAX;
            p->raised = card->irq_clock;
        }
        p->pending += fifo;
        p->irq_seq = card->irq_seq;
        for (int i = 0; i < ISR_PAGES; i++) {
            p->ack_flags[i] = card->irq_flags[i] & pcl_mask(p, i);
        }
        p->ack_seq++;
    } else if (!p->open && p->seq > 0 && p->prime == 0 && p->pending == 0 &&
               card->stock <= p->min_stock) {
        p->pending = 1;
        p->due = now;
        p->raised = -1;
    }
}

void pcl_halt(struct pcl *p, bool halted)
{
    p->halted = halted;
    if (halted) {
        p->prime = p->min_stock + p->batch;
        p->points = p->refusals = 0;
        p->late = false;
        p->pending = 0;
        p->raised = -1;
    }
}

int64_t pcl_due(const struct pcl *p)
{
    if (p->open || p->halted) {
        return INT64_MAX;
    }
    return p->prime > 0 ? 0 : p->pending > 0 ? p->due : INT64_MAX;
}

void pcl_turn(struct pcl *p, int64_t clock)
{
    p->due = p->due < clock ? p->due : clock;
}

void pcl_take(struct pcl *p, const struct mcc *m)
{
    const int32_t want = p->prime > 0 ? p->prime : p->batch;

    p->count = want < PCL_FRAMES ? want : PCL_FRAMES;
    p->points = m->queue.count < p->count ? m->queue.count : p->count;
    p->late = p->points < p->count && task_moving(m);
    memset(p->frames, 0, sizeof p->frames);
    for (int i = 0; i < p->points; i++) {
        for (int k = 0; k < AXES; k++) {
            const int32_t pulses = queue_peek(&m->queue, i)->frame[k];
            p->frames[i][k] = m->machine.axis[k].inverted ? -pulses : pulses;
        }
    }
}

void pcl_write(struct pcl *p, int64_t clock)
{
    p->clock = clock;
    p->open = true;
    p->seq++;
    if (p->prime == 0) {
        p->pending--;
        p->services++;
        if (p->raised >= 0) {
            p->latency = clock - p->raised;
        }
        p->raised = -1;
    }
}
