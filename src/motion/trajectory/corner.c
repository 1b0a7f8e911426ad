#include "corner.h"

#include <math.h>

#include "el_extremes.h"

/* Directions that differ by less are the same. */
static const double STRAIGHT = 1e-9;

/* A curve shorter than this cannot be driven in any useful time. [mm] */
static const double LEAST = 1e-6;

/* Farthest of the curve from two lines whose directions differ by 1: what is left of A and gone of
 * B at x = 1/2, 2 half times the integral of 1 - h over the second half. */
static const double CUT = 0.1875;

/* Bound of what curved paths add, by the sum of their curvatures and half^2: (y^2 - 2 y s) / 2 of
 * the path that is followed and y^2 / 2 of the other one (docs/theory/speed.md). */
static const double CUT_CURVED = 0.035;

/* Bound of |P''| by the curvature of the paths: (1 - h)^2 + h^2 and what the turn of their
 * directions adds, h' times the way walked on both. */
static const double BEND_CURVED = 1.17;

static double norm3(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* How much the directions differ where the paths meet: of X Y Z or of U V W, the larger. */
static double turn(const struct path *a, const struct path *b)
{
    double at[AXES], in[AXES], out[AXES];

    path_at(a, a->length, at, in);
    path_at(b, 0.0, at, out);
    for (int i = 0; i < AXES; i++) {
        out[i] -= in[i];
    }
    return el_max(norm3(out), norm3(out + 3));
}

bool corner_make(struct corner *k, const struct path *a, const struct path *b, double tolerance,
                 double room, bool round)
{
    const double d = turn(a, b), ka = path_bend(a), kb = path_bend(b), sum = ka + kb;
    const bool straight = d < STRAIGHT;

    *k = (struct corner){ 0.0, 0.0, 0.0 };
    if (straight && (!round || ka == kb)) {
        k->bend = el_max(ka, kb);
        return true;
    }
    /* CUT d half + CUT_CURVED (ka + kb) half^2 = tolerance */
    const double p = CUT * d, q = CUT_CURVED * sum;
    double half = 2.0 * tolerance / (p + sqrt(p * p + 4.0 * q * tolerance));
    half = el_min(half, room);
    half = sum > 0.0 ? el_min(half, 0.5 / el_max(ka, kb)) : half;
    if (!(half >= LEAST)) {
        return straight;
    }
    k->half = half;
    k->bend = 0.75 * d / half + BEND_CURVED * el_max(ka, kb);
    k->twist = 1.5 * d / (half * half) + 4.0 * el_max(ka, kb) / half
               + el_max(path_twist(a), path_twist(b));
    return true;
}

void corner_at(const struct corner *k, const struct path *a, const struct path *b, double s,
               double point[AXES], double slope[AXES])
{
    const double x = (s + k->half) / (2.0 * k->half), h = x * x * (3.0 - 2.0 * x);
    const double y = 2.0 * k->half * x * x * x * (1.0 - 0.5 * x);
    double at[AXES], direction[AXES];

    path_at(b, y, at, direction);
    path_at(a, a->length + s - y, point, slope);
    for (int i = 0; i < AXES; i++) {
        point[i] += at[i] - b->start[i];
        slope[i] = (1.0 - h) * slope[i] + h * direction[i];
    }
}
