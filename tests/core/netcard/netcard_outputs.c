/* Programmable outputs against a model that counts each output's microseconds down. */
#include "check.h"

#include <string.h>

#include "card_outputs.h"

static struct card_outputs c;

struct pin {
    int level, asked, left;
    struct mc_po po;
};

static void against_model(void)
{
    uint64_t seed = 21;
    long long pulses = 0, restarts = 0, merges = 0, together = 0;
    for (int run = 0; run < 200 && !check_failures; run += CHECK_EACH) {
        struct pin pin[CARD_OUTPUTS];
        const int often = (int)check_random(&seed, 0, 40);
        long long stores = 0, merged = 0;
        memset(pin, 0, sizeof pin);
        card_outputs_start(&c);
        for (int us = 1; us < 2000; us++) {
            int64_t next = INT64_MAX;
            for (int i = 0; i < CARD_OUTPUTS; i++) {
                if (pin[i].left > 0) {
                    next = us - 1 + pin[i].left < next ? us - 1 + pin[i].left : next;
                    pin[i].level = --pin[i].left ? pin[i].level : !pin[i].level;
                }
            }
            CHECK_EQ(card_outputs_next(&c), next == INT64_MAX ? next : 1000 * next);
            if (next == us) {
                card_outputs_advance(&c, 1000 * us);
            }
            while (check_random(&seed, 0, often) == 0) {
                const struct mc_po po = { (uint8_t)check_random(&seed, 0, 15),
                                          (uint8_t)check_random(&seed, 0, 1),
                                          (uint8_t)check_random(&seed, 0, 1),
                                          (uint32_t)check_random(&seed, 1, 50) };
                const uint32_t pins =
                    1u << po.pin
                    | (check_random(&seed, 0, 2) ? 0 : (uint32_t)check_random(&seed, 0, 0xFFFF));
                CHECK(card_outputs_flag_pins(&c, pins, &po));
                for (int i = 0; i < CARD_OUTPUTS; i++) {
                    if (pins >> i & 1) {
                        merged += pin[i].asked;
                        pin[i].asked = 1;
                        pin[i].po = po;
                    }
                }
                if (often == 0) {
                    break;
                }
            }
            if (check_random(&seed, 0, 10) == 0) {
                uint32_t asked = 0;
                for (int i = 0; i < CARD_OUTPUTS; i++) {
                    struct pin *p = &pin[i];
                    if (p->asked) {
                        asked |= 1u << i;
                        restarts += p->left > 0 && p->po.mode == MC_PO_PULSE;
                        pulses += p->po.mode == MC_PO_PULSE;
                        p->level = p->po.active;
                        p->left = p->po.mode == MC_PO_PULSE ? (int)p->po.width_us : 0;
                        p->asked = 0;
                    }
                }
                stores += asked != 0;
                together += (asked & (asked - 1)) != 0;
                CHECK_EQ(card_outputs_serve(&c, 1000 * us), asked);
            }
            uint32_t levels = 0;
            for (int i = 0; i < CARD_OUTPUTS; i++) {
                levels |= (uint32_t)pin[i].level << i;
            }
            CHECK_EQ(c.levels, levels);
            CHECK(c.stores == stores && c.merged == merged);
        }
        merges += merged;
    }
    printf("outputs: %lld pulses, %lld begun anew, %lld merged, %lld stores of several pins\n",
           pulses, restarts, merges, together);
    CHECK(CHECK_EACH > 1 || (restarts > 1000 && merges > 1000 && together > 1000));
}

static void refused(void)
{
    const struct mc_po bad[] = { { 16, 0, 1, 0 },
                                 { 0, 2, 1, 1 },
                                 { 0, 0, 2, 0 },
                                 { 0, 1, 1, 0 },
                                 { 0, 1, 1, 1000001 } },
                       good = { 3, 1, 1, 1000000 };
    card_outputs_start(&c);
    const struct card_outputs before = c;
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++) {
        CHECK(!card_outputs_flag(&c, &bad[i]));
        CHECK(i == 0 || !card_outputs_flag_pins(&c, 1, &bad[i]));
    }
    CHECK(!card_outputs_flag_pins(&c, 0x10000, &good));
    CHECK(!memcmp(&c, &before, sizeof c));
    CHECK(card_outputs_flag(&c, &good));
    CHECK_EQ(c.levels, 0); /* nothing switches before the software interrupt */
    CHECK_EQ(card_outputs_serve(&c, 5), 8);
    CHECK_EQ(card_outputs_next(&c), 1000000005);
}

int main(void)
{
    against_model();
    refused();
    return check_result();
}
