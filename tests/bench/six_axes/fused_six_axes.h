/* Of six_axes: axes in use; component, variable, C type and elements of what it records. */
#ifndef FUSED_SIX_AXES_H
#define FUSED_SIX_AXES_H

#include <stdbool.h>
#include <stdint.h>

enum { USED = 6 };

/* clang-format off */
#define RECORDED(X)                                                                               \
    X(mcc, status, int32_t, 1) X(mcc, homed, bool, 1)                                             \
    X(mcc, done, bool, 1) X(mcc, failed, bool, 1)                                                 \
    X(mcc, error, int32_t, 1) X(mcc, line, int32_t, 1) X(mcc, command, int32_t, 1)                \
    X(mcc, command_newest, int32_t, 1) X(mcc, path_feed, double, 1)                               \
    X(mcc, position, double, AXES) X(mcc, compensation, int32_t, AXES)                            \
    X(mcc, spindle_speed, double, 1) X(mcc, coolant, int32_t, 1) X(mcc, digital_out, int32_t, 1)  \
    X(mcc, work_offset, double, AXES) X(mcc, distance_to_go, double, AXES)                        \
    X(mcc, probed, double, AXES) X(mcc, probe_found, bool, 1)                                     \
    X(mcc, system, int32_t, 1) X(mcc, mdi_taken, int32_t, 1)                                      \
    X(mcc, mdi_room, int32_t, 1) X(mcc, mdi_lines, int32_t, 1) X(mcc, mdi_done, int32_t, 1)       \
    X(mcc, mdi_fault, int32_t, 1) X(mcc, mdi_refused, int32_t, 1)                                 \
    X(mcc, queue, int32_t, 1) X(mcc, starved, int32_t, 1) X(mcc, services, int32_t, 1)            \
    X(mcc, latency, double, 1) X(mcc, serving, int32_t, 1) X(mcc, module, int32_t, 1)             \
    X(mcc, module_runs, int32_t, AXES) X(mcc, module_latency, double, AXES)                       \
    X(mcc, module_response, double, AXES) X(mcc, module_missed, int32_t, AXES)                    \
    X(mcc, module_load, double, AXES) X(mcc, card_dda_length, int32_t, 1)                         \
    X(mcc, card_dda_divider, int32_t, 1) X(mcc, card_dda_run, bool, 1)                            \
    X(mcc, card_min_stock, int32_t, 1) X(mcc, card_ack_seq, int32_t, 1)                           \
    X(mcc, card_p_gain, int32_t, AXES) X(mcc, card_loop_on, bool, AXES)                           \
    X(mcc, card_dac_source, int32_t, AXES) X(mcc, card_dac_volts, double, AXES)                   \
    X(mcc, card_cmd_seq, int32_t, 1) X(mcc, card_cmd_clock, double, 1)                            \
    X(mcc, card_cmd_count, int32_t, 1) X(mcc, card_index_low, bool, AXES)                         \
    X(mcc, card_latch_seq, int32_t, AXES) X(mcc, card_clear_seq, int32_t, 1)                      \
    X(mcc, tool, int32_t, 1) X(mcc, tool_asked, int32_t, 1) X(mcc, analog, double, 4)             \
    X(mcc, tool_rows, int32_t, 1)                                                                 \
    X(card, irq, bool, 1) X(card, irq_seq, int32_t, 1) X(card, irq_clock, double, 1)              \
    X(card, irq_pages, int32_t, 1) X(card, cmd_ack, int32_t, 1) X(card, reg_ack, int32_t, 1)      \
    X(card, reg_status, int32_t, 1) X(card, frames_taken, int32_t, 1)                             \
    X(card, frames_refused, int32_t, 1) X(card, stock, int32_t, AXES)                             \
    X(card, underflows, int32_t, AXES) X(card, overflows, int32_t, 1)                             \
    X(card, dda_time, double, 1) X(card, dda_command, int32_t, AXES)                              \
    X(card, pulse_count, int32_t, AXES) X(card, pulse_a, bool, AXES) X(card, pulse_b, bool, AXES) \
    X(card, pulse_clock, double, AXES) X(card, enc_count, int32_t, AXES)                          \
    X(card, enc_count_7, int32_t, 1) X(card, enc_count_8, int32_t, 1)                             \
    X(card, enc_count_9, int32_t, 1) X(card, enc_too_fast, int32_t, 1)                            \
    X(card, latch_value, int32_t, AXES) X(card, latch_value_7, int32_t, 1)                        \
    X(card, latch_value_8, int32_t, 1) X(card, latch_value_9, int32_t, 1)                         \
    X(card, latch_seen, int32_t, AXES) X(card, latch_seen_7, int32_t, 1)                          \
    X(card, latch_seen_8, int32_t, 1) X(card, latch_seen_9, int32_t, 1)                           \
    X(card, err_count, int32_t, AXES) X(card, err_count_7, int32_t, 1) X(card, dac, double, AXES) \
    X(card, dac_7, double, 1) X(card, dac_8, double, 1) X(card, dac_six_aux, double, AXES)        \
    X(card, dac_fired, int32_t, 1) X(card, adc, double, AXES) X(card, adc_7, double, 1)           \
    X(card, adc_8, double, 1) X(card, adc_conversions, int32_t, 1) X(card, adc_busy, bool, 1)     \
    X(card, inputs, int32_t, 1) X(card, home, int32_t, 1) X(card, over_travel, int32_t, 1)        \
    X(card, stopped, bool, 1) X(card, off, bool, 1) X(card, ldo, int32_t, 1)                      \
    X(card, servo_on, bool, AXES) X(card, position_ready, bool, 1)                                \
    X(card, timer_fired, int32_t, 1) X(card, watchdog_expired, bool, 1)                           \
    X(card, remote_in_1, int32_t, AXES) X(card, remote_in_2, int32_t, AXES)                       \
    X(card, remote_in_3, int32_t, AXES) X(card, remote_in_4, int32_t, AXES)                       \
    X(card, remote_out_1, int32_t, AXES) X(card, remote_out_2, int32_t, AXES)                     \
    X(card, remote_out_3, int32_t, AXES) X(card, remote_out_4, int32_t, AXES)                     \
    X(card, remote_ready, int32_t, 1) X(card, remote_errors, int32_t, AXES)                       \
    X(drives, torque, double, AXES) X(drives, speed, double, AXES)                                \
    X(drives, speed_command, double, AXES) X(drives, following_error, double, AXES)               \
    X(drives, load_ratio, double, AXES)                                                           \
    X(drives, ready, bool, AXES) X(drives, saturated, bool, AXES) X(drives, alarm, int32_t, AXES) \
    X(machine, motor_torque, double, AXES) X(machine, motor_angle, double, AXES)                  \
    X(machine, motor_speed, double, AXES) X(machine, motor_phase, double, AXES)                   \
    X(machine, index, bool, AXES) X(machine, table_position, double, AXES)                        \
    X(machine, table_speed, double, AXES) X(machine, table_phase, double, AXES)                   \
    X(machine, screw_force, double, AXES) X(machine, home_switch, bool, AXES)                     \
    X(machine, lower_limit, bool, AXES) X(machine, upper_limit, bool, AXES)
/* clang-format on */

#endif
