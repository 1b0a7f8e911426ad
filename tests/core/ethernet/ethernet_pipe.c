/* One way over Ethernet: when each segment arrives, by the line's arithmetic; jitter, losses and
 * content by counting. */
#include <string.h>

#include "check.h"
#include "ether_pipe.h"

static const int64_t SECOND = 1000000000;

static const struct ether_config plain = {
    .rate = 100000000, .delay = 700, .segment = 536, .overhead = 78
};

static void put(struct ether_pipe *p, size_t n)
{
    static uint8_t count;
    uint8_t byte;
    for (size_t i = 0; i < n; i++) {
        byte = count++;
        ether_pipe_put(p, &byte, 1);
    }
}

static size_t get(struct ether_pipe *p, int64_t now)
{
    uint8_t bytes[ETHER_BUFFER];
    return ether_pipe_get(p, now, bytes, sizeof bytes);
}

/* So many bytes come at this instant, and none before it. */
static void check_arrival(struct ether_pipe *p, int64_t at, size_t bytes)
{
    CHECK_EQ(get(p, at - 1), 0);
    CHECK_EQ(get(p, at), bytes);
}

/* At 100 Mbit/s a byte takes 80 ns, so 536 + 78 of them 49,120 ns. */
static void check_line(void)
{
    struct ether_pipe p;
    ether_pipe_start(&p, 1);
    put(&p, 1100);
    ether_pipe_send(&p, &plain, 1000, 1000 + SECOND);
    check_arrival(&p, 1000 + 49120 + 700, 536);
    check_arrival(&p, 1000 + 2 * 49120 + 700, 536);
    check_arrival(&p, 1000 + 2 * 49120 + (28 + 78) * 80 + 700, 28);
    CHECK_EQ(p.passed, 1100);
    /* The line is free again before these are put. */
    put(&p, 1);
    ether_pipe_send(&p, &plain, SECOND, 2 * SECOND);
    check_arrival(&p, SECOND + 79 * 80 + 700, 1);
}

/* A segment starts if the line is free before the next instant, not at it. */
static void check_starts(void)
{
    struct ether_pipe p;
    ether_pipe_start(&p, 1);
    put(&p, 3 * 536);
    ether_pipe_send(&p, &plain, 0, 49120);
    CHECK_EQ(p.segments, 1);
    ether_pipe_send(&p, &plain, 0, 49121);
    CHECK_EQ(p.segments, 2);
    ether_pipe_send(&p, &plain, 90000, 98240);
    CHECK_EQ(p.segments, 2);
    ether_pipe_send(&p, &plain, 98240, 98241);
    CHECK_EQ(p.segments, 3);
    CHECK_EQ(get(&p, 2 * 49120 + 700), 2 * 536);
    check_arrival(&p, 3 * 49120 + 700, 536);
}

/* A line of 3 bit/s takes a third of a second for a bit, up to the next whole nanosecond. */
static void check_rounds_up(void)
{
    const struct ether_config slow = { .rate = 3, .segment = 2, .overhead = 0 };
    struct ether_pipe p;
    ether_pipe_start(&p, 1);
    put(&p, 1);
    ether_pipe_send(&p, &slow, 0, 1);
    check_arrival(&p, 2666666667, 1);
    ether_pipe_clear(&p, 0);
    put(&p, 2);
    ether_pipe_send(&p, &slow, 0, 1);
    check_arrival(&p, 5333333334, 2);
    const struct ether_config even = { .rate = 8, .segment = 1, .overhead = 2 };
    ether_pipe_clear(&p, 0);
    put(&p, 1);
    ether_pipe_send(&p, &even, 0, 1);
    check_arrival(&p, 3 * SECOND, 1);
}

/* What comes later than 0 .. jitter on top, each of these equally often: 10,000 segments are
 * within five standard deviations of their share. */
static void check_jitter(void)
{
    struct ether_config c = plain;
    struct ether_pipe p;
    int times[5] = { 0 };
    c.jitter = 4;
    ether_pipe_start(&p, 5);
    for (int i = 0; i < 10000; i++) {
        ether_pipe_clear(&p, 0);
        put(&p, 1);
        ether_pipe_send(&p, &c, 0, 1);
        const int64_t late = p.segment[p.first_segment].arrival - 79 * 80 - 700;
        CHECK(late >= 0 && late <= 4);
        if (late >= 0 && late <= 4)
            times[late]++;
    }
    for (int i = 0; i < 5; i++)
        CHECK_NEAR(times[i], 2000, 5 * sqrt(2000 * 0.8));
}

/* A state whose second draw of a million is `want`; the first is the jitter's. */
static uint64_t before_draw(int64_t want)
{
    uint64_t two[2] = { 1, 1 }, state = 1;
    while (check_random(&state, 0, 999999) != want || two[0] == 1) {
        two[0] = two[1];
        two[1] = state;
    }
    return two[0];
}

