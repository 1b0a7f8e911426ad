/* Every setting of the controller counts: another value of any element is another configuration.
 * Times, rates and angles are what they say, in clocks and rad. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "controller_settings.h"

static struct controller_settings s;
static struct controller_config usual, by_axes;
static int count;

/* An arm by its axes, whose directions depend on each number. */
static void with_axes(void)
{
    for (int i = 0; i < 18; i++) {
        s.axis_direction[i] = 1.0 + i;
    }
    s.arm_by = 1;
}

/* Another value within the range, as far from the start as it goes. */
static double other(double start, double low, double high)
{
    return start == high ? low : high > 1e9 ? 2.0 * start + 1.0 : high;
}

static void changed(const char *name, size_t element)
{
    static struct controller_config c;
    struct controller_wrong wrong;

    controller_configure(&s, &c);
    const bool counts = memcmp(&c, &usual, sizeof c) != 0;
    s.arm_by ^= 1; /* what is of the arm by its axes, or by its lengths */
    controller_configure(&s, &c);
    s.arm_by ^= 1;
    if (!counts && memcmp(&c, &by_axes, sizeof c) == 0) {
        check_failures++;
        printf("%s[%d] counts for nothing\n", name, (int)element);
    }
    CHECK(controller_settings_good(&s, &wrong) || wrong.name);
    count++;
}

/* A value beyond either end of its range is refused by its name, element and bounds. */
static void refused(const char *name, size_t element, double value, double low, double high)
{
    struct controller_wrong wrong = { 0 };

    CHECK(!controller_settings_good(&s, &wrong));
    CHECK(wrong.name && !strcmp(wrong.name, name));
    CHECK(!wrong.why);
    CHECK_EQ(wrong.index, element);
    CHECK_EQ(wrong.value, value);
    CHECK_EQ(wrong.low, low);
    CHECK_EQ(wrong.high, high);
}

#define IS(type, like) _Generic((type)0, like: true, default: false)

#define EACH(type, name, elements, unit, start, low, high) \
    for (size_t i = 0; i < sizeof s.name / sizeof(type); i++) { \
        type *value = (type *)&s.name + i; \
        const type was = *value; \
        *value = (type)(IS(type, bool) ? !was : other((double)was, low, high)); \
        changed(#name, i); \
        if (IS(type, double)) { \
            *value = (type)((high) * 1.001 + 1e-9); \
            refused(#name, i, (double)*value, low, high); \
            *value = (type)((low) - fabs((double)(low)) * 0.001 - 1e-9); \
            refused(#name, i, (double)*value, low, high); \
        } else if (IS(type, int32_t) && (double)(high) < 1e9) { \
            *value = (type)((double)(high) + 1); \
            refused(#name, i, (double)*value, low, high); \
            *value = (type)((double)(low) - 1); \
            refused(#name, i, (double)*value, low, high); \
        } \
        *value = was; \
    }

static void wrong_together(const char *name, const char *why)
{
    struct controller_wrong wrong = { 0 };

    CHECK(!controller_settings_good(&s, &wrong));
    CHECK(wrong.name && !strcmp(wrong.name, name));
    CHECK(wrong.why && !strcmp(wrong.why, why));
    s = controller_defaults();
    CHECK(controller_settings_good(&s, &wrong));
}

int main(void)
{
    struct controller_wrong wrong;

    s = controller_defaults();
    CHECK(controller_settings_good(&s, &wrong));
    controller_configure(&s, &usual);
    /* Where the longest wait is at work it is longer than the least. */
    s.irq_longest = 1e-3;
    s.external = EXTERNAL_TRACK;
    for (int i = 0; i < 3; i++) {
        s.external_direction[i] = 1.0 + i;
    }
    with_axes();
    controller_configure(&s, &by_axes);
    s.arm_by = 0;
    controller_configure(&s, &usual);
    CONTROLLER_SETTINGS(EACH)
    CHECK(count > 120);

    s = controller_defaults();
    s.bus_period = 5.001e-5;
    wrong_together("bus_period", "not a whole number of 25 ns clocks");
    s.arm_by = 1;
    wrong_together("axis_direction", "an axis without direction");
    with_axes();
    s.joint_sign[2] = -1;
    wrong_together("joint_sign", "1 is wanted, as axis_direction has the sign");
    with_axes();
    s.joint_level[3] = 2;
    wrong_together("joint_level", "no palletizer of four joints");
    with_axes();
    s.hand_offset[1] = 0.1;
    wrong_together("hand_offset", "no hand that joint_level[4] = 2 keeps level");
    with_axes();
    s.external = EXTERNAL_TABLE;
    s.external_high = s.external_low;
    wrong_together("external_low", "not below external_high");
    s.external = EXTERNAL_TRACK;
    s.external_direction[0] = 0.0;
    wrong_together("external_direction", "no direction");
    with_axes();
    s.singular = ROBOT_WRIST;
    wrong_together("singular", "not of an arm by its axes");
    s.joint_sign[3] = 0;
    wrong_together("joint_sign", "1 or -1 is wanted");
    s.joint_low[2] = s.joint_high[2];
    wrong_together("joint_low", "not below joint_high");

    /* 40 MHz: 50 us are 2000 clocks, 36 us 1440, 1 KB at 133 MB/s 308. */
    CHECK_EQ(usual.bus, 2000);
    CHECK_EQ(usual.point, 1440);
    CHECK_EQ(usual.copy_in, 308);
    CHECK_EQ(usual.copy_out, 924);
    CHECK_EQ(usual.layers.access, 40);
    CHECK_EQ(usual.layers.tick, 400000);
    CHECK_EQ(usual.depth, 32);
    CHECK_EQ(usual.servo, 0x7f);
    CHECK_NEAR(usual.zero[4], 1.5707963267948966, 1e-15);
    CHECK_NEAR(usual.robot.cycle, 1e-4, 1e-18);
    CHECK_NEAR(usual.robot.feed, 3000.0, 1e-9);
    CHECK_NEAR(usual.robot.scale[1], 120.0 * 2500.0 / 6.283185307179586, 1e-9);
    CHECK_NEAR(usual.orders.feed, 10.0, 1e-12);
    return check_result();
}
