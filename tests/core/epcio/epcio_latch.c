/* Encoder latches: which of several triggers within a sample a counter keeps, where it stood. */
#include "epcio_card.h"

#include <math.h>

enum { SPAN = 4000 }; /* [clocks] between two samples */

/* Clock in a sample at which an index line of one line period rises, its phase going from `from` to
 * `to`: on entering the first quarter of a period, going up at its lower end, going down at its
 * upper one; the n-th from 0, or the last but -1 - n. -1: there is none. Looked for clock by
 * clock. */
static int64_t index_at(double from, double to, int n)
{
    int64_t found[64], count = 0;
    bool was = floor(4.0 * from) == 4.0 * floor(from);
    for (int64_t k = 1; k <= SPAN; k++) {
        const double quarter = floor(4.0 * (from + (to - from) * (double)k / SPAN));
        const bool high = fmod(quarter, 4.0) == 0.0;
        if (high && !was)
            found[count++] = k;
        was = high;
    }
    return n < count && -n <= count ? found[n < 0 ? count + n : n] : -1;
}

/* A counter is latched at the first or at the last index of another encoder; the other one's own
 * place and direction do not matter. */
static void first_and_last(double index_to, double counter_to)
{
    for (int last = 0; last < 2; last++) {
        struct epcio_config config = epcio_default_config();
        struct epcio card;
        double phase[EPCIO_ENCODERS] = { 0 };
        int bad;
        config.encoder[1].index_lines = 1;
        CHECK_EQ(epcio_reset(&card, &config), EPCIO_OK);
        phase[0] = 0.125;
        phase[1] = 0.5;
        CHECK_EQ(card_sample(&card, phase, &bad), EPCIO_OK);
        CHECK_EQ(epcio_set_latch(&card, 0, 1u << (LATCH_INDEX + 1), last), EPCIO_OK);
        phase[0] += counter_to;
        phase[1] += index_to;
        epcio_advance(&card, SPAN);
        CHECK_EQ(card_sample(&card, phase, &bad), EPCIO_OK);
        const int64_t at = index_at(0.5, 0.5 + index_to, last ? -1 : 0);
        const struct latch *l = &card.latch[0];
        CHECK_EQ(l->seen, at > 0);
        if (at > 0) {
            CHECK_EQ(l->clock, at);
            CHECK_EQ(l->value, floor(4.0 * (0.125 + counter_to * (double)at / SPAN)));
        }
        CHECK_EQ(l->armed, last || at < 0);
        /* One more index in the next sample: only the one that keeps the last takes it. */
        const int64_t kept = l->clock;
        CHECK_EQ(card_sample(&card, phase, &bad), EPCIO_OK);
        CHECK_EQ(l->clock, kept);
        phase[1] += 1.0;
        epcio_advance(&card, 2 * SPAN);
        CHECK_EQ(card_sample(&card, phase, &bad), EPCIO_OK);
        CHECK_EQ(l->seen, last ? 1 + (at > 0) : 1);
        CHECK_EQ(l->clock > SPAN, last || at < 0);
    }
}

/* Of several sources the earliest is the first and the latest the last, in either order. */
static void several_sources(void)
{
    for (int swap = 0; swap < 2; swap++)
        for (int last = 0; last < 2; last++) {
            struct epcio_config config = epcio_default_config();
            struct epcio card;
            double phase[EPCIO_ENCODERS] = { 0 };
            int bad;
            config.encoder[1].index_lines = config.encoder[2].index_lines = 1;
            CHECK_EQ(epcio_reset(&card, &config), EPCIO_OK);
            phase[1] = phase[2] = 0.5;
            CHECK_EQ(card_sample(&card, phase, &bad), EPCIO_OK);
            CHECK_EQ(epcio_set_latch(&card, 0, 6u << LATCH_INDEX, last), EPCIO_OK);
            phase[0] = 10.0;
            phase[1 + swap] = 1.5;   /* index half-way */
            phase[2 - swap] = 1.125; /* index at four fifths */
            epcio_advance(&card, SPAN);
            CHECK_EQ(card_sample(&card, phase, &bad), EPCIO_OK);
            CHECK_EQ(card.latch[0].clock, last ? 3200 : 2000);
            CHECK_EQ(card.latch[0].value, last ? 32 : 20);
        }
}

int main(void)
{
    static const double way[] = { 3.75, -3.75, 7.5, 1.0, 0.25, -0.4, 30.0 };
    for (int i = 0; i < 7; i++)
        for (int k = 0; k < 7; k++)
            first_and_last(way[i], way[k]);
    several_sources();
    return check_result();
}
