/* Homing on a model axis: from anywhere to the same place, or a fault that says why not. */
#include "home.h"
#include "mcc_check.h"

static const double CYCLE = 1e-3, ACC = 2000.0; /* [s], [mm/s^2] */

/* Sensor ON in [on_from, on_to], limits beyond +-limit for the length of a cam, an index every
 * pitch. [mm] */
struct axis {
    double position, speed;
    double on_from, on_to, limit, cam, pitch;
    bool sensor_on, dead_sensor, no_index;
    int stuck; /* the upper (1) or lower (-1) limit switch shows always */
    bool armed, latched;
    double latch;
};

static bool on_switch(const struct axis *a, int side)
{
    const double beyond = side * a->position - a->limit;
    return a->stuck == side || (beyond >= 0.0 && beyond <= a->cam);
}

static struct home_inputs show(const struct axis *a)
{
    const bool on = a->position >= a->on_from && a->position <= a->on_to && !a->dead_sensor;
    return (struct home_inputs){ .sensor = on == a->sensor_on,
                                 .upper = on_switch(a, 1),
                                 .lower = on_switch(a, -1),
                                 .rest = a->speed == 0.0,
                                 .position = a->position,
                                 .latched = a->latched,
                                 .latch = a->latch };
}

/* Ramp to the ordered speed; a move ends on its target. */
static void obey(struct axis *a, const struct home_order *o)
{
    double want = o->what == HOME_RUN ? o->speed : 0.0;
    const double before = a->position;

    if (o->arm) {
        a->armed = true;
        a->latched = false;
    }
    if (o->what == HOME_MOVE) {
        const double way = o->target - a->position;
        want = copysign(fmin(o->speed, sqrt(ACC * fabs(way))), way);
        if (fabs(way) <= fabs(want) * CYCLE + 1e-9 || fabs(way) < 1e-6) {
            a->position = o->target;
            a->speed = 0.0;
            return;
        }
    }
    const double step = ACC * CYCLE;
    a->speed += fmax(-step, fmin(step, want - a->speed));
    a->position += a->speed * CYCLE;
    const double low = fmin(before, a->position), high = fmax(before, a->position);
    const double index = ceil(low / a->pitch) * a->pitch;
    if (a->armed && !a->no_index && index < high) {
        a->latched = true;
        a->armed = false;
        a->latch = index;
    }
}

static enum home_phase run(struct axis *a, const struct home_config *c, struct home *h)
{
    struct home_inputs in = show(a);

    CHECK(home_valid(c));
    home_start(h, c, &in);
    for (int k = 0; k < 200000; k++) {
        in = show(a);
        const struct home_order o = home_step(h, c, &in);
        if (h->phase == HOME_DONE || h->phase == HOME_FAILED) {
            CHECK_EQ(o.what, HOME_STAND);
            return h->phase;
        }
        obey(a, &o);
        CHECK(fabs(a->position) < 130.0);
    }
    return h->phase;
}

static struct axis machine(void)
{
    return (struct axis){
        .on_from = 20.0, .on_to = 26.0, .limit = 100.0, .cam = 1e3, .pitch = 10.0, .sensor_on = true
    };
}

static struct home_config config(enum home_mode mode, uint32_t direction)
{
    return (struct home_config){ mode, direction, true, 40.0, 2.0, 1.25, 300.0, 12.0 };
}

/* All modes and directions that make sense, from everywhere: one and the same place. */
static void same_place_from_anywhere(void)
{
    static const struct {
        enum home_mode mode;
        uint32_t direction;
        double place;
    } row[] = {
        { HOME_SENSOR_INDEX, 2, 20.0 }, /* up onto it, back off it, up to the index in it */
        { HOME_SENSOR_INDEX, 6, 10.0 }, /* up onto it, back off it, on down to the index */
        { HOME_SENSOR_INDEX, 1, 30.0 }, /* down onto it, up off it, on up */
        { HOME_SENSOR, 2, 20.0 },       { HOME_SENSOR, 1, 26.0 },
        { HOME_LIMIT_INDEX, 6, 90.0 },  { HOME_LIMIT, 2, 100.0 },
        { HOME_LIMIT_INDEX, 1, -90.0 },
    };
    for (size_t i = 0; i < sizeof row / sizeof row[0]; i++) {
        for (double start = -99.0; start < 99.5; start += 3.3) {
            struct axis a = machine();
            struct home h;
            struct home_config c = config(row[i].mode, row[i].direction);
            c.offset = row[i].place > 80.0 ? -1.25 : 1.25; /* off the limit switch */
            a.position = start;
            CHECK_EQ(run(&a, &c, &h), HOME_DONE);
            const bool index = c.mode != HOME_SENSOR && c.mode != HOME_LIMIT;
            /* the index is exact; an edge is found on the cycle's grid at low speed */
            CHECK_NEAR(h.place - c.offset, row[i].place, index ? 1e-9 : 2.0 * CYCLE + 1e-9);
            CHECK_NEAR(a.position, h.place, 1e-12);
        }
    }
}

/* A sensor narrower than the way to rest is run over; the way back leads over it again. */
static void run_over(void)
{
    for (double start = -50.0; start < 15.0; start += 1.7) {
        struct axis a = machine();
        struct home h;
        struct home_config c = config(HOME_SENSOR_INDEX, 6);
        a.on_to = 20.2;
        a.position = start;
        CHECK_EQ(run(&a, &c, &h), HOME_DONE);
        CHECK_NEAR(h.place, 11.25, 1e-9);
        a.position = start;
        a.on_from = 20.1;
        c.direction = 4; /* on from it in the direction of the search: it is not met */
        CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
    }
}

