/* Wherever the axes stand, a start brings them to where the job begins, then plays it: the path is
 * the same each time. The rest event is put out when a job is given up. */
#include "card_bench.h"

enum { TOOL_DOWN = 1, TOOL = 8 }; /* event; output 3 */
static const struct job_event events[] = { { TOOL, 0, 1, 0 }, { TOOL, 0, 0, 0 } };
static const int64_t MOST = 6000; /* [ms] of any run */

static struct netcard c, copy;

static void begin(void)
{
    struct netcard_config config = bench_config();

    for (int i = 0; i < CARD_AXES; i++) {
        config.settings.speed_max[i] = 50000;
        config.settings.acc_max[i] = 2000000;
    }
    config.settings.home_order[1] = config.settings.home_order[2] = 0;
    config.settings.home_order[3] = 0;
    bench_rest = 2;
    bench_make(1000, 100, events, 2);
    bench_rest = 0;
    bench_start(&c, &config);
}

static bool tool_on(void)
{
    return (c.outputs.levels & TOOL) != 0;
}

/* On the job's path at each of its frames, within what 20 us move. */
static void on_the_path(void)
{
    const int64_t k = netcard_frames(&c) - 1;

    for (int i = 0; i < 2 && k >= 0 && c.state == NET_RUNNING; i++) {
        const int64_t off = netcard_position(&c, i) - bench_path[k][i];
        CHECK(llabs(off) <= llabs(bench_path[k < 999 ? k + 1 : k][i] - bench_path[k][i]) + 1
              || k == 999);
    }
}

/* Runs until the state is another one, or the time is over; returns the last frame seen. */
static int64_t play(int64_t ms)
{
    const enum net_state state = c.state;
    const int64_t end = c.now + ms * BENCH_MS;
    int64_t was = 0;

    while (c.state == state && c.now < end) {
        netcard_advance(&c, c.now + 20000);
        if (c.phase > JOB_READING && netcard_frames(&c) != was) {
            CHECK(netcard_frames(&c) == was + 1 || was == 0);
            was = netcard_frames(&c);
            on_the_path();
        }
        CHECK(!c.approach || !tool_on());
    }
    return was;
}

static void plays_all(void)
{
    CHECK_EQ(c.state, NET_RUNNING);
    CHECK_EQ(play(MOST), 1000);
    CHECK_EQ(c.state, NET_READY);
    for (int i = 0; i < CARD_AXES; i++) {
        CHECK_EQ(netcard_position(&c, i), bench_end[i]);
    }
    CHECK_EQ(c.player.dry, 0);
    bench_times(&c);
}

static void start(void)
{
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
}

/* Starts in a row, and behind a stop in mid-line: with the tool at rest from its end on. */
static void comes_back(void)
{
    begin();
    start();
    play(3);
    CHECK(!c.approach);
    plays_all();
    CHECK(tool_on()); /* the job leaves it so */
    for (int stop = 0; stop < 3; stop++) {
        start();
        play(3);
        CHECK(c.approach && !tool_on());
        while (stop && netcard_frames(&c) < 300 * stop && c.state == NET_RUNNING) {
            bench_pass(&c, 1);
        }
        if (stop) {
            CHECK(tool_on());
            CHECK_EQ(bench_order(&c, CARD_DO_STOP), NET_DONE);
            while (c.state == NET_STOPPING) {
                CHECK(tool_on());
                netcard_advance(&c, c.now + 20000);
            }
            netcard_advance(&c, c.now + 20000);
            CHECK_EQ(c.state, NET_READY);
            CHECK(!tool_on());
            start();
        }
        plays_all();
    }
}

/* The tool's axes come first; each axis within its speed and acceleration, nearly as fast as they
 * allow: v / a + d / v for each of the two ways. */
static void keeps_the_limits(void)
{
    static const int64_t AT[] = { 20000, -3000, 7000, -5000 };
    const double v = 50.0, a = 2.0 * 0.9; /* [pulses/ms, /ms^2] */
    int64_t was[CARD_AXES], step[CARD_AXES] = { 0 };

    begin();
    for (int i = 0; i < CARD_AXES; i++) {
        c.zero[i] = -AT[i];
        was[i] = AT[i];
    }
    start();
    while (!c.player.begun) {
        netcard_advance(&c, c.now + 20);
    }
    const int64_t from = c.now;
    while (c.approach) {
        bench_pass(&c, 1);
        const bool tool = was[2] != 0 || was[3] != 0;
        for (int i = 0; c.approach && i < CARD_AXES; i++) {
            const int64_t now = netcard_position(&c, i), move = now - was[i];
            CHECK(llabs(move) <= 51);
            CHECK(llabs(move - step[i]) <= 5); /* of whole pulses: a + 3 */
            CHECK(!tool || i >= 2 || move == 0);
            CHECK(move == 0 || (move > 0) == (AT[i] < 0));
            step[i] = move;
            was[i] = now;
        }
    }
    const double ideal = 2.0 * v / a + (7000.0 + 20000.0) / v;
    const double took = (double)(c.now - from) * 1e-6;
    printf("approach %.0f ms, ideal %.0f ms\n", took, ideal);
    CHECK(took > 0.99 * ideal && took < 1.03 * ideal + 3.0);
    plays_all();
}

