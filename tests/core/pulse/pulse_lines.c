/* Pulse lines against an accumulator and a pair of lines stepped clock by clock. */
#include "check.h"
#include "pulse.h"

#include <stdlib.h>
#include <string.h>

enum {
    CLOCKS_MAX = 7 << 11, /* longest DDA time here [clocks] */
    WIDEST = 65535,       /* pulse [clocks] */
};

/* One channel as hardware: all offsets are clocks since the DDA time in progress began. */
struct literal {
    struct pulse_config c;
    bool pulse[CLOCKS_MAX + 1]; /* there is one; at 0: the last of the DDA time before */
    bool back[CLOCKS_MAX + 1];  /* its direction */
    bool high[CLOCKS_MAX];      /* some pulse is high */
    bool high_back[CLOCKS_MAX]; /* direction of that pulse */
    bool direction;
    int64_t before; /* pulses up to and including offset 0 */
    int64_t last;   /* [clock] of the latest one of these */
};

/* What a receiver of the lines makes of them. */
struct receiver {
    bool started, a, b;
    int64_t count, lost;
};

/* All pulses of the DDA time, by addition; then each is held high. */
static void run_literal(struct literal *m, int32_t command, int32_t ticks, int32_t divider)
{
    int32_t end = divider * ticks, accumulator = ticks / 2;
    for (int32_t o = 1; o <= end; o++) {
        m->pulse[o] = false;
        if (o % divider != 0)
            continue;
        accumulator += abs(command);
        if (accumulator >= ticks) {
            accumulator -= ticks;
            m->pulse[o] = true;
            m->back[o] = command < 0;
        }
    }
    CHECK_EQ(accumulator, ticks / 2); /* nothing is carried over the boundary */
    memset(m->high, 0, sizeof m->high);
    for (int32_t o = 0; o < end; o++) {
        if (!m->pulse[o])
            continue;
        int32_t next = o + 1;
        while (next < end + divider && !(next <= end && m->pulse[next]))
            next++;
        int32_t high = o == 0 ? divider / 2 : (next - o) / 2;
        high = high < 1 ? 1 : high > m->c.width ? m->c.width : high;
        for (int32_t i = o; i < o + high && i < end; i++) {
            m->high[i] = true;
            m->high_back[i] = m->back[o];
        }
    }
}

/* A stop cuts the pulse on the first clock: it ends when the DDA goes on at this offset. */
static void cut_literal(struct literal *m, int32_t offset, int32_t end)
{
    m->pulse[0] = false;
    for (int32_t i = 1; i <= offset; i++)
        if (m->pulse[i])
            return; /* it was over before */
    for (int32_t i = offset; i < end && !m->pulse[i] && m->high[i]; i++)
        m->high[i] = false;
}

static struct lines literal_lines(const struct literal *m, int32_t o, int64_t count,
                                  int32_t command)
{
    bool a = false, b = false;
    bool back = m->high[o] ? m->high_back[o] : command != 0 ? command < 0 : m->direction;
    int place = (int)(((count % 4) + 4) % 4);
    if (m->c.format == PULSE_DIRECTION) {
        a = m->high[o];
        b = back;
    } else if (m->c.format == PULSE_CW_CCW) {
        a = m->high[o] && !back;
        b = m->high[o] && back;
    } else if (m->c.format == PULSE_AB) {
        a = place == 0 || place == 1;
        b = place == 1 || place == 2;
    }
    if (m->c.wiring & 1)
        a = !a;
    if (m->c.wiring & 2)
        b = !b;
    return m->c.wiring & 4 ? (struct lines){ b, a } : (struct lines){ a, b };
}

/* The DDA time is over at `clock`: its last pulse may lie on the boundary. */
static void end_literal(struct literal *m, int32_t command, int32_t end, int64_t last,
                        int64_t clock)
{
    for (int32_t o = 1; o <= end; o++)
        m->before += m->pulse[o] ? (m->back[o] ? -1 : 1) : 0;
    m->direction = command != 0 ? command < 0 : m->direction;
    m->pulse[0] = m->pulse[end];
    m->back[0] = m->back[end];
    m->last = m->pulse[0] ? clock : last;
}

