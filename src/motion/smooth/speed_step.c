#include "speed_step.h"

#include <math.h>

#include "el_extremes.h"
#include "elementary.h"

/* Time of a step that turns by less than this [rad] is that of a constant acceleration. */
static const double STRAIGHT = 1e-5;

/* Time of a step with the acceleration a + c u / 2, w^2 = |c| / 2: for c > 0 a + w v grows, a - w v
 * falls as e^(w t), for c < 0 (w v, a) turns by w t. */
static double time_of(double v0, double a0, double v1, double a1, double c, double way)
{
    const double w = sqrt(0.5 * fabs(c)), straight = 2.0 * way / (v0 + v1);

    if (w * straight < STRAIGHT) {
        return straight;
    }
    if (c < 0.0) {
        return el_atan2(w * (a0 * v1 - a1 * v0), a0 * a1 + w * w * v0 * v1) / w;
    }
    const double dv = w * way * (a0 + a1) / (v0 + v1), da = 0.5 * c * way;
    return a0 + a1 >= 0.0 ? el_log(1.0 + (da + dv) / (a0 + w * v0)) / w
                          : el_log(1.0 + (dv - da) / (a1 - w * v1)) / w;
}

struct speed_step speed_step_bent(struct speed_state from, double c, double s)
{
    const struct speed_state to = speed_step_to(from, c, s);
    struct speed_step step = {
        .kind = SPEED_BENT, .way = s, .speed = sqrt(from.x), .acc = 0.5 * from.b, .c = c, .to = to
    };

    step.time = time_of(step.speed, step.acc, sqrt(el_max(0.0, to.x)), 0.5 * to.b, c, s);
    return step;
}

struct speed_step speed_step_start(double jerk, double time)
{
    const double v = 0.5 * jerk * time * time;

    return (struct speed_step){ .kind = SPEED_JERK,
                                .way = v * time / 3.0,
                                .time = time,
                                .c = jerk,
                                .to = { v * v, 2.0 * jerk * time } };
}

struct speed_step speed_step_land(struct speed_state from)
{
    const double v = sqrt(from.x), a = 0.5 * from.b, time = -2.0 * v / a;

    return (struct speed_step){ .kind = SPEED_JERK,
                                .way = v * time / 3.0,
                                .time = time,
                                .speed = v,
                                .acc = a,
                                .c = -a / time };
}

struct speed_step speed_step_hop(double jerk, double way)
{
    return (struct speed_step){
        .kind = SPEED_HOP, .way = way, .time = 4.0 * el_cbrt(0.5 * way / jerk), .c = jerk
    };
}

static struct speed_motion steady(double v, double a, double j, double t)
{
    return (struct speed_motion){ t * (v + t * (0.5 * a + t * j / 6.0)),
                                  el_max(0.0, v + t * (a + 0.5 * t * j)), a + t * j, j };
}

/* In a fourth of the time to half of the most speed, in the next to all of it; then backwards. */
static struct speed_motion hop_at(const struct speed_step *s, double t)
{
    const double part = 0.25 * s->time, v = 0.5 * s->c * part * part;

    if (t > 2.0 * part) {
        struct speed_motion m = hop_at(s, s->time - t);
        m.way = s->way - m.way;
        m.gain = -m.gain;
        return m;
    }
    if (t <= part) {
        return steady(0.0, 0.0, s->c, t);
    }
    struct speed_motion m = steady(v, s->c * part, -s->c, t - part);
    m.way += v * part / 3.0;
    return m;
}

struct speed_motion speed_step_at(const struct speed_step *s, double t)
{
    const double w = sqrt(0.5 * fabs(s->c)), sign = s->c < 0.0 ? -1.0 : 1.0;

    if (s->kind == SPEED_HOP) {
        return hop_at(s, t);
    }
    if (s->kind != SPEED_BENT || w * t < STRAIGHT) {
        return steady(s->speed, s->acc, s->kind == SPEED_BENT ? 0.5 * s->c * s->speed : s->c, t);
    }
    const double x = 0.5 * w * t, half = s->c < 0.0 ? el_sin(x) : 0.5 * (el_exp(x) - el_exp(-x));
    const double cosine = 1.0 + sign * 2.0 * half * half, turn = 2.0 * half * half / (w * w);
    const double sine = (s->c < 0.0 ? el_sin(w * t) : 2.0 * half * sqrt(1.0 + half * half)) / w;
    const double v = el_max(0.0, s->speed * cosine + s->acc * sine);
    return (struct speed_motion){ s->speed * sine + s->acc * turn, v,
                                  s->acc + 0.5 * s->c * (s->speed * sine + s->acc * turn),
                                  0.5 * s->c * v };
}
