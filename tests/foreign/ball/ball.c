/* A bouncing ball, FMI 2.0, from the standard's headers alone: no reset, no states, one step
 * size. */
#include <math.h>

#include "fmi2_rest.h"

enum { HEIGHT = 901, SPEED = 17, GRAVITY = 5, RESTITUTION = 400, LIFT = 6 };
enum { BOUNCES = 3, PHASE = 88 };
enum phase { FALLING = 1, RISING, RESTING };

struct ball {
    double h, v; /* [m], [m/s] */
    double g, e; /* gravity [m/s2]; share of the speed that a bounce leaves */
    double lift; /* [m/s2] an acceleration from outside, held over the step */
    int bounces, resting;
};

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String place,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean logging)
{
    struct ball *b = type == fmi2CoSimulation ? calloc(1, sizeof *b) : NULL;
    (void)name, (void)guid, (void)place, (void)functions, (void)visible, (void)logging;
    if (b)
        *b = (struct ball){ .h = 1.0, .g = -9.81, .e = 0.7 };
    return b;
}

static double *real(struct ball *b, fmi2ValueReference which)
{
    switch (which) {
    case HEIGHT:      return &b->h;
    case SPEED:       return &b->v;
    case GRAVITY:     return &b->g;
    case RESTITUTION: return &b->e;
    case LIFT:        return &b->lift;
    default:          return NULL;
    }
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real x[])
{
    for (size_t i = 0; i < n; i++) {
        const double *at = real(c, r[i]);
        if (!at)
            return fmi2Error;
        x[i] = *at;
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real x[])
{
    for (size_t i = 0; i < n; i++) {
        double *at = real(c, r[i]);
        if (!at)
            return fmi2Error;
        *at = x[i];
    }
    return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Integer x[])
{
    const struct ball *b = c;
    for (size_t i = 0; i < n; i++) {
        if (r[i] != BOUNCES && r[i] != PHASE)
            return fmi2Error;
        x[i] = r[i] == BOUNCES ? b->bounces : b->resting ? RESTING : b->v > 0 ? RISING : FALLING;
    }
    return fmi2OK;
}

/* To the next bounce the ball is on a parabola; speeds below 1 mm/s rest. */
fmi2Status fmi2DoStep(fmi2Component c, fmi2Real now, fmi2Real step, fmi2Boolean no_set)
{
    struct ball *b = c;
    const double a = b->g + b->lift;
    double left = step;
    (void)now, (void)no_set;
    while (!b->resting && left > 0.0) {
        const double hit = (-b->v - sqrt(b->v * b->v - 2.0 * a * b->h)) / a;
        if (a >= 0.0 || hit > left) {
            b->h += (b->v + 0.5 * a * left) * left;
            b->v += a * left;
            return fmi2OK;
        }
        left -= hit;
        b->v = -b->e * (b->v + a * hit);
        b->h = 0.0;
        b->bounces++;
        b->resting = b->v < 1e-3;
    }
    if (b->resting)
        b->h = b->v = 0.0;
    return fmi2OK;
}
