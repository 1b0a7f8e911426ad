#include "group_parts.h"

#include <stddef.h>
#include <string.h>

void groups_init(struct groups *s, const struct group_config *config,
                 const struct machine card[GROUP_CARDS])
{
    memset(s, 0, offsetof(struct groups, group));
    memset(s->card, 0, sizeof s->card);
    for (int i = 0; i < GROUP_MAX; i++) {
        memset(&s->group[i], 0, offsetof(struct group, mcc));
    }
    s->config = *config;
    for (int k = 0; k < GROUP_CARDS; k++) {
        s->card[k].machine = card[k];
        s->card[k].random = (uint64_t)((int64_t)config->seed + k);
        for (int i = 0; i < AXES; i++) {
            s->card[k].machine.axis[i].used = false;
        }
    }
}

/* True if a group may have these channels: each exists, is free and is named once, and there is at
 * least one. */
static bool channels_free(const struct groups *s, int card, const int32_t channel[AXES])
{
    bool taken[AXES] = { false };
    bool any = false;

    for (int i = 0; i < AXES; i++) {
        const int32_t c = channel[i];
        if (c == -1) {
            continue;
        }
        if (c < 0 || c >= AXES || taken[c] || s->card[card].machine.axis[c].used) {
            return false;
        }
        taken[c] = any = true;
    }
    return any;
}

static bool valid(const struct groups *s, int group)
{
    return group >= 0 && group < GROUP_MAX && s->group[group].used;
}

/* Mark the channels of a group as used, or as free again. */
static void use(struct groups *s, const struct group *g, bool used)
{
    struct group_card *c = &s->card[g->card];

    for (int i = 0; i < AXES; i++) {
        if (g->channel[i] >= 0 && g->voltage) {
            c->dac[g->channel[i]].axis.used = used;
            c->volts[g->channel[i]] = 0.0;
        } else if (g->channel[i] >= 0) {
            c->machine.axis[g->channel[i]].used = used;
        }
    }
}

/* The machine of a group: settings of its motion, axes of its channels, DDA time of its card. An
 * axis that it does not have gets the valid settings of another. */
static struct machine machine_of(const struct groups *s, int card, const int32_t channel[AXES],
                                 bool voltage, const struct machine *motion)
{
    const struct group_card *c = &s->card[card];
    struct machine m = *motion;
    int32_t any = 0;

    m.dda_time = c->machine.dda_time;
    m.dda_length = c->machine.dda_length;
    for (int i = 0; i < AXES; i++) {
        any = voltage && channel[i] >= 0 ? channel[i] : any;
    }
    for (int i = 0; i < AXES; i++) {
        const int32_t k = channel[i] < 0 ? any : channel[i];
        m.axis[i] = voltage ? c->dac[k].axis : c->machine.axis[k];
        m.axis[i].used = channel[i] >= 0;
    }
    return m;
}

/* Create a group on channels that it may have. Returns its index, or a code. */
static int create(struct groups *s, int card, const int32_t channel[AXES], bool voltage,
                  const struct machine *motion)
{
    int n = 0;

    while (n < GROUP_MAX && s->group[n].used) {
        n++;
    }
    if (n == GROUP_MAX) {
        return MCC_GROUP_RAN_OUT;
    }
    const struct machine m = machine_of(s, card, channel, voltage, motion);
    struct group *g = &s->group[n];
    const int code = MCC_init_motion(&g->mcc, &m);
    if (code != MCC_NO_ERR) {
        return code;
    }
    inquiry_set_place(&g->mcc, voltage ? INQUIRY_ENCODERS : INQUIRY_PULSES);
    g->used = true;
    g->voltage = voltage;
    g->card = card;
    memcpy(g->channel, channel, sizeof g->channel);
    use(s, g, true);
    return n;
}

int group_create(struct groups *s, int card, const int32_t channel[AXES],
                 const struct machine *motion)
{
    if (s->running) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    if (card < 0 || card >= GROUP_CARDS || !channels_free(s, card, channel)) {
        return MCC_GROUP_PARAMETER;
    }
    const int code = group_dac_check_pulse(s, card, channel);
    return code ? code : create(s, card, channel, false, motion);
}

int group_create_voltage(struct groups *s, int card, const int32_t dac[AXES],
                         const struct machine *motion)
{
    if (s->running) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    if (card < 0 || card >= GROUP_CARDS) {
        return MCC_GROUP_PARAMETER;
    }
    const int code = group_dac_check(s, card, dac);
    return code ? code : create(s, card, dac, true, motion);
}

int group_close(struct groups *s, int group)
{
    if (s->running) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    if (!valid(s, group)) {
        return MCC_GROUP_PARAMETER;
    }
    use(s, &s->group[group], false);
    memset(&s->group[group], 0, sizeof s->group[group]);
    return MCC_NO_ERR;
}

int group_program(struct groups *s, int group, int64_t start)
{
    if (s->running) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    if (!valid(s, group)) {
        return MCC_GROUP_PARAMETER;
    }
    s->group[group].program = true;
    s->group[group].start = start;
    return MCC_NO_ERR;
}

bool groups_card_used(const struct groups *s, int card)
{
    for (int i = 0; i < AXES; i++) {
        if (s->card[card].machine.axis[i].used) {
            return true;
        }
    }
    return false;
}

