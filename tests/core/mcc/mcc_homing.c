/* Homing of library, card and a model motor in one loop: from anywhere to the same count. */
#include <stdlib.h>

#include "mcc_card.h"

/* Counts of the motors from a mark on the machine; the library does not know where it starts. */
enum { SENSOR_FROM = 5200, SENSOR_TO = 8300, LIMIT = 30000, INDEX = 10000, INDEX_AT = 1000 };

struct motor {
    int32_t start; /* [counts] where the counter began */
    double place;  /* [counts] from the mark */
    int32_t now;   /* [counts] the same, whole */
    bool backward; /* the encoder counts down */
    bool no_index, no_sensor;
    int32_t armed; /* latch_seq when armed last */
    bool waits;    /* for an index */
};

struct machine_room {
    struct card card;
    struct motor motor[AXES];
    struct pc_panel panel;
    int64_t at; /* [clocks] */
};

static struct machine_room room;

static struct pc_config config_of(enum home_mode mode, uint32_t direction)
{
    struct pc_config c = { .bus = 4000,
                           .ipo = 40000,
                           .latency = 8000,
                           .seed = 1,
                           .min_stock = 3,
                           .batch = 4,
                           .home_settle = 0.05,
                           .home_order = { 1 } };
    for (int i = 0; i < AXES; i++) {
        c.home[i] = (struct home_config){ mode, direction, true, 60.0, 5.0, 0.0, 100.0, 12.0 };
    }
    return c;
}

static int32_t depth = 12; /* of the point queue */

static void start(const struct pc_config *c, int32_t at, bool program)
{
    struct machine m = mcc_machine();
    m.queue_depth = depth;
    memset(&room, 0, sizeof room);
    room.panel.override = room.panel.rapid = 1.0;
    for (int i = 0; i < AXES; i++) {
        room.motor[i].start = room.motor[i].now = at - 1700 * i;
        room.motor[i].place = room.motor[i].start;
    }
    card_start(&room.card, &m, c, program);
}

static int32_t count(const struct motor *x, int32_t place)
{
    return x->backward ? x->start - place : place - x->start;
}

/* The motor follows its pulses with a lag of some 3 ms; signals as the card samples them. */
static void move(int i)
{
    struct motor *x = &room.motor[i];
    struct signals *s = &room.panel.signals;
    const int32_t want = x->start + room.card.sum[i], from = x->now;

    x->place += 0.03 * (want - x->place);
    x->now = (int32_t)lround(x->place);
    if (pc.mcc.latch_seq[i] != x->armed) {
        x->armed = pc.mcc.latch_seq[i];
        x->waits = true;
    }
    /* The index is met on entering its count from either side. */
    const int32_t above = x->now > from ? from + 1 : x->now;
    const int32_t index = INDEX_AT + INDEX * (int32_t)ceil((double)(above - INDEX_AT) / INDEX);
    if (x->waits && index <= (x->now > from ? x->now : from - 1) && !x->no_index) {
        x->waits = false;
        s->latch[i] = count(x, index);
        s->latched[i]++;
    }
    const uint32_t bit = (uint32_t)1 << i;
    const bool on = x->now >= SENSOR_FROM && x->now <= SENSOR_TO && !x->no_sensor;
    s->enc[i] = count(x, x->now);
    s->home = (s->home & ~bit) | (on ? bit : 0);
    s->upper = (s->upper & ~bit) | (x->now >= LIMIT ? bit : 0);
    s->lower = (s->lower & ~bit) | (x->now <= -LIMIT ? bit : 0);
}

static void period(const char *text)
{
    for (int i = 0; i < AXES; i++) {
        move(i);
    }
    card_period(&room.card, room.at, &room.panel, text);
    room.at += pc.config.bus;
}

