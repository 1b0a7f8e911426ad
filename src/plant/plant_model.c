/* Model of every Modelica FMU: PLANT_INSTANCES copies of one class on a fixed micro-grid.
 *
 * At each instant of the grid k h the inputs are read, and held to the next instant, when the
 * outputs get the new state. At communication points between two instants they show the older one,
 * so any split of an interval gives the same bits.
 *
 * Integrator: classic Runge-Kutta of order 4, in n equal sub-steps per micro step. It is stable to
 * (h/n) |lambda| = 2.785 on the negative real axis and 2.83 on the imaginary one. model_start
 * bounds |lambda| over all branches of the equations (contact or gap, and so on) at the initial
 * state, where smoothed friction is steepest, and takes n so that (h/n) |lambda| <= 2. A machine
 * that needs no sub-steps gets none; axes do not influence each other's n.
 *
 * PLANT_CONTROLLED: the method is that of Bogacki and Shampine, order 3(2), and each micro step is
 * divided as the error asks; an axis is then a block of its own. The division depends on the state
 * at the grid instant and on the step asked for there, which is part of the state: so it is still
 * the same for any split of an interval.
 *
 * Active axes with the same sub-steps are packed into blocks that are integrated together, each as
 * wide as its axes need: the next of PLANT_WIDTHS from their number on.
 */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"
#include "plant.h"
#include "plant_stiffness.h"

/* plant_stiffness takes long, so a fuzz harness, which starts a plant again and again, replaces it
 * by a function that remembers its results. */
#ifndef PLANT_STIFFNESS
#define PLANT_STIFFNESS plant_stiffness
#endif

enum {
    PLANT_STATE_SIZE = PLANT_STATES * PLANT_LANES,
    PLANT_INPUT_ROWS = PLANT_INPUTS > 0 ? PLANT_INPUTS : 1,
    PLANT_CONSTANT_ROWS = PLANT_CONSTANTS > 0 ? PLANT_CONSTANTS : 1,
    PLANT_INPUT_SIZE = PLANT_INPUT_ROWS * PLANT_LANES,
    PLANT_CONSTANT_SIZE = PLANT_CONSTANT_ROWS * PLANT_LANES,
    PLANT_OUTPUT_SIZE = PLANT_OUTPUTS * PLANT_LANES,
    PLANT_PARAMETER_SIZE = PLANT_PARAMETERS > 0 ? PLANT_PARAMETERS : 1,
    PLANT_SUB_STEPS_MAX = 1000 /* 1000 is 25 ns at 25 us: beyond it a parameter is wrong */
};

_Static_assert(!PLANT_CONTROLLED || PLANT_LANES == 1, "steps of its own for each axis");

/* Axes with the same number of sub-steps, a lane each, which are integrated together. */
struct plant_block {
    double x[PLANT_STATE_SIZE];    /* states: [quantity][lane] */
    double u[PLANT_INPUT_SIZE];    /* inputs, likewise */
    double c[PLANT_CONSTANT_SIZE]; /* constants, likewise */
    int instance[PLANT_LANES];     /* axis in each lane; the last one fills the unused lanes */
    int lanes;                     /* number of lanes, one of PLANT_WIDTHS */
    int used;                      /* number of lanes with an axis of their own */
    int sub_steps;                 /* sub-steps of a micro step */
    double fastest;                /* [1/s] bound of |lambda| at the start, of its stiffest axis */
    double size[PLANT_STATES];     /* scale of the error of each state */
    double asked;                  /* [s] step size that the error control asks for */
};

struct model {
    struct plant_block block[PLANT_INSTANCES];
    int blocks;
    int64_t step_ns;          /* [ns] micro step */
    struct plant_tuned tuned; /* tunable parameters that are in force */
    bool watched;             /* the first communication step was compared with the micro step */
};

#include "fmi_model.h"

static const double plant_h_lambda = 2.0; /* largest (h/n) |lambda| */

