/* Pulses of the card's FPGA against a model that is ticked clock by clock, and the trace of its
 * lines against what a drive asks for. */
#include "check.h"
#include "player_ticks.h"

static struct player one, two, image;
static struct ticks t;

/* What a drive sees of an axis. */
struct seen {
    int64_t rise, fall, turn;
    struct lines l;
};
static struct seen seen[FRAME_AXES];
static long long pulses, turns, tight, waits, drys, edges;

static void watch(const struct player_config *c, const struct player *p, int axis, int64_t clock)
{
    struct seen *s = &seen[axis];
    const struct lines l = player_lines(p, axis, clock);

    if (l.a && !s->l.a) {
        CHECK(s->turn < 0 || clock - s->turn >= c->setup);
        CHECK(s->fall < 0 || clock - s->fall >= c->width);
        tight += s->turn >= 0 && clock - s->turn == c->setup;
        s->rise = clock;
        pulses++;
    }
    if (!l.a && s->l.a) {
        CHECK_EQ(clock - s->rise, c->width);
        s->fall = clock;
    }
    if (l.b != s->l.b) {
        CHECK((!l.a || clock == s->rise) && (s->fall < 0 || clock - s->fall >= c->hold));
        s->turn = clock;
        turns++;
    }
    s->l = l;
}

/* The image stays where it was a while: its getters must tell the same up to its next clock. */
static void compare(int64_t clock, int64_t edge[FRAME_AXES])
{
    int64_t n[FRAME_AXES], m[FRAME_AXES];

    player_counts(&one, clock, n);
    player_counts(&image, clock, m);
    for (int i = 0; i < FRAME_AXES; i++) {
        const struct lines l = player_lines(&one, i, clock), k = player_lines(&image, i, clock);
        CHECK_EQ(n[i], t.count[i]);
        CHECK_EQ(m[i], n[i]);
        CHECK(l.a == (t.high_left[i] > 0) && l.b == t.backward[i]);
        CHECK(k.a == l.a && k.b == l.b);
        if (edge[i] == clock) {
            CHECK(t.high_left[i] == t.width);
            edges++;
        } else {
            CHECK(t.high_left[i] < t.width || edge[i] == -1);
        }
    }
    CHECK_EQ(one.fifo.stock, t.stock);
    CHECK(one.dry == t.dry && one.refused == t.refused && one.dead == t.dead
          && one.frames == t.frames);
}

static void random_frame(uint64_t *seed, struct frame *f, int most)
{
    f->event = check_random(seed, 0, 3) ? 0 : (uint8_t)check_random(seed, 1, 31);
    for (int i = 0; i < FRAME_AXES; i++) {
        const int kind = (int)check_random(seed, 0, 3);
        f->command[i] = (int16_t)(kind == 0   ? 0
                                  : kind == 1 ? check_random(seed, -3, 3) % (most + 1)
                                              : check_random(seed, -most, most));
    }
}

/* What both told since the last look, at this clock. */
static void compare_told(int64_t clock)
{
    const struct player_told told = player_take(&one);

    CHECK_EQ(told.what & ~(uint32_t)(PLAYER_REST | PLAYER_FULL_SPEED), t.told);
    CHECK_EQ(told.events, t.events);
    for (int i = 0; i < PLAYER_TELLS; i++) {
        CHECK(!(told.what >> i & 1) || told.clock[i] == clock);
    }
    t.told = t.events = 0;
}

