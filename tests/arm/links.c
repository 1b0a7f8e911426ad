#include "links.h"

#include <math.h>

#include "elementary.h"

static const double DEGREE = 0.017453292519943295;

static bool joints(const void *geometry, const double place[AXES], double joint[AXES])
{
    const struct links *l = geometry;
    const double r = el_hypot(place[0], place[1]), a = l->upper, b = l->fore;
    const double c = (r * r - a * a - b * b) / (2.0 * a * b);
    if (!(fabs(c) <= 1.0)) {
        return false;
    }
    const double side = joint[1] < 0.0 ? -1.0 : 1.0;
    joint[1] = side * el_acos(c) / DEGREE;
    joint[0] =
        (el_atan2(place[1], place[0]) - el_atan2(side * b * sqrt(1.0 - c * c), a + b * c)) / DEGREE;
    return true;
}

static bool rates(const void *geometry, const double joint[AXES], const double slope[AXES],
                  double rate[AXES])
{
    const struct links *l = geometry;
    const double q = joint[0] * DEGREE, p = q + joint[1] * DEGREE;
    const double det = l->upper * l->fore * el_sin(p - q) * DEGREE;
    for (int i = 2; i < AXES; i++) {
        rate[i] = 0.0;
    }
    rate[0] = l->fore * (el_cos(p) * slope[0] + el_sin(p) * slope[1]) / det;
    rate[1] = -l->upper * (el_cos(q) * slope[0] + el_sin(q) * slope[1]) / det - rate[0];
    return fabs(det) > 1e-6;
}

static void place(const void *geometry, const double joint[AXES], double at[AXES])
{
    const struct links *l = geometry;
    const double q = joint[0] * DEGREE, p = q + joint[1] * DEGREE;
    for (int i = 2; i < AXES; i++) {
        at[i] = 0.0;
    }
    at[0] = l->upper * el_cos(q) + l->fore * el_cos(p);
    at[1] = l->upper * el_sin(q) + l->fore * el_sin(p);
}

struct kinematics links_kinematics(void)
{
    return (struct kinematics){ joints, rates, place };
}
