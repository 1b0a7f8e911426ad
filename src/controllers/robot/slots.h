/* slots - pulses of a cycle in its slots: differences of the rounded straight line from the joints
 * at its start to those at its end. So no joint is more than half a pulse off at any slot's end,
 * and nothing adds up. */
#ifndef SLOTS_H
#define SLOTS_H

#include <stdbool.h>
#include <stdint.h>

/* Pulses of a joint in each of the slots of a cycle; false: none in any of them, pulses[] is as it
 * was. Joints [rad], scale [pulses/rad]. */
bool slots_pulses(double from, double to, double scale, int32_t slots, int32_t pulses[]);

#endif
