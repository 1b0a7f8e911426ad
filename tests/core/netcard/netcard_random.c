/* Commands at random under the table: a literal copy of it says what each one does; nothing moves
 * behind stop, home, fault without a new start; at each stop of the clock the most urgent ready
 * task has the processor and all times add up; cut at random places the run is the same to the
 * bit. */
#include "card_bench.h"

enum { CARDS = 20, STEPS = 60 };

static struct netcard c, twin;
static uint64_t seed;

static uint32_t draw(uint32_t below)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(seed >> 33) % below;
}

/* Codes of START PAUSE STOP HOME RESET in each state, as the README tells. */
static const char *const codes[] = {
    [NET_EMPTY] = "43000",   [NET_READY] = "03000",  [NET_RUNNING] = "30003",
    [NET_PAUSING] = "00003", [NET_PAUSED] = "00003", [NET_STOPPING] = "33033",
    [NET_HOMING] = "30033",  [NET_FAULT] = "AA0A0"
};

static enum net_code wanted(enum net_state state, enum card_command command)
{
    const char code = codes[state][command];
    return code == 'A' ? NET_ALARM : (enum net_code)(code - '0');
}

/* May the axes move, and where from? */
static bool may_move(void)
{
    return card_state_moves(c.state);
}

static void pass(int64_t ns)
{
    int64_t before = bench_count(&c, 0);
    bool could = may_move();

    for (const int64_t end = c.now + ns; c.now < end;) {
        const int64_t slice = 50000 + draw(2000000);
        const uint32_t origin = bench_count(&c, 0) <= -200;
        if (origin != (c.axes.origin & 1)) {
            netcard_set_axes(&c, &(struct netcard_axes){ .origin = origin, .stop = c.axes.stop });
            netcard_set_axes(&twin,
                             &(struct netcard_axes){ .origin = origin, .stop = c.axes.stop });
        }
        const int64_t to = c.now + slice < end ? c.now + slice : end;
        netcard_advance(&twin, to);
        while (c.now < to) { /* in pieces */
            const int64_t piece = c.now + 1 + draw(1000000);
            netcard_advance(&c, piece < to ? piece : to);
            bench_urgent(&c.kernel);
        }
        const int64_t now = bench_count(&c, 0);
        if (!could && !may_move()) {
            CHECK_EQ(now, before);
        }
        before = now;
        could = may_move();
    }
    bench_times(&c);
}

static void same(void)
{
    CHECK_EQ(memcmp(&c, &twin, sizeof c), 0);
}

/* Whatever came before: a stop, a start, and all of the job from its place. */
static void plays_whole(void)
{
    netcard_set_axes(&c, &(struct netcard_axes){ .stop = false });
    bench_order(&c, CARD_DO_STOP);
    bench_pass(&c, 600);
    bench_order(&c, CARD_DO_RESET);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    bench_pass(&c, 2000);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(netcard_position(&c, 0), bench_end[0]);
    CHECK_EQ(netcard_position(&c, 1), bench_end[1]);
}

static void play(void)
{
    struct netcard_config config = bench_config();
    int starts = 0;

    config.settings.home_order[1] = config.settings.home_order[2] = 0;
    config.settings.home_order[3] = 0;
    config.settings.home_back[0] = 50 + (int32_t)draw(200);
    config.settings.fifo_depth = 32 + (int32_t)draw(480);
    bench_make(50 + (int32_t)draw(400), 20 + (int32_t)draw(80), NULL, 0);
    bench_start(&c, &config);
    bench_start(&twin, &config);
    pass(BENCH_MS);
    for (int i = 0; i < STEPS; i++) {
        if (draw(25) == 0) {
            const bool stop = !c.axes.stop && draw(3) == 0;
            const struct netcard_axes a = { .origin = c.axes.origin, .stop = stop };
            netcard_set_axes(&c, &a);
            netcard_set_axes(&twin, &a);
            CHECK(!stop || c.state == NET_FAULT);
        }
        const enum card_command command =
            (enum card_command)(draw(100) < 45 ? CARD_DO_START : draw(CARD_DO_RESET + 1));
        const int32_t before = c.result.count;
        enum net_state state = c.state;
        CHECK(netcard_command(&c, command, 1));
        CHECK(netcard_command(&twin, command, 1));
        while (c.result.count == before) {
            state = c.state;
            netcard_advance(&c, c.now + 1);
        }
        for (int k = 0; k < 400; k++) { /* what the tasks do about it, in small pieces */
            netcard_advance(&c, c.now + 250);
        }
        netcard_advance(&twin, c.now);
        enum net_code code = wanted(state, command);
        if (command == CARD_DO_RESET && state == NET_FAULT && c.axes.stop) {
            code = NET_ALARM;
        }
        CHECK_EQ(c.result.code, code);
        starts += command == CARD_DO_START && code == NET_DONE && state == NET_READY;
        CHECK(c.jobs <= starts);
        pass((1 + draw(draw(4) == 0 ? 500 : 40)) * BENCH_MS);
        CHECK(c.jobs == starts || c.state != NET_RUNNING);
    }
    same();
    plays_whole();
}

int main(void)
{
    for (int i = 0; i < CARDS; i += CHECK_EACH) {
        const int before = check_failures;
        seed = (uint64_t)i;
        play();
        if (check_failures > before) {
            printf("card %d\n", i);
            break;
        }
    }
    return check_result();
}
