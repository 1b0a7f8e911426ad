/* shape_whole - a command as one segment, or as chords. */
#ifndef SHAPE_WHOLE_H
#define SHAPE_WHOLE_H

#include "shape_run.h"

enum { SHAPE_CHORDS = 64 }; /* of one command in a run, at most */

/* A segment under a law, without its geometry; a whole path as a segment. */
struct segment shape_blank(const struct shape_law *law);
struct segment shape_whole(const struct path *path, const struct shape_law *law);

/* The path of such a segment; of a cut line what is left. */
struct path shape_whole_path(const struct segment *p);

/* Number of chords that stand for a length of a path; 0: too many. Where it bends they are off by
 * at most SHAPE_SAGITTA of the tolerance. */
#define SHAPE_SAGITTA 0.05
int32_t shape_chords(const struct path *p, double length, double tolerance);

/* Length of a long command that a run takes. [mm] */
double shape_grab(const struct segment *p, double tolerance);

#endif
