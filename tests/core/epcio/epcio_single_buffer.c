/* Single-buffer card: exact gaps, no pulse lost, and every clock like a model that counts them. */
#include <string.h>

#include "check.h"
#include "single_buffer.h"
#include "single_buffer_literal.h"

enum { LENGTH = 10, T = 1 << LENGTH };

static const struct single_buffer_config all_axes = { { true, true, true, true, true, true },
                                                      false };
static const uint32_t open_mask[IRQ_PAGES] = { 0x7F }, fifo_mask[IRQ_PAGES] = { 0x3F };

/* A card with DDA time 1024 clocks and open interrupts, at clock 0. */
static struct single_buffer power_on(bool latched, const uint32_t mask[IRQ_PAGES])
{
    struct single_buffer card;
    struct single_buffer_config config = all_axes;
    config.latched = latched;
    single_buffer_reset(&card, &config);
    CHECK_EQ(card.dda.ticks, 1 << 12);
    CHECK_EQ(card.dda.divider, 10);
    CHECK_EQ(single_buffer_set_dda(&card, LENGTH, 1), EPCIO_OK);
    single_buffer_set_mask(&card, mask);
    return card;
}

static int64_t pulses_of(const struct single_buffer *card, int axis)
{
    int64_t pulses[AXES];
    single_buffer_pulses(card, pulses);
    return pulses[axis];
}

/* Figure 2: T + L from command to command, the axis stands for L, and not a clock more. The first
 * command comes at clock 7; its pulse j of 100 at ceil((2 j - 1) 512 / 100) clocks. */
static void direct_gaps(int64_t latency)
{
    struct single_buffer card = power_on(false, fifo_mask);
    const int32_t frame[AXES] = { 100, -100, 0, 1023, -1023, 1 };
    int64_t begin = 7;
    for (int k = 0; k < 20; k++) {
        single_buffer_advance(&card, begin);
        CHECK_EQ(single_buffer_stock(&card), 0);
        CHECK_EQ(single_buffer_underflows(&card, 0), latency > 0 ? k : 0);
        CHECK_EQ(single_buffer_write_frame(&card, frame), EPCIO_OK);
        CHECK_EQ(card.gap[0], k * latency);
        CHECK_EQ(card.gap[2], 0); /* never moves */
        CHECK_EQ(single_buffer_stock(&card), 1);
        single_buffer_acknowledge(&card, fifo_mask, fifo_mask);
        for (int64_t j = 1; j <= 100; j++) {
            int64_t edge = begin + ((2 * j - 1) * 512 + 99) / 100;
            single_buffer_advance(&card, edge - 1);
            CHECK_EQ(pulses_of(&card, 0), 100 * k + j - 1);
            single_buffer_advance(&card, edge);
            CHECK_EQ(pulses_of(&card, 0), 100 * k + j);
            CHECK_EQ(pulses_of(&card, 1), -100 * k - j);
        }
        single_buffer_advance(&card, begin + T - 1);
        CHECK_EQ(card.irq.seq, k);
        CHECK_EQ(single_buffer_stock(&card), 1);
        single_buffer_advance(&card, begin + T);
        CHECK_EQ(card.irq.seq, k + 1);
        CHECK_EQ(card.irq.clock, begin + T);
        CHECK_EQ(card.irq.flags[IRQ_DDA] & 0x3F, 0x3F);
        begin += T + latency;
    }
    CHECK_EQ(pulses_of(&card, 3), 20 * 1023);
    single_buffer_advance(&card, begin + 50 * T); /* and stands, for one underflow */
    CHECK_EQ(single_buffer_underflows(&card, 0), latency > 0 ? 20 : 1);
    CHECK_EQ(single_buffer_underflows(&card, 2), 0);
    CHECK_EQ(card.gap[0], 19 * latency);
    CHECK_EQ(card.irq.seq, 20);
}

