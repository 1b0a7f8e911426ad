#include "pcl.h"

#include <math.h>
#include <string.h>

#include "latency.h"

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

bool pcl_interrupt(const struct pcl *p, const struct pcl_card *card)
{
    return card->irq_seq > p->irq_seq;
}

int64_t pcl_latency(uint64_t *random, double least, double width)
{
    return (int64_t)llround(least + width * latency_uniform(random));
}

int32_t pcl_acknowledged(struct pcl *p, const struct pcl_card *card)
{
    if (!p->open || card->cmd_ack != p->seq) {
        return -1;
    }
    /* The card has taken all frames but those that it refused. */
    const int64_t refused = (int64_t)card->frames_refused - p->refused;
    const int32_t taken = refused < 0          ? p->count
                          : refused > p->count ? 0
                                               : (int32_t)(p->count - refused);
    p->prime = p->prime > taken ? p->prime - taken : 0;
    p->refusals = taken > 0 ? 0 : p->refusals + 1;
    p->refused = card->frames_refused;
    p->open = false;
    return taken;
}

int32_t pcl_release(struct mcc *m, const struct pcl_part *part, int32_t taken)
{
    const int32_t due = taken < part->points ? taken : part->points;
    const int32_t points = due < m->queue.count ? due : m->queue.count;

    if (points > 0) {
        m->written = *queue_peek(&m->queue, points - 1);
        queue_drop(&m->queue, points);
    }
    if (taken <= points) {
        return 0;
    }
    m->written.feed = 0.0;
    return part->late ? taken - points : 0;
}

void pcl_notice(struct pcl *p, const struct pcl_card *card, int64_t now, int64_t latency)
{
    if (pcl_interrupt(p, card)) {
        const bool fifo = (card->irq_flags[ISR_FIFO_PAGE] & p->mask) != 0;
        isr_read(&p->isr, card->irq_flags, p->mask, p->pending > 0, card->irq_clock,
                 card->irq_clock + latency);
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
    } else if (!p->open && p->seq > 0 && p->prime == 0 && p->pending == 0
               && card->stock <= p->min_stock) {
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
        p->part = (struct pcl_part){ 0 };
        p->refusals = 0;
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

void pcl_prepare(struct pcl *p)
{
    const int32_t want = p->prime > 0 ? p->prime : p->batch;

    p->count = want < PCL_FRAMES ? want : PCL_FRAMES;
    memset(p->frames, 0, sizeof p->frames);
}

void pcl_merge(struct pcl *p, const struct mcc *m, const int32_t channel[AXES],
               struct pcl_part *part)
{
    part->points = m->queue.count < p->count ? m->queue.count : p->count;
    part->late = part->points < p->count && task_moving(m);
    for (int i = 0; i < part->points; i++) {
        const struct point *point = queue_peek(&m->queue, i);
        for (int k = 0; k < AXES; k++) {
            if (channel[k] >= 0) {
                p->frames[i][channel[k]] =
                    m->machine.axis[k].inverted ? -point->frame[k] : point->frame[k];
            }
        }
    }
}

void pcl_take(struct pcl *p, const struct mcc *m)
{
    static const int32_t own[AXES] = { 0, 1, 2, 3, 4, 5 };

    pcl_prepare(p);
    pcl_merge(p, m, own, &p->part);
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