/* Let time pass until homing ends; the code then. */
static int search(void)
{
    room.panel.go_home = true;
    for (int k = 0; k < 15; k++) { /* an IPO cycle and more */
        period(NULL);
    }
    room.panel.go_home = false;
    CHECK_EQ(MCC_check_homef(&pc.mcc), 0);
    for (int k = 0; k < 600000 && MCC_check_homef(&pc.mcc) == 0; k++) {
        period(NULL);
    }
    return MCC_check_homef(&pc.mcc);
}

/* Every mode finds one place, wherever it starts: the index to the count, an edge to the counts
 * of a bus period at low speed. */
static void same_place(void)
{
    static const struct {
        enum home_mode mode;
        uint32_t direction;
        int32_t place;
        double offset;
    } row[] = {
        { HOME_SENSOR_INDEX, 2, 11000, 0.0 },   /* up, back off, up to the next index */
        { HOME_SENSOR_INDEX, 6, 1000, 1.2345 }, /* up, back off, on down */
        { HOME_SENSOR_INDEX, 1, 11000, -2.5 },  /* down, off up, on up */
        { HOME_SENSOR, 2, SENSOR_FROM - 1, 0.0 }, { HOME_SENSOR, 1, SENSOR_TO + 1, 3.0005 },
        { HOME_LIMIT_INDEX, 6, 21000, 0.0 },      { HOME_LIMIT, 2, LIMIT - 1, -1.0 },
        { HOME_LIMIT_INDEX, 1, -29000, 0.0 },
    };
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        for (int32_t at = -29500; at < 29900; at += 3313) {
            struct pc_config c = config_of(row[k].mode, row[k].direction);
            double place[AXES];
            int32_t pulses[AXES];
            c.home[0].offset = row[k].offset;
            start(&c, at, false);
            const bool index = c.home[0].mode != HOME_SENSOR && c.home[0].mode != HOME_LIMIT;
            CHECK_EQ(search(), 1);
            const int32_t want = row[k].place + (int32_t)lround(row[k].offset * 1000.0);
            CHECK(abs(room.motor[0].now - want) <= (index ? 0 : 1));
            CHECK(MCC_check_stop(&pc.mcc) && pc_done(&pc));
            CHECK(MCC_get_cpos(&pc.mcc, place) == 0 && place[0] == 0.0);
            CHECK(MCC_get_ppos(&pc.mcc, pulses) == 0 && pulses[0] == 0);
            CHECK(pc.mcc.end[0] == 0.0 && pc.mcc.trajectory.rest[0] == 0.0);
            CHECK_EQ(room.card.underflows, 0);
        }
    }
}

/* Index only goes to the next one; a second search from the origin finds the one after it. */
static void index_only(void)
{
    const struct pc_config c = config_of(HOME_INDEX, 4);
    start(&c, 5000, false);
    CHECK_EQ(search(), 1);
    CHECK_EQ(room.motor[0].now, 1000);
    CHECK_EQ(search(), 1);
    CHECK_EQ(room.motor[0].now, -9000);
}

/* The encoder may count the other way; and search after search finds the same place. */
static void backward_and_again(void)
{
    struct pc_config c = config_of(HOME_SENSOR_INDEX, 6);
    c.encoder_backward[0] = true;
    c.home[0].offset = 2.0;
    depth = 300; /* far longer than an axis has to stand still */
    c.home[0].high_speed = 20.0;
    start(&c, 777, false);
    depth = 12;
    room.motor[0].backward = true;
    for (int k = 0; k < 3; k++) {
        CHECK_EQ(search(), 1);
        CHECK_EQ(room.motor[0].now, 3000);
        CHECK(MCC_jog_s(&pc.mcc, 0, 12345 - 5000 * k) == 0);
        for (int j = 0; j < 20000; j++) {
            period(NULL);
        }
        CHECK_EQ(room.motor[0].now, 3000 + 12345 - 5000 * k);
    }
}

/* An axis that need not settle is done with all its points planned: the origin waits until they
 * are written. */
