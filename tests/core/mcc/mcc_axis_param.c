/* Axis parameters of the document: taken at standstill, the axes stay where they are. */
#include "mcc_card.h"

static const struct pc_panel calm = { .override = 1.0, .rapid = 1.0 };
static const struct pc_config usual = {
    .bus = 4000, .ipo = 40000, .latency = 8000.0, .seed = 1, .min_stock = 3, .batch = 4
};

static int64_t wait(struct card *c, int64_t at, const struct pc_panel *p)
{
    for (int k = 0; k < 20000; k++, at += pc.config.bus) {
        card_period(c, at, p, NULL);
    }
    return at;
}

static void check_place(int axis, double place, int32_t pulses)
{
    double cpos[AXES];
    int32_t ppos[AXES];

    MCC_get_cpos(&pc.mcc, cpos);
    MCC_get_ppos(&pc.mcc, ppos);
    CHECK_NEAR(cpos[axis], place, 0.0);
    CHECK_EQ(ppos[axis], pulses);
    CHECK_NEAR(pc.mcc.end[axis], place, 0.0);
}

/* What MCC_init_motion was given stands there, and made effective again changes nothing. */
static void first_values(void)
{
    static struct mcc was;
    struct machine m = mcc_machine();
    struct card c;

    m.axis[1].inverted = true;
    card_start(&c, &m, &usual, false);
    const MCC_MACH_PARAM *p = pc.mcc.epcio_axis_param;
    CHECK(p[0].type == MCC_LINEAR && p[3].type == MCC_UNUSED && p[0].PPR == 10000);
    CHECK(p[0].pitch == 10.0 && p[0].gear_ratio == 1.0 && p[0].RPM == 3000.0);
    CHECK(p[0].pos2encoder_dir == 0 && p[1].pos2encoder_dir == 1);
    CHECK_NEAR(pc.mcc.cart_max_speed, 1000.0, 0.0);
    was = pc.mcc;
    CHECK_EQ(MCC_update_param(&pc.mcc), 0);
    CHECK(memcmp(&was, &pc.mcc, sizeof was) == 0);
}

/* Another lead: the pulses are the same, the millimetres follow, and so do the next moves. */
static void another_lead(void)
{
    const struct machine m = mcc_machine();
    struct card c;

    card_start(&c, &m, &usual, false);
    MCC_MACH_PARAM *p = pc.mcc.epcio_axis_param;
    CHECK(MCC_line(&pc.mcc, (double[AXES]){ 4.0, 0.3, 1.0 }) > 0);
    int64_t at = wait(&c, 0, &calm);
    CHECK_EQ(c.sum[0], 4000);
    p[0].pitch = 5.0;
    p[1].PPR = 20000;
    p[1].gear_ratio = 3.0;
    CHECK_EQ(MCC_update_param(&pc.mcc), 0);
    check_place(0, 2.0, 4000);
    check_place(1, 300.0 / 6000.0, 300);
    check_place(2, 1.0, 1000);
    at = wait(&c, at, &calm);
    CHECK(c.sum[0] == 4000 && c.sum[1] == 300 && c.sum[2] == 1000);
    CHECK(MCC_line(&pc.mcc, (double[AXES]){ 1.0, 0.1, 1.0 }) > 0);
    wait(&c, at, &calm);
    CHECK(c.sum[0] == 2000 && c.sum[1] == 600 && c.sum[2] == 1000);
    check_place(0, 1.0, 2000);
}

/* An inverted axis: its pulses and its encoder run the other way, the library's position does not;
 * turned round while it stands at +4 mm and compensated, it stands at -4 mm. */
