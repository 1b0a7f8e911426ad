/* What comes in by wires and goes out: homing on a switch, limits, alarms, inputs, outputs of a
 * job, the loss of power. */
#include "card_bench.h"

static struct netcard c;
static const int64_t SWITCH = -1234; /* [pulses] origin switch of axis X: on from here down */

static void wires(bool stop)
{
    const uint32_t origin = bench_count(&c, 0) <= SWITCH;

    netcard_set_axes(&c, &(struct netcard_axes){ .origin = origin, .stop = stop });
}

static void pass(int64_t us, bool stop)
{
    for (int64_t i = 0; i < us / 20; i++) {
        wires(stop);
        netcard_advance(&c, c.now + 20000);
    }
}

static struct netcard_config one_axis(void)
{
    struct netcard_config config = bench_config();

    config.settings.home_order[1] = config.settings.home_order[2] = 0;
    config.settings.home_order[3] = 0;
    config.settings.home_back[0] = 300;
    config.settings.home_offset[0] = 77;
    return config;
}

/* Homing ends 77 pulses from the switch's edge, wherever it began and was paused; a job that runs
 * is given up for it. */
static void goes_home(void)
{
    const struct netcard_config config = one_axis();

    bench_make(3000, 100, NULL, 0);
    for (int from = 0; from < 2; from++) {
        bench_start(&c, &config);
        if (from) {
            CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
            pass(300000, false);
            CHECK_EQ(c.state, NET_RUNNING);
        }
        CHECK_EQ(bench_order(&c, CARD_DO_HOME), NET_DONE);
        CHECK_EQ(c.state, NET_HOMING);
        pass(200000, false);
        CHECK_EQ(bench_order(&c, CARD_DO_PAUSE), NET_DONE);
        pass(200000, false);
        CHECK_EQ(c.state, NET_PAUSED);
        const int64_t at = bench_count(&c, 0);
        pass(50000, false);
        CHECK_EQ(bench_count(&c, 0), at);
        CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
        for (int i = 0; i < 400 && c.state == NET_HOMING; i++) {
            pass(10000, false);
        }
        CHECK_EQ(c.state, NET_READY);
        CHECK_EQ(c.homed, 1);
        CHECK_NEAR((double)(bench_count(&c, 0) - SWITCH), 77.0, 1.0);
        CHECK_EQ(netcard_position(&c, 0), 0);
        const int64_t rest = bench_count(&c, 0);
        pass(100000, false);
        CHECK_EQ(bench_count(&c, 0), rest);
        CHECK_EQ(c.jobs, from);
        bench_times(&c);
    }
}

/* HOME is for the axes it names: the others keep their place, their zero, whether they are homed.
 * With must_home a job starts when all that have an order are homed, not before; a new homing of
 * one takes its own away first. */
static void homes_what_is_asked(void)
{
    struct netcard_config config = bench_config();
    struct netcard_axes switches = { 0 };
    int64_t zero[CARD_AXES];

    config.settings.must_home = true;
    config.settings.home_order[2] = config.settings.home_order[3] = 0;
    bench_start(&c, &config);
    for (int turn = 0; turn < 3; turn++) { /* Y, X, then Y again */
        const int axis = turn != 1;
        const uint32_t asked = 1u << axis, before = c.homed & ~asked;
        CHECK_EQ(c.state, NET_READY);
        CHECK_EQ(bench_order(&c, CARD_DO_START), turn < 2 ? NET_NOT_HOMED : NET_DONE);
        const int64_t other = bench_count(&c, 1 - axis);
        memcpy(zero, c.zero, sizeof zero);
        CHECK(netcard_command(&c, CARD_DO_HOME, (uint8_t)asked));
        bool moved = false;
        for (int i = 0; i < 200000; i++) {
            switches.origin = 0;
            for (int a = 0; a < 2; a++) {
                switches.origin |= (uint32_t)(bench_count(&c, a) <= SWITCH) << a;
            }
            netcard_set_axes(&c, &switches);
            netcard_advance(&c, c.now + 20000);
            moved = moved || bench_count(&c, 1 - axis) != other;
            CHECK(c.state != NET_HOMING || !c.homing || c.home.state == HOME_CYCLE_IDLE
                  || c.homed == before);
            if (i > 100 && c.state == NET_READY) {
                break;
            }
        }
        CHECK_EQ(c.state, NET_READY);
        CHECK(turn == 2 || !moved); /* a job was given up for the last one */
        CHECK_EQ(c.homed, before | asked);
        CHECK_EQ(netcard_position(&c, axis), 0);
        CHECK_EQ(c.zero[1 - axis], zero[1 - axis]);
    }
    CHECK_EQ(c.homed, 3);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    CHECK_EQ(c.state, NET_RUNNING);
    netcard_set_power(&c, false); /* without power nothing is homed */
    netcard_set_power(&c, true);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_NOT_HOMED);
}

