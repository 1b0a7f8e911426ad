#include "subproblem.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"
#include "vector3.h"

/* So much may a cosine exceed 1 by rounding at the edge of reach. */
static const double EDGE = 1e-12;

/* Share of its size below which a vector has no direction: rounding decides. */
static const double IN_LINE = 1e-9;

/* The same of a sum of products. */
static const double NOTHING = 1e-12;

double subproblem_turn(const double h[3], const double u[3], const double v[3], double size,
                       double near)
{
    double a[3], b[3];

    vector3_across(h, u, a);
    vector3_across(h, v, b);
    if (vector3_length(a) < IN_LINE * size || vector3_length(b) < IN_LINE * size) {
        return near;
    }
    return el_atan2(vector3_triple(h, a, b), vector3_dot(a, b));
}

/* a cos t + b sin t = c. With a = r cos f, b = r sin f it is cos(t - f) = c / r. rest2 is
 * r^2 - c^2. */
static bool circle(double a, double b, double c, double rest2, double size, double near,
                   double t[2])
{
    const double r = sqrt(a * a + b * b);

    if (!(r > NOTHING * size)) {
        t[0] = t[1] = near;
        return fabs(c) <= IN_LINE * size;
    }
    if (!(fabs(c) <= (1.0 + EDGE) * r)) {
        return false;
    }
    const double middle = el_atan2(b, a), off = el_atan2(sqrt(el_max(0.0, rest2)), c);
    t[0] = middle - off;
    t[1] = middle + off;
    return true;
}

bool subproblem_plane(const double h[3], const double u[3], const double k[3], double d,
                      double size, double near, double t[2])
{
    const double along = vector3_dot(k, h) * vector3_dot(u, h);
    const double a = vector3_dot(k, u) - along, b = vector3_triple(k, h, u), c = d - along;
    const double r = sqrt(a * a + b * b);

    return circle(a, b, c, (r - c) * (r + c), size, near, t);
}

bool subproblem_sphere(const double h[3], const double u[3], const double v[3], double d2,
                       double size, double near, double t[2])
{
    double p[3], q[3];

    vector3_across(h, u, p);
    vector3_across(h, v, q);
    const double p2 = vector3_dot(p, p), q2 = vector3_dot(q, q);
    const double a = vector3_dot(q, p), b = vector3_triple(q, h, p), c = 0.5 * (d2 - p2 - q2);
    const double r = sqrt(p2 * q2);

    return circle(a, b, c, (r - c) * (r + c), size * size, near, t);
}

/* Any vector across h, of length 1. */
static void some_across(const double h[3], double x[3])
{
    const int least = fabs(h[0]) < 0.6 ? 0 : fabs(h[1]) < 0.6 ? 1 : 2;
    const double e[3] = { least == 0, least == 1, least == 2 };

    vector3_across(h, e, x);
    const double length = vector3_length(x);
    for (int i = 0; i < 3; i++) {
        x[i] /= length;
    }
}

double subproblem_angle(const double h[3], const double r[3][3])
{
    double x[3], y[3];

    some_across(h, x);
    vector3_by(r, x, y);
    return subproblem_turn(h, x, y, 1.0, 0.0);
}

/* r = R(h, t)^T r */
static void take(const double h[3], double t, double r[3][3])
{
    double own[3][3], rest[3][3];

    vector3_matrix(h, el_sincos(t), own);
    vector3_back_product((const double(*)[3])own, (const double(*)[3])r, rest);
    memcpy(r, rest, sizeof rest);
}

bool subproblem_attitude(const double h[3][3], const double r[3][3], const double near[3],
                         double t[2][3])
{
    double b[3], side[3], middle[2];

    vector3_by(r, h[2], b);
    const double c0 = vector3_dot(h[0], h[1]), c2 = vector3_dot(h[1], h[2]);
    const double a = vector3_dot(h[0], h[2]) - c0 * c2, s = vector3_triple(h[0], h[1], h[2]);
    const double c = vector3_dot(h[0], b) - c0 * c2, reach2 = a * a + s * s;
    double rest2 = (sqrt(reach2) - c) * (sqrt(reach2) + c);
    if (fabs(c0) < IN_LINE && fabs(c2) < IN_LINE) { /* the sine itself, exact where it is small */
        vector3_cross(h[0], b, side);
        rest2 = vector3_dot(side, side);
    }
    if (!circle(a, s, c, rest2, 1.0, near[1], middle)) {
        return false;
    }
    for (int n = 0; n < 2; n++) {
        double rest[3][3], turned[3];
        t[n][1] = middle[n];
        vector3_turn(h[1], el_sincos(middle[n]), h[2], turned);
        t[n][0] = subproblem_turn(h[0], turned, b, 1.0, near[0]);
        memcpy(rest, r, sizeof rest);
        take(h[0], t[n][0], rest);
        take(h[1], t[n][1], rest);
        t[n][2] = subproblem_angle(h[2], (const double(*)[3])rest);
    }
    return true;
}

void subproblem_part(int count, const double h[3][3], const double r[3][3], const double near[3],
                     double t[3])
{
    double rest[3][3], b[3];

    memcpy(rest, r, sizeof rest);
    if (count == 2) {
        vector3_by(r, h[1], b);
        t[0] = subproblem_turn(h[0], h[1], b, 1.0, near[0]);
        take(h[0], t[0], rest);
    }
    if (count > 0) {
        t[count - 1] = subproblem_angle(h[count - 1], (const double(*)[3])rest);
    }
}
