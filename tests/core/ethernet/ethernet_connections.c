/* Connections of two ends that follow the rules, and of ends that do not: when one comes about and
 * ends, and what a cut lets through. */
#include <string.h>

#include "check.h"
#include "ethernet.h"

enum { PERIOD = 1000, SENT = 6000 };

/* No delay and a line so fast that bytes cross within two instants. */
static const struct ethernet_config quick = { .pipe = { .rate = 10000000000, .segment = 1460 },
                                              .connect = 3 * PERIOD,
                                              .away = 5 * PERIOD };

/* Ends that write and read as the ring allows. */
struct ends {
    struct ethernet_seen seen[ETHERNET_ENDS];
    int32_t connection;
    int64_t got[ETHERNET_ENDS], sent[ETHERNET_ENDS]; /* over all connections */
    bool wrong;                                      /* another byte than the other end's */
};

static uint8_t byte_of(int end, int32_t n)
{
    return (uint8_t)(n * (end ? 7 : 13) + n / 256);
}

/* An end reads what is shown and writes what fits. */
static void act(struct ends *s, int end, const struct ethernet *e)
{
    struct ethernet_seen *seen = &s->seen[end];
    uint8_t bytes[BYTE_RING_BYTES];
    const struct ethernet_shown *shown = &e->shown[end];
    const size_t n =
        byte_ring_look(shown->rx_words, shown->rx_count, seen->rx_taken, bytes, sizeof bytes);
    for (size_t i = 0; i < n; i++)
        s->wrong |= bytes[i] != byte_of(1 - end, seen->rx_taken + (int32_t)i);
    seen->rx_taken += (int32_t)n;
    s->got[end] += (int64_t)n;
    for (int32_t k = 0; k < 200; k++) {
        const uint8_t byte = byte_of(end, seen->tx_count);
        s->sent[end] +=
            (int64_t)byte_ring_put(seen->tx_words, &seen->tx_count, shown->tx_taken, &byte, 1);
    }
}

/* An instant: both ends see the link, then the link sees them. */
static void instant(struct ethernet *e, struct ends *s, int64_t now)
{
    for (int i = 0; i < ETHERNET_ENDS; i++) {
        if (e->connection != s->connection || !e->connection)
            s->seen[i].tx_count = s->seen[i].rx_taken = 0;
        if (e->connection)
            act(s, i, e);
    }
    s->connection = e->connection;
    ethernet_instant(e, now, now + PERIOD, s->seen);
}

static void both_want(struct ends *s)
{
    memset(s, 0, sizeof *s);
    s->seen[0].wants = s->seen[1].wants = true;
}

static int64_t run_until(struct ethernet *e, struct ends *s, int64_t now, int64_t end)
{
    for (; now < end; now += PERIOD)
        instant(e, s, now);
    return now;
}

/* It takes its time from the first instant on, whenever that is, and after each end of one. */
static void check_connect_time(void)
{
    for (int64_t first = 0; first < 50 * PERIOD; first += 49 * PERIOD) {
        struct ethernet e;
        struct ends s;
        both_want(&s);
        ethernet_start(&e, &quick);
        int64_t now = run_until(&e, &s, first, first + 3 * PERIOD);
        CHECK_EQ(e.connection, 0);
        now = run_until(&e, &s, now, now + PERIOD);
        CHECK_EQ(e.connection, 1);
        s.seen[0].wants = false;
        now = run_until(&e, &s, now, now + PERIOD);
        s.seen[0].wants = true;
        now = run_until(&e, &s, now, now + 3 * PERIOD);
        CHECK_EQ(e.connection, 0);
        run_until(&e, &s, now, now + PERIOD);
        CHECK_EQ(e.connection, 2);
    }
}

/* A cut while one comes about begins that anew, however short the ends are kept apart; it may be
 * due a nanosecond behind the start. */
static void check_cut_while_connecting(void)
{
    struct ethernet_config c = quick;
    struct ethernet e;
    struct ends s;
    both_want(&s);
    c.away = 0;
    c.cut_at[0] = 1;
    ethernet_start(&e, &c);
    run_until(&e, &s, 0, 2 * PERIOD);
    CHECK_EQ(e.cuts, 1);
    run_until(&e, &s, 2 * PERIOD, 5 * PERIOD);
    CHECK_EQ(e.connection, 0);
    run_until(&e, &s, 5 * PERIOD, 6 * PERIOD);
    CHECK_EQ(e.connection, 1);
}