static void no_settling(void)
{
    struct pc_config c = config_of(HOME_SENSOR_INDEX, 6);
    c.home_settle = 0.0;
    depth = 300;
    start(&c, 777, false);
    depth = 12;
    CHECK_EQ(search(), 1);
    for (int j = 0; j < 20000; j++) {
        CHECK_EQ(pc.mcc.queue.count, 0);
        period(NULL);
        CHECK_EQ(pc.mcc.written.pulses[0], 0);
    }
    CHECK_EQ(room.motor[0].now, 1000);
}

/* Axes of one number together, then the next; others keep their place. */
static void orders(void)
{
    struct pc_config c = config_of(HOME_SENSOR_INDEX, 2);
    double place[AXES];
    memcpy(c.home_order, (int32_t[AXES]){ 2, 0, 1 }, sizeof c.home_order);
    start(&c, -8000, false);
    CHECK_EQ(MCC_jog_s(&pc.mcc, 1, 2500), 0);
    for (int k = 0; k < 5000; k++) {
        period(NULL);
    }
    const int32_t x = room.motor[0].now;
    room.panel.go_home = true;
    while (room.motor[0].now == x && room.at < 1000000000) {
        period(NULL);
    }
    CHECK_EQ(room.motor[2].now, 11000); /* was there before X began */
    while (MCC_check_homef(&pc.mcc) == 0) {
        period(NULL);
    }
    CHECK_EQ(MCC_check_homef(&pc.mcc), 1);
    CHECK_EQ(room.motor[0].now, 11000);
    MCC_get_cpos(&pc.mcc, place);
    CHECK(place[0] == 0.0 && place[1] == 2.5 && place[2] == 0.0);
    memcpy(c.home_order, (int32_t[AXES]){ 1, 0, 1 }, sizeof c.home_order);
    start(&c, -8000, false);
    CHECK_EQ(search(), 1);
    CHECK(room.motor[0].now == 11000 && room.motor[2].now == 11000);
}

/* home_first: the program starts behind the search, in the new coordinates. */
static void before_the_program(void)
{
    struct pc_config c = config_of(HOME_SENSOR_INDEX, 2);
    c.home_first = true;
    start(&c, -8000, true);
    for (int k = 0; k < 300000 && !pc_done(&pc); k++) {
        CHECK(!pc.process.started || MCC_check_homef(&pc.mcc) == 1);
        period("G1 X-3 F6000\nM2\n");
    }
    CHECK(pc_done(&pc));
    for (int k = 0; k < 2000; k++) {
        period("G1 X-3 F6000\nM2\n");
    }
    CHECK_EQ(room.motor[0].now, 11000 - 3000);
}