/* One machine: random frames at random times, targets, ends and clears, for so many clocks. */
static void machine(uint64_t *seed, int clocks)
{
    const int period = (int)check_random(seed, 2, 300);
    const struct player_config c = { (int)check_random(seed, 1, 9), (int)check_random(seed, 1, 5),
                                     (int)check_random(seed, 0, 40),
                                     (int)check_random(seed, 0, 40) };
    struct player_job job = { .period = period, .reserve = 0.1 };
    const double seconds = period * 20e-9;
    for (int i = 0; i < FRAME_AXES; i++) { /* ramps of some thousand clocks */
        job.acc[i] = check_random(seed, 0, 3) ? 5e4 * period / 4 / seconds : 0.0;
        job.jerk[i] = check_random(seed, 0, 1) ? job.acc[i] * 1e5 : 0.0;
    }
    player_start(&one, &c);
    ticks_start(&t, c.depth, c.width, c.setup, c.hold, period);
    CHECK_EQ(player_begin(&one, &job, 0), PLAYER_OK);
    two = one;
    for (int i = 0; i < FRAME_AXES; i++) {
        seen[i] = (struct seen){ -1, -1, -1, { false, false } };
    }
    const int most = player_largest(&one, period), often = (int)check_random(seed, 10, 500),
              rare = check_random(seed, 0, 1) ? 600 : 30000;
    int64_t edge[FRAME_AXES] = { -1, -1, -1, -1 };
    for (int64_t clock = 0; clock < clocks && !check_failures; clock++) {
        struct frame f;
        if (check_random(seed, 0, often) == 0) {
            random_frame(seed, &f, most);
            if (!t.whole) {
                player_advance(&two, clock);
                const enum player_status s = player_push(&one, &f);
                CHECK_EQ(s, ticks_push(&t, &f));
                CHECK_EQ(s, player_push(&two, &f));
                edge[0] = edge[1] = edge[2] = edge[3] = -1;
            }
        }
        if (check_random(seed, 0, 2000) == 0) {
            const int target = (int)check_random(seed, 0, 2) > 0;
            const bool fresh = one.fresh;
            player_advance(&two, clock);
            player_set_target(&one, target);
            player_set_target(&two, target);
            player_advance(&one, clock);
            player_advance(&two, clock);
            if (fresh && target) {
                ticks_period(&t);
                for (int i = 0; i < FRAME_AXES; i++) {
                    t.backward[i] = t.turn_in[i] ? t.backward[i] : t.wanted[i];
                }
            }
            compare_told(clock);
            edge[0] = edge[1] = edge[2] = edge[3] = -1;
        }
        if (check_random(seed, 0, rare) == 0) {
            player_advance(&two, clock);
            if (check_random(seed, 0, 1)) {
                player_whole(&one);
                player_whole(&two);
                t.whole = 1;
            } else {
                player_clear(&one);
                player_clear(&two);
                ticks_clear(&t);
                player_begin(&one, &job, clock);
                player_begin(&two, &job, clock);
                t.frames = 0, t.told = t.events = 0;
            }
            edge[0] = edge[1] = edge[2] = edge[3] = -1;
        }
        if (edge[0] == -1) {
            image = one;
        }
        compare(clock, edge);
        for (int i = 0; i < FRAME_AXES; i++) {
            watch(&c, &one, i, clock);
            edge[i] = player_edge(&one, i, clock);
            CHECK(edge[i] > clock);
        }
        const int64_t rate = one.rate;
        if (clock + 1 >= player_next(&image) || check_random(seed, 0, 99) == 0) {
            player_advance(&one, clock + 1);
            image = one;
        } else {
            player_advance(&one, clock + 1);
        }
        ticks_clock(&t, rate);
        compare_told(clock + 1);
    }
    player_advance(&two, clocks);
    player_take(&two);
    CHECK(!memcmp(&one, &two, sizeof one)); /* whatever the steps */
    waits += t.dead;
    drys += t.dry;
}

static void against_ticks(void)
{
    uint64_t seed = 1;
    for (int i = 0; i < 100 && !check_failures; i += CHECK_EACH) {
        machine(&seed, 20000);
    }
    printf("player: %lld pulses, %lld turns, %lld at the set-up's clock, %lld dead clocks, "
           "%lld dry periods, %lld edges foretold\n",
           pulses, turns, tight, waits, drys, edges);
    CHECK(CHECK_EACH > 1 || (pulses > 50000 && turns > 3000 && tight > 100 && drys > 500));
}

/* Frames of a job of 2 axes, drawn again and again. */
static struct frame wave(int n, int frames)
{
    const double a = 6.283185307179586 / frames;
    struct frame f = { { 0 }, 0 };
    f.command[0] = (int16_t)(lround(3e4 * cos(a * (n + 1))) - lround(3e4 * cos(a * n)));
    f.command[1] = (int16_t)(lround(3e4 * sin(a * (n + 1))) - lround(3e4 * sin(a * n)));
    f.command[3] = (int16_t)(n % 7 - 3);
    return f;
}

/* Pulses out are the frames' pulses, and all frames are played in order, whatever the pauses. The
 * FIFO is fed as its interrupt asks. */
static void any_pauses(void)
{
    enum { FRAMES = 3000 };
    uint64_t seed = 5;
    int64_t paused_for = 0;
    for (int run = 0; run < 40; run += CHECK_EACH) {
        const struct player_config c = { 512, 50, 250, 250 };
        const struct player_job job = { .period = 50000,
                                        .reserve = 0.1,
                                        .speed = { 1e5, 1e5, 0.0, 5e3 },
                                        .acc = { 1e6, 1e6, 1e6, 1e7 },
                                        .jerk = { 5e7, 5e7, 5e7, 0.0 } };
        int64_t sum[FRAME_AXES] = { 0 }, n[FRAME_AXES];
        int pushed = 0, pauses = 0, ended = 0;
        player_start(&one, &c);
        player_begin(&one, &job, 0);
        int64_t change = check_random(&seed, 0, 20000000);
        for (; pushed < 512; pushed++) {
            const struct frame f = wave(pushed, FRAMES);
            CHECK_EQ(player_push(&one, &f), PLAYER_OK);
        }
        player_set_target(&one, 1);
        while (!ended && one.clock < (int64_t)1 << 32) {
            const int64_t next = player_next(&one);
            player_advance(&one, next < change ? next : change);
            if (one.clock == change) {
                player_set_target(&one, pauses++ % 2);
                change += check_random(&seed, 0, 3) ? check_random(&seed, 1, 20000000)
                                                    : check_random(&seed, 1, 300000);
            }
            const struct player_told told = player_take(&one);
            if (told.what & PLAYER_HALF) {
                CHECK_EQ(one.fifo.stock, 256);
                for (int i = 0; i < 256 && pushed < FRAMES; i++, pushed++) {
                    const struct frame f = wave(pushed, FRAMES);
                    CHECK_EQ(player_push(&one, &f), PLAYER_OK);
                }
                if (pushed == FRAMES) {
                    player_whole(&one);
                }
            }
            ended = (told.what & PLAYER_ENDED) != 0;
        }
        for (int i = 0; i < FRAMES; i++) {
            const struct frame f = wave(i, FRAMES);
            for (int k = 0; k < FRAME_AXES; k++) {
                sum[k] += f.command[k];
            }
        }
        player_counts(&one, one.clock, n);
        CHECK(ended && !memcmp(n, sum, sizeof n));
        CHECK(one.frames == FRAMES && one.dry == 0 && one.refused == 0 && pauses >= 3);
        paused_for += one.clock - FRAMES * 50000LL;
    }
    CHECK(paused_for > 0);
}

