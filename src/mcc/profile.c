#include "profile.h"

#include <math.h>
#include <string.h>

void profile_wait(struct profile *p, double seconds)
{
    memset(p, 0, sizeof *p);
    p->time[1] = seconds;
    p->tail = p->total = seconds;
    p->ends = true;
}

/* Rest at the end of the path by one deceleration that starts now. */
static void stop_at_end(struct profile *p, double way)
{
    p->ends = true;
    if (p->v0 > 0.0 && way > 0.0) {
        p->time[2] = 2.0 * way / p->v0;
        p->acc[2] = -p->v0 / p->time[2];
    }
}

void profile_plan(struct profile *p, double s, double v, double length,
                  const struct profile_limits *l)
{
    const double way = fmax(0.0, length - s);
    const double brake = v * v / (2.0 * l->dec);    /* way to rest from now */

    memset(p, 0, sizeof *p);
    p->s0 = s;
    p->v0 = v;
    p->length = length;
    if (brake >= way) {
        stop_at_end(p, way);
    } else if (l->speed <= 0.0) {
        p->time[0] = v / l->dec;
        p->acc[0] = -l->dec;
    } else if (v > l->speed) {
        p->ends = true;
        p->time[0] = (v - l->speed) / l->dec;
        p->acc[0] = -l->dec;
        p->time[1] = (way - brake) / l->speed;
        p->time[2] = l->speed / l->dec;
        p->acc[2] = -l->dec;
    } else {
        /* Peak speed of the triangle: (vp^2 - v^2)/(2 acc) + vp^2/(2 dec) = way. */
        const double peak = sqrt(l->dec * (2.0 * l->acc * way + v * v) / (l->acc + l->dec));
        const double top = fmax(v, fmin(l->speed, peak));
        const double ramps = (top * top - v * v) / (2.0 * l->acc) + top * top / (2.0 * l->dec);
        p->ends = true;
        p->time[0] = (top - v) / l->acc;
        p->acc[0] = l->acc;
        p->time[1] = top < peak ? fmax(0.0, (way - ramps) / top) : 0.0;
        p->time[2] = top / l->dec;
        p->acc[2] = -l->dec;
    }
    p->tail = p->time[0] + p->time[1];
    p->total = p->tail + p->time[2];
}

void profile_state(const struct profile *p, double *s, double *v)
{
    if (p->ends && p->t >= p->tail) {
        /* Seen from the end, so that it is met exactly: s = length - |a| left^2 / 2. */
        const double left = fmax(0.0, p->total - p->t);
        *v = -p->acc[2] * left;
        *s = p->length - 0.5 * *v * left;
        return;
    }
    double left = fmax(0.0, p->t);
    *s = p->s0;
    *v = p->v0;
    for (int i = 0; i < PROFILE_PHASES; i++) {
        const double dt = fmin(left, p->time[i]);
        *s += (*v + 0.5 * p->acc[i] * dt) * dt;
        *v += p->acc[i] * dt;
        left -= dt;
    }
    if (!p->ends && p->t >= p->total) {
        *v = 0.0;
    }
    *v = fmax(0.0, *v);
    *s = fmin(*s, p->length);
}

double profile_left(const struct profile *p)
{
    return p->total - p->t;
}