/* A hold interrupts the search, an abort drops it; faster by the override it finds the same. */
static void hold_and_abort(void)
{
    const struct pc_config c = config_of(HOME_SENSOR_INDEX, 6);
    const double target[AXES] = { 1.0 };

    start(&c, -20000, false);
    room.panel.go_home = true;
    for (int k = 0; k < 3000; k++) {
        period(NULL);
    }
    CHECK_EQ(MCC_line(&pc.mcc, target), MCC_COMMAND_NOTACCEPTED);
    CHECK_EQ(MCC_jog_s(&pc.mcc, 1, 1), MCC_COMMAND_NOTFINISHED);
    CHECK_EQ(MCC_MPG_set(&pc.mcc, 1, 6, 1.0), MCC_COMMAND_NOTFINISHED);
    CHECK_EQ(MCC_go_home(&pc.mcc, c.home_order), MCC_COMMAND_NOTFINISHED);
    CHECK_EQ(homing_set(&pc.mcc, 0, &c.home[0], false), MCC_COMMAND_NOTFINISHED);
    room.panel.hold = true;
    for (int k = 0; k < 5000; k++) {
        period(NULL);
    }
    const int32_t held = room.motor[0].now;
    for (int k = 0; k < 2000; k++) {
        period(NULL);
    }
    CHECK_EQ(room.motor[0].now, held);
    CHECK_EQ(task_status(&pc.mcc), TASK_HOLD);
    CHECK(held > -20000 && held < 0);
    room.panel.hold = false;
    room.panel.override = 1.7;
    while (MCC_check_homef(&pc.mcc) == 0) {
        period(NULL);
    }
    CHECK_EQ(room.motor[0].now, 1000);
    start(&c, -20000, false);
    room.panel.go_home = true;
    for (int k = 0; k < 3000; k++) {
        period(NULL);
    }
    room.panel.abort = true;
    for (int k = 0; k < 3000; k++) {
        period(NULL);
    }
    CHECK_EQ(MCC_check_homef(&pc.mcc), MCC_HOME_COMMAND_NOTCALLED);
    CHECK(MCC_check_stop(&pc.mcc) && pc.mcc.error == 0);
    CHECK_NEAR(pc.mcc.end[0] * 1000.0, room.motor[0].now + 20000, 0.5);
    /* A jog does not go on with the search that was dropped. */
    const int32_t from = room.motor[0].now;
    CHECK_EQ(MCC_jog_s(&pc.mcc, 0, -500), MCC_NO_ERR);
    CHECK_EQ(MCC_jog_s(&pc.mcc, 1, 300), MCC_NO_ERR);
    CHECK_EQ(MCC_check_homef(&pc.mcc), MCC_HOME_COMMAND_NOTCALLED);
    for (int k = 0; k < 5000; k++) {
        period(NULL);
    }
    CHECK_EQ(room.motor[0].now, from - 500);
    CHECK_EQ(room.motor[1].now, -21700 + 300);
    CHECK(MCC_check_stop(&pc.mcc) && pc.mcc.error == 0);
}

/* An abort before the search of home_first or within it drops search and program for good: the axes
 * rest where they are, and a search asked for later moves nothing but its axes. */
static void abort_of_home_first(void)
{
    static const char text[] = "G1 X-3 F6000\nM2\n";
    for (int within = 0; within < 2; within++) {
        struct pc_config c = config_of(HOME_SENSOR_INDEX, 2);
        c.home_first = true;
        c.start = 2000 * c.bus;
        start(&c, -8000, true);
        for (int k = 0; k < (within ? 3000 : 1000); k++) {
            period(text);
        }
        CHECK_EQ(room.motor[0].now != -8000, within);
        CHECK_EQ(MCC_check_homef(&pc.mcc), within ? 0 : MCC_HOME_COMMAND_NOTCALLED);
        room.panel.abort = true;
        for (int k = 0; k < 3000; k++) {
            period(text);
        }
        const int32_t rest = room.motor[0].now;
        CHECK(within ? rest > -8000 && rest < SENSOR_FROM : rest == -8000);
        CHECK(MCC_check_stop(&pc.mcc) && pc_done(&pc) && pc.mcc.error == 0);
        room.panel.abort = false;
        for (int k = 0; k < 5000; k++) {
            period(text);
        }
        CHECK_EQ(room.motor[0].now, rest);
        CHECK_EQ(MCC_check_homef(&pc.mcc), MCC_HOME_COMMAND_NOTCALLED);
        CHECK_EQ(search(), 1);
        for (int k = 0; k < 5000; k++) {
            period(text);
        }
        CHECK_EQ(room.motor[0].now, 11000);
    }
}

/* A program behind home_first waits for a good search: a failed one, its error cleared and a press
 * of cycle start do not let it run. */
