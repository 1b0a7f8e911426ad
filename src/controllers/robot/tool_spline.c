#include "tool_spline.h"

#include <math.h>
#include <string.h>

#include "arm_moves.h"
#include "el_extremes.h"

/* Poses nearer than that are the same. [mm] */
static const double SAME = 1e-6;

/* Rates are differences over so much of the way. */
static const double APART = 1e-4;

static void turn_between(const double from[4], const double to[4], double by[3])
{
    double q[4];

    quaternion_inverse(from, q);
    quaternion_product(to, q, q);
    quaternion_vector(q, by);
}

/* Where `to` is from `from`: X Y Z [mm], rotation vector [rad]; how far. [mm] */
static double step_to(const struct pose *from, const struct pose *to, double step[6])
{
    double square = 0.0;

    turn_between(from->turn, to->turn, step + 3);
    for (int i = 0; i < 3; i++) {
        step[i] = to->at[i] - from->at[i];
        square += step[i] * step[i];
        square += ARM_MOVES_LEVER * step[3 + i] * ARM_MOVES_LEVER * step[3 + i];
    }
    return sqrt(square);
}

/* The parabola through three poses, the middle one at a place of the way; without one of the
 * others, a straight line. */
static bool through(struct tool_spline_parabola *p, double at, const struct pose *before,
                    const struct pose *middle, const struct pose *behind)
{
    double a[6] = { 0.0 }, b[6] = { 0.0 };
    const double to_a = before ? step_to(middle, before, a) : INFINITY;
    const double to_b = behind ? step_to(middle, behind, b) : INFINITY;

    p->middle = *middle;
    p->at = at;
    for (int i = 0; i < 6; i++) {
        const double in = -a[i] / to_a, out = b[i] / to_b;
        p->bend[i] = before && behind ? (out - in) / (to_a + to_b) : 0.0;
        p->slope[i] = behind ? out - p->bend[i] * to_b : in;
    }
    return to_a > SAME && to_b > SAME;
}

bool tool_spline_make(struct tool_spline *s, const struct pose *before, const struct pose *from,
                      const struct pose *to, const struct pose *next)
{
    double step[6];
    bool good;

    s->length = step_to(from, to, step);
    good = s->length > SAME && through(&s->parabola[0], 0.0, before, from, to);
    good = good && through(&s->parabola[1], s->length, from, to, next);
    if (!before && next) {
        s->parabola[0] = s->parabola[1];
    } else if (!next) {
        s->parabola[1] = s->parabola[0];
    }
    return good;
}

static struct pose on_parabola(const struct tool_spline_parabola *p, double t)
{
    struct pose pose = p->middle;
    double x[6], q[4];

    t -= p->at;
    for (int i = 0; i < 6; i++) {
        x[i] = t * (p->slope[i] + t * p->bend[i]);
    }
    for (int i = 0; i < 3; i++) {
        pose.at[i] += x[i];
    }
    quaternion_by_vector(x + 3, q);
    quaternion_product(q, pose.turn, pose.turn);
    return pose;
}

struct pose tool_spline_pose(const struct tool_spline *s, enum tool_spline_part which, double part)
{
    const double t = part * s->length;

    if (which != TOOL_SPLINE_WAY) {
        return on_parabola(&s->parabola[which], t);
    }
    const double share = part * part * part * (10.0 + part * (6.0 * part - 15.0));
    struct pose pose = on_parabola(&s->parabola[0], t);
    const struct pose other = on_parabola(&s->parabola[1], t);
    double by[3], q[4];

    turn_between(pose.turn, other.turn, by);
    for (int i = 0; i < 3; i++) {
        pose.at[i] += share * (other.at[i] - pose.at[i]);
        by[i] *= share;
    }
    quaternion_by_vector(by, q);
    quaternion_product(q, pose.turn, pose.turn);
    return pose;
}

void tool_spline_rates(const struct tool_spline *s, double part, double *way, double *turn)
{
    const double from = el_max(0.0, part - APART), to = el_min(1.0, part + APART);
    const struct pose a = tool_spline_pose(s, TOOL_SPLINE_WAY, from);
    const struct pose b = tool_spline_pose(s, TOOL_SPLINE_WAY, to);
    const double mm = (to - from) * s->length;
    double by[3], square[2] = { 0.0, 0.0 };

    turn_between(a.turn, b.turn, by);
    for (int i = 0; i < 3; i++) {
        square[0] += (b.at[i] - a.at[i]) * (b.at[i] - a.at[i]);
        square[1] += by[i] * by[i];
    }
    *way = sqrt(square[0]) / mm;
    *turn = sqrt(square[1]) / mm;
}
