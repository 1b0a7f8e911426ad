/* controller_settings - what a user sets of a robot controller, in a user's units. Each setting is
 * declared once, with its start value and range, for whoever offers it under this name.
 *
 *     X(type, name, elements, unit, start, low, high)
 */
#ifndef CONTROLLER_SETTINGS_H
#define CONTROLLER_SETTINGS_H

#include "controller.h"

/* The driver's cycle, the card's slots, copies over the bus, times of the processor. */
#define CONTROLLER_TIMES(X) \
    X(double, bus_period, , "s", 5e-5, 25e-9, 1e-2) /* whole clocks */ \
    X(double, start_delay, , "s", 0.0, 0.0, 1e6) \
    X(int32_t, slot_clocks, , "clocks", 200, 8, 4000) \
    X(int32_t, slots, , "", 20, 1, FPGA_SLOTS) \
    X(int32_t, pulse_format, , "", 0, 0, 1) /* enum fpga_format */ \
    X(bool, servo, [6], "", true, false, true) \
    X(double, irq_latency, , "s", 5e-7, 0.0, 1.0) \
    X(double, irq_mean, , "s", 0.0, 0.0, 1.0) \
    X(double, irq_rare, , "", 0.0, 0.0, 1.0) \
    X(double, irq_longest, , "s", 5e-7, 0.0, 1.0) \
    X(double, access_time, , "s", 1e-6, 0.0, 1.0) \
    X(double, bus_read_rate, , "1/s", 133e6, 1e3, 1e12) \
    X(double, bus_write_rate, , "1/s", 133e6, 1e3, 1e12) \
    X(int32_t, bus_bytes_in, , "", 1024, 0, FPGA_ALL_BYTES) \
    X(int32_t, bus_bytes_out, , "", 3072, 0, FPGA_ALL_BYTES) \
    X(double, line_time, , "s", 0.0, 0.0, 1.0) \
    X(double, ik_time, , "s", 36e-6, 0.0, 1.0) \
    X(double, pitch, , "mm", 0.1, 1e-6, 1e6) \
    X(int32_t, lines, , "", 4, 1, 1000)

#define CONTROLLER_LAYERS(X) \
    X(double, timer_period, , "s", 1e-2, 1e-4, 10.0) \
    X(double, poll_period, , "s", 36e-3, 1e-4, 10.0) \
    X(double, quantum, , "s", 36e-3, 0.0, 10.0) \
    X(double, crowded, , "", 0.0, 0.0, 1.0) \
    X(int32_t, follow_interrupt, , "", 0, INT32_MIN, INT32_MAX) \
    X(int32_t, follow_driver, , "", 0, INT32_MIN, INT32_MAX) \
    X(int32_t, follow_timer, , "", 0, INT32_MIN, INT32_MAX) \
    X(int32_t, follow_user, , "", 0, INT32_MIN, INT32_MAX) \
    X(int32_t, program_layer, , "", 0, 0, 1) \
    X(int32_t, queue_depth, , "", 32, 1, CONTROLLER_QUEUE) \
    X(int32_t, seed, , "", 1, INT32_MIN, INT32_MAX)

