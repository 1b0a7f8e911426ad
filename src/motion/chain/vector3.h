/* vector3 - vectors of three numbers and rotation matrices. */
#ifndef VECTOR3_H
#define VECTOR3_H

#include <math.h>

#include "elementary.h"

static inline double vector3_dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline double vector3_length(const double a[3])
{
    return sqrt(vector3_dot(a, a));
}

/* c may be none of a and b. */
static inline void vector3_cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

/* c = a + factor b; c may be a or b. */
static inline void vector3_add(const double a[3], double factor, const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) {
        c[i] = a[i] + factor * b[i];
    }
}

/* a . (b x c) */
static inline double vector3_triple(const double a[3], const double b[3], const double c[3])
{
    double d[3];
    vector3_cross(b, c, d);
    return vector3_dot(a, d);
}

/* What of v is across the unit vector h; p may be v. */
static inline void vector3_across(const double h[3], const double v[3], double p[3])
{
    vector3_add(v, -vector3_dot(h, v), h, p);
}

/* v turned about the unit vector h by an angle whose cosine and sine are given; w may be v. */
static inline void vector3_turn(const double h[3], struct el_turn t, const double v[3], double w[3])
{
    double c[3];

    vector3_cross(h, v, c);
    const double along = (1.0 - t.cosine) * vector3_dot(h, v);
    for (int i = 0; i < 3; i++) {
        w[i] = t.cosine * v[i] + t.sine * c[i] + along * h[i];
    }
}

/* The rotation matrix of a turn about the unit vector h. */
static inline void vector3_matrix(const double h[3], struct el_turn t, double m[3][3])
{
    for (int k = 0; k < 3; k++) {
        const double e[3] = { k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0 };
        double column[3];
        vector3_turn(h, t, e, column);
        for (int i = 0; i < 3; i++) {
            m[i][k] = column[i];
        }
    }
}

/* w = m v and w = m^T v; w may not be v. */
static inline void vector3_by(const double m[3][3], const double v[3], double w[3])
{
    for (int i = 0; i < 3; i++) {
        w[i] = vector3_dot(m[i], v);
    }
}

static inline void vector3_back(const double m[3][3], const double v[3], double w[3])
{
    for (int i = 0; i < 3; i++) {
        w[i] = m[0][i] * v[0] + m[1][i] * v[1] + m[2][i] * v[2];
    }
}

/* c = a b, and c = a^T b; c may be neither. */
static inline void vector3_product(const double a[3][3], const double b[3][3], double c[3][3])
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            c[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k];
        }
    }
}

static inline void vector3_back_product(const double a[3][3], const double b[3][3], double c[3][3])
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            c[i][k] = a[0][i] * b[0][k] + a[1][i] * b[1][k] + a[2][i] * b[2][k];
        }
    }
}

#endif