/* Two pulses one clock apart on one line. */
static bool literal_merges(const struct literal *m, int32_t end)
{
    for (int32_t o = 0; o < end; o++) {
        bool both = m->pulse[o] && m->pulse[o + 1];
        if (both
            && (m->c.format == PULSE_DIRECTION
                || (m->c.format == PULSE_CW_CCW && m->back[o] == m->back[o + 1])))
            return true;
    }
    return false;
}

/* Counts at rising edges and the level of the direction there; quadrature as encoder inputs do. */
static void receive(struct receiver *r, const struct pulse_config *c, struct lines l)
{
    bool a = (c->wiring & 4 ? l.b : l.a) != ((c->wiring & 1) != 0);
    bool b = (c->wiring & 4 ? l.a : l.b) != ((c->wiring & 2) != 0);
    bool a_rises = r->started && a && !r->a, b_rises = r->started && b && !r->b;
    if (c->format == PULSE_DIRECTION && a_rises)
        r->count += b ? -1 : 1;
    if (c->format == PULSE_CW_CCW)
        r->count += (int)a_rises - (int)b_rises;
    if (c->format == PULSE_AB && r->started) {
        CHECK(a == r->a || b == r->b);
        if (a != r->a)
            r->count += a != b ? 1 : -1;
        if (b != r->b)
            r->count += a == b ? 1 : -1;
    }
    r->started = true;
    r->a = a;
    r->b = b;
}

struct bench {
    struct dda d;
    struct pulse p;
    struct literal m;
    struct receiver r;
    int64_t clock;
};

static struct bench bench; /* channel `CHANNEL` of the DDA */
enum { CHANNEL = 4 };

static struct lines lines_now(const struct bench *x)
{
    return pulse_at(&x->m.c, &x->p, &x->d, CHANNEL, x->clock);
}

/* Stand still for some clocks. */
static void pause(struct bench *x, struct lines want, int64_t latest, int64_t clocks)
{
    dda_set_run(&x->d, false, x->clock);
    for (int64_t i = 0; i < clocks; i++) {
        struct lines got = lines_now(x);
        CHECK(got.a == want.a && got.b == want.b);
        CHECK_EQ(pulse_latest(&x->p, &x->d, CHANNEL, x->clock), latest);
        receive(&x->r, &x->m.c, got);
        x->clock++;
    }
    dda_set_run(&x->d, true, x->clock);
}

/* Lines and latest pulse at every clock, the receiver's count where nothing merges. */
static void one_time(struct bench *x, int32_t pause_at, int64_t pause_clocks, bool merged_before)
{
    struct literal *m = &x->m;
    int32_t command = x->d.command[CHANNEL], end = x->d.divider * x->d.ticks, last = -1;
    bool merges = literal_merges(m, end);
    int64_t count = m->before;
    for (int32_t o = 0; o < end; o++, x->clock++) {
        bool pulse = o > 0 && m->pulse[o];
        count += pulse ? (m->back[o] ? -1 : 1) : 0;
        last = pulse ? o : last;
        struct lines want = literal_lines(m, o, count, command);
        if (o == pause_at) {
            pause(x, want, last < 0 ? m->last : x->d.start + last, pause_clocks);
            if (m->pulse[0] && pause_clocks > 0)
                cut_literal(m, o, end);
            want = literal_lines(m, o, count, command);
        }
        struct lines got = lines_now(x);
        CHECK(got.a == want.a && got.b == want.b);
        CHECK_EQ(pulse_latest(&x->p, &x->d, CHANNEL, x->clock),
                 last < 0 ? m->last : x->d.start + last);
        receive(&x->r, &m->c, got);
        if (o == 0 && merged_before)
            x->r.lost = count - x->r.count;
        CHECK(merges || m->c.format == PULSE_NONE || x->r.count + x->r.lost == count);
    }
    CHECK(!merges || pause_at >= 0 || x->r.count + x->r.lost != count);
    end_literal(m, command, end, last < 0 ? m->last : x->d.start + last, x->clock);
    CHECK_EQ(m->before, x->d.before[CHANNEL] + command);
}

