/* FMU whose outputs are steps from a table. A signal has the value of its latest step; of two steps
 * at one instant that of the later one in the table; before its first step 0. */
#include "vars.h"

struct model {
    int32_t steps; /* number of steps of the table in use */
};

#include "fmi_model.h"
#include <math.h>

enum { ROWS = 128, EACH = 32, SIGNALS = 3 * EACH };

_Static_assert(sizeof((struct vars *)0)->at == ROWS * sizeof(double), "rows of the table");
_Static_assert(sizeof((struct vars *)0)->real == EACH * sizeof(double), "signals of a type");

/* Set the outputs to the values at an instant [ns]. */
static void show(struct fmu *f, int64_t now)
{
    struct vars *v = &f->s.v;
    int64_t latest[SIGNALS] = { 0 };
    double value[SIGNALS] = { 0 };
    for (int k = 0; k < f->s.m.steps; k++) {
        const int signal = v->signal[k] - 1;
        const int64_t at = llround(v->at[k] * 1e9);
        if (at <= now && at >= latest[signal]) {
            latest[signal] = at;
            value[signal] = v->value[k];
        }
    }
    for (int i = 0; i < EACH; i++) {
        v->real[i] = value[i] + v->offset;
        v->whole[i] = (int32_t)llround(value[EACH + i]);
        v->on[i] = value[2 * EACH + i] != 0.0;
    }
}

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    int n = 0;
    for (; n < ROWS && v->signal[n] > 0; n++) {
        const bool whole = v->signal[n] > EACH && v->signal[n] <= 2 * EACH;
        if (whole && !(fabs(v->value[n]) < 2147483647.5))
            return fmu_fail(f, "value[%d] = %.17g: beyond a whole number of 32 bits", n + 1,
                            v->value[n]);
    }
    f->s.m.steps = n;
    show(f, 0);
    return 0;
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    (void)t0;
    show(f, t1);
    return 0;
}
