/* Voltage groups: what may have which DAC. */
#include "group.h"
#include "mcc_check.h"

static struct groups set; /* 2 MB: not on the stack */
static struct groups before;

static const int32_t none[AXES] = { -1, -1, -1, -1, -1, -1 };
static const int32_t pair[AXES] = { 6, 7, -1, -1, -1, -1 };
static const int32_t xy[AXES] = { 0, 1, -1, -1, -1, -1 };

static struct group_dac settings(int encoder)
{
    const struct machine m = mcc_machine();
    struct group_dac d = {
        .axis = m.axis[0], .encoder = encoder, .position_gain = 50.0, .speed_per_volt = 300.0
    };
    d.axis.used = false;
    return d;
}

/* Two cards without a group whose DAC have settings, each with the counter of its number. */
static void fresh(void)
{
    const struct group_config config = { .bus = 4000, .ipo = 40000, .min_stock = 3, .batch = 4 };
    const struct machine card[GROUP_CARDS] = { mcc_machine(), mcc_machine() };

    groups_init(&set, &config, card);
    for (int k = 0; k < GROUP_CARDS; k++) {
        for (int i = 0; i < GROUP_DACS; i++) {
            const struct group_dac d = settings(i);
            CHECK_EQ(groups_set_dac(&set, k, i, &d), MCC_NO_ERR);
        }
    }
}

/* A refused call changes nothing. */
#define REFUSED(call, code) \
    do { \
        before = set; \
        CHECK_EQ(call, code); \
        CHECK(!memcmp(&set, &before, sizeof set)); \
    } while (0)

static void channels(void)
{
    static const int32_t bad[][AXES] = { { 8, -1, -1, -1, -1, -1 },
                                         { 2, 2, -1, -1, -1, -1 },
                                         { 3, 6, -1, -1, -1, -1 },
                                         { -2, -1, -1, -1, -1, -1 },
                                         { -1, -1, -1, -1, -1, -1 } };
    const struct machine motion = mcc_machine();
    struct machine wrong = motion;
    fresh();
    CHECK_EQ(group_create_voltage(&set, 0, pair, &motion), 0);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        REFUSED(group_create_voltage(&set, 0, bad[i], &motion), MCC_GROUP_PARAMETER);
    }
    REFUSED(group_create_voltage(&set, 2, xy, &motion), MCC_GROUP_PARAMETER);
    REFUSED(group_create_voltage(&set, -1, xy, &motion), MCC_GROUP_PARAMETER);
    wrong.feed = 0.0;
    REFUSED(group_create_voltage(&set, 0, xy, &wrong), MCC_PARAMETER);
    CHECK_EQ(group_create_voltage(&set, 1, pair, &motion), 1); /* another card */
    CHECK_EQ(group_create(&set, 0, (int32_t[]){ 0, 1, 2, 3, 4, 5 }, &motion), 2);
    CHECK_EQ(group_create_voltage(&set, 0, (int32_t[]){ 0, 1, 2, 3, 4, 5 }, &motion), 3);
    CHECK_EQ(group_close(&set, 0), MCC_NO_ERR);
    CHECK_EQ(group_create_voltage(&set, 0, pair, &motion), 0); /* free again */
    CHECK_EQ(groups_start(&set), MCC_NO_ERR);
    REFUSED(group_create_voltage(&set, 1, xy, &motion), MCC_COMMAND_NOTACCEPTED);
    const struct group_dac d = settings(0);
    REFUSED(groups_set_dac(&set, 1, 0, &d), MCC_COMMAND_NOTACCEPTED);
    REFUSED(groups_set_command_mode(&set, 1, 0, GROUP_COMMAND_VOLTAGE), MCC_COMMAND_NOTACCEPTED);
    fresh();
    before = set;
    CHECK_EQ(group_create_voltage(&set, 0, none, &motion), MCC_GROUP_PARAMETER);
    CHECK_EQ(groups_start(&set), MCC_GROUP_PARAMETER);
    CHECK_EQ(group_create_voltage(&set, 0, xy, &motion), 0);
    CHECK_EQ(groups_start(&set), MCC_NO_ERR); /* a card without pulses */
    CHECK(!groups_card_used(&set, 0));
}

static void values(void)
{
    struct group_dac d;
    fresh();
#define BAD(field, value) \
    d = settings(0); \
    d.field = value; \
    REFUSED(groups_set_dac(&set, 0, 0, &d), MCC_PARAMETER)
    BAD(encoder, -1);
    BAD(encoder, 9);
    BAD(position_gain, 0.0);
    BAD(position_gain, NAN);
    BAD(speed_per_volt, -300.0);
    BAD(feed_forward, 1.0001);
    BAD(feed_forward, -0.1);
    BAD(lag, -1e-3);
    BAD(lag, INFINITY);
#undef BAD
    d = settings(8);
    REFUSED(groups_set_dac(&set, 0, 8, &d), MCC_GROUP_PARAMETER);
    REFUSED(groups_set_dac(&set, 2, 0, &d), MCC_GROUP_PARAMETER);
    CHECK_EQ(groups_set_dac(&set, 0, 7, &d), MCC_NO_ERR);
    REFUSED(groups_set_command_mode(&set, 0, 0, 2), MCC_PARAMETER);
    REFUSED(groups_set_command_mode(&set, 0, 6, 1), MCC_GROUP_PARAMETER);
    /* without settings there is no axis */
    const struct machine card[GROUP_CARDS] = { mcc_machine(), mcc_machine() }, motion = card[0];
    const struct group_config config = { .bus = 4000, .ipo = 40000 };
    groups_init(&set, &config, card);
    REFUSED(group_create_voltage(&set, 0, pair, &motion), MCC_GROUP_PARAMETER);
}