/* A loss of n of a million takes the draws 0 .. n - 1: a stall, behind which the others wait. */
static void check_loss(void)
{
    static const struct {
        int64_t draw, loss;
        bool lost;
    } all[] = {
        { 0, 0, false },           { 0, 1, true },
        { 1, 1, false },           { 1, 2, true },
        { 499999, 500000, true },  { 500000, 500000, false },
        { 999999, 999999, false }, { 999999, 1000000, true },
    };
    struct ether_config c = plain;
    c.stall = SECOND;
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        struct ether_pipe p;
        ether_pipe_start(&p, 1);
        p.random = before_draw(all[i].draw);
        c.loss = all[i].loss;
        put(&p, 536);
        ether_pipe_send(&p, &c, 0, 1);
        CHECK_EQ(p.stalls, all[i].lost);
        c.loss = 0;
        put(&p, 536);
        ether_pipe_send(&p, &c, 0, SECOND);
        if (all[i].lost) {
            check_arrival(&p, 49120 + 700 + SECOND, 2 * 536);
        } else {
            check_arrival(&p, 49120 + 700, 536);
            check_arrival(&p, 2 * 49120 + 700, 536);
        }
        ether_pipe_clear(&p, 5);
        CHECK_EQ(p.stalls, all[i].lost);
    }
}

/* Both bounds of a pipe, 64 segments and 16,384 bytes, and that they move on as bytes leave it. */
static void check_full(void)
{
    struct ether_config c = plain;
    struct ether_pipe p;
    c.segment = 1;
    ether_pipe_start(&p, 1);
    put(&p, 10);
    CHECK_EQ(ether_pipe_room(&p), ETHER_BUFFER - 10);
    put(&p, ETHER_BUFFER - 10);
    CHECK_EQ(ether_pipe_room(&p), 0);
    ether_pipe_send(&p, &c, 0, SECOND);
    CHECK_EQ(p.segments, ETHER_SEGMENTS);
    CHECK_EQ(get(&p, SECOND), ETHER_SEGMENTS);
    CHECK_EQ(ether_pipe_room(&p), ETHER_SEGMENTS);
    ether_pipe_send(&p, &c, SECOND, 2 * SECOND);
    CHECK_EQ(p.segments, ETHER_SEGMENTS);
    /* Nothing of it is left behind a clear, which keeps what passed; the line is free at once. */
    ether_pipe_clear(&p, 3 * SECOND);
    CHECK_EQ(ether_pipe_room(&p), ETHER_BUFFER);
    CHECK_EQ(get(&p, 9 * SECOND), 0);
    CHECK_EQ(p.passed, ETHER_SEGMENTS);
    ether_pipe_start(&p, 1);
    put(&p, 2);
    ether_pipe_send(&p, &c, 50 * SECOND, 60 * SECOND);
    ether_pipe_clear(&p, 7 * SECOND);
    put(&p, 1);
    ether_pipe_send(&p, &c, 7 * SECOND, 8 * SECOND);
    check_arrival(&p, 7 * SECOND + 79 * 80 + 700, 1);
}

/* Bytes put, sent and got at random are all there, in order, however often the buffer wraps. */
static void check_content(void)
{
    struct ether_config c = plain;
    struct ether_pipe p;
    uint64_t seed = 3;
    uint8_t bytes[2000], in = 0, out = 0;
    int64_t now = 0, put_in = 0, got = 0;
    c.jitter = 100000, c.loss = 20000, c.stall = 2000000;
    ether_pipe_start(&p, 9);
    for (int i = 0; i < 3000; i++) {
        const size_t room = ether_pipe_room(&p), asked = (size_t)check_random(&seed, 0, 2000);
        const size_t n = asked < room ? asked : room;
        for (size_t k = 0; k < n; k++)
            bytes[k] = in = (uint8_t)(in * 5 + 1);
        ether_pipe_put(&p, bytes, n);
        put_in += (int64_t)n;
        c.segment = (int32_t)check_random(&seed, 1, 1460);
        ether_pipe_send(&p, &c, now, now + 100000);
        const size_t most = (size_t)check_random(&seed, 0, 2000);
        const size_t came = ether_pipe_get(&p, now, bytes, most);
        CHECK(came <= most);
        for (size_t k = 0; k < came; k++)
            CHECK_EQ(bytes[k], out = (uint8_t)(out * 5 + 1));
        got += (int64_t)came;
        CHECK_EQ(p.passed, got);
        CHECK_EQ(ether_pipe_room(&p), ETHER_BUFFER - (put_in - got));
        now += 100000;
    }
    CHECK(got > 20 * ETHER_BUFFER);
}

int main(void)
{
    check_line();
    check_starts();
    check_rounds_up();
    check_jitter();
    check_loss();
    check_full();
    check_content();
    return check_result();
}