/* A connection comes about once both ends have wanted it for so long without a break. */
static void check_connect(void)
{
    struct ethernet e;
    struct ends s;
    both_want(&s);
    ethernet_start(&e, &quick);
    for (int end = 0; end < ETHERNET_ENDS; end++) {
        s.seen[end].wants = false;
        run_until(&e, &s, 0, 10 * PERIOD);
        CHECK_EQ(e.connection, 0);
        s.seen[end].wants = true;
    }
    run_until(&e, &s, 10 * PERIOD, 13 * PERIOD);
    CHECK_EQ(e.connection, 0);
    s.seen[1].wants = false;
    run_until(&e, &s, 13 * PERIOD, 14 * PERIOD);
    s.seen[1].wants = true;
    run_until(&e, &s, 14 * PERIOD, 17 * PERIOD);
    CHECK_EQ(e.connection, 0);
    run_until(&e, &s, 17 * PERIOD, 18 * PERIOD);
    CHECK_EQ(e.connection, 1);
    /* Either end that wants it no more ends it, and all counts are 0 then. */
    for (int end = 0; end < ETHERNET_ENDS; end++) {
        int64_t now = run_until(&e, &s, 18 * PERIOD, 40 * PERIOD);
        CHECK_EQ(e.connection, 1 + end);
        CHECK(s.got[0] > 0 && s.got[1] > 0 && !s.wrong);
        s.seen[end].wants = false;
        now = run_until(&e, &s, now, now + PERIOD);
        CHECK_EQ(e.connection, 0);
        for (int i = 0; i < ETHERNET_ENDS; i++) {
            CHECK_EQ(e.shown[i].rx_count, 0);
            CHECK_EQ(e.shown[i].tx_taken, 0);
            CHECK_EQ(e.pipe[i].held, 0);
        }
        s.seen[end].wants = true;
    }
    CHECK_EQ(e.cuts, 0);
    CHECK_EQ(e.faults, 0);
}

/* None comes about while an end shows a count of the one before. */
static void check_let_go(void)
{
    for (int what = 0; what < 4; what++) {
        struct ethernet e;
        struct ends s;
        both_want(&s);
        ethernet_start(&e, &quick);
        int32_t *count = what % 2 ? &s.seen[what / 2].tx_count : &s.seen[what / 2].rx_taken;
        for (int64_t k = 0; k < 9; k++) {
            *count = 1;
            ethernet_instant(&e, k * PERIOD, (k + 1) * PERIOD, s.seen);
        }
        CHECK_EQ(e.connection, 0);
        *count = 0;
        for (int64_t k = 9; k < 12; k++)
            ethernet_instant(&e, k * PERIOD, (k + 1) * PERIOD, s.seen);
        CHECK_EQ(e.connection, 0);
        ethernet_instant(&e, 12 * PERIOD, 13 * PERIOD, s.seen);
        CHECK_EQ(e.connection, 1);
    }
}

/* The last number of a connection is taken once. */
static void check_last_number(void)
{
    struct ethernet e;
    struct ends s;
    both_want(&s);
    ethernet_start(&e, &quick);
    e.connections = INT32_MAX - 1;
    run_until(&e, &s, 0, 10 * PERIOD);
    CHECK_EQ(e.connection, INT32_MAX);
    s.seen[0].wants = false;
    run_until(&e, &s, 10 * PERIOD, 11 * PERIOD);
    s.seen[0].wants = true;
    run_until(&e, &s, 11 * PERIOD, 40 * PERIOD);
    CHECK_EQ(e.connection, 0);
}

/* A cut comes at the first instant that is not before its time, in each of its eight places, and
 * keeps both apart for `away`; then the connection takes its time again. */
static void check_cut_at(void)
{
    for (int place = 0; place < ETHERNET_CUTS; place++) {
        for (int64_t early = -1; early <= 1; early++) {
            struct ethernet_config c = quick;
            struct ethernet e;
            struct ends s;
            both_want(&s);
            c.cut_at[place] = 20 * PERIOD + early;
            ethernet_start(&e, &c);
            const int64_t at = (early > 0 ? 21 : 20) * PERIOD;
            run_until(&e, &s, 0, at);
            CHECK_EQ(e.connection, 1);
            run_until(&e, &s, at, at + PERIOD);
            CHECK_EQ(e.connection, 0);
            CHECK_EQ(e.pipe[0].held + e.pipe[1].held, 0);
            run_until(&e, &s, at + PERIOD, at + 8 * PERIOD);
            CHECK_EQ(e.connection, 0);
            run_until(&e, &s, at + 8 * PERIOD, at + 9 * PERIOD);
            CHECK_EQ(e.connection, 2);
            run_until(&e, &s, at + 9 * PERIOD, at + 50 * PERIOD);
            CHECK_EQ(e.connection, 2);
            CHECK_EQ(e.cuts, 1);
        }
    }
}

/* The end gets this many bytes over all connections, all of them, and the cut. Of several the
 * nearest comes first. */