static void inverted(void)
{
    struct machine m = mcc_machine();
    struct comp_table table = {
        .interval = 100000, .home = 1, .forward = { 0, 7, 7 }, .backward = { -2, -2, -2 }
    };
    struct pc_panel p = calm;
    struct card c;
    int32_t counts[AXES];

    m.axis[0].inverted = true;
    card_start(&c, &m, &usual, false);
    CHECK_EQ(MCC_set_comp(&pc.mcc, 0, &table), 0);
    CHECK(MCC_line(&pc.mcc, (double[AXES]){ 4.0, 2.0 }) > 0);
    p.signals.err[0] = p.signals.err[1] = 5;
    p.signals.enc[0] = -4000;
    p.signals.latch[0] = 123;
    int64_t at = wait(&c, 0, &p);
    CHECK(c.sum[0] == -4007 && c.sum[1] == 2000);
    check_place(0, 4.0, 4000);
    MCC_get_errcnt(&pc.mcc, counts);
    CHECK(counts[0] == -5 && counts[1] == 5);
    CHECK(pc.mcc.signals.enc[0] == 4000 && pc.mcc.signals.latch[0] == -123);

    pc.mcc.epcio_axis_param[0].pos2encoder_dir = 0;
    CHECK_EQ(MCC_update_param(&pc.mcc), 0);
    check_place(0, -4.0, -4000);
    check_place(1, 2.0, 2000);
    MCC_get_errcnt(&pc.mcc, counts);
    CHECK(counts[0] == 5 && counts[1] == 5 && pc.mcc.signals.enc[0] == -4000);
    at = wait(&c, at, &p);
    CHECK_EQ(c.sum[0], -4002); /* it came there backward now */
    CHECK(MCC_line_x(&pc.mcc, -1.0) > 0);
    wait(&c, at, &p);
    CHECK_EQ(c.sum[0], -993);
}

/* What homing has been set to shows in the parameters, and what they say goes to it. */
static void homing(void)
{
    static struct mcc was;
    const struct machine m = mcc_machine();
    const struct home_config config = { .mode = HOME_SENSOR_INDEX,
                                        .direction = 5,
                                        .sensor_on = true,
                                        .high_speed = 20.0,
                                        .low_speed = 2.0,
                                        .offset = 1.25,
                                        .search = 100.0,
                                        .index_way = 15.0 };
    struct card c;

    card_start(&c, &m, &usual, false);
    CHECK_EQ(homing_set(&pc.mcc, 1, &config, false), 0);
    MCC_MACH_PARAM *p = &pc.mcc.epcio_axis_param[1];
    CHECK(p->home_dir == 5 && p->sensor_on == 1);
    p->home_dir = 2;
    p->sensor_on = 0;
    p->pitch = 20.0; /* 0.02 mm a pulse */
    p->gear_ratio = 0.1;
    p->pos2encoder_dir = 1;
    pc.mcc.homing.axis[1].zero = 123;
    CHECK_EQ(MCC_update_param(&pc.mcc), 0);
    const struct homing_axis *x = &pc.mcc.homing.axis[1];
    CHECK(x->config.direction == 2 && !x->config.sensor_on && x->zero == -123);
    CHECK_NEAR(x->config.offset, 1.26, 1e-12);
    p->RPM = 0.05; /* 10 mm/s */
    p->pitch = 20.0;
    was = pc.mcc;
    CHECK_EQ(MCC_update_param(&pc.mcc), MCC_PARAMETER);
    CHECK(memcmp(&was, &pc.mcc, sizeof was) == 0);
    p->RPM = 3000.0;
    CHECK_EQ(MCC_enable_dry_run(&pc.mcc), 0);
    CHECK_EQ(MCC_go_home(&pc.mcc, (int32_t[AXES]){ 0, 1 }), MCC_COMMAND_NOTACCEPTED);
    CHECK_EQ(MCC_disable_dry_run(&pc.mcc), 0);
    CHECK_EQ(MCC_go_home(&pc.mcc, (int32_t[AXES]){ 0, 1 }), 0);
    CHECK_EQ(MCC_update_param(&pc.mcc), MCC_COMMAND_NOTFINISHED);
}

