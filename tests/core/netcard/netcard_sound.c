/* Damaged states: what its own check takes can be worked with. */
#include "check.h"

#include <stddef.h>
#include <string.h>

#include "card_inputs.h"
#include "card_outputs.h"
#include "home_cycle.h"
#include "player.h"

static uint64_t seed = 41;
static long long taken, refused;

/* Some bytes of a state, but for those from `skip` to `on`. */
static void damage(void *state, size_t size, size_t skip, size_t on)
{
    unsigned char *bytes = state;
    for (int n = (int)check_random(&seed, 1, 3); n > 0; n--) {
        const size_t at = (size_t)check_random(&seed, 0, (int64_t)(size - (on - skip)) - 1);
        const unsigned char extreme[] = { 0, 1, 0x7F, 0x80, 0xFF };
        bytes[at < skip ? at : at + on - skip] =
            check_random(&seed, 0, 1) ? extreme[check_random(&seed, 0, 4)]
                                      : (unsigned char)check_random(&seed, 0, 255);
    }
}

static bool truth(const bool *b, int n)
{
    bool ok = true;
    for (int i = 0; i < n; i++) {
        unsigned char byte;
        memcpy(&byte, &b[i], 1);
        ok = ok && byte <= 1;
    }
    return ok;
}

static void players(void)
{
    static struct player p, q;
    const struct player_config c = { 20, 1, 30, 20 };
    const struct player_job job = { .period = 400, .reserve = 0.1, .speed = { 1e6 },
                                    .acc = { 1e9, 1e9, 1e9 }, .jerk = { 1e13, 0.0, 1e13 } };
    for (int run = 0; run < 1000; run++) {
        player_start(&p, &c);
        player_begin(&p, &job, 0);
        for (int n = 0; n < 15; n++) {
            const struct frame f = { { (int16_t)check_random(&seed, -150, 150), 7, -9, 0 }, 1 };
            player_push(&p, &f);
        }
        player_set_target(&p, 1);
        player_advance(&p, check_random(&seed, 0, 5000));
        for (int n = (int)check_random(&seed, 0, 2); n > 0; n--) {
            player_set_target(&p, n % 2);
            player_advance(&p, p.clock + check_random(&seed, 0, 3000));
        }
        for (int n = 0; n < 20; n++) {
            q = p;
            damage(&q, sizeof q, offsetof(struct player, fifo.frame) + 20 * sizeof(struct frame),
                   offsetof(struct player, frame));
            if (!truth(&q.fifo.high, 1) || !truth(&q.fresh, 1) || !truth(&q.begun, 1) ||
                !truth(&q.playing, 1) || !truth(&q.whole, 1) || !truth(q.backward, 4) ||
                !truth(&q.ramping, 1) || !truth(&q.braking, 1)) {
                continue;
            }
            if (!player_sound(&q)) {
                refused++;
                continue;
            }
            taken++;
            int64_t counts[FRAME_AXES];
            for (int step = 0; step < 60 && player_next(&q) < INT64_MAX; step++) {
                for (int i = 0; i < FRAME_AXES; i++) {
                    player_lines(&q, i, q.clock);
                    player_edge(&q, i, q.clock);
                    player_velocity(&q, i);
                }
                player_counts(&q, q.clock, counts);
                player_advance(&q, player_next(&q));
                if (step % 20 == 10) {
                    player_set_target(&q, !q.target);
                }
            }
            player_clear(&q);
        }
    }
}

static void inputs(void)
{
    static struct card_inputs c, d;
    struct card_inputs_config k;
    for (int run = 0; run < 2000; run++) {
        for (int i = 0; i < CARD_INPUTS; i++) {
            k.line[i] = (struct card_input){ (enum card_action)check_random(&seed, 0, 5),
                                             CARD_EDGE_BOTH, check_random(&seed, 0, 50) };
        }
        card_inputs_start(&c, &k, 0);
        card_inputs_set(&c, 0x5A5A, 10);
        card_inputs_serve(&c, (int)check_random(&seed, 0, 6), 12);
        d = c;
        damage(&d, sizeof d, 0, 0);
        if (!card_inputs_sound(&d)) {
            refused++;
            continue;
        }
        taken++;
        for (int n = 0; n < 100; n++) {
            card_inputs_set(&d, (uint32_t)check_random(&seed, 0, 0xFFFF), 20 + n);
            card_inputs_serve(&d, (int)check_random(&seed, 0, 6), 20 + n);
        }
        CHECK(card_inputs_sound(&d));
    }
}

static void outputs(void)
{
    static struct card_outputs c, d;
    for (int run = 0; run < 2000; run++) {
        const struct mc_po po = { 0, MC_PO_PULSE, 1, (uint32_t)check_random(&seed, 1, 100) };
        card_outputs_start(&c);
        card_outputs_flag_pins(&c, 0xF0F0, &po);
        card_outputs_serve(&c, 5);
        card_outputs_flag_pins(&c, 0x0FF0, &po);
        d = c;
        damage(&d, sizeof d, 0, 0);
        if (!truth(d.flag, CARD_OUTPUTS)) {
            continue;
        }
        if (!card_outputs_sound(&d)) {
            refused++;
            continue;
        }
        taken++;
        card_outputs_serve(&d, 1000);
        card_outputs_advance(&d, 1000000);
        CHECK(card_outputs_sound(&d));
    }
}

static void homes(void)
{
    static struct home_cycle h, g;
    struct home_cycle_config c = { .period = 1e-3, .settle = 2 };
    struct home_cycle_input in = { .plus = 0 };
    for (int i = 0; i < CARD_AXES; i++) {
        c.axis[i] = (struct home_axis){ .order = 1 + i / 2, .fast = 2e4, .slow = 1e3, .acc = 1e6,
                                        .back = 50, .travel = 3000 };
    }
    for (int run = 0; run < 4000; run++) {
        home_cycle_begin(&h, &c, 15, &in);
        for (int n = (int)check_random(&seed, 0, 100); n > 0; n--) {
            in.origin = (uint32_t)check_random(&seed, 0, 15);
            home_cycle_step(&h, &in);
        }
        g = h;
        damage(&g, sizeof g, 0, 0);
        bool ok = true;
        for (int i = 0; i < CARD_AXES; i++) {
            ok = ok && truth(&g.config.axis[i].plus, 1) && truth(&g.axis[i].stopping, 1) &&
                 truth(&g.axis[i].turned, 1) && truth(&g.axis[i].passed, 1) &&
                 truth(&g.axis[i].off, 1);
        }
        if (!ok) {
            continue;
        }
        if (!home_cycle_sound(&g)) {
            refused++;
            continue;
        }
        taken++;
        for (int n = 0; n < 60; n++) {
            in.origin = (uint32_t)check_random(&seed, 0, 15);
            in.latched = (uint32_t)check_random(&seed, 0, 15);
            home_cycle_step(&g, &in);
            if (n == 40) {
                home_cycle_stop(&g);
            }
            CHECK(home_cycle_sound(&g));
        }
    }
}

int main(void)
{
    players();
    inputs();
    outputs();
    homes();
    printf("damaged states: %lld taken, %lld refused\n", taken, refused);
    CHECK(taken > 8000 && refused > 5000);
    return check_result();
}
