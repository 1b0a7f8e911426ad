/* comp - compensation of screw pitch and backlash: pulses added to an axis' commands.
 *
 * A table holds what has to be added at points an interval apart, one row for motion forward, one
 * for motion backward; between the points it is a straight line, beyond the ends it stays. With
 *
 *     x = position / interval + home          place in the table; home is the index of position 0
 *
 * the wanted correction is table[x] of the direction of the latest motion. Backlash is what the two
 * rows differ by: it is driven in when the direction turns, not faster than the axis allows.
 */
#ifndef COMP_H
#define COMP_H

#include <stdbool.h>
#include <stdint.h>

enum { COMP_POINTS = 256, COMP_LARGEST = 32767 };

struct comp_table {
    int32_t interval;             /* [pulses] between two points, >= 1; 0: no compensation */
    int32_t home;                 /* index of the point at position 0, 0 .. 255 */
    int32_t forward[COMP_POINTS]; /* [pulses] each within +-32767 */
    int32_t backward[COMP_POINTS];
};

struct comp {
    int32_t added; /* [pulses] of correction in the commands so far */
    bool backward; /* direction of the latest motion */
};

struct comp_limits {
    int32_t command; /* [pulses] largest command of a DDA time, correction included */
    int32_t change;  /* [pulses] largest correction in a DDA time */
};

/* True if every value lies in its range. */
bool comp_valid(const struct comp_table *t);

/* Wanted correction at a position, which is where the axis would be without any. [pulses] */
int32_t comp_wanted(const struct comp_table *t, int64_t position, bool backward);

/* The next command of an axis moves it by `frame` to `position` (correction left out): pulses to
 * add to it. A frame beyond the limit of the command alone gets none. */
int32_t comp_step(const struct comp_table *t, struct comp *c, int64_t position, int32_t frame,
                  const struct comp_limits *l);

/* Nothing is left to add where the axis stands. */
bool comp_done(const struct comp_table *t, const struct comp *c, int64_t position);

#endif
