/* quaternion - orientations as unit quaternions (w, x, y, z).
 *
 * A program's angles A B C [deg] mean R = Rz(C) Ry(B) Rx(A).
 */
#ifndef QUATERNION_H
#define QUATERNION_H

/* c = a b: first b, then a. c may be a or b. */
void quaternion_product(const double a[4], const double b[4], double c[4]);

/* c turns back what a turns. */
void quaternion_inverse(const double a[4], double c[4]);

/* Scale to length 1; a quaternion without length becomes (1, 0, 0, 0). */
void quaternion_normalise(double a[4]);

/* The vector v as a turns it. */
void quaternion_turn(const double a[4], const double v[3], double turned[3]);

/* From a rotation vector, axis times angle [rad], and back to the one of the smaller angle. */
void quaternion_by_vector(const double v[3], double a[4]);
void quaternion_vector(const double a[4], double v[3]);

/* From a (part 0) to b (part 1) along the shorter arc at constant speed. Nearly equal ones are
 * mixed linearly and scaled to length 1. */
void quaternion_slerp(const double a[4], const double b[4], double part, double c[4]);

/* To a rotation matrix, and back. */
void quaternion_matrix(const double a[4], double m[3][3]);
void quaternion_of_matrix(const double m[3][3], double a[4]);

/* From a program's angles A B C [deg], and back: B in -90..90, and C = 0 where only C + A or C - A
 * is known. */
void quaternion_by_angles(const double angle[3], double a[4]);
void quaternion_angles(const double a[4], double angle[3]);

#endif
