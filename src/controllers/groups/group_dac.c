#include <math.h>
#include <string.h>

#include "group_parts.h"

/* The card's seventh error counter looks at this encoder counter. */
enum { WATCHED = 6 };

static bool there(int card, int number, int count)
{
    return card >= 0 && card < GROUP_CARDS && number >= 0 && number < count;
}

/* True if a DAC gets the voltage of the card's own position loop, of the pulse channel of its
 * number. */
static bool looped(const struct group_card *c, int channel)
{
    return channel < AXES && c->machine.axis[channel].used
           && c->command_mode[channel] == GROUP_COMMAND_VOLTAGE;
}

/* True if an encoder counter is the feedback of an axis. */
static bool counter_taken(const struct group_card *c, int encoder)
{
    for (int i = 0; i < GROUP_DACS; i++) {
        if (c->dac[i].axis.used && c->dac[i].encoder == encoder) {
            return true;
        }
    }
    return looped(c, encoder);
}

int group_dac_check(const struct groups *s, int card, const int32_t dac[AXES])
{
    const struct group_card *c = &s->card[card];
    uint32_t dacs = 0, counters = 0;

    for (int i = 0; i < AXES; i++) {
        const int32_t d = dac[i];
        if (d == -1) {
            continue;
        }
        if (!there(card, d, GROUP_DACS) || c->dac[d].axis.used || (dacs >> d & 1)) {
            return MCC_GROUP_PARAMETER;
        }
        if (looped(c, d)) {
            return MCC_VOLTAGE_COMMAND_CHANNEL;
        }
        if (c->dac[d].position_gain <= 0.0 || (counters >> c->dac[d].encoder & 1)
            || counter_taken(c, c->dac[d].encoder)) {
            return MCC_GROUP_PARAMETER;
        }
        dacs |= 1u << d;
        counters |= 1u << c->dac[d].encoder;
    }
    return dacs ? MCC_NO_ERR : MCC_GROUP_PARAMETER;
}

int group_dac_check_pulse(const struct groups *s, int card, const int32_t channel[AXES])
{
    const struct group_card *c = &s->card[card];

    for (int i = 0; i < AXES; i++) {
        const int32_t k = channel[i];
        if (k < 0 || c->command_mode[k] != GROUP_COMMAND_VOLTAGE) {
            continue;
        }
        if (c->dac[k].axis.used) {
            return MCC_VOLTAGE_COMMAND_CHANNEL;
        }
        if (counter_taken(c, k)) {
            return MCC_GROUP_PARAMETER;
        }
    }
    return MCC_NO_ERR;
}

static bool settings_valid(const struct group_dac *d)
{
    return d->encoder >= 0 && d->encoder < GROUP_COUNTERS && machine_positive(d->position_gain)
           && machine_positive(d->speed_per_volt) && d->feed_forward >= 0.0
           && d->feed_forward <= 1.0 && (d->lag == 0.0 || machine_positive(d->lag));
}

int groups_set_dac(struct groups *s, int card, int dac, const struct group_dac *settings)
{
    if (s->running) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    if (!there(card, dac, GROUP_DACS)) {
        return MCC_GROUP_PARAMETER;
    }
    struct group_dac *d = &s->card[card].dac[dac];
    if (d->axis.used) {
        return MCC_VOLTAGE_COMMAND_CHANNEL;
    }
    if (!settings_valid(settings)) {
        return MCC_PARAMETER;
    }
    *d = *settings;
    d->axis.used = false;
    return MCC_NO_ERR;
}

int groups_set_command_mode(struct groups *s, int card, int channel, int mode)
{
    if (s->running) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    if (!there(card, channel, AXES)) {
        return MCC_GROUP_PARAMETER;
    }
    struct group_card *c = &s->card[card];
    if (mode != GROUP_COMMAND_PULSE && mode != GROUP_COMMAND_VOLTAGE) {
        return MCC_PARAMETER;
    }
    if (mode == GROUP_COMMAND_VOLTAGE && c->machine.axis[channel].used) {
        if (c->dac[channel].axis.used) {
            return MCC_VOLTAGE_COMMAND_CHANNEL;
        }
        if (c->command_mode[channel] != mode && counter_taken(c, channel)) {
            return MCC_GROUP_PARAMETER;
        }
    }
    c->command_mode[channel] = mode;
    return MCC_NO_ERR;
}

int groups_set_dac_output(struct groups *s, int card, int dac, double volts)
{
    if (!there(card, dac, GROUP_DACS)) {
        return MCC_GROUP_PARAMETER;
    }
    struct group_card *c = &s->card[card];
    if (c->dac[dac].axis.used || looped(c, dac)) {
        return MCC_VOLTAGE_COMMAND_CHANNEL;
    }
    if (!(fabs(volts) <= VOLTAGE_RANGE)) {
        return MCC_PARAMETER;
    }
    c->volts[dac] = volts;
    return MCC_NO_ERR;
}

bool groups_watched(const struct groups *s, int card, int32_t *command)
{
    const struct group_card *c = &s->card[card];

    for (int i = 0; i < GROUP_DACS; i++) {
        if (c->dac[i].axis.used && c->dac[i].encoder == WATCHED) {
            *command = c->command[i];
            return true;
        }
    }
    return false;
}

void group_dac_start(struct groups *s, struct group *g)
{
    struct law_config law = { 0 };

    for (int i = 0; i < AXES; i++) {
        if (g->channel[i] >= 0) {
            const struct group_dac *d = &s->card[g->card].dac[g->channel[i]];
            const double volts = 60.0 / (d->axis.ppr * d->speed_per_volt);
            law.axis[i] = (struct law_axis){ .gain = d->position_gain * volts,
                                             .volts = volts,
                                             .feed_forward = d->feed_forward,
                                             .lag = d->lag };
        }
    }
    servo_start(&g->servo, &law, &g->mcc.machine, s->config.bus);
}

void group_dac_instant(struct groups *s, struct group *g, int64_t now)
{
    struct group_card *c = &s->card[g->card];
    int32_t counts[AXES] = { 0 };

    for (int i = 0; i < AXES; i++) {
        if (g->channel[i] >= 0) {
            counts[i] = c->counts[c->dac[g->channel[i]].encoder];
        }
    }
    servo_instant(&g->servo, &g->mcc, now, s->config.bus, counts);
    g->starved = g->servo.starved;
    for (int i = 0; i < AXES; i++) {
        if (g->channel[i] >= 0) {
            const int32_t d = g->channel[i], way = g->mcc.machine.axis[i].inverted ? -1 : 1;
            c->volts[d] = g->servo.volts[i];
            c->command[d] = way * g->servo.next[i];
            c->error[d] = way * g->mcc.signals.err[i];
        }
    }
}
