/* comp - compensation of screw pitch error and backlash: pulses added to an axis' commands.
 *
 * A table holds the correction at points an interval apart, one row for motion forward, one for
 * motion backward. It is linear between the points and constant beyond the first and the last. With
 *
 *     x = position / interval + home          place in the table; home is the index of position 0
 *
 * the wanted correction is row[x], of the row for the direction of the latest motion. The two rows
 * differ by the backlash: the axis takes it up when its direction turns, over as many DDA times as
 * its limits ask for.
 */
#ifndef COMP_H
#define COMP_H

#include <stdbool.h>
#include <stdint.h>

enum { COMP_POINTS = 256, COMP_LARGEST = 32767 };

struct comp_table {
    int32_t interval;              /* [pulses] between two points, >= 1; 0: no compensation */
    int32_t home;                  /* index of the point at position 0, 0 .. 255 */
    int32_t forward[COMP_POINTS];  /* [pulses] correction, each within +-COMP_LARGEST */
    int32_t backward[COMP_POINTS]; /* [pulses] likewise */
};

struct comp {
    int32_t added; /* [pulses] correction that the commands so far contain */
    bool backward; /* direction of the latest motion */
};

struct comp_limits {
    int32_t command; /* [pulses] largest command of a DDA time, correction included */
    int32_t change;  /* [pulses] largest correction in a DDA time */
};

/* Whether interval, home and every correction lie in their ranges. */
bool comp_valid(const struct comp_table *t);

/* Wanted correction [pulses] at a position [pulses], that of the axis without correction. */
int32_t comp_wanted(const struct comp_table *t, int64_t position, bool backward);

/* Pulses to add to an axis' next command, which moves it by `frame` to `position` (both without
 * correction). 0 if the frame alone exceeds the limit of a command. */
int32_t comp_step(const struct comp_table *t, struct comp *c, int64_t position, int32_t frame,
                  const struct comp_limits *l);

/* Whether the correction in the commands so far is the wanted one at `position`. */
bool comp_done(const struct comp_table *t, const struct comp *c, int64_t position);

#endif
