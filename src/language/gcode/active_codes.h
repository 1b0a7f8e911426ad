/* active_codes - the G codes in force, as a panel shows them. */
#ifndef ACTIVE_CODES_H
#define ACTIVE_CODES_H

#include "modes.h"

enum { ACTIVE_CODES = 16 };

/* Ten times the number of each code, -1: none. In their order: motion, plane, G90 or G91, G90.1 or
 * G91.1, feed mode, units, cutter compensation, tool length, coordinate system, path, G98 or G99,
 * G96 or G97, scaling, rotation, polar words, G92 (G52). */
void active_codes(const struct interpreter *in, int32_t codes[ACTIVE_CODES]);

/* Number of the coordinate system in force: 1 is G54, 9 G59.3, from 10 on G54.1 P1 .. */
int32_t active_system(const struct interpreter *in);

#endif