/* What goes in comes out, stays, or is refused; each dry period is counted. */
static void conserved(void)
{
    uint64_t seed = 9;
    for (int run = 0; run < 200; run++) {
        const struct player_config c = { (int)check_random(&seed, 1, 2304), 1, 0, 0 };
        const struct player_job job = { .period = 1000, .reserve = 0.1 };
        int64_t in = 0, refused = 0, n[FRAME_AXES], accepted = 0, halves = 0, falls = 0;
        const int load = (int)check_random(&seed, 200, 2000);
        player_start(&one, &c);
        player_begin(&one, &job, 0);
        player_set_target(&one, 1);
        for (int64_t clock = 0; clock < 500000; clock += check_random(&seed, 1, load)) {
            const int before = one.fifo.stock > c.depth / 2;
            player_advance(&one, clock);
            falls += before && one.fifo.stock <= c.depth / 2;
            halves += (player_take(&one).what & PLAYER_HALF) != 0;
            const struct frame f = { { (int16_t)check_random(&seed, -500, 500), 1, 0, 0 }, 0 };
            const enum player_status s = player_push(&one, &f);
            CHECK_EQ(s, one.fifo.stock < c.depth || s == PLAYER_OK ? PLAYER_OK : PLAYER_FULL);
            refused += s == PLAYER_FULL;
            in += s == PLAYER_OK ? f.command[0] : 0;
            accepted += s == PLAYER_OK;
        }
        CHECK_EQ(one.refused, refused);
        CHECK_EQ(one.frames + one.fifo.stock, accepted);
        CHECK_EQ(one.frames + one.dry, one.clock / 1000 + 1);
        CHECK_EQ(halves, falls);
        player_whole(&one);
        player_advance(&one, one.clock + 1000 * (one.fifo.stock + 2));
        player_counts(&one, one.clock, n);
        CHECK_EQ(n[0], in);
        CHECK_EQ(n[1], accepted);
        CHECK(player_take(&one).what & PLAYER_ENDED);
        CHECK_EQ(player_next(&one), INT64_MAX);
    }
}

static void refused(void)
{
    const struct player_config bad[] = { { 0, 1, 0, 0 },
                                         { 2305, 1, 0, 0 },
                                         { 8, 0, 0, 0 },
                                         { 8, 1, -1, 0 },
                                         { 8, 1, 0, -1 } },
                               good = { 8, 50, 250, 250 };
    struct player_job job = { .period = 50000, .reserve = 0.1 };
    struct frame f = { { 500, -500, 0, 0 }, 31 };
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++) {
        CHECK(!player_start(&one, &bad[i]));
    }
    CHECK(player_start(&one, &good));
    CHECK_EQ(player_largest(&one, 50000), 500); /* 500 kHz at 1 us high and 1 us low */
    CHECK_EQ(player_begin(&one, &job, 7), PLAYER_OK);
    CHECK_EQ(player_push(&one, &f), PLAYER_OK);
    f.command[1] = -501;
    CHECK_EQ(player_push(&one, &f), PLAYER_RANGE);
    f.command[1] = 0;
    f.event = 32;
    CHECK_EQ(player_push(&one, &f), PLAYER_RANGE);
    f.event = 0;
    player_whole(&one);
    CHECK_EQ(player_push(&one, &f), PLAYER_RANGE);
    CHECK_EQ(one.fifo.stock, 1);
    job.reserve = 0.0;
    CHECK_EQ(player_begin(&one, &job, 8), PLAYER_RANGE);
    CHECK_EQ(one.fifo.stock, 1);
    job.reserve = 0.1, job.period = 1;
    CHECK_EQ(player_begin(&one, &job, 8), PLAYER_RANGE);
    job.period = 50000, job.acc[3] = NAN;
    CHECK_EQ(player_begin(&one, &job, 8), PLAYER_RANGE);
}

int main(void)
{
    against_ticks();
    any_pauses();
    conserved();
    refused();
    return check_result();
}
