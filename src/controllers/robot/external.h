/* external - one axis beside the arm: a track that the arm stands on, or a table with its work.
 *
 *     world ── along, place ──> base of the arm ── joints ──> tool
 *
 * A track carries the base, which stands in the world where it does with the track at 0. A table
 * turns work of which the arm knows nothing. Its places are in m, those of a table in rad.
 */
#ifndef EXTERNAL_H
#define EXTERNAL_H

#include <stdbool.h>

/* Kinds of axis, numbered as those of the robot language (enum robot_job_outside). */
enum external_kind { EXTERNAL_NONE, EXTERNAL_TRACK, EXTERNAL_TABLE };

struct external {
    enum external_kind kind;
    double low, high; /* [m] [rad] */
    double speed;     /* [m/s] [rad/s] highest */
    double acc;       /* [m/s^2] [rad/s^2] highest */
    double along[3];  /* unit vector of a track's way in the world */
    double scale;     /* [pulses/m] [pulses/rad] */
};

/* at[] [mm], seen from the arm's base with the axis at a place, becomes what it is in the world. */
void external_to_world(const struct external *e, double place, double at[3]);

/* The other way round. */
void external_to_arm(const struct external *e, double place, double at[3]);

/* What people give a place in: [m] of a mm, [rad] of a degree. */
double external_unit(const struct external *e);

/* Whether a place is beyond the range, and further out than `from`; *limit becomes its end. */
bool external_outside(const struct external *e, double from, double place, double *limit);

#endif