/* An axis that leaves the motion keeps its pulses, and goes on from there when it is back. */
static void types(void)
{
    const struct machine m = mcc_machine();
    struct card c;

    card_start(&c, &m, &usual, false);
    CHECK(MCC_line(&pc.mcc, (double[AXES]){ 4.0, 3.0 }) > 0);
    int64_t at = wait(&c, 0, &calm);
    for (int32_t type = MCC_SPINDLE; type <= MCC_UNUSED; type++) {
        pc.mcc.epcio_axis_param[1].type = type;
        CHECK_EQ(MCC_update_param(&pc.mcc), 0);
        CHECK_EQ(MCC_line_y(&pc.mcc, 1.0), MCC_PARAMETER);
        CHECK(MCC_line_x(&pc.mcc, type) > 0);
        at = wait(&c, at, &calm);
        CHECK(c.sum[0] == 1000 * type && c.sum[1] == 3000);
    }
    pc.mcc.epcio_axis_param[1].type = MCC_ROTARY;
    CHECK_EQ(MCC_update_param(&pc.mcc), 0);
    CHECK(MCC_line_y(&pc.mcc, 1.0) > 0);
    wait(&c, at, &calm);
    CHECK_EQ(c.sum[1], 1000);
}

/* One wrong field, or the wrong time: nothing changes. */
static void refusals(void)
{
    static struct mcc was;
    const struct machine m = mcc_machine();
    struct card c;

    card_start(&c, &m, &usual, false);
    MCC_MACH_PARAM *p = &pc.mcc.epcio_axis_param[2];
    const MCC_MACH_PARAM good = *p;
    MCC_MACH_PARAM bad[] = { good, good, good, good, good, good, good,
                             good, good, good, good, good, good, good };
    enum { KINDS = sizeof bad / sizeof *bad };
    bad[0].type = 4;
    bad[1].pos2encoder_dir = 2;
    bad[2].PPR = 0;
    bad[3].RPM = 0.0;
    bad[4].pitch = -10.0;
    bad[5].gear_ratio = NAN;
    bad[6].high_limit = INFINITY;
    bad[7].low_limit = good.high_limit + 1.0;
    bad[8].HOT_offset = NAN;
    bad[9].LOT_offset = INFINITY;
    bad[10].sensor_on = -1;
    bad[11].index_on = 2;
    bad[12].home_dir = 8;
    bad[13].type = -1;
    for (int i = 0; i < KINDS; i++) {
        *p = bad[i];
        pc.mcc.epcio_axis_param[0].pitch = 5.0; /* not taken either */
        was = pc.mcc;
        CHECK_EQ(MCC_update_param(&pc.mcc), MCC_PARAMETER);
        CHECK(memcmp(&was, &pc.mcc, sizeof was) == 0);
    }
    *p = good;
    static const struct {
        double speed;
        int code;
    } speeds[] = {
        { 9.0, MCC_FEED_RATE }, { 0.0, MCC_FEED_RATE }, { NAN, MCC_PARAMETER }, { 10.0, 0 }
    };
    for (int i = 0; i < 4; i++) {
        pc.mcc.cart_max_speed = speeds[i].speed;
        was = pc.mcc;
        CHECK_EQ(MCC_update_param(&pc.mcc), speeds[i].code);
        CHECK((memcmp(&was, &pc.mcc, sizeof was) == 0) == (speeds[i].code != 0));
    }
    CHECK_EQ(MCC_set_fspd(&pc.mcc, 10.5), MCC_FEED_RATE);
    CHECK(MCC_line_x(&pc.mcc, 1.0) > 0);
    was = pc.mcc;
    CHECK_EQ(MCC_update_param(&pc.mcc), MCC_COMMAND_NOTFINISHED);
    CHECK(memcmp(&was, &pc.mcc, sizeof was) == 0);
    wait(&c, 0, &calm);
    CHECK_EQ(MCC_enable_dry_run(&pc.mcc), 0);
    CHECK_EQ(MCC_update_param(&pc.mcc), MCC_COMMAND_NOTACCEPTED);
    MCC_close_motion(&pc.mcc);
    CHECK_EQ(MCC_update_param(&pc.mcc), MCC_INITIAL_MOTION);
}

int main(void)
{
    first_values();
    another_lead();
    inverted();
    homing();
    types();
    refusals();
    return check_result();
}