/* -9: a DAC has one source, the voltage of an axis or what a call says. */
static void voltage_command_channel(void)
{
    const struct machine motion = mcc_machine();
    const struct group_dac d = settings(0);
    fresh();
    CHECK_EQ(groups_set_command_mode(&set, 0, 1, GROUP_COMMAND_VOLTAGE), MCC_NO_ERR);
    CHECK_EQ(groups_set_dac_output(&set, 0, 1, 2.0), MCC_NO_ERR); /* no group has channel 1 */
    CHECK_EQ(group_create(&set, 0, xy, &motion), 0);
    REFUSED(groups_set_dac_output(&set, 0, 1, 2.0), MCC_VOLTAGE_COMMAND_CHANNEL);
    REFUSED(group_create_voltage(&set, 0, (int32_t[]){ 2, 1, -1, -1, -1, -1 }, &motion),
            MCC_VOLTAGE_COMMAND_CHANNEL);
    CHECK_EQ(groups_set_dac_output(&set, 0, 0, -3.0), MCC_NO_ERR); /* channel 0 gives pulses */
    CHECK(set.card[0].volts[0] == -3.0);
    CHECK_EQ(group_create_voltage(&set, 0, (int32_t[]){ 0, 7, -1, -1, -1, -1 }, &motion), 1);
    CHECK(set.card[0].volts[0] == 0.0);
    REFUSED(groups_set_dac_output(&set, 0, 0, 1.0), MCC_VOLTAGE_COMMAND_CHANNEL);
    REFUSED(groups_set_dac_output(&set, 0, 7, 1.0), MCC_VOLTAGE_COMMAND_CHANNEL);
    REFUSED(groups_set_command_mode(&set, 0, 0, GROUP_COMMAND_VOLTAGE),
            MCC_VOLTAGE_COMMAND_CHANNEL);
    REFUSED(groups_set_dac(&set, 0, 7, &d), MCC_VOLTAGE_COMMAND_CHANNEL);
    CHECK_EQ(groups_set_dac_output(&set, 1, 7, 1.0), MCC_NO_ERR);
    CHECK_EQ(groups_set_dac_output(&set, 0, 6, 10.0), MCC_NO_ERR);
    REFUSED(groups_set_dac_output(&set, 0, 6, -10.001), MCC_PARAMETER);
    REFUSED(groups_set_dac_output(&set, 0, 6, NAN), MCC_PARAMETER);
    REFUSED(groups_set_dac_output(&set, 0, 8, 0.0), MCC_GROUP_PARAMETER);
    /* the mode stands before the group of pulses: then that one is refused */
    fresh();
    CHECK_EQ(group_create_voltage(&set, 0, xy, &motion), 0);
    CHECK_EQ(groups_set_command_mode(&set, 0, 1, GROUP_COMMAND_VOLTAGE), MCC_NO_ERR);
    REFUSED(group_create(&set, 0, xy, &motion), MCC_VOLTAGE_COMMAND_CHANNEL);
    CHECK_EQ(groups_set_command_mode(&set, 0, 1, GROUP_COMMAND_PULSE), MCC_NO_ERR);
    CHECK_EQ(group_create(&set, 0, xy, &motion), 1);
}

/* A counter closes one loop. */
static void counters(void)
{
    const struct machine motion = mcc_machine();
    const struct group_dac d = settings(2);
    fresh();
    CHECK_EQ(groups_set_dac(&set, 0, 7, &d), MCC_NO_ERR);
    REFUSED(group_create_voltage(&set, 0, (int32_t[]){ 2, 7, -1, -1, -1, -1 }, &motion),
            MCC_GROUP_PARAMETER);
    CHECK_EQ(group_create_voltage(&set, 0, pair, &motion), 0);
    REFUSED(group_create_voltage(&set, 0, (int32_t[]){ 2, -1, -1, -1, -1, -1 }, &motion),
            MCC_GROUP_PARAMETER);
    CHECK_EQ(groups_set_command_mode(&set, 0, 2, GROUP_COMMAND_VOLTAGE), MCC_NO_ERR);
    REFUSED(group_create(&set, 0, (int32_t[]){ 2, -1, -1, -1, -1, -1 }, &motion),
            MCC_GROUP_PARAMETER);
}

/* Each axis has the settings of its own DAC, one that the group does not have those of another. */
static void settings_of_axes(void)
{
    const struct machine motion = mcc_machine();
    fresh();
    for (int i = 0; i < 3; i++) {
        struct group_dac d = settings(i);
        d.axis.ppr = 1000 + i;
        CHECK_EQ(groups_set_dac(&set, 0, i, &d), MCC_NO_ERR);
    }
    CHECK_EQ(group_create_voltage(&set, 0, (int32_t[]){ 2, 0, 1, -1, -1, -1 }, &motion), 0);
    const struct machine_axis *axis = set.group[0].mcc.machine.axis;
    CHECK(axis[0].ppr == 1002 && axis[1].ppr == 1000 && axis[2].ppr == 1001);
    CHECK(axis[0].used && axis[1].used && axis[2].used && !axis[3].used);
    CHECK(axis[3].ppr == 1001);
}

int main(void)
{
    channels();
    settings_of_axes();
    values();
    voltage_command_channel();
    counters();
    return check_result();
}
