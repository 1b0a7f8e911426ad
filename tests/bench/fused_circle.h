/* Of scenarios/circle: axes in use; component, variable, C type and elements of what it records. */
#ifndef FUSED_CIRCLE_H
#define FUSED_CIRCLE_H

#include <stdbool.h>
#include <stdint.h>

enum { USED = 2 };

#define RECORDED(X) \
    X(machine, table_position, double, AXES) \
    X(card, dac, double, AXES) \
    X(drives, torque, double, AXES) \
    X(drives, speed, double, AXES) \
    X(drives, alarm, int32_t, AXES) \
    X(mcc, path_feed, double, 1) \
    X(card, pulse_count, int32_t, AXES) \
    X(card, stock, int32_t, AXES) \
    X(card, underflows, int32_t, AXES) \
    X(card, err_count, int32_t, AXES) \
    X(mcc, command, int32_t, 1) \
    X(mcc, command_newest, int32_t, 1) \
    X(mcc, line, int32_t, 1) \
    X(mcc, status, int32_t, 1) \
    X(mcc, error, int32_t, 1) \
    X(mcc, queue, int32_t, 1) \
    X(mcc, starved, int32_t, 1) \
    X(card, irq_seq, int32_t, 1) \
    X(mcc, done, bool, 1) \
    X(mcc, card_dda_length, int32_t, 1) \
    X(mcc, card_dda_divider, int32_t, 1)

#endif