/* Free-running grid: a command costs (floor(L / T) + 1) T; at L = T the boundary was first. */
static void latched_gaps(int64_t latency)
{
    struct single_buffer card = power_on(true, fifo_mask);
    const int32_t frame[AXES] = { 100, -100, 0, 1023, -1023, 1 };
    const int64_t each = (latency / T + 1) * T;
    CHECK_EQ(single_buffer_write_frame(&card, frame), EPCIO_OK);
    single_buffer_advance(&card, T - 1);
    CHECK_EQ(pulses_of(&card, 3), 0);
    CHECK_EQ(single_buffer_stock(&card), 1);
    for (int k = 0; k < 20; k++) {
        int64_t begin = T + k * each;
        single_buffer_advance(&card, begin);
        CHECK_EQ(card.irq.seq, k + 1);
        CHECK_EQ(card.irq.clock, begin);
        CHECK_EQ(pulses_of(&card, 3), k * 1023);
        CHECK_EQ(single_buffer_stock(&card), 0);
        CHECK_EQ(single_buffer_underflows(&card, 0), latency < T ? 0 : k);
        CHECK_EQ(card.gap[0], k * (each - T));
        CHECK_EQ(card.gap[2], 0);
        single_buffer_advance(&card, begin + 1); /* 1023 of 1024: a pulse at once */
        CHECK_EQ(pulses_of(&card, 3), k * 1023 + 1);
        single_buffer_advance(&card, begin + latency);
        single_buffer_acknowledge(&card, fifo_mask, fifo_mask);
        CHECK_EQ(single_buffer_write_frame(&card, frame), EPCIO_OK);
    }
}

/* Through the bus, at clocks around the end of the DDA time: before it refused (direct) or in time
 * (latched), at it after the boundary, later a gap of exactly that. */
static void write_around_the_end(void)
{
    for (int late = -2; late <= 2; late++) {
        struct single_buffer card = power_on(false, open_mask);
        struct bus_write w = { .seq = 1, .count = 1, .frame = { { 9 } } };
        single_buffer_post(&card, &w);
        CHECK_EQ(card.cmd_ack, 1); /* its clock has come: at once */
        w.seq = 2;
        w.clock = T + late;
        single_buffer_post(&card, &w);
        single_buffer_advance(&card, T + late);
        CHECK_EQ(card.cmd_ack, 2);
        CHECK_EQ(card.frames_taken, late < 0 ? 1 : 2);
        CHECK_EQ(card.frames_refused, late < 0 ? 1 : 0);
        CHECK_EQ(card.gap[0], late < 0 ? 0 : late);
        CHECK_EQ(single_buffer_underflows(&card, 0), late > 0 ? 1 : 0);
        CHECK_EQ(single_buffer_underflows(&card, 1), 0);

        card = power_on(true, open_mask);
        w.seq = 1;
        w.clock = 0;
        single_buffer_post(&card, &w);
        w.seq = 2;
        w.clock = 2 * T + late;
        single_buffer_post(&card, &w);
        single_buffer_advance(&card, 4 * T);
        CHECK_EQ(card.frames_taken, 2);
        CHECK_EQ(pulses_of(&card, 0), 18);
        CHECK_EQ(card.gap[0], late < 0 ? 0 : T);
        CHECK_EQ(single_buffer_underflows(&card, 0), late < 0 ? 1 : 2);
    }
}

/* What is refused changes nothing but says why. */
static void refusals(bool latched)
{
    struct single_buffer card = power_on(latched, open_mask), before;
    card.config.active[0] = card.config.active[4] = false;
    CHECK_EQ(single_buffer_write_frame(&card, (int32_t[6]){ 0, 5, 0, 1023, 0, -1023 }), 0);
    const int32_t frame[5][6] = {
        { 0, 7 }, { 0, 0, 1024 }, { 0, 0, 0, INT32_MIN }, { 0, 0, 0, 0, 1 }, { -1 }
    };
    const struct epcio_refusal why[5] = { { EPCIO_NOT_FREE, 1, 7 },
                                          { EPCIO_COMMAND_TOO_LARGE, 2, 1024 },
                                          { EPCIO_COMMAND_TOO_LARGE, 3, INT32_MIN },
                                          { EPCIO_AXIS_UNUSED, 4, 1 },
                                          { EPCIO_AXIS_UNUSED, 0, -1 } };
    for (int k = 0; k < 5; k++) {
        before = card;
        CHECK_EQ(single_buffer_write_frame(&card, frame[k]), why[k].status);
        CHECK(memcmp(&card.refusal, &why[k], sizeof why[k]) == 0);
        card.refusal = before.refusal;
        CHECK(memcmp(&card, &before, sizeof card) == 0);
    }
    const int32_t bad[8][2] = { { 9, 1 },  { 16, 1 },     { -1, 1 },  { INT32_MIN, 1 },
                                { 10, 0 }, { 10, 65536 }, { 10, -1 }, { 15, INT32_MAX } };
    for (int k = 0; k < 8; k++)
        CHECK_EQ(single_buffer_set_dda(&card, bad[k][0], bad[k][1]),
                 k < 4 ? EPCIO_BAD_LENGTH : EPCIO_BAD_DIVIDER);
    struct bus_write w = { .seq = 1, .clock = 5, .count = -1 };
    CHECK_EQ(single_buffer_post(&card, &w), EPCIO_BAD_COUNT);
    w.count = BUS_FRAMES + 1;
    CHECK_EQ(single_buffer_post(&card, &w), EPCIO_BAD_COUNT);
    CHECK(memcmp(&card, &before, sizeof card) == 0);
    w.count = BUS_FRAMES;
    for (int k = 0; k < BUS_DEPTH; k++)
        CHECK_EQ(single_buffer_post(&card, &w), EPCIO_OK);
    before = card;
    CHECK_EQ(single_buffer_post(&card, &w), EPCIO_BUS_FULL);
    CHECK(memcmp(&card, &before, sizeof card) == 0);
}