/* A case of a switch that calls a function with the number of lanes as a constant. */
#define PLANT_CASE(n, call) \
    case n: call; break;

/* So many Runge-Kutta steps of h [s] of the states x. */
static PLANT_INLINE void plant_steps_of(int lanes, plant_function *rhs, double *restrict x,
                                        const double *restrict u, const double *restrict c,
                                        double h, int64_t steps)
{
    enum { SIZE = PLANT_STATES * PLANT_WIDEST };
    const int n = PLANT_STATES * lanes;
    double k1[SIZE], k2[SIZE], k3[SIZE], k4[SIZE], at[SIZE];
    for (int64_t k = 0; k < steps; k++) {
        rhs(x, u, c, k1);
        for (int i = 0; i < n; i++) {
            at[i] = x[i] + 0.5 * h * k1[i];
        }
        rhs(at, u, c, k2);
        for (int i = 0; i < n; i++) {
            at[i] = x[i] + 0.5 * h * k2[i];
        }
        rhs(at, u, c, k3);
        for (int i = 0; i < n; i++) {
            at[i] = x[i] + h * k3[i];
        }
        rhs(at, u, c, k4);
        for (int i = 0; i < n; i++) {
            x[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        }
    }
}

/* Integrate a block by so many steps of h [s]. */
typedef void plant_stepper(struct plant_block *b, double h, int64_t steps);

/* PLANT_FLAT (plant.h): the function that gives the rates is inlined, so that states stay in
 * registers between its calls. A plant of one lane has too many states for that. */
#define STEPS(n, rhs) PLANT_CASE(n, plant_steps_of(n, rhs, b->x, b->u, b->c, h, steps))
PLANT_FLAT static void plant_steps_plain(struct plant_block *b, double h, int64_t steps)
{
#define PLAIN(n) STEPS(n, plant_rhs_##n)
    switch (b->lanes) {
        PLANT_WIDTHS(PLAIN)
    }
#undef PLAIN
}
#undef STEPS

/* Vectors of the sums between rates are as wide as those of the rates: a wide load would wait for
 * two narrow stores. One lane alone has many states, which are vectors themselves. */
#define WIDE(n) (n > 2 || PLANT_LANES == 1)
#define STEPS(n, which) \
    PLANT_CASE(n, if (which) plant_steps_of(n, plant_rhs_##n##_avx2, b->x, b->u, b->c, h, steps))
PLANT_FLAT EL_AVX2 static void plant_steps_avx2(struct plant_block *b, double h, int64_t steps)
{
#define MANY(n) STEPS(n, WIDE(n))
    switch (b->lanes) {
        PLANT_WIDTHS(MANY)
    }
#undef MANY
}

PLANT_FLAT EL_AVX2_TWO static void plant_steps_two(struct plant_block *b, double h, int64_t steps)
{
#define FEW(n) STEPS(n, !WIDE(n))
    switch (b->lanes) {
        PLANT_WIDTHS(FEW)
    }
#undef FEW
}
#undef STEPS

/* The one for a block. */
static plant_stepper *plant_steps_for(const struct plant_block *b)
{
    return !plant_has_avx2() ? plant_steps_plain
           : WIDE(b->lanes)  ? plant_steps_avx2
                             : plant_steps_two;
}

/* One step of h [s] by Bogacki and Shampine (1989) to y. Returns its error relative to the allowed
 * one. */
static double plant_trial(const struct plant_block *b, double h, double *y)
{
    enum { STAGES = 4 }; /* the point of the fourth stage is y; its rate serves the error only */
    static const double a[STAGES][STAGES - 1] = {
        { 0.0 }, { 1.0 / 2.0 }, { 0.0, 3.0 / 4.0 }, { 2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0 }
    };
    static const double e[STAGES] = { -5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0 };
    double k[STAGES][PLANT_STATE_SIZE];
    for (int s = 0; s < STAGES; s++) {
        for (int i = 0; i < PLANT_STATE_SIZE; i++) {
            double sum = 0.0;
            for (int q = 0; q < s; q++) {
                sum += a[s][q] * k[q][i];
            }
            y[i] = b->x[i] + h * sum;
        }
        plant_rhs_1(y, b->u, b->c, k[s]);
    }
    double worst = 0.0;
    for (int i = 0; i < PLANT_STATE_SIZE; i++) {
        double sum = 0.0;
        for (int s = 0; s < STAGES; s++) {
            sum += e[s] * k[s][i];
        }
        const double error = fabs(h * sum) / (PLANT_TOLERANCE * b->size[i]);
        worst = error > worst || isnan(error) ? error : worst;
    }
    return worst;
}

/* A micro step of h [s] in steps that the error allows; -1 if they get too small. */
static int plant_controlled(struct plant_block *b, double h)
{
    static const double safety = 0.9, grow = 5.0, shrink = 0.2;
    double left = h;
    for (int n = 0; left > 0.0; n++) {
        if (n == PLANT_SUB_STEPS_MAX) {
            return -1;
        }
        double step = b->asked < left ? b->asked : left, y[PLANT_STATE_SIZE];
        if (step < left && 2.0 * step > left) {
            step = 0.5 * left; /* two equal steps instead of a long and a very short one */
        }
        const double error = plant_trial(b, step, y);
        double factor = error > 0.0 ? safety / el_cbrt(error) : grow;
        factor = factor < grow ? factor > shrink ? factor : shrink : isnan(factor) ? shrink : grow;
        if (error <= 1.0) {
            memcpy(b->x, y, sizeof y);
            left = step < left ? left - step : 0.0;
            /* A step that the grid has cut short is no reason to ask for less than before. */
            b->asked = factor < 1.0 || factor * step > b->asked ? factor * step : b->asked;
        } else {
            b->asked = step * (factor < safety ? factor : safety);
        }
    }
    return 0;
}

/* So many micro steps of all axes, the first of which begins at `now` [ns]. */
static int plant_advance(struct fmu *f, int64_t now, int64_t steps)
{
    const int64_t step = f->s.m.step_ns;
    const double h = 1e-9 * (double)step;
    for (int n = 0; n < f->s.m.blocks && !PLANT_CONTROLLED; n++) {
        struct plant_block *b = &f->s.m.block[n];
        plant_steps_for(b)(b, h / b->sub_steps, steps * b->sub_steps);
    }
    for (int64_t k = 1; k <= steps && PLANT_CONTROLLED; k++) {
        for (int n = 0; n < f->s.m.blocks; n++) {
            struct plant_block *b = &f->s.m.block[n];
            if (plant_controlled(b, h) != 0) {
                return fmu_fail(f,
                                "axis %d: too stiff at %.9f s, %g s would need more than %d "
                                "sub-steps",
                                b->instance[0] + 1, 1e-9 * (double)(now + k * step), h,
                                PLANT_SUB_STEPS_MAX);
            }
        }
    }
    return 0;
}

static void plant_read_block(const struct fmu *f, struct plant_block *b)
{
    for (int lane = 0; lane < b->lanes; lane++) {
        plant_inputs(&f->s.v, b->instance[lane], b->lanes, &b->u[lane]);
    }
}

static void plant_read(struct fmu *f)
{
    for (int n = 0; n < f->s.m.blocks; n++) {
        plant_read_block(f, &f->s.m.block[n]);
    }
}

/* Whether all values are finite. Then so is their sum, unless it overflows: only where it is not
 * finite each value is looked at. */
static PLANT_INLINE bool plant_finite_of(int lanes, const double *a, int rows)
{
    double sum[PLANT_WIDEST] = { 0.0 }, all = 0.0;
    for (int k = 0; k < rows; k++) {
        for (int lane = 0; lane < lanes; lane++) {
            sum[lane] += a[k * lanes + lane];
        }
    }
    for (int lane = 0; lane < lanes; lane++) {
        all += sum[lane];
    }
    if (fabs(all) <= DBL_MAX) {
        return true;
    }
    for (int i = 0; i < rows * lanes; i++) {
        if (!(fabs(a[i]) <= DBL_MAX)) {
            return false;
        }
    }
    return true;
}

/* Compute the outputs y. Returns whether all states and outputs are finite. */
static PLANT_INLINE bool plant_outputs_of(int lanes, plant_function *outputs, const double *x,
                                          const double *u, const double *c, double *y)
{
    outputs(x, u, c, y);
    return plant_finite_of(lanes, x, PLANT_STATES) && plant_finite_of(lanes, y, PLANT_OUTPUTS);
}

static bool plant_outputs(const struct plant_block *b, double *y)
{
    const bool wide = plant_has_avx2();
    bool good = false;
#define OUTPUTS(n) \
    PLANT_CASE(n, good = plant_outputs_of(n, wide ? plant_outputs_##n##_avx2 : plant_outputs_##n, \
                                          b->x, b->u, b->c, y))
    switch (b->lanes) {
        PLANT_WIDTHS(OUTPUTS)
    }
#undef OUTPUTS
    return good;
}

/* Report the first value that is not finite, a state before an output; returns -1. */
static int plant_refuse(struct fmu *f, const struct plant_block *b, const double *y, int64_t now)
{
    const double *a = b->x;
    const char *const *names = plant_state_names;
    int i = 0;
    while (fabs(a[i]) <= DBL_MAX) {
        i++;
        if (a == b->x && i == PLANT_STATES * b->lanes) {
            a = y;
            names = plant_output_names;
            i = 0;
        }
    }
    return fmu_fail(f, "axis %d: %s is %g at %.9f s", b->instance[i % b->lanes] + 1,
                    names[i / b->lanes], isnan(a[i]) ? NAN : a[i], 1e-9 * (double)now);
}

/* Set the outputs of a block from y, whose quantities are `step` apart. */
static void plant_show_block(struct fmu *f, const struct plant_block *b, const double *y, int step)
{
    for (int lane = 0; lane < b->used; lane++) {
        plant_show(&f->s.v, b->instance[lane], step, &y[lane]);
    }
}

/* Set the outputs of a block from its state at the grid instant `now` [ns]; fails if a value is not
 * finite. */
static int plant_publish_block(struct fmu *f, const struct plant_block *b, int64_t now)
{
    double y[PLANT_OUTPUT_SIZE];
    if (!plant_outputs(b, y)) {
        return plant_refuse(f, b, y, now);
    }
    plant_show_block(f, b, y, b->lanes);
    return 0;
}

static int plant_publish(struct fmu *f, int64_t now)
{
    for (int n = 0; n < f->s.m.blocks; n++) {
        if (plant_publish_block(f, &f->s.m.block[n], now) != 0) {
            return -1;
        }
    }
    return 0;
}

/* Warn if the integration steps are coarse for time constants that an importer can see, those above
 * its communication step `seen` [s]. A Runge-Kutta step of z time constants has a relative error of
 * z^4/120 in that lag, 1e-4 at z = 1/3. Faster lags have decayed between two communication
 * points. */
static void plant_watch(struct fmu *f, double seen)
{
    static const double coarse = 1.0 / 3.0;
    const double h = 1e-9 * (double)f->s.m.step_ns;
    const struct plant_block *worst = NULL;
    double most = coarse;
    for (int n = 0; n < f->s.m.blocks && !PLANT_CONTROLLED; n++) {
        const struct plant_block *b = &f->s.m.block[n];
        const double z = h / b->sub_steps * el_min(b->fastest, 1.0 / seen);
        if (z > most) {
            most = z;
            worst = b;
        }
    }
    if (worst) {
        fmu_warn(f,
                 "axis %d: micro_step %.9g s (%d sub-steps) is coarse against its shortest time "
                 "constant, %.3g s: lags of %.3g s are off by up to %.2g %%",
                 worst->instance[0] + 1, h, worst->sub_steps, 1.0 / worst->fastest,
                 el_max(1.0 / worst->fastest, seen), 100.0 * most * most * most * most / 120.0);
    }
}

/* An active axis before it is placed in a lane. */
struct plant_axis {
    double p[PLANT_PARAMETER_SIZE]; /* its parameters */
    double fastest;                 /* [1/s] bound of |lambda| */
    int sub_steps;                  /* 0: not active, or already placed */
};

/* Put the constants of parameters into a lane of a block. */
static void plant_put_constants(struct plant_block *b, int lane, const double *p)
{
    double c[PLANT_CONSTANT_SIZE];
    plant_constants(p, c);
    for (int k = 0; k < PLANT_CONSTANTS; k++) {
        b->c[k * b->lanes + lane] = c[k];
    }
}

/* Put an axis into the lanes of a block from `lane` on. */
static void plant_fill(struct plant_block *b, int lane, int instance, const struct plant_axis *axis)
{
    double x[PLANT_STATES];
    plant_start(axis->p, x);
    plant_sizes(axis->p, b->size);
    b->fastest = el_max(b->fastest, axis->fastest);
    for (; lane < b->lanes; lane++) {
        b->instance[lane] = instance;
        for (int k = 0; k < PLANT_STATES; k++) {
            b->x[k * b->lanes + lane] = x[k];
        }
        plant_put_constants(b, lane, axis->p);
    }
}

/* Number of lanes of a block for so many axes, at most PLANT_LANES. */
static int plant_width(int axes)
{
#define WIDE_ENOUGH(n) \
    if (axes <= n) { \
        return n; \
    }
    PLANT_WIDTHS(WIDE_ENOUGH)
#undef WIDE_ENOUGH
    return PLANT_LANES;
}

/* Make a block of the axis `first` and those after it with its sub-steps that are not placed. */
static void plant_place(struct model *m, int first, struct plant_axis axes[PLANT_INSTANCES])
{
    struct plant_block *b = &m->block[m->blocks++];
    int alike = 0;
    b->sub_steps = axes[first].sub_steps;
    b->asked = 1e-9 * (double)m->step_ns;
    for (int i = first; i < PLANT_INSTANCES; i++) {
        alike += axes[i].sub_steps == b->sub_steps;
    }
    b->lanes = plant_width(alike);
    for (int i = first; i < PLANT_INSTANCES && b->used < b->lanes; i++) {
        if (axes[i].sub_steps == b->sub_steps) {
            plant_fill(b, b->used++, i, &axes[i]);
            axes[i].sub_steps = 0;
        }
    }
}

/* Check an axis' parameters and find the sub-steps they need. */
static int plant_look(struct fmu *f, int instance, struct plant_axis *axis)
{
    double x[PLANT_STATES], u[PLANT_INPUT_SIZE];
    const double h = 1e-9 * (double)f->s.m.step_ns;
    plant_parameters(&f->s.v, instance, axis->p);
    const char *wrong = plant_check(axis->p);
    if (wrong) {
        return fmu_fail(f, "axis %d: %s", instance + 1, wrong);
    }
    axis->sub_steps = 1;
    if (PLANT_CONTROLLED) {
        return 0;
    }
    plant_start(axis->p, x);
    plant_inputs(&f->s.v, instance, 1, u);
    axis->fastest = PLANT_STIFFNESS(x, u, axis->p);
    const double steps = ceil(h * axis->fastest / plant_h_lambda);
    if (!(steps <= PLANT_SUB_STEPS_MAX)) {
        return fmu_fail(f, "axis %d: too stiff, %g s would need %g sub-steps, more than %d",
                        instance + 1, h, steps, PLANT_SUB_STEPS_MAX);
    }
    axis->sub_steps = steps > 1.0 ? (int)steps : 1;
    return 0;
}

/* The same at the start, where sub-steps are told. */
static int plant_start_axis(struct fmu *f, int instance, struct plant_axis *axis)
{
    if (plant_look(f, instance, axis) != 0) {
        return -1;
    }
    if (axis->sub_steps > 1) {
        fmu_event(f, "axis %d: stiff, %d sub-steps per micro step of %g s", instance + 1,
                  axis->sub_steps, 1e-9 * (double)f->s.m.step_ns);
    }
    return 0;
}

static int model_start(struct fmu *f)
{
    const double y[PLANT_OUTPUTS] = { 0.0 };
    struct plant_axis axes[PLANT_INSTANCES];
    const double step = 1e9 * f->s.v.micro_step;
    const double tolerance = 1e-3; /* [ns] for decimal steps: 25 us is 25000.000000000004 ns */
    memset(&f->s.m, 0, sizeof f->s.m);
    memset(axes, 0, sizeof axes);
    if (!(step >= FMU_TICK_NS && step <= 1e18) || fabs(step - round(step)) > tolerance
        || llround(step) % FMU_TICK_NS != 0) {
        return fmu_fail(f, "micro_step %.12g s is not a whole multiple of %d ns", f->s.v.micro_step,
                        FMU_TICK_NS);
    }
    f->s.m.step_ns = llround(step);
    plant_tuned(&f->s.v, &f->s.m.tuned);
    for (int i = 0; i < PLANT_INSTANCES; i++) {
        plant_show(&f->s.v, i, 1, y);
        if (plant_active(&f->s.v, i) && plant_start_axis(f, i, &axes[i]) != 0) {
            return -1;
        }
    }
    for (int i = 0; i < PLANT_INSTANCES; i++) {
        if (axes[i].sub_steps > 0) {
            plant_place(&f->s.m, i, axes);
        }
    }
    plant_read(f);
    return plant_publish(f, 0);
}

/* Take the tunable parameters as they are now: constants, and more sub-steps if a block needs them.
 * What was reached stays. */
static int plant_tune(struct fmu *f)
{
    for (int n = 0; n < f->s.m.blocks; n++) {
        struct plant_block *b = &f->s.m.block[n];
        for (int lane = 0; lane < b->lanes; lane++) {
            struct plant_axis axis = { .fastest = 0.0 };
            if (plant_look(f, b->instance[lane], &axis) != 0) {
                return -1;
            }
            plant_put_constants(b, lane, axis.p);
            plant_sizes(axis.p, b->size);
            b->fastest = el_max(b->fastest, axis.fastest);
            b->sub_steps = axis.sub_steps > b->sub_steps ? axis.sub_steps : b->sub_steps;
        }
    }
    return 0;
}

/* Take tunable parameters that have changed, and compare the first communication step. */
static int plant_ready(struct fmu *f, int64_t t0, int64_t t1)
{
    if (PLANT_TUNABLES > 0 && f->tuned && plant_tuned(&f->s.v, &f->s.m.tuned)
        && plant_tune(f) != 0) {
        return -1;
    }
    f->tuned = false;
    if (!f->s.m.watched) {
        f->s.m.watched = true;
        plant_watch(f, 1e-9 * (double)(t1 - t0));
    }
    return 0;
}

static int plant_run(struct fmu *f, int64_t t0, int64_t t1)
{
    const int64_t h = f->s.m.step_ns, last = t1 / h * h;
    int64_t now = t0 / h * h;
    if (last <= t0) {
        if (now == t0) {
            plant_read(f);
        }
        return 0;
    }
    if (now < t0) { /* the micro step that has begun goes on with the inputs of its begin */
        if (plant_advance(f, now, 1) != 0) {
            return -1;
        }
        now += h;
    }
    if (now < t1) {
        plant_read(f);
    }
    return plant_advance(f, now, (last - now) / h) != 0 ? -1 : plant_publish(f, last);
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    return plant_ready(f, t0, t1) != 0 ? -1 : plant_run(f, t0, t1);
}

#if defined(FMU_PART) && defined(PLANT_TOGETHER) && defined(EL_WIDE)
#include "plant_together.h"
#endif
