#include "pose.h"

#include <math.h>
#include <string.h>

/* Sine of the angle between three points that are on one line. */
static const double ALIGNED = 1e-9;

struct pose pose_none(void)
{
    return (struct pose){ { 0.0, 0.0, 0.0 }, { 1.0, 0.0, 0.0, 0.0 } };
}

struct pose pose_of(const double xyz[3], const double abc[3])
{
    struct pose p;

    memcpy(p.at, xyz, sizeof p.at);
    quaternion_by_angles(abc, p.turn);
    return p;
}

struct pose pose_product(const struct pose *a, const struct pose *b)
{
    struct pose c;

    pose_point(a, b->at, c.at);
    quaternion_product(a->turn, b->turn, c.turn);
    quaternion_normalise(c.turn);
    return c;
}

struct pose pose_inverse(const struct pose *a)
{
    const double back[3] = { -a->at[0], -a->at[1], -a->at[2] };
    struct pose c;

    quaternion_inverse(a->turn, c.turn);
    quaternion_turn(c.turn, back, c.at);
    return c;
}

void pose_point(const struct pose *a, const double point[3], double out[3])
{
    quaternion_turn(a->turn, point, out);
    for (int i = 0; i < 3; i++) {
        out[i] += a->at[i];
    }
}

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        c[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static double unit(double a[3])
{
    const double n = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int i = 0; i < 3; i++) {
        a[i] /= n;
    }
    return n;
}

int pose_by_points(const double origin[3], const double x[3], const double xy[3],
                   struct pose *frame)
{
    double e[3][3], to[3], m[3][3];

    for (int i = 0; i < 3; i++) {
        e[0][i] = x[i] - origin[i];
        to[i] = xy[i] - origin[i];
    }
    const double way = unit(e[0]) * unit(to);
    cross(e[0], to, e[2]);
    if (!(way > 0.0) || !(unit(e[2]) > ALIGNED)) {
        return 1;
    }
    cross(e[2], e[0], e[1]);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) {
            m[i][k] = e[k][i];
        }
    }
    memcpy(frame->at, origin, sizeof frame->at);
    quaternion_of_matrix((const double(*)[3])m, frame->turn);
    return 0;
}