static int32_t some_command(uint64_t *seed, int32_t ticks)
{
    int32_t largest = dda_largest(ticks), half = ticks / 2;
    int32_t size[] = { 0,
                       0,
                       1,
                       2,
                       half - 1,
                       half,
                       half + 1,
                       largest,
                       largest - 1,
                       half + 200,
                       (int32_t)check_random(seed, 0, 20),
                       (int32_t)check_random(seed, 0, largest),
                       (int32_t)check_random(seed, 0, largest) };
    int32_t k = size[check_random(seed, 0, (int64_t)(sizeof size / sizeof *size) - 1)];
    k = k < largest ? k : largest;
    return check_random(seed, 0, 1) ? -k : k;
}

static int32_t some_width(uint64_t *seed)
{
    int32_t width[] = { 1, 2, 3, 40, WIDEST, (int32_t)check_random(seed, 1, 1000) };
    return width[check_random(seed, 0, 5)];
}

/* DDA times of random ticks, divider and command in a row, some of them stopped on the way. */
static void against_clocks(enum pulse_format format, uint32_t wiring, uint64_t seed)
{
    enum { TIMES = 12 };
    struct bench *x = &bench;
    memset(x, 0, sizeof *x);
    x->m.c = (struct pulse_config){ format, wiring, some_width(&seed) };
    x->m.last = -1;
    CHECK_EQ(pulse_check(&x->m.c, WIDEST), PULSE_OK);
    pulse_reset(&x->p);
    dda_reset(&x->d, CHANNEL + 1, 1024, 1);
    bool merged = false;
    for (int i = 0; i < TIMES; i++) {
        int32_t end = x->d.divider * x->d.ticks, at = -1;
        run_literal(&x->m, x->d.command[CHANNEL], x->d.ticks, x->d.divider);
        if (check_random(&seed, 0, 2) == 0)
            at = (int32_t)check_random(&seed, 0, check_random(&seed, 0, 1) ? 3 : end - 1);
        bool merges = literal_merges(&x->m, end);
        one_time(x, at, check_random(&seed, 0, 40), merged);
        merged = merges;
        CHECK_EQ(x->clock, dda_boundary(&x->d));
        int32_t some[] = { 1024, 1024, 2048, 1000, 1001, (int32_t)check_random(&seed, 2, 2048) };
        int32_t ticks = some[check_random(&seed, 0, 5)];
        int32_t dividers[] = { 1, 1, 2, 3, 4, (int32_t)check_random(&seed, 1, 7) };
        int32_t divider = dividers[check_random(&seed, 0, 5)];
        dda_set_time(&x->d, ticks, divider, x->clock);
        if (x->d.command[CHANNEL] != 0) /* as the card does */
            pulse_boundary(&x->m.c, &x->p, &x->d, CHANNEL);
        dda_begin(&x->d, (int32_t[CHANNEL + 1]){ 7, [CHANNEL] = some_command(&seed, ticks) });
    }
}

/* The figure in pulse.c, read off by hand; then the direction stands while nothing moves. */
static void sign_change(void)
{
    const struct pulse_config c = { PULSE_DIRECTION, 0, 3 };
    const char a[] = "110011001100", b[] = "000000111111";
    struct dda d;
    struct pulse p;
    dda_reset(&d, 1, 1024, 4);
    pulse_reset(&p);
    CHECK_EQ(pulse_latest(&p, &d, 0, 4095), -1);
    dda_begin(&d, &(int32_t){ 1023 });
    for (int i = 0; i < 12; i++) {
        int64_t clock = 8192 - 4 + i;
        if (i == 4) {
            pulse_boundary(&c, &p, &d, 0);
            dda_begin(&d, &(int32_t){ -1023 });
        }
        struct lines l = pulse_at(&c, &p, &d, 0, clock);
        CHECK_EQ(l.a, a[i] - '0');
        CHECK_EQ(l.b, b[i] - '0');
        CHECK_EQ(pulse_latest(&p, &d, 0, clock), clock - i % 4);
    }
    pulse_boundary(&c, &p, &d, 0);
    dda_begin(&d, &(int32_t){ 0 });
    struct pulse old = p;
    pulse_boundary(&c, &p, &d, 0);
    CHECK(memcmp(&old, &p, sizeof p) == 0);
    dda_begin(&d, &(int32_t){ 0 });
    CHECK(pulse_at(&c, &p, &d, 0, d.start).b);
    CHECK(!pulse_at(&c, &p, &d, 0, d.start).a);
    CHECK_EQ(pulse_latest(&p, &d, 0, d.start), 3 * 4096);
}