/* The logic state of the sensor, and index only. */
static void logic_and_index_only(void)
{
    struct axis a = machine();
    struct home h;
    struct home_config c = config(HOME_SENSOR_INDEX, 6);

    a.sensor_on = c.sensor_on = false;
    a.position = -50.0;
    CHECK_EQ(run(&a, &c, &h), HOME_DONE);
    CHECK_NEAR(h.place, 11.25, 1e-9);
    c = config(HOME_INDEX, 4);
    a.position = 57.0;
    CHECK_EQ(run(&a, &c, &h), HOME_DONE);
    CHECK_NEAR(h.place, 51.25, 1e-9);
}

static void faults(void)
{
    struct axis a = machine();
    struct home h;
    struct home_config c = config(HOME_SENSOR_INDEX, 6);

    a.dead_sensor = true; /* both limits are met */
    CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
    CHECK_EQ(h.fault, HOME_NO_SENSOR);
    a = machine();
    a.position = -90.0;
    c.search = 50.0; /* it is 110 mm away */
    CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
    CHECK_EQ(h.fault, HOME_NO_SENSOR);
    c = config(HOME_SENSOR_INDEX, 6);
    a = machine();
    a.no_index = true;
    CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
    CHECK_EQ(h.fault, HOME_NO_INDEX);
    a = machine();
    a.on_from = -99.0; /* the sensor reaches down to the limit */
    a.on_to = 101.0;
    a.limit = 40.0;
    CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
    CHECK_EQ(h.fault, HOME_ON_LIMIT);
    a = machine();
    a.on_from = -1e3;
    a.on_to = 1e3;
    c.search = 20.0;
    CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
    CHECK_EQ(h.fault, HOME_STUCK);
}

/* Only the switch that a phase moves onto ends it: index and last way, either way round. */
static void switches_ahead(void)
{
    for (int down = 0; down < 2; down++) {
        const double side = down ? -1.0 : 1.0;
        struct axis a = machine();
        struct home h;
        struct home_config c = config(HOME_INDEX, down ? 4 : 0);

        a.position = 83.0 * side; /* the index lies behind the switch */
        a.limit = 88.0;
        CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
        CHECK_EQ(h.fault, HOME_ON_LIMIT);
        CHECK_NEAR(side * a.position, 88.0, 2.0 * CYCLE + 1e-9);

        a = machine(); /* on the switch behind it */
        c = config(HOME_INDEX, down ? 0 : 4);
        a.position = 109.0 * side;
        c.offset = 0.0;
        CHECK_EQ(run(&a, &c, &h), HOME_DONE);
        CHECK_NEAR(h.place, 100.0 * side, 1e-9);

        a = machine(); /* an offset that leads onto the switch */
        a.position = 83.0 * side;
        c = config(HOME_INDEX, down ? 4 : 0);
        c.offset = 15.0 * side;
        CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
        CHECK_EQ(h.fault, HOME_ON_LIMIT);
        CHECK_NEAR(side * a.position, 100.0, 2.0 * CYCLE + 1e-9);

        a = machine(); /* at rest on the switch, and back from there */
        a.position = 93.0 * side;
        c.offset = -1.25 * side;
        CHECK_EQ(run(&a, &c, &h), HOME_DONE);
        CHECK_NEAR(a.position, 98.75 * side, 1e-9);
    }
}

/* A limit switch that is the sensor may be left on its far side if it is a cam; the other one ends
 * the phase, whatever the sensor says. */
static void switch_as_sensor(void)
{
    for (int down = 0; down < 2; down++) {
        const double side = down ? -1.0 : 1.0;
        struct axis a = machine();
        struct home h;
        struct home_config c = config(HOME_LIMIT, down ? 3 : 0);

        a.cam = 4.0;
        a.position = 60.0 * side;
        c.offset = 2.0 * side;
        CHECK_EQ(run(&a, &c, &h), HOME_DONE);
        CHECK_NEAR(h.place, 106.0 * side, 2.0 * CYCLE + 1e-9);

        a = machine();
        a.stuck = down ? -1 : 1;
        a.position = -97.0 * side;
        c = config(HOME_LIMIT, down ? 1 : 2);
        CHECK_EQ(run(&a, &c, &h), HOME_FAILED);
        CHECK_EQ(h.fault, HOME_ON_LIMIT);
        CHECK_NEAR(a.position, -100.0 * side, 2.0 * CYCLE + 1e-9);
    }
}

static void refusals(void)
{
    struct home_config c = config(HOME_SENSOR, 0);
    CHECK(home_valid(&c));
    c.direction = 8;
    CHECK(!home_valid(&c));
    c = config((enum home_mode)5, 0);
    CHECK(!home_valid(&c));
    c = config(HOME_LIMIT, 7);
    c.low_speed = 0.0;
    CHECK(!home_valid(&c));
    c = config(HOME_LIMIT, 7);
    c.offset = NAN;
    CHECK(!home_valid(&c));
}

int main(void)
{
    same_place_from_anywhere();
    run_over();
    logic_and_index_only();
    faults();
    switches_ahead();
    switch_as_sensor();
    refusals();
    return check_result();
}