/* A shorter length waits for the command written under the longer one; both ends are accepted. */
static void shorter_length(void)
{
    struct single_buffer card = power_on(true, open_mask), before;
    CHECK_EQ(single_buffer_set_dda(&card, 15, 65535), EPCIO_OK);
    CHECK_EQ(single_buffer_set_dda(&card, 11, 1), EPCIO_OK);
    CHECK_EQ(single_buffer_write_frame(&card, (int32_t[6]){ 0, -1024 }), EPCIO_OK);
    before = card;
    CHECK_EQ(single_buffer_set_dda(&card, 10, 1), EPCIO_COMMAND_WAITS);
    CHECK(memcmp(&card, &before, sizeof card) == 0);
    single_buffer_advance(&card, 2 * T); /* taken: the register is empty */
    CHECK_EQ(single_buffer_set_dda(&card, 10, 1), EPCIO_OK);
    CHECK_EQ(single_buffer_set_dda(&card, 11, 1), EPCIO_OK);
    CHECK_EQ(single_buffer_write_frame(&card, (int32_t[6]){ 0, 1023 }), EPCIO_OK);
    CHECK_EQ(single_buffer_set_dda(&card, 10, 1), EPCIO_OK); /* it just fits */
    single_buffer_advance(&card, 5 * T);
    CHECK_EQ(pulses_of(&card, 1), -1);
    CHECK_EQ(dda_boundary(&card.dda), 6 * T);
    card = power_on(false, open_mask); /* direct: the next command has it */
    single_buffer_write_frame(&card, (int32_t[6]){ 1023 });
    CHECK_EQ(single_buffer_set_dda(&card, 11, 3), EPCIO_OK);
    single_buffer_advance(&card, T);
    CHECK_EQ(pulses_of(&card, 0), 1023);
    CHECK_EQ(single_buffer_write_frame(&card, (int32_t[6]){ 2047 }), EPCIO_OK);
    CHECK_EQ(dda_boundary(&card.dda), T + 3 * 2048);
}

/* Emergency stop: nothing waits or comes any more, the DDA time in progress ends as commanded. */
static void emergency_stop(bool latched)
{
    struct single_buffer card = power_on(latched, open_mask);
    struct bus_write w = { .seq = 4, .clock = 3000, .count = 3, .frame = { { 33 } } };
    single_buffer_write_frame(&card, (int32_t[6]){ 100 });
    single_buffer_advance(&card, latched ? T + 10 : 10);
    single_buffer_acknowledge(&card, open_mask, open_mask);
    if (latched)
        single_buffer_write_frame(&card, (int32_t[6]){ 50 });
    single_buffer_post(&card, &w);
    uint32_t pulls = card.irq.seq;
    single_buffer_clear(&card);
    CHECK_EQ(card.irq.flags[IRQ_DDA], latched ? 0x3F : 0);
    CHECK_EQ(card.irq.seq, latched ? pulls + 1 : pulls);
    CHECK_EQ(card.frames_refused, 3);
    CHECK_EQ(card.refusal.status, EPCIO_DROPPED);
    CHECK_EQ(card.cmd_ack, 4);
    CHECK_EQ(single_buffer_stock(&card), latched ? 0 : 1);
    single_buffer_advance(&card, 5 * T + 5);
    CHECK_EQ(pulses_of(&card, 0), 100);
    CHECK_EQ(single_buffer_underflows(&card, 0), 1); /* the axis ran out, as on the EPCIO */
    CHECK_EQ(single_buffer_write_frame(&card, (int32_t[6]){ 100 }), EPCIO_OK);
    single_buffer_advance(&card, 7 * T + 5);
    CHECK_EQ(card.gap[0], 0);   /* a new start */
    single_buffer_clear(&card); /* nothing to drop: no interrupt */
    CHECK_EQ(card.frames_refused, 3);
}