static void check_cut_behind(int end, int64_t first)
{
    for (int place = 0; place < ETHERNET_CUTS; place++) {
        struct ethernet_config c = quick;
        struct ethernet e;
        struct ends s;
        int64_t at_cut[3] = { 0 };
        both_want(&s);
        c.cut_behind[end][place] = 1700;
        c.cut_behind[end][(place + 1) % ETHERNET_CUTS] = first;
        c.cut_behind[end][(place + 2) % ETHERNET_CUTS] = SENT;
        ethernet_start(&e, &c);
        for (int64_t k = 0; k < 400; k++) {
            const uint32_t cuts = e.cuts;
            instant(&e, &s, k * PERIOD);
            if (e.cuts > cuts && e.cuts <= 3)
                at_cut[e.cuts - 1] = s.got[end];
        }
        CHECK_EQ(e.cuts, 3);
        CHECK_EQ(at_cut[0], first);
        CHECK_EQ(at_cut[1], 1700);
        CHECK_EQ(at_cut[2], SENT);
        CHECK(!s.wrong);
        CHECK_EQ(e.faults, 0);
        CHECK_EQ(s.got[end] + e.shown[end].rx_count - s.seen[end].rx_taken, e.pipe[end].passed);
    }
}

/* Counts that cannot be end the connection and count once; the last ones that can be do not. */
static void check_faults(void)
{
    for (int what = 0; what < 8; what++) {
        const int end = what % 2;
        const bool taken = what / 2 % 2, far = what / 4 % 2;
        struct ethernet e;
        struct ends s;
        both_want(&s);
        ethernet_start(&e, &quick);
        int64_t now = 0;
        while (e.connection == 0) {
            ethernet_instant(&e, now, now + PERIOD, s.seen);
            now += PERIOD;
        }
        int32_t *count = taken ? &s.seen[end].rx_taken : &s.seen[end].tx_count;
        *count = taken ? e.shown[end].rx_count : BYTE_RING_BYTES;
        ethernet_instant(&e, now, now + PERIOD, s.seen);
        CHECK_EQ(e.faults, 0);
        CHECK_EQ(e.connection, 1);
        const int32_t before = taken ? e.shown[end].rx_count : e.shown[end].tx_taken;
        *count = far ? -1 : taken ? before + 1 : before + BYTE_RING_BYTES + 1;
        ethernet_instant(&e, now + PERIOD, now + 2 * PERIOD, s.seen);
        CHECK_EQ(e.faults, 1);
        CHECK_EQ(e.connection, 0);
        CHECK_EQ(e.cuts, 0);
    }
}

/* An end that takes nothing gets a ring full, and the pipe to it a buffer full; then all goes
 * on. */
static void check_slow_reader(void)
{
    struct ethernet e;
    struct ends s;
    both_want(&s);
    ethernet_start(&e, &quick);
    struct ethernet_seen *card = &s.seen[ETHERNET_CARD];
    int32_t held = 0;
    for (int64_t k = 0; k < 300; k++) {
        const struct ethernet_shown *shown = &e.shown[ETHERNET_HOST];
        if (e.connection)
            act(&s, ETHERNET_HOST, &e);
        held = s.seen[ETHERNET_HOST].tx_count - shown->tx_taken;
        ethernet_instant(&e, k * PERIOD, (k + 1) * PERIOD, s.seen);
    }
    CHECK_EQ(e.shown[ETHERNET_CARD].rx_count, BYTE_RING_BYTES);
    CHECK_EQ(e.pipe[ETHERNET_CARD].held, ETHER_BUFFER);
    CHECK_EQ(held, BYTE_RING_BYTES);
    s.connection = e.connection;
    for (int64_t k = 300; k < 600; k++)
        instant(&e, &s, k * PERIOD);
    CHECK(!s.wrong);
    CHECK(card->rx_taken > 2 * ETHER_BUFFER);
    CHECK_EQ(e.faults, 0);
}

/* No two ends of any links draw the same jitter, as far as seeds of 0 to 99 go; and what a seed
 * draws stays that, or kept results could not be had again. */
static void check_seeds(void)
{
    uint64_t all[200];
    for (int i = 0; i < 200; i++) {
        struct ethernet_config c = quick;
        struct ethernet e;
        c.seed = (uint64_t)(i / 2);
        ethernet_start(&e, &c);
        all[i] = e.pipe[i % 2].random;
        CHECK(all[i] != 0);
        for (int k = 0; k < i; k++)
            CHECK(all[k] != all[i]);
    }
    CHECK(all[0] == UINT64_C(0x9E3779B97F4A7C15));
    CHECK(all[5] == UINT64_C(0xB54CDA58FBBEE87F));
}

int main(void)
{
    check_connect_time();
    check_cut_while_connecting();
    check_connect();
    check_let_go();
    check_last_number();
    check_cut_at();
    for (int end = 0; end < ETHERNET_ENDS; end++) {
        check_cut_behind(end, 401);
        check_cut_behind(end, 1);
    }
    check_faults();
    check_slow_reader();
    check_seeds();
    return check_result();
}
