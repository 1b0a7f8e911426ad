/* binding_netcard - the network card for Python, with a simple machine that counts its pulses. */
#include <stdio.h>
#include <string.h>

#include "binding.h"
#include "netcard.h"

static const int64_t LOOK_NS = 1000000; /* time between two updates of the machine's switches */

/* A card and its machine: the origin switch of an axis is on from `origin` onwards in the direction
 * of homing; no limit switch is ever on and no drive has an alarm. */
struct netcard_sim {
    struct netcard_config config;
    int64_t origin[CARD_AXES]; /* [pulses] */
    struct netcard card;
};

#define OF_SETTING(type, name, elements, unit, start, low, high, words) \
    { #name, \
      unit, \
      KIND((type){ 0 }), \
      OFFSET(netcard_sim, config.settings.name), \
      (int32_t)(sizeof(type elements) / sizeof(type)), \
      sizeof(type), \
      SAME },
#define SEEN(m, name, unit) ONE(netcard_sim, card.m, name, unit)
static const struct field sim_fields[] = {
    CARD_SETTINGS(OF_SETTING) ROW(netcard_sim, config.key, "key", ""),
    ROW(netcard_sim, origin, "origin", "pulses"),
    SEEN(now, "now", "ns"),
    SEEN(homed, "homed", "bits"),
    SEEN(outputs.levels, "outputs", "bits"),
    SEEN(player.frames, "frames", ""),
    SEEN(player.fifo.stock, "stock", ""),
    SEEN(player.dry, "underflows", ""),
    SEEN(least, "stock_least", ""),
    SEEN(result.count, "answered", ""),
    SEEN(jobs, "jobs", ""),
    SEEN(approach, "approach", ""),
    SEEN(played_id, "played", ""),
    SEEN(session.connections, "connections", ""),
    SEEN(session.repeats, "repeats", ""),
    SEEN(session.fault, "fault", ""),
    SEEN(flash.programs, "programs", ""),
    SEEN(session.phase, "phase", ""),
    SEEN(flash.sector_erases, "sector_erases", ""),
    SEEN(flash.block_erases, "block_erases", ""),
};

const struct table NETCARD_TABLES[] = {
    { "netcard_sim", sim_fields, sizeof sim_fields, sizeof(struct netcard_sim) },
    { NULL, NULL, 0, 0 },
};

void binding_netcard_settings(struct netcard_sim *s)
{
    s->config.settings = card_settings_start();
}

/* Power on, with these bytes in the flash (NULL: erased). False, with the reason in `words`, if a
 * setting is out of range. */
bool binding_netcard_start(struct netcard_sim *s, const uint8_t seed[NET_SHA_BYTES],
                           const uint8_t *flash, char *words, size_t size)
{
    struct card_wrong w;

    if (!card_settings_good(&s->config.settings, &w)) {
        snprintf(words, size, "%s[%d] = %.17g: %s", w.name, (int)w.index, w.value,
                 w.why ? w.why : "out of range");
        return false;
    }
    netcard_start(&s->card, &s->config, NULL, 0);
    net_random_start(&s->card.session.random, seed);
    netcard_set_power(&s->card, false);
    if (flash) {
        flash_put(&s->card.flash, 0, flash, FLASH_PAGES);
    }
    netcard_set_power(&s->card, true);
    return true;
}

static struct netcard_axes look(const struct netcard_sim *s)
{
    const struct card_settings *c = &s->config.settings;
    struct netcard_axes a = { 0 };
    int64_t counts[FRAME_AXES];

    player_counts(&s->card.player, s->card.now / PLAYER_CLOCK_NS, counts);
    for (int i = 0; i < CARD_AXES; i++) {
        const bool on = c->home_plus[i] ? counts[i] >= s->origin[i] : counts[i] <= s->origin[i];
        const bool high = on == home_cycle_on_level((enum card_trigger)c->origin_trigger[i]);
        a.origin |= (uint32_t)high << i;
        a.plus |= (uint32_t)!c->limit_high[i] << i;
        a.alarm |= (uint32_t)!c->alarm_high[i] << i;
    }
    a.minus = a.plus;
    return a;
}

/* Let time pass up to `until` [ns]. */
void binding_netcard_run(struct netcard_sim *s, int64_t until)
{
    while (s->card.now < until) {
        const int64_t next = s->card.now - s->card.now % LOOK_NS + LOOK_NS;
        const struct netcard_axes a = look(s);
        netcard_set_axes(&s->card, &a);
        netcard_advance(&s->card, next < until ? next : until);
    }
}

/* Power off and on again. */
void binding_netcard_power(struct netcard_sim *s)
{
    netcard_set_power(&s->card, false);
    netcard_set_power(&s->card, true);
}

struct netcard *binding_netcard_card(struct netcard_sim *s)
{
    return &s->card;
}

int32_t binding_netcard_state(const struct netcard_sim *s)
{
    return s->card.state;
}

/* Copy all bytes of the card's flash. */
void binding_netcard_flash(const struct netcard_sim *s, uint8_t bytes[FLASH_BYTES])
{
    for (int32_t k = 0; k < FLASH_PAGES; k++) {
        flash_look(&s->card.flash, k, bytes + k * FLASH_PAGE);
    }
}

void binding_netcard_pulses(const struct netcard_sim *s, int64_t counts[CARD_AXES])
{
    player_counts(&s->card.player, s->card.now / PLAYER_CLOCK_NS, counts);
}