/* Off, the time of the DDA stands: in a command, in a wait, before a command written meanwhile. */
static void frozen(void)
{
    struct single_buffer card = power_on(false, open_mask);
    single_buffer_write_frame(&card, (int32_t[6]){ 4 });
    single_buffer_advance(&card, 500);
    single_buffer_set_run(&card, false);
    single_buffer_advance(&card, 90000);
    CHECK_EQ(pulses_of(&card, 0), 2); /* at 128, 384; next 640 */
    single_buffer_set_run(&card, true);
    single_buffer_advance(&card, 90000 + 524 + 6); /* six clocks of waiting */
    single_buffer_set_run(&card, false);
    single_buffer_advance(&card, 200000);
    CHECK_EQ(single_buffer_underflows(&card, 0), 1);
    single_buffer_write_frame(&card, (int32_t[6]){ 4 });
    CHECK_EQ(card.gap[0], 6);
    CHECK_EQ(single_buffer_stock(&card), 1);
    single_buffer_advance(&card, 300000);
    CHECK_EQ(pulses_of(&card, 0), 4);
    single_buffer_set_run(&card, true);
    single_buffer_advance(&card, 300127);
    CHECK_EQ(pulses_of(&card, 0), 4);
    single_buffer_advance(&card, 300128);
    CHECK_EQ(pulses_of(&card, 0), 5);
    single_buffer_advance(&card, 300000 + T - 1);
    CHECK_EQ(single_buffer_stock(&card), 1);
    single_buffer_advance(&card, 300000 + T);
    CHECK_EQ(single_buffer_stock(&card), 0);
}

/* Writes at random clocks, by a host that does not look: pulses out = commands taken, axis by axis;
 * every frame is taken or refused; a direct card refuses exactly those within a DDA time. */
static void conservation(bool latched, uint64_t seed)
{
    struct single_buffer card = power_on(latched, open_mask);
    int64_t sum[AXES] = { 0 }, free_at = 0;
    int32_t refused = 0;
    enum { WRITES = 4000 };
    for (int32_t seq = 1; seq <= WRITES; seq++) {
        struct bus_write w = { .seq = seq, .count = 1 };
        w.clock = card.clock + check_random(&seed, 0, 3 * T);
        for (int i = 0; i < AXES; i++)
            w.frame[0][i] = (int32_t)check_random(&seed, -1023, 1023);
        CHECK_EQ(single_buffer_post(&card, &w), EPCIO_OK);
        single_buffer_advance(&card, w.clock);
        CHECK_EQ(card.cmd_ack, seq);
        bool is_free = w.clock >= free_at; /* direct: its end; latched: the boundary after */
        if (is_free)
            free_at = latched ? (w.clock / T + 1) * T : w.clock + T;
        for (int i = 0; i < AXES && is_free; i++)
            sum[i] += w.frame[0][i];
        refused += !is_free;
        CHECK_EQ(card.frames_refused, refused);
        CHECK_EQ(card.frames_taken, seq - refused);
    }
    single_buffer_advance(&card, card.clock + 3 * T);
    for (int i = 0; i < AXES; i++)
        CHECK_EQ(pulses_of(&card, i), sum[i]);
    CHECK(refused > WRITES / 10 && refused < WRITES / 2);
}

static void same(const struct single_buffer *card, const struct literal *m)
{
    int64_t pulses[AXES];
    bool equal = true;
    single_buffer_pulses(card, pulses);
    for (int i = 0; i < AXES; i++)
        equal = equal && pulses[i] == m->out[i] && card->gap[i] == m->gap[i]
                && single_buffer_underflows(card, i) == m->underflows[i];
    equal = equal && memcmp(&card->irq, &m->irq, sizeof m->irq) == 0;
    CHECK(equal);
    CHECK_EQ(single_buffer_stock(card), m->latched ? m->waits : m->running);
    CHECK_EQ(card->cmd_ack, m->ack);
    CHECK_EQ(card->frames_taken, m->taken);
    CHECK_EQ(card->frames_refused, m->refused);
}

