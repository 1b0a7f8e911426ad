/* card_settings - the settings of the network card. Each is declared once, with its start value,
 * range, unit and description, for everything that offers it under this name. Its number in the
 * list is its id on the link (CONFIG_GET, CONFIG_SET), with the number of the element as index.
 *
 *     X(type, name, elements, unit, start, low, high, words)
 *
 * Positions are in pulses; times are whole numbers of the unit given.
 */
#ifndef CARD_SETTINGS_H
#define CARD_SETTINGS_H

#include <stdbool.h>
#include <stdint.h>

enum { CARD_AXES = 4, CARD_INPUTS = 16, CARD_OUTPUTS = 16 };

/* In this order: the trigger of an origin, the edge of an input, what an input does, what the loss
 * of the link does, and the policy, which is the rules for commands. */
enum card_trigger { CARD_RISING, CARD_FALLING, CARD_HIGH, CARD_LOW };
enum card_edge { CARD_EDGE_RISE, CARD_EDGE_FALL, CARD_EDGE_BOTH };
enum card_action { CARD_NONE, CARD_START, CARD_PAUSE, CARD_STOP, CARD_HOME, CARD_EVENT };
enum card_link_loss { CARD_LOSS_PAUSE, CARD_LOSS_STOP, CARD_LOSS_GO_ON };
enum card_policy { CARD_SAFE, CARD_LITERAL };

#define CARD_SETTINGS_AXES(X) \
    X(int32_t, pulses_per_m, [4], "1/m", 1000000, 1, 1000000000, \
      "Pulses per metre; what the page shows") \
    X(int32_t, position_low, [4], "", -2147483647, -2147483647, 2147483647, \
      "Lowest position a job may lead to [pulses]") \
    X(int32_t, position_high, [4], "", 2147483647, -2147483647, 2147483647, \
      "Highest position a job may lead to [pulses]") \
    X(bool, limit_high, [4], "", true, false, true, "Limit switches are active at the high level") \
    X(bool, alarm_high, [4], "", true, false, true, \
      "The drive's alarm is active at the high level") \
    X(int32_t, origin_trigger, [4], "", 0, 0, 3, \
      "Origin switch: 0 rising edge, 1 falling edge, 2 high level, 3 low level") \
    X(int32_t, speed_max, [4], "1/s", 200000, 1, 500000, \
      "Highest speed [pulses/s]; what the page and homing keep to") \
    X(int32_t, speed_min, [4], "1/s", 500, 0, 500000, \
      "Speed at which an axis may start and stop at once [pulses/s]") \
    X(int32_t, acc_max, [4], "1/s2", 1000000, 1, 2000000000, "Highest acceleration [pulses/s2]") \
    X(double, jerk_max, [4], "1/s3", 5e7, 1.0, 1e15, "Highest jerk [pulses/s3]") \
    X(int32_t, home_order, [4], "", 1, 0, 4, \
      "Turn in which the axis goes home, equal numbers together; 0 not at all") \
    X(bool, home_plus, [4], "", false, false, true, "The axis looks for its origin upwards") \
    X(int32_t, home_speed, [4], "1/s", 20000, 1, 500000, \
      "Speed towards the origin switch [pulses/s]") \
    X(int32_t, home_slow, [4], "1/s", 1000, 1, 500000, \
      "Speed of the second, exact approach [pulses/s]") \
    X(int32_t, home_back, [4], "", 2000, 1, 100000000, \
      "Way back off the switch between the two [pulses]") \
    X(int32_t, home_travel, [4], "", 2000000, 1, 2000000000, \
      "Way in which the switch must be found [pulses]") \
    X(int32_t, home_offset, [4], "", 0, -100000000, 100000000, \
      "Way from the origin to where the position is 0 [pulses]")

#define CARD_SETTINGS_FPGA(X) \
    X(int32_t, fifo_depth, , "", 512, 16, 2304, "Frames of the FIFO in the FPGA") \
    X(int32_t, period_ns, , "ns", 1000000, 20000, 10000000, \
      "DDA period of homing, a multiple of 20 ns; a job brings its own") \
    X(int32_t, pulse_width_ns, , "ns", 1000, 20, 1000000, \
      "A pulse is high so long at most, in whole 20 ns") \
    X(int32_t, dir_setup_ns, , "ns", 5000, 0, 1000000, \
      "From a change of direction to the first pulse, in whole 20 ns") \
    X(int32_t, dir_hold_ns, , "ns", 5000, 0, 1000000, \
      "From the last pulse to a change of direction, in whole 20 ns") \
    X(double, reserve, , "", 0.1, 0.02, 1.0, \
      "Share of a job's acceleration and jerk that its plan leaves free for pauses") \
    X(int32_t, fsmc_word_ns, , "ns", 48, 1, 10000, \
      "A word of 16 bits written to the FPGA; a frame has five")