/* In mid-approach. */
static void begin_approach(void)
{
    begin();
    start();
    plays_all();
    start();
    bench_pass(&c, 200);
    CHECK(c.approach);
    CHECK_EQ(c.state, NET_RUNNING);
}

static void can_be_paused(void)
{
    begin_approach();
    for (int i = 0; i < 3; i++) {
        CHECK_EQ(bench_order(&c, CARD_DO_PAUSE), NET_DONE);
        bench_pass(&c, 300);
        CHECK_EQ(c.state, NET_PAUSED);
        const int64_t at = bench_count(&c, 0);
        bench_pass(&c, 100);
        CHECK_EQ(bench_count(&c, 0), at);
        start();
        bench_pass(&c, 20 * i);
        CHECK(c.approach);
    }
    plays_all();
    CHECK_EQ(c.jobs, 2);
}

/* A stop, homing, a limit, the emergency stop: each ends it, and a new start comes back. */
static void can_be_given_up(void)
{
    for (int how = 0; how < 4; how++) {
        begin_approach();
        if (how == 0) {
            CHECK_EQ(bench_order(&c, CARD_DO_STOP), NET_DONE);
            bench_pass(&c, 300);
        } else if (how == 1) {
            CHECK_EQ(bench_order(&c, CARD_DO_HOME), NET_DONE);
            bench_pass(&c, 600);
            CHECK_EQ(c.state, NET_HOMING);
            CHECK_EQ(bench_order(&c, CARD_DO_STOP), NET_DONE);
            bench_pass(&c, 300);
        } else {
            netcard_set_axes(&c, &(struct netcard_axes){ .minus = how == 2, .stop = how == 3 });
            CHECK_EQ(c.state, NET_FAULT);
            CHECK_EQ(c.error, how == 2 ? NET_LIMIT : NET_ALARM);
            netcard_set_axes(&c, &(struct netcard_axes){ .stop = false });
            CHECK_EQ(bench_order(&c, CARD_DO_RESET), NET_DONE);
        }
        CHECK_EQ(c.state, NET_READY);
        const int64_t at = bench_count(&c, 0);
        bench_pass(&c, 300);
        CHECK_EQ(bench_count(&c, 0), at);
        CHECK_EQ(netcard_frames(&c), how == 1 ? c.player.frames : 0);
        start();
        plays_all();
    }
}

/* With the tool on: homing puts it out at rest, the emergency stop at once, a pause does not. */
static void puts_the_tool_out(void)
{
    for (int how = 0; how < 3; how++) {
        begin();
        start();
        bench_pass(&c, 400);
        CHECK(tool_on());
        if (how == 0) {
            CHECK_EQ(bench_order(&c, CARD_DO_PAUSE), NET_DONE);
            bench_pass(&c, 400);
            CHECK_EQ(c.state, NET_PAUSED);
            CHECK(tool_on());
            CHECK_EQ(bench_order(&c, CARD_DO_STOP), NET_DONE);
            netcard_advance(&c, c.now + 100000);
        } else if (how == 1) {
            CHECK_EQ(bench_order(&c, CARD_DO_HOME), NET_DONE);
            while (!player_at_rest(&c.player)) {
                CHECK(tool_on());
                netcard_advance(&c, c.now + 20000);
            }
            netcard_advance(&c, c.now + 100000);
            CHECK_EQ(c.state, NET_HOMING);
        } else {
            netcard_set_axes(&c, &(struct netcard_axes){ .stop = true });
            netcard_advance(&c, c.now + 20000);
        }
        CHECK(!tool_on());
    }
}

/* The tool goes on at the very clock of an emergency stop: it is off behind it. */
static void loses_no_race(void)
{
    begin();
    start();
    while (netcard_frames(&c) < 100) {
        bench_pass(&c, 1);
    }
    memcpy(&copy, &c, sizeof c);
    while (!(c.told.events & 1u << TOOL_DOWN)) {
        netcard_advance(&c, c.now + 20);
    }
    const int64_t then = c.now;
    for (int64_t off = -40; off < 8000; off += 20) {
        memcpy(&c, &copy, sizeof c);
        netcard_advance(&c, then + off);
        netcard_set_axes(&c, &(struct netcard_axes){ .stop = true });
        bench_pass(&c, 1);
        CHECK(!tool_on());
    }
}

/* A state taken in the approach goes on to the same bits, in other steps. */
static void divides(void)
{
    begin_approach();
    memcpy(&copy, &c, sizeof c);
    const int64_t end = c.now + 2200 * BENCH_MS;
    netcard_advance(&c, end);
    while (copy.now < end) {
        const int64_t to = copy.now + 1237913;
        netcard_advance(&copy, to < end ? to : end);
    }
    CHECK(!c.approach && netcard_frames(&c) > 0);
    CHECK_EQ(memcmp(&c, &copy, sizeof c), 0);
}

/* The document's scheme plays from where it is. */
static void literal_does_not(void)
{
    begin();
    c.settings.policy = CARD_LITERAL;
    for (int i = 1; i < 3; i++) {
        start();
        bench_pass(&c, 1200);
        CHECK_EQ(c.state, NET_READY);
        CHECK_EQ(bench_count(&c, 0), i * bench_end[0]);
    }
}

int main(void)
{
    comes_back();
    keeps_the_limits();
    can_be_paused();
    can_be_given_up();
    puts_the_tool_out();
    loses_no_race();
    divides();
    literal_does_not();
    return check_result();
}