/* A transaction of a host that looks sometimes, and is wrong sometimes. */
static struct bus_write random_write(uint64_t *seed, int32_t seq, int64_t now)
{
    struct bus_write w = { .seq = seq,
                           .clock = now + check_random(seed, -100, 1500),
                           .count = check_random(seed, 0, 4) == 0 ? 2 : 1 };
    for (int k = 0; k < w.count; k++)
        for (int i = 0; i < LITERAL_UNUSED; i++)
            w.frame[k][i] = (int32_t)(check_random(seed, -1023, 1023) * check_random(seed, 0, 1));
    if (check_random(seed, 0, 9) == 0)
        w.frame[0][check_random(seed, 0, 5)] = (int32_t)check_random(seed, 900, 2200);
    return w;
}

/* What the host does at this clock, on the model and on both cards. */
static void random_host(struct literal *m, struct single_buffer card[2], uint64_t *seed)
{
    const struct bus_write w = random_write(seed, m->ack + m->on_way + 1, m->now);
    const int32_t length = (int32_t)check_random(seed, 10, 11);
    const int32_t divider = (int32_t)check_random(seed, 1, 2);
    const uint32_t flags[IRQ_PAGES] = { (uint32_t)check_random(seed, 1, 127) };
    const int64_t what = m->run ? check_random(seed, 0, 40) : check_random(seed, 10, 24);
    bool post = what < 18 && m->on_way < BUS_DEPTH, set = what >= 18 && what < 22, fits = false;
    bool run = what >= 22 && what < 25, clear = what == 25, acknowledge = what > 25;
    if (post) {
        m->coming[m->on_way++] = w;
        literal_arrivals(m);
    }
    if (set)
        fits = literal_set_dda(m, length, divider);
    m->run = m->run != run;
    if (clear)
        literal_clear(m);
    if (acknowledge)
        irq_acknowledge(&m->irq, flags, open_mask, m->now);
    for (int k = 0; k < 2; k++) {
        if (post)
            CHECK_EQ(single_buffer_post(&card[k], &w), EPCIO_OK);
        if (set)
            CHECK_EQ(single_buffer_set_dda(&card[k], length, divider) == EPCIO_OK, fits);
        single_buffer_set_run(&card[k], m->run);
        if (clear)
            single_buffer_clear(&card[k]);
        if (acknowledge)
            single_buffer_acknowledge(&card[k], flags, open_mask);
    }
}

/* Every clock like the literal card; long steps end in the same bits as single clocks. Adds up how
 * much happened: clocks of gaps, underflows, refused frames. */
static void compare(bool latched, uint64_t seed, int64_t seen[3])
{
    struct single_buffer card[2];
    const struct single_buffer_config config = { { true, true, true, true, true, false }, latched };
    struct literal m = { .latched = latched,
                         .run = true,
                         .length = LENGTH,
                         .divider = 1,
                         .next_length = LENGTH,
                         .next_divider = 1,
                         .irq.mask = { 0x7F } };
    for (int k = 0; k < 2; k++) {
        single_buffer_reset(&card[k], &config);
        single_buffer_set_dda(&card[k], LENGTH, 1);
        single_buffer_set_mask(&card[k], open_mask);
    }
    for (int64_t next = 0; m.now < 60000;) {
        if (m.now == next) {
            single_buffer_advance(&card[1], m.now);
            CHECK(memcmp(&card[0], &card[1], sizeof card[0]) == 0);
            random_host(&m, card, &seed);
            next += check_random(&seed, 1, 2500);
        }
        literal_clock(&m);
        literal_arrivals(&m);
        single_buffer_advance(&card[0], m.now);
        same(&card[0], &m);
    }
    seen[0] += m.gap[0];
    seen[1] += m.underflows[0];
    seen[2] += m.refused;
}

int main(void)
{
    const int64_t latency[] = { 0, 1, 2, 77, T - 1, T, T + 1, 3 * T, 3 * T + 5 };
    for (int i = 0; i < 9; i++) {
        direct_gaps(latency[i]);
        latched_gaps(latency[i]);
    }
    write_around_the_end();
    shorter_length();
    frozen();
    for (int latched = 0; latched < 2; latched++) {
        int64_t seen[3] = { 0 };
        refusals(latched);
        emergency_stop(latched);
        conservation(latched, 15485863);
        for (uint64_t seed = 1; seed <= 20; seed++)
            compare(latched, seed * 32452843, seen);
        CHECK(seen[0] > 5000 && seen[1] > 10 && seen[2] > 50);
    }
    return check_result();
}
