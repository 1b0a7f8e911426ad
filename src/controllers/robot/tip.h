/* tip - a tool measured by touching one point in several orientations.
 *
 *     R_i t + p_i = point    for each flange pose (p_i, R_i): six unknowns, least squares
 */
#ifndef TIP_H
#define TIP_H

#include "pose.h"

enum { TIP_POSES = 16 };

/* Find the tip t in the flange's frame [mm] and *rms, the root of the mean square distance of the
 * touches from their mean point [mm]. It takes three poses at least, whose orientations differ
 * about two axes. Returns 0; 1: the poses do not tell the tip. */
int tip_solve(const struct pose *flange, int count, double tip[3], double *rms);

#endif