#define CARD_SETTINGS_TASKS(X) \
    X(int32_t, priority_parser, , "", 7, 1, 15, "Priority of the parser, the highest first") \
    X(int32_t, priority_storage, , "", 6, 1, 15, "Priority of the storage task") \
    X(int32_t, priority_home, , "", 5, 1, 15, "Priority of the home task while it waits") \
    X(int32_t, priority_home_active, , "", 2, 1, 15, "Priority of the home task while it works") \
    X(int32_t, priority_stop, , "", 4, 1, 15, "Priority of the stop task") \
    X(int32_t, priority_pause, , "", 3, 1, 15, "Priority of the pause task") \
    X(int32_t, priority_run, , "", 1, 1, 15, "Priority of the run task") \
    X(int32_t, tick_ns, , "ns", 1000000, 10000, 100000000, "Tick of the kernel") \
    X(int32_t, tick_time_ns, , "ns", 1000, 0, 1000000, "What a tick takes") \
    X(int32_t, switch_ns, , "ns", 2500, 0, 1000000, "What a give and a switch of tasks take") \
    X(int32_t, entry_ns, , "ns", 100, 0, 1000000, "From an interrupt to its first line") \
    X(int32_t, isr_cycles, , "", 120, 0, 10000000, "Cycles of an interrupt's own lines") \
    X(int32_t, packet_cycles, , "", 2500, 0, 100000000, "Cycles of a packet in the parser") \
    X(int32_t, byte_cycles, , "", 12, 0, 1000000, "Cycles of each of its bytes") \
    X(int32_t, frame_cycles, , "", 200, 0, 100000000, "Cycles of the decoding of a frame") \
    X(int32_t, page_cycles, , "", 3000, 0, 100000000, \
      "Cycles in which a page that is read is checked") \
    X(int32_t, step_cycles, , "", 1500, 1, 100000000, \
      "Cycles of a step of the home, stop and pause tasks")

#define CARD_SETTINGS_FLASH(X) \
    X(int32_t, slots, , "", 2, 1, 2, \
      "Slots for jobs: 2 keep the old job until the new one is whole, 1 has twice the room") \
    X(int32_t, program_us, , "us", 700, 1, 100000, "Usual time of the program of a page") \
    X(int32_t, program_most_us, , "us", 3000, 1, 100000, "Longest time of the program of a page") \
    X(int32_t, erase_ms, , "ms", 45, 1, 100000, "Usual time of the erase of a sector of 4 KB") \
    X(int32_t, erase_most_ms, , "ms", 400, 1, 100000, \
      "Longest time of the erase of a sector of 4 KB") \
    X(int32_t, block_ms, , "ms", 150, 1, 100000, "Usual time of the erase of a block of 64 KB") \
    X(int32_t, block_most_ms, , "ms", 2000, 1, 100000, \
      "Longest time of the erase of a block of 64 KB") \
    X(int32_t, flash_spread, , "", 0, 0, 1000, \
      "Share of the way from usual to longest that a time is drawn from [1/1000]") \
    X(int32_t, spi_hz, , "Hz", 42000000, 100000, 200000000, "Clock of the bus of the flash") \
    X(bool, write_during_run, , "", false, false, true, \
      "A job may be received while another one runs")

#define CARD_SETTINGS_WIRES(X) \
    X(int32_t, on_link_loss, , "", 0, 0, 2, \
      "A link that is lost while a job runs: 0 pauses, 1 stops, 2 changes nothing") \
    X(int32_t, in_action, [16], "", 0, 0, 5, \
      "What an input does: 0 nothing, 1 start, 2 pause, 3 stop, 4 home, 5 a user's event") \
    X(int32_t, in_edge, [16], "", 0, 0, 2, "At which edge: 0 rising, 1 falling, 2 both") \
    X(int32_t, in_debounce_us, [16], "us", 10000, 0, 1000000, \
      "Time in which an input is deaf behind an edge") \
    X(bool, must_home, , "", false, false, true, \
      "A job starts only when every axis with a home_order is homed") \
    X(int32_t, policy, , "", 0, 0, 1, \
      "Rules: 0 safe, a table of state and command; 1 literal, the document's scheme") \
    X(int32_t, seed, , "", 1, 0, 2147483647, "Seed of nonces, of torn writes, of jitter") \
    X(int32_t, card_id, , "", 1, 0, 2147483647, "Number of the card")

#define CARD_SETTINGS(X) \
    CARD_SETTINGS_AXES(X) \
    CARD_SETTINGS_FPGA(X) CARD_SETTINGS_TASKS(X) CARD_SETTINGS_FLASH(X) CARD_SETTINGS_WIRES(X)

#define CARD_MEMBER(type, name, elements, unit, start, low, high, words) type name elements;
struct card_settings {
    CARD_SETTINGS(CARD_MEMBER)
};

/* Number of each setting on the link. */
#define CARD_NUMBER(type, name, elements, unit, start, low, high, words) CARD_SET_##name,
enum card_setting { CARD_SETTINGS(CARD_NUMBER) CARD_SETTING_COUNT };

struct card_settings card_settings_start(void);

/* A setting that is not good, and why. */
struct card_wrong {
    const char *name, *why; /* why NULL: the value is not within low .. high */
    int32_t index;          /* element of the setting, from 0 */
    double value, low, high;
};

/* True if a card can have these settings; if not, *wrong is the first one that is not good. */
bool card_settings_good(const struct card_settings *s, struct card_wrong *wrong);

/* Value of a setting by its number, rounded to a whole number. False if there is no such
 * setting. */
bool card_settings_get(const struct card_settings *s, int id, int index, int64_t *value);

/* Set a setting by its number. False, and nothing changes, if there is no such setting or the
 * settings would not be good. */
bool card_settings_set(struct card_settings *s, int id, int index, int64_t value);

#endif