#define CONTROLLER_ARM(X) \
    X(double, a1, , "m", 0.150, -10.0, 10.0) \
    X(double, a2, , "m", -0.115, -10.0, 10.0) \
    X(double, b, , "m", 0.0, -10.0, 10.0) \
    X(double, c1, , "m", 0.445, -10.0, 10.0) \
    X(double, c2, , "m", 0.700, 1e-3, 10.0) \
    X(double, c3, , "m", 0.795, 1e-3, 10.0) \
    X(double, c4, , "m", 0.085, -10.0, 10.0) \
    X(int32_t, arm_by, , "", 0, 0, 1) /* its lengths a1 .. c4, or its axes */ \
    X(int32_t, joints, , "", 6, 1, 6) /* by its axes */ \
    X(int32_t, joint_slides, [6], "", 0, 0, 1) \
    X(int32_t, joint_level, [6], "", 0, 0, 2)            /* chain_joint.level */ \
    X(double, hand_offset, [3], "m", 0.0, -100.0, 100.0) /* of a palletizer */ \
    X(double, axis_origin, [18], "m", 0.0, -100.0, 100.0) \
    X(double, axis_direction, [18], "", 0.0, -1e3, 1e3) \
    X(double, flange, [6], "mm, deg", 0.0, -1e4, 1e4) \
    X(double, joint_offset, [6], "deg", 0.0, -3600.0, 3600.0) \
    X(int32_t, joint_sign, [6], "", 1, -1, 1) /* not 0 */ \
    X(double, joint_low, [6], "deg", 0.0, -3600.0, 3600.0) \
    X(double, joint_high, [6], "deg", 0.0, -3600.0, 3600.0) \
    X(double, joint_speed, [6], "deg/s", 0.0, 1e-3, 36000.0) \
    X(double, joint_acc, [6], "deg/s2", 0.0, 1e-3, 1e6) \
    X(double, gear_ratio, [6], "", 0.0, 1e-3, 1e5) \
    X(int32_t, pulses_per_turn, [6], "", 2500, 1, 10000000) \
    X(double, start_joint, [6], "deg", 0.0, -3600.0, 3600.0) \
    X(double, tool, [6], "mm, deg", 0.0, -1e4, 1e4)

/* An axis outside the arm, in mm, of a table in deg. */
#define CONTROLLER_EXTERNAL(X) \
    X(int32_t, external, , "", 0, 0, 2) /* enum external_kind */ \
    X(double, external_direction, [3], "", 0.0, -1e3, 1e3) \
    X(double, external_low, , "mm, deg", -1000.0, -1e6, 1e6) \
    X(double, external_high, , "mm, deg", 1000.0, -1e6, 1e6) \
    X(double, external_speed, , "mm/s, deg/s", 1000.0, 1e-3, 1e6) \
    X(double, external_acc, , "mm/s2, deg/s2", 1000.0, 1e-3, 1e7) \
    X(double, external_gear, , "", 100.0, 1e-3, 1e5) \
    X(int32_t, external_pulses, , "", 2500, 1, 10000000) \
    X(double, external_start, , "mm, deg", 0.0, -1e6, 1e6)

#define CONTROLLER_PATH(X) \
    X(double, origin, [6], "mm, deg", 0.0, -1e5, 1e5) /* of G54 */ \
    X(double, feed, , "mm/min", 600.0, 1e-6, 1e6) \
    X(double, max_feed, , "mm/min", 180000.0, 1e-6, 1e6) \
    X(double, acceleration, , "mm/s2", 1000.0, 1e-3, 1e6) \
    X(double, smooth_time, , "s", 0.0, 0.0, 0.2) \
    X(double, max_spin, , "deg/s", 180.0, 1e-3, 36000.0) \
    X(double, rapid, , "", 0.5, 1e-3, 1.0) \
    X(double, zone, [9], "mm", 0.0, 0.0, 1e4) \
    X(bool, flow, , "", false, false, true) \
    X(int32_t, singular, , "", 0, 0, 2) /* enum robot_singular */ \
    X(bool, block_delete, , "", true, false, true) \
    X(bool, optional_stop, , "", false, false, true) \
    X(bool, tool_stop, , "", true, false, true)

#define CONTROLLER_SETTINGS(X) \
    CONTROLLER_TIMES(X) \
    CONTROLLER_LAYERS(X) CONTROLLER_ARM(X) CONTROLLER_EXTERNAL(X) CONTROLLER_PATH(X)

#define CONTROLLER_MEMBER(type, name, elements, unit, start, low, high) type name elements;
struct controller_settings {
    CONTROLLER_SETTINGS(CONTROLLER_MEMBER)
};

/* The settings at the start: the document's times and an IRB 2600-12/1.65, whose joints differ. */
struct controller_settings controller_defaults(void);

/* What is wrong with a setting. */
struct controller_wrong {
    const char *name, *why; /* why NULL: not within low .. high */
    int32_t index;          /* from 0 */
    double value, low, high;
};

/* Whether a controller can have these settings; if not, *wrong is the first that is wrong. */
bool controller_settings_good(const struct controller_settings *s, struct controller_wrong *wrong);

void controller_configure(const struct controller_settings *s, struct controller_config *c);

#endif