/* Homing without a switch ends in a fault behind the travel; a stop ends it at any time. */
static void finds_no_home(void)
{
    struct netcard_config config = one_axis();

    config.settings.home_travel[0] = 1000;
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_HOME), NET_DONE);
    pass(1000000, false);
    CHECK_EQ(c.state, NET_FAULT);
    CHECK_EQ(c.error, NET_NOT_HOMED);
    CHECK(bench_count(&c, 0) < -900 && bench_count(&c, 0) > SWITCH);
    CHECK_EQ(bench_order(&c, CARD_DO_RESET), NET_DONE);
    CHECK_EQ(bench_order(&c, CARD_DO_HOME), NET_DONE);
    pass(20000, false);
    CHECK_EQ(bench_order(&c, CARD_DO_STOP), NET_DONE);
    pass(300000, false);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(kernel_priority(&c.kernel, NETCARD_HOME), 5);
}

/* The emergency stop ends all pulses at once; only RESET and a new start move again. */
static void stops_at_once(void)
{
    const struct netcard_config config = one_axis();

    bench_make(2000, 100, NULL, 0);
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    pass(300000, false);
    wires(true);
    const int64_t at = bench_count(&c, 0);
    CHECK_EQ(c.state, NET_FAULT);
    pass(100000, true);
    CHECK_EQ(bench_count(&c, 0), at);
    CHECK_EQ(bench_order(&c, CARD_DO_RESET), NET_ALARM);
    pass(20, false);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_ALARM);
    CHECK_EQ(bench_order(&c, CARD_DO_RESET), NET_DONE);
    pass(100000, false);
    CHECK_EQ(bench_count(&c, 0), at);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    pass(2500000, false);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(bench_count(&c, 0), bench_end[0]);
}

/* A limit switch stops a job that moves towards it, and no other. */
static void keeps_off_limits(void)
{
    const struct netcard_config config = bench_config();

    bench_start(&c, &config);
    netcard_set_axes(&c, &(struct netcard_axes){ .minus = 1 });
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    bench_pass(&c, 300);
    CHECK_EQ(c.state, NET_RUNNING);
    netcard_set_axes(&c, &(struct netcard_axes){ .plus = 1 });
    CHECK_EQ(c.state, NET_FAULT);
    CHECK_EQ(c.error, NET_LIMIT);
    CHECK_EQ(bench_order(&c, CARD_DO_RESET), NET_DONE);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    bench_pass(&c, 1000); /* away from it to the begin; the first frame of the job meets it */
    CHECK_EQ(c.state, NET_FAULT);
}

/* Buttons: a pause within microseconds of the edge, a start behind the deaf time. */
static void hears_buttons(void)
{
    struct netcard_config config = bench_config();

    config.settings.in_action[3] = CARD_PAUSE;
    config.settings.in_action[12] = CARD_START;
    bench_make(2000, 100, NULL, 0);
    bench_start(&c, &config);
    bench_pass(&c, 1);
    netcard_set_inputs(&c, 1u << 12);
    bench_pass(&c, 9);
    CHECK_EQ(c.state, NET_READY);
    bench_pass(&c, 2);
    CHECK_EQ(c.state, NET_RUNNING);
    bench_pass(&c, 200);
    netcard_set_inputs(&c, 1u << 3);
    netcard_advance(&c, c.now + 15000);
    CHECK_EQ(c.player.target, 0);
    CHECK_EQ(c.state, NET_PAUSING);
    CHECK_EQ(c.served[3], 1);
    bench_pass(&c, 400);
    CHECK_EQ(c.state, NET_PAUSED);
}

/* Events switch outputs at their frames: together, within microseconds of the frame's begin. */
static void switches_outputs(void)
{
    const struct netcard_config config = bench_config();
    const struct job_event events[] = { { 0x8003, 0, 1, 0 },
                                        { 0x0001, 0, 0, 0 },
                                        { 0x0040, 1, 1, 25000 } };
    int64_t at = -1;

    bench_make(1000, 100, events, 3);
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    for (int k = 1; k <= 3; k++) {
        static const uint32_t LEVELS[] = { 0, 0x8003, 0x8002, 0x8042 };
        while (c.outputs.levels == LEVELS[k - 1] && c.now < 1000 * BENCH_MS) {
            netcard_advance(&c, c.now + 500);
        }
        CHECK_EQ(c.outputs.levels, LEVELS[k]);
        CHECK_EQ(c.player.frames, 100 * k + 1);
        CHECK(at < 0 || llabs(c.now - at - 100 * BENCH_MS) < 20000);
        at = c.now;
    }
    netcard_advance(&c, at + 24900000);
    CHECK_EQ(c.outputs.levels, 0x8042);
    netcard_advance(&c, at + 25100000);
    CHECK_EQ(c.outputs.levels, 0x8002);
}