/* The widest pulses, at a slow divider and many ticks: no overflow, half the distance. */
static void slow(void)
{
    enum { DIVIDER = 65535 };
    const struct pulse_config c = { PULSE_CW_CCW, 0, WIDEST };
    struct dda d;
    struct pulse p;
    dda_reset(&d, 1, 1 << 15, DIVIDER);
    pulse_reset(&p);
    dda_begin(&d, &(int32_t){ -32767 });
    int64_t first = d.start + DIVIDER;
    struct lines before = pulse_at(&c, &p, &d, 0, first - 1), on = pulse_at(&c, &p, &d, 0, first);
    CHECK(!before.a && !before.b && !on.a && on.b);
    CHECK(pulse_at(&c, &p, &d, 0, first + DIVIDER / 2 - 1).b);
    CHECK(!pulse_at(&c, &p, &d, 0, first + DIVIDER / 2).b);
    pulse_boundary(&c, &p, &d, 0);
    CHECK_EQ(p.last, dda_boundary(&d));
    CHECK_EQ(p.high, DIVIDER / 2);
    dda_begin(&d, &(int32_t){ 1 });
    int64_t middle = d.start + ((int64_t)DIVIDER << 14);
    CHECK(!pulse_at(&c, &p, &d, 0, middle - 1).a && pulse_at(&c, &p, &d, 0, middle).a);
    CHECK(pulse_at(&c, &p, &d, 0, middle + WIDEST - 1).a);
    CHECK(!pulse_at(&c, &p, &d, 0, middle + WIDEST).a);
}

static void refusals(void)
{
    const struct {
        struct pulse_config c;
        enum pulse_status want;
    } row[] = {
        { { PULSE_DIRECTION, 0, 1 }, PULSE_OK },
        { { PULSE_NONE, 7, WIDEST }, PULSE_OK },
        { { (enum pulse_format)4, 0, 1 }, PULSE_BAD_FORMAT },
        { { (enum pulse_format) - 1, 0, 1 }, PULSE_BAD_FORMAT },
        { { PULSE_AB, 8, 1 }, PULSE_BAD_WIRING },
        { { PULSE_AB, 0x80000000u, 1 }, PULSE_BAD_WIRING },
        { { PULSE_AB, 0, 0 }, PULSE_BAD_WIDTH },
        { { PULSE_AB, 0, -1 }, PULSE_BAD_WIDTH },
        { { PULSE_AB, 0, WIDEST + 1 }, PULSE_BAD_WIDTH },
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
        struct pulse_config c = row[i].c;
        CHECK_EQ(pulse_check(&c, WIDEST), row[i].want);
        CHECK(memcmp(&c, &row[i].c, sizeof c) == 0);
    }
}

int main(void)
{
    uint64_t seed = 4711;
    for (uint32_t wiring = 0; wiring < 8; wiring++)
        for (int format = PULSE_DIRECTION; format <= PULSE_NONE; format++)
            for (int n = format == PULSE_DIRECTION || format == PULSE_CW_CCW ? 4 : 1; n > 0; n--)
                against_clocks((enum pulse_format)format, wiring, seed += 7919);
    sign_change();
    slow();
    refusals();
    return check_result();
}