static void failed_home_first(void)
{
    static const char text[] = "G1 X-3 F6000\nM2\n";
    struct pc_config c = config_of(HOME_SENSOR_INDEX, 2);
    c.home_first = true;
    start(&c, -8000, true);
    room.motor[0].no_sensor = true;
    for (int k = 0; k < 300000 && pc.mcc.error == 0; k++) {
        period(text);
    }
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0xF700 + 16 * HOME_NO_SENSOR + 1);
    for (int k = 0; k < 6000; k++) {
        room.panel.clear_error = k >= 2000 && k < 2100;
        room.panel.cycle_start = k >= 3000 && k < 3100;
        period(text);
        CHECK(!pc.process.started && !pc.mcc.running);
    }
    CHECK_EQ(pc.mcc.error, 0);
    room.motor[0].no_sensor = false;
    room.panel.go_home = true;
    for (int k = 0; k < 300000 && !pc_done(&pc); k++) {
        period(text);
    }
    for (int k = 0; k < 2000; k++) {
        period(text);
    }
    CHECK(pc_done(&pc));
    CHECK_EQ(room.motor[0].now, 11000 - 3000);
}

/* What is missing is told with its axis; nothing is taken until the error is cleared. */
static void failures(void)
{
    struct pc_config c = config_of(HOME_SENSOR_INDEX, 2);
    memcpy(c.home_order, (int32_t[AXES]){ 1, 1 }, sizeof c.home_order);
    start(&c, 0, false);
    room.motor[1].no_index = true;
    CHECK_EQ(search(), MCC_RUN_TIME);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0xF700 + 16 * HOME_NO_INDEX + 2);
    CHECK_EQ(MCC_go_home(&pc.mcc, c.home_order), MCC_RUN_TIME);
    for (int k = 0; k < 5000; k++) {
        period(NULL);
    }
    CHECK(MCC_check_stop(&pc.mcc) && !pc_done(&pc));
    CHECK_EQ(MCC_clear_error(&pc.mcc), 0);
    room.motor[1].no_index = false;
    CHECK_EQ(search(), 1);
    CHECK(room.motor[0].now == 11000 && room.motor[1].now == 11000);
    start(&c, 0, false);
    room.motor[0].no_sensor = true;
    CHECK_EQ(search(), MCC_RUN_TIME);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0xF700 + 16 * HOME_NO_SENSOR + 1);
}

static void refusals(void)
{
    static struct mcc before;
    struct pc_config c = config_of(HOME_SENSOR_INDEX, 2);
    struct home_config fast = c.home[0], bad = c.home[0];
    const int32_t none[AXES] = { 0 }, negative[AXES] = { -1 }, unused[AXES] = { [4] = 1 };
    const int32_t unset[AXES] = { 1, 1 };

    start(&c, 0, false);
    fast.high_speed = 501.0;
    bad.search = -1.0;
    memcpy(&before, &pc.mcc, sizeof before);
    CHECK_EQ(MCC_go_home(&pc.mcc, none), MCC_PARAMETER);
    CHECK_EQ(MCC_go_home(&pc.mcc, negative), MCC_PARAMETER);
    CHECK_EQ(MCC_go_home(&pc.mcc, unused), MCC_PARAMETER);
    CHECK_EQ(MCC_go_home(&pc.mcc, unset), MCC_PARAMETER); /* Y has no configuration */
    CHECK_EQ(homing_set(&pc.mcc, 0, &fast, false), MCC_PARAMETER);
    CHECK_EQ(homing_set(&pc.mcc, 0, &bad, false), MCC_PARAMETER);
    CHECK_EQ(homing_set(&pc.mcc, 6, &c.home[0], false), MCC_PARAMETER);
    CHECK_EQ(homing_set_settle(&pc.mcc, NAN), MCC_PARAMETER);
    CHECK_EQ(MCC_check_homef(&pc.mcc), MCC_HOME_COMMAND_NOTCALLED);
    CHECK(memcmp(&before, &pc.mcc, sizeof before) == 0);
    CHECK_EQ(MCC_jog_s(&pc.mcc, 1, 5), 0);
    CHECK_EQ(MCC_go_home(&pc.mcc, c.home_order), MCC_COMMAND_NOTFINISHED);
}

int main(void)
{
    same_place();
    index_only();
    backward_and_again();
    no_settling();
    orders();
    before_the_program();
    hold_and_abort();
    abort_of_home_first();
    failed_home_first();
    failures();
    refusals();
    return check_result();
}