/* Power goes while a job runs: no pulse more; the job is there when it comes again. */
static void loses_power(void)
{
    const struct netcard_config config = bench_config();

    bench_make(2000, 100, NULL, 0);
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    bench_pass(&c, 300);
    netcard_set_power(&c, false);
    const int64_t at = bench_count(&c, 0);
    bench_pass(&c, 300);
    CHECK(!netcard_command(&c, CARD_DO_START, 15));
    CHECK_EQ(bench_count(&c, 0), at);
    netcard_set_power(&c, true);
    bench_pass(&c, 300);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(bench_count(&c, 0), at);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    bench_pass(&c, 2500);
    CHECK_EQ(bench_count(&c, 0), bench_end[0]);
    bench_times(&c);
}

/* One RESET clears an alarm of a drive that lets itself be cleared; the answer waits for it, for
 * 20 ms at most. */
static void clears_alarms(void)
{
    const struct netcard_config config = bench_config();

    for (int64_t helps = 5; helps < 30; helps += 20) { /* [ms] behind the command */
        bench_start(&c, &config);
        bench_pass(&c, 10);
        netcard_set_axes(&c, &(struct netcard_axes){ .alarm = 4 });
        CHECK_EQ(c.state, NET_FAULT);
        const int32_t before = c.result.count;
        const int64_t from = c.now;
        CHECK(netcard_command(&c, CARD_DO_RESET, 15));
        bench_pass(&c, 4);
        CHECK(c.now < c.clear_until);
        CHECK_EQ(c.result.count, before);
        CHECK_EQ(bench_order(&c, CARD_DO_RESET), NET_BUSY);
        while (c.result.count == before + 1 && c.now < from + 40 * BENCH_MS) {
            if (c.now - from > helps * BENCH_MS) {
                netcard_set_axes(&c, &(struct netcard_axes){ .alarm = 0 });
            }
            netcard_advance(&c, c.now + 10000);
        }
        CHECK_EQ(c.result.command, CARD_DO_RESET);
        CHECK_EQ(c.result.code, helps < 20 ? NET_DONE : NET_ALARM);
        CHECK_EQ(c.state, helps < 20 ? NET_READY : NET_FAULT);
        CHECK_NEAR((double)(c.now - from) / BENCH_MS, fmin((double)helps, 20.0), 0.1);
    }
}

/* At power-up the flash is read before the first command is taken. */
static void reads_first(void)
{
    struct netcard_config config = bench_config();
    const double pages = bench_bytes / 256.0;

    config.settings.spi_hz = 1000000;
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    CHECK_NEAR((double)c.now * 1e-9, 8.0 * 256.0 * (pages + 3.0) / 1e6,
               0.03 * (double)c.now * 1e-9);
    bench_times(&c);
}

/* A job that leads out of the axis' range is stopped before that, without a jump of speed. */
static void keeps_range(void)
{
    struct netcard_config config = bench_config();

    config.settings.position_high[0] = 60000;
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    for (int64_t was = 0, step = 0; c.now < 2100 * BENCH_MS;) {
        bench_pass(&c, 1);
        const int64_t now = bench_count(&c, 0);
        CHECK(llabs(now - was - step) <= 6); /* 4 pulses a period are its acceleration */
        step = now - was;
        was = now;
    }
    CHECK_EQ(c.state, NET_FAULT);
    CHECK_EQ(c.error, NET_LIMIT);
    CHECK(bench_count(&c, 0) <= 60000 && bench_count(&c, 0) > 10000);
}

/* The range counts from where a job begins: literally started twice, it begins where it ended, and
 * the second one meets the limit that the first was far from. */
static void keeps_range_from_its_begin(void)
{
    struct netcard_config config = bench_config();

    bench_make(2000, 100, NULL, 0);
    const int64_t high = bench_end[0] + bench_end[0] / 2;
    config.settings.policy = CARD_LITERAL;
    config.settings.position_high[0] = (int32_t)high;
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    bench_pass(&c, 2500);
    CHECK_EQ(c.state, NET_READY);
    CHECK_EQ(netcard_position(&c, 0), bench_end[0]);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    bench_pass(&c, 2500);
    CHECK_EQ(c.state, NET_FAULT);
    CHECK_EQ(c.error, NET_LIMIT);
    CHECK(netcard_position(&c, 0) > bench_end[0] && netcard_position(&c, 0) <= high);
}

int main(void)
{
    goes_home();
    homes_what_is_asked();
    finds_no_home();
    stops_at_once();
    keeps_off_limits();
    hears_buttons();
    switches_outputs();
    loses_power();
    keeps_range();
    keeps_range_from_its_begin();
    clears_alarms();
    reads_first();
    return check_result();
}
