/* axis_count - coordinates of a tool place, and joints that move it. */
#ifndef AXIS_COUNT_H
#define AXIS_COUNT_H

enum { AXES = 6 }; /* X Y Z U V W, or joints 1 .. 6 */

#endif
