/* tip - a tool measured by touching one point in several attitudes.
 *
 *     R_i t + p_i = point    for each flange pose (p_i, R_i): six unknowns, least squares
 */
#ifndef TIP_H
#define TIP_H

#include "pose.h"

enum { TIP_POSES = 16 };

/* Tip t in the flange's frame [mm] and what is left: root of the mean square distance of the
 * touches from their mean point [mm]. Three poses at least, of which attitudes differ about two
 * axes; returns 0, or 1: they do not tell the tip. */
int tip_solve(const struct pose *flange, int count, double tip[3], double *rms);

#endif
