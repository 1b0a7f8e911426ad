/* First-order filter, time_constant dy/dt = u - y: exact for an input that is held from one sample
 * to the next. */
#include "elementary.h"
#include "vars.h"

struct model {
    int64_t period;  /* [ns] */
    int64_t instant; /* [ns] next sample, since startTime */
    double share;    /* of the way from y to u that a period makes */
};

#include "fmi_model.h"
#include "fmu_period.h"

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const double ticks = v->period * 1e9 / FMU_TICK_NS;
    if (!fmu_is_period(ticks))
        return fmu_fail(f, "period = %.17g s: not a whole number of 25 ns", v->period);
    m->period = llround(ticks) * FMU_TICK_NS;
    m->instant = m->period;
    m->share = -el_expm1(-v->period / v->time_constant);
    return 0;
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    (void)t0;
    for (; m->instant <= t1; m->instant += m->period)
        v->y += m->share * (v->u - v->y);
    return 0;
}
