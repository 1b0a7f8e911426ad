/* Van der Pol's oscillator, FMI 3.0, from the standard's headers alone: no reset, no states. */
#include <math.h>

#include "fmi3_rest.h"

enum { TIME, X0 = 12, X1 = 4, MU = 77, X0_SHORT = 8 };
static const double LONGEST = 1e-4; /* [s] of a Runge-Kutta step */

struct oscillator {
    double t, x[2], mu;
};

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String place,
                                         fmi3Boolean visible, fmi3Boolean logging,
                                         fmi3Boolean events, fmi3Boolean early,
                                         const fmi3ValueReference needed[], size_t n,
                                         fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update)
{
    struct oscillator *o = calloc(1, sizeof *o);
    (void)name, (void)token, (void)place, (void)visible, (void)logging, (void)events, (void)early;
    (void)needed, (void)n, (void)environment, (void)log, (void)update;
    if (o)
        *o = (struct oscillator){ .x = { 2.0, 0.0 }, .mu = 1.0 };
    return o;
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean defined, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean ends, fmi3Float64 stop)
{
    struct oscillator *o = c;
    (void)defined, (void)tolerance, (void)ends, (void)stop;
    o->t = start;
    return fmi3OK;
}

static double *at(struct oscillator *o, fmi3ValueReference which)
{
    switch (which) {
    case TIME: return &o->t;
    case X0:   return &o->x[0];
    case X1:   return &o->x[1];
    case MU:   return &o->mu;
    default:   return NULL;
    }
}

fmi3Status fmi3GetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float64 x[],
                          size_t count)
{
    for (size_t i = 0; i < n; i++) {
        const double *found = at(c, r[i]);
        if (!found || count != n)
            return fmi3Error;
        x[i] = *found;
    }
    return fmi3OK;
}

fmi3Status fmi3SetFloat64(fmi3Instance c, const fmi3ValueReference r[], size_t n,
                          const fmi3Float64 x[], size_t count)
{
    for (size_t i = 0; i < n; i++) {
        if (r[i] != MU || count != n)
            return fmi3Error;
        *at(c, r[i]) = x[i];
    }
    return fmi3OK;
}

fmi3Status fmi3GetFloat32(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3Float32 x[],
                          size_t count)
{
    const struct oscillator *o = c;
    for (size_t i = 0; i < n; i++) {
        if (r[i] != X0_SHORT || count != n)
            return fmi3Error;
        x[i] = (float)o->x[0];
    }
    return fmi3OK;
}

static void slope(const struct oscillator *o, const double x[2], double d[2])
{
    d[0] = x[1];
    d[1] = o->mu * (1.0 - x[0] * x[0]) * x[1] - x[0];
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 now, fmi3Float64 step, fmi3Boolean no_set,
                      fmi3Boolean *event, fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *last)
{
    struct oscillator *o = c;
    const int parts = (int)ceil(step / LONGEST - 1e-9);
    const double h = step / parts;
    (void)no_set;
    for (int i = 0; i < parts; i++) {
        double k[4][2], x[2] = { o->x[0], o->x[1] };
        static const double SHARE[4] = { 0.5, 0.5, 1.0, 0.0 };
        for (int s = 0; s < 4; s++) {
            slope(o, x, k[s]);
            for (int j = 0; j < 2; j++)
                x[j] = o->x[j] + SHARE[s] * h * k[s][j];
        }
        for (int j = 0; j < 2; j++)
            o->x[j] += h / 6.0 * (k[0][j] + 2.0 * (k[1][j] + k[2][j]) + k[3][j]);
    }
    o->t = now + step;
    *event = *end = *early = false;
    *last = o->t;
    return fmi3OK;
}
