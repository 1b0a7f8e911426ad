/* subproblem - the steps of which closed forms of inverse kinematics are made (Paden 1986, Kahan;
 * Elias and Wen, IK-Geo, Mechanism and Machine Theory 209, 2025).
 *
 * All of them are a turn from one vector to another, or a circle that meets a plane:
 *
 *     k . R(h, t) u = d      2 solutions t, apart by the sign of the derivative k . (h x R(h, t) u)
 *
 * as a sphere, |R(h, t) u + v| = d, meets the circle of R(h, t) u in a plane, too. The derivative
 * is 0 where both are one: there the arm is singular. Where no t is better than another, it stays
 * `near`.
 */
#ifndef SUBPROBLEM_H
#define SUBPROBLEM_H

#include <stdbool.h>

/* Angle t with R(h, t) u = v, but for what lies along h. u and v shorter than `size` times 1e-9
 * across h leave it open. */
double subproblem_turn(const double h[3], const double u[3], const double v[3], double size,
                       double near);

/* Angles t with k . R(h, t) u = d: t[0] where the left side grows with t, t[1] where it falls.
 * False: there is none. */
bool subproblem_plane(const double h[3], const double u[3], const double k[3], double d,
                      double size, double near, double t[2]);

/* The same with |R(h, t) u + v| = d, all across h: what lies along h is the caller's. */
bool subproblem_sphere(const double h[3], const double u[3], const double v[3], double d2,
                       double size, double near, double t[2]);

/* Angle of a turn about h that is the rotation r. */
double subproblem_angle(const double h[3], const double r[3][3]);

/* Angles of three turns that together are the rotation r: two solutions, apart by the sign of the
 * middle one's derivative h1 . (h2 x R2 h3). Where axes 1 and 3 are in line joint 1 stays as in
 * near[]. False: there is none, as axes that are not square to one another do not reach all. */
bool subproblem_attitude(const double h[3][3], const double r[3][3], const double near[3],
                         double t[2][3]);

/* The same with one or two turns, or with none: one solution, which the caller has to try. */
void subproblem_part(int count, const double h[3][3], const double r[3][3], const double near[3],
                     double t[3]);

#endif