int groups_start(struct groups *s)
{
    const struct isr_config fifo_only = { .service = 0 };
    bool any = false;

    if (s->running) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    for (int n = 0; n < GROUP_MAX; n++) {
        struct group *g = &s->group[n];
        any = any || g->used;
        if (g->used && g->voltage) {
            group_dac_start(s, g);
        }
    }
    for (int k = 0; k < GROUP_CARDS; k++) {
        struct group_card *c = &s->card[k];
        pcl_start(&c->pcl, &c->machine, s->config.min_stock, s->config.batch, &fifo_only);
    }
    s->running = any;
    return any ? MCC_NO_ERR : MCC_GROUP_PARAMETER;
}

/* --- What each group does. ------------------------------------------------------------------- */

static void cycle(struct group *g, int64_t clock, const struct group_panel *panel,
                  const struct source *program)
{
    if (g->program && !g->started && clock >= g->start) {
        task_start(&g->mcc);
        g->started = true;
    }
    if (key_take(&g->abort)) {
        g->started = true; /* a program that waits for its start is dropped too */
        MCC_motion_abort(&g->mcc);
    }
    if (key_take(&g->cycle_start)) {
        task_continue(&g->mcc); /* refused where nothing waits for it */
    }
    task_operate(&g->mcc, panel->hold, panel->override, panel->override);
    task_run(&g->mcc, g->program ? program : NULL);
}

/* Set the signals that the program of a group asks for: inputs, probe, and where pulse channels
 * are. */
static void show(const struct groups *s, struct group *g, const struct group_panel *panel)
{
    const struct group_card *c = &s->card[g->card];
    struct signals *signals = &g->mcc.signals;

    signals->probe = panel->probe;
    signals->digital = panel->digital;
    memcpy(signals->analog, panel->analog, sizeof signals->analog);
    for (int i = 0; i < AXES && !g->voltage; i++) {
        if (g->channel[i] >= 0) {
            signals->pulses[i] = c->pulses[g->channel[i]];
            signals->enc[i] = c->counts[g->channel[i]];
        }
    }
    if (!g->voltage) {
        inquiry_look(&g->mcc, s->config.bus); /* a voltage group's servo looks by itself */
    }
}

/* --- What each card is given. ---------------------------------------------------------------- */

/* True if the frames of a group go to the FIFO of this card. */
static bool on_fifo(const struct group *g, int card)
{
    return g->used && !g->voltage && g->card == card;
}

static void look(struct groups *s, int card, const struct pcl_card *shows, int64_t now)
{
    struct group_card *c = &s->card[card];
    const int32_t taken = pcl_acknowledged(&c->pcl, shows);

    for (int n = 0; n < GROUP_MAX && taken >= 0; n++) {
        struct group *g = &s->group[n];
        if (on_fifo(g, card)) {
            g->starved += pcl_release(&g->mcc, &g->part, taken);
        }
    }
    const bool interrupt = pcl_interrupt(&c->pcl, shows);
    pcl_notice(&c->pcl, shows, now,
               interrupt ? pcl_latency(&c->random, s->config.latency, s->config.jitter) : 0);
}

/* Clock at which a card is to be served; INT64_MAX: never. */
static int64_t due(const struct groups *s, int card)
{
    const struct pcl *p = &s->card[card].pcl;
    const int64_t page = isr_ready(&p->isr), write = pcl_due(p);

    return !groups_card_used(s, card) ? INT64_MAX : page < write ? page : write;
}

static void serve(struct groups *s, int card, int64_t clock, int64_t publish)
{
    struct pcl *p = &s->card[card].pcl;

    if (isr_ready(&p->isr) <= clock) {
        isr_begin(&p->isr, ISR_FIFO_PAGE, clock);
        pcl_turn(p, clock);
    }
    if (pcl_due(p) > clock) {
        return; /* the transaction before has not been acknowledged */
    }
    pcl_prepare(p);
    for (int n = 0; n < GROUP_MAX; n++) {
        struct group *g = &s->group[n];
        if (on_fifo(g, card)) {
            pcl_merge(p, &g->mcc, g->channel, &g->part);
        }
    }
    pcl_write(p, clock < publish ? publish : clock);
}

void groups_instant(struct groups *s, int64_t now, const struct pcl_card card[GROUP_CARDS],
                    const struct group_panel panel[GROUP_MAX],
                    const struct source program[GROUP_MAX])
{
    const int64_t publish = now + s->config.bus, horizon = publish + s->config.bus;

    for (int k = 0; k < GROUP_CARDS; k++) {
        look(s, k, &card[k], now);
    }
    for (int n = 0; n < GROUP_MAX; n++) {
        key_look(&s->group[n].abort, panel[n].abort);
        key_look(&s->group[n].cycle_start, panel[n].cycle_start);
        if (s->group[n].used) {
            show(s, &s->group[n], &panel[n]);
        }
        if (s->group[n].used && s->group[n].voltage) {
            group_dac_instant(s, &s->group[n], now);
        }
    }
    for (;;) {
        const int first = due(s, 1) < due(s, 0);
        const int64_t at = due(s, first);
        if (s->next_ipo < horizon && s->next_ipo <= at) {
            for (int n = 0; n < GROUP_MAX; n++) {
                if (s->group[n].used) {
                    cycle(&s->group[n], s->next_ipo, &panel[n], &program[n]);
                }
            }
            s->next_ipo += s->config.ipo;
        } else if (at < horizon) {
            serve(s, first, at < publish ? publish : at, publish);
        } else {
            return;
        }
    }
}
_Static_assert(GROUP_CARDS == 2, "the first of the cards to be served");

bool group_done(const struct groups *s, int group)
{
    const struct group *g = &s->group[group];
    return (g->started || !g->program) && !g->mcc.error && MCC_check_stop(&g->mcc);
}
