/* Model of every Modelica FMU: PLANT_INSTANCES copies of one class on a fixed micro-grid.
 *
 * At each instant of the grid k h the inputs are read, and held to the next instant, where the new
 * state shows. Communication points between two instants show the older one, so any split of an
 * interval gives the same bits.
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
 * Active axes are packed into blocks of PLANT_LANES that are integrated together.
 */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "plant.h"

enum {
    PLANT_STATE_SIZE    = PLANT_STATES * PLANT_LANES,
    PLANT_INPUT_SIZE    = (PLANT_INPUTS > 0 ? PLANT_INPUTS : 1) * PLANT_LANES,
    PLANT_CONSTANT_SIZE = (PLANT_CONSTANTS > 0 ? PLANT_CONSTANTS : 1) * PLANT_LANES,
    PLANT_OUTPUT_SIZE   = PLANT_OUTPUTS * PLANT_LANES,
    PLANT_PARAMETER_SIZE = PLANT_PARAMETERS > 0 ? PLANT_PARAMETERS : 1,
    PLANT_SUB_STEPS_MAX = 1000 /* 1000 is 25 ns at 25 us: beyond it a parameter is wrong */
};

_Static_assert(!PLANT_CONTROLLED || PLANT_LANES == 1, "steps of its own for each axis");

/* Axes with the same number of sub-steps. */
struct plant_block {
    double x[PLANT_STATE_SIZE];
    double u[PLANT_INPUT_SIZE];
    double c[PLANT_CONSTANT_SIZE];
    int    instance[PLANT_LANES]; /* the last axis fills the lanes that are left */
    int    lanes;                 /* used */
    int    sub_steps;
    double fastest;            /* [1/s] bound of |lambda| at the start, of its stiffest axis */
    double size[PLANT_STATES]; /* what is large for each state */
    double asked;              /* [s] step that the error asks for */
};

struct model {
    struct plant_block block[PLANT_INSTANCES];
    int     blocks;
    int64_t step_ns; /* [ns] micro step */
    bool    watched; /* the first communication step was compared with it */
};

#include "fmi_model.h"

static const double plant_h_lambda = 2.0;

/* Bound of the largest |eigenvalue| of an n x n matrix, [i][j] at [i * n + j]: |lambda| <=
 * norm(a^m)^(1/m) for every m; with m = 2^squarings, of 2^10 at most some per cent too large. */
enum { PLANT_ROUGH = 4, PLANT_FINE = 10 };
static double plant_spectral_radius(const double *matrix, int squarings)
{
    enum { n = PLANT_STATES };
    double a[n * n], square[n * n], logarithm = 0.0, share = 1.0;
    memcpy(a, matrix, sizeof a);
    for (int k = 0;; k++, share *= 0.5) {
        double norm = 0.0;
        for (int i = 0; i < n; i++) {
            double sum = 0.0;
            for (int j = 0; j < n; j++) {
                sum += fabs(a[i * n + j]);
            }
            norm = sum > norm || isnan(sum) ? sum : norm;
        }
        if (norm == 0.0 || !isfinite(norm)) {
            return norm;
        }
        logarithm += share * log(norm);
        if (k == squarings) {
            return exp(logarithm);
        }
        for (int i = 0; i < n * n; i++) {
            a[i] /= norm;
        }
        memset(square, 0, sizeof square);
        for (int i = 0; i < n; i++) {
            for (int q = 0; q < n; q++) {
                const double factor = a[i * n + q], *row = &a[q * n];
                double *sum = &square[i * n];
                for (int j = 0; j < n && factor != 0.0; j++) {
                    sum[j] += factor * row[j];
                }
            }
        }
        memcpy(a, square, sizeof square);
    }
}

/* [1/s] bound of |lambda| at a point with these branches; branches that exclude each other may give
 * 0/0 and NaN. */
static double plant_radius(const double *x, const double *u, const double *p, unsigned branches,
                           int squarings)
{
    double a[PLANT_STATES * PLANT_STATES];
    plant_jacobian(x, u, p, branches, a);
    return plant_spectral_radius(a, squarings);
}

/* Whether a value, no NaN, is larger than the largest so far, NaN before the first. */
static bool plant_larger(double radius, double largest)
{
    return !isnan(radius) && !(largest >= radius);
}

/* [1/s] bound of |lambda| at a point, over all branches; NaN if none has one. Of many branches not
 * every combination is looked at: from none and from all of them each in turn is changed if that
 * makes the bound larger. */
static double plant_stiffness(const double *x, const double *u, const double *p)
{
    const int every = 8;
    unsigned all = 0u;
    for (int bit = 0; bit < PLANT_BRANCHES; bit++) {
        all |= 1u << bit;
    }
    double largest = NAN;
    if (PLANT_BRANCHES <= every) {
        for (unsigned branches = 0; branches <= all; branches++) {
            const double radius = plant_radius(x, u, p, branches, PLANT_FINE);
            largest = plant_larger(radius, largest) ? radius : largest;
        }
        return largest;
    }
    for (int begin = 0; begin < 2; begin++) {
        unsigned branches = begin ? all : 0u;
        double here = plant_radius(x, u, p, branches, PLANT_ROUGH);
        for (int bit = 0; bit < PLANT_BRANCHES; bit++) {
            const double radius = plant_radius(x, u, p, branches ^ 1u << bit, PLANT_ROUGH);
            const bool better = plant_larger(radius, here);
            branches ^= better ? 1u << bit : 0u;
            here = better ? radius : here;
        }
        here = plant_radius(x, u, p, branches, PLANT_FINE);
        largest = plant_larger(here, largest) ? here : largest;
    }
    return largest;
}

/* One Runge-Kutta step of h [s]. */
static void plant_step(struct plant_block *b, double h)
{
    double k1[PLANT_STATE_SIZE], k2[PLANT_STATE_SIZE], k3[PLANT_STATE_SIZE], k4[PLANT_STATE_SIZE];
    double at[PLANT_STATE_SIZE];
    plant_rhs(b->x, b->u, b->c, k1);
    for (int i = 0; i < PLANT_STATE_SIZE; i++) {
        at[i] = b->x[i] + 0.5 * h * k1[i];
    }
    plant_rhs(at, b->u, b->c, k2);
    for (int i = 0; i < PLANT_STATE_SIZE; i++) {
        at[i] = b->x[i] + 0.5 * h * k2[i];
    }
    plant_rhs(at, b->u, b->c, k3);
    for (int i = 0; i < PLANT_STATE_SIZE; i++) {
        at[i] = b->x[i] + h * k3[i];
    }
    plant_rhs(at, b->u, b->c, k4);
    for (int i = 0; i < PLANT_STATE_SIZE; i++) {
        b->x[i] += h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
    }
}

/* One step of h [s] by Bogacki and Shampine (1989) to y; its error, 1 being allowed. */
static double plant_trial(const struct plant_block *b, double h, double *y)
{
    enum { STAGES = 4 }; /* y stands in the last row: the fourth stage is for the error alone */
    static const double a[STAGES][STAGES - 1] = {{0.0}, {1.0 / 2.0}, {0.0, 3.0 / 4.0},
        {2.0 / 9.0, 1.0 / 3.0, 4.0 / 9.0}};
    static const double e[STAGES] = {-5.0 / 72.0, 1.0 / 12.0, 1.0 / 9.0, -1.0 / 8.0};
    double k[STAGES][PLANT_STATE_SIZE];
    for (int s = 0; s < STAGES; s++) {
        for (int i = 0; i < PLANT_STATE_SIZE; i++) {
            double sum = 0.0;
            for (int q = 0; q < s; q++) {
                sum += a[s][q] * k[q][i];
            }
            y[i] = b->x[i] + h * sum;
        }
        plant_rhs(y, b->u, b->c, k[s]);
    }
    double worst = 0.0;
    for (int i = 0; i < PLANT_STATE_SIZE; i++) {
        double sum = 0.0;
        for (int s = 0; s < STAGES; s++) {
            sum += e[s] * k[s][i];
        }
        const double error = fabs(h * sum) / (PLANT_TOLERANCE * b->size[i / PLANT_LANES]);
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
            step = 0.5 * left; /* not a whole one and then a scrap */
        }
        const double error = plant_trial(b, step, y);
        double factor = error > 0.0 ? safety * pow(error, -1.0 / 3.0) : grow;
        factor = factor < grow ? factor > shrink ? factor : shrink : isnan(factor) ? shrink : grow;
        if (error <= 1.0) {
            memcpy(b->x, y, sizeof y);
            left = step < left ? left - step : 0.0;
            /* A step cut by the grid says nothing against the larger one asked for before. */
            b->asked = factor < 1.0 || factor * step > b->asked ? factor * step : b->asked;
        } else {
            b->asked = step * (factor < safety ? factor : safety);
        }
    }
    return 0;
}

/* One micro step of all axes, which ends at `now` [ns]. */
static int plant_advance(struct fmu *f, int64_t now)
{
    const double h = 1e-9 * (double)f->s.m.step_ns;
    for (int n = 0; n < f->s.m.blocks; n++) {
        struct plant_block *b = &f->s.m.block[n];
        if (!PLANT_CONTROLLED) {
            for (int k = 0; k < b->sub_steps; k++) {
                plant_step(b, h / b->sub_steps);
            }
        } else if (plant_controlled(b, h) != 0) {
            return fmu_fail(f,
                "axis %d: too stiff at %.9f s, %g s would need more than %d sub-steps",
                b->instance[0] + 1, 1e-9 * (double)now, h, PLANT_SUB_STEPS_MAX);
        }
    }
    return 0;
}

static void plant_read(struct fmu *f)
{
    for (int n = 0; n < f->s.m.blocks; n++) {
        struct plant_block *b = &f->s.m.block[n];
        for (int lane = 0; lane < PLANT_LANES; lane++) {
            plant_inputs(&f->s.v, b->instance[lane], &b->u[lane]);
        }
    }
}

/* Whether rows of lanes are all numbers: 0 times a number is 0, times infinity or NaN it is NaN. */
static int plant_finite(const double *a, int rows)
{
    double rest[PLANT_LANES] = {0.0}, sum = 0.0;
    for (int k = 0; k < rows; k++) {
        for (int lane = 0; lane < PLANT_LANES; lane++) {
            rest[lane] += 0.0 * a[k * PLANT_LANES + lane];
        }
    }
    for (int lane = 0; lane < PLANT_LANES; lane++) {
        sum += rest[lane];
    }
    return sum == 0.0;
}

/* Say which row is the first that is no number. */
static int plant_refuse(struct fmu *f, const struct plant_block *b, const double *a,
    const char *const *names, int64_t now)
{
    int i = 0;
    while (fabs(a[i]) <= DBL_MAX) {
        i++;
    }
    return fmu_fail(f, "axis %d: %s is %g at %.9f s", b->instance[i % PLANT_LANES] + 1,
        names[i / PLANT_LANES], isnan(a[i]) ? NAN : a[i], 1e-9 * (double)now);
}

/* Show the state at the grid instant `now` [ns] on the outputs, if all are numbers. */
static int plant_publish(struct fmu *f, int64_t now)
{
    for (int n = 0; n < f->s.m.blocks; n++) {
        const struct plant_block *b = &f->s.m.block[n];
        double y[PLANT_OUTPUT_SIZE];
        plant_outputs(b->x, b->u, b->c, y);
        if (!plant_finite(b->x, PLANT_STATES)) {
            return plant_refuse(f, b, b->x, plant_state_names, now);
        }
        if (!plant_finite(y, PLANT_OUTPUTS)) {
            return plant_refuse(f, b, y, plant_output_names, now);
        }
        for (int lane = 0; lane < b->lanes; lane++) {
            plant_show(&f->s.v, b->instance[lane], &y[lane]);
        }
    }
    return 0;
}

/* Tell once if steps are coarse for what an importer sees: a lag slower than its communication step
 * `seen` [s]. A Runge-Kutta step of z time constants makes such a lag wrong by z^4/120 of itself,
 * 1e-4 at z = 1/3. What is faster has died away between two communication points. */
static void plant_watch(struct fmu *f, double seen)
{
    static const double coarse = 1.0 / 3.0;
    const double h = 1e-9 * (double)f->s.m.step_ns;
    const struct plant_block *worst = NULL;
    double most = coarse;
    for (int n = 0; n < f->s.m.blocks && !PLANT_CONTROLLED; n++) {
        const struct plant_block *b = &f->s.m.block[n];
        const double z = h / b->sub_steps * fmin(b->fastest, 1.0 / seen);
        if (z > most) {
            most = z;
            worst = b;
        }
    }
    if (worst) {
        fmu_warn(f, "axis %d: micro_step %.9g s (%d sub-steps) is coarse against its shortest time "
            "constant, %.3g s: lags of %.3g s are off by up to %.2g %%", worst->instance[0] + 1, h,
            worst->sub_steps, 1.0 / worst->fastest, fmax(1.0 / worst->fastest, seen),
            100.0 * most * most * most * most / 120.0);
    }
}

/* Give an axis its lane: in a block with room and the same sub-steps, else in a new one. */
static void plant_place(struct fmu *f, int instance, int sub_steps, const double *p,
    double fastest)
{
    struct model *m = &f->s.m;
    int n = 0;
    while (n < m->blocks
           && (m->block[n].sub_steps != sub_steps || m->block[n].lanes == PLANT_LANES)) {
        n++;
    }
    m->blocks += n == m->blocks;
    struct plant_block *b = &m->block[n];
    double x[PLANT_STATES], c[PLANT_CONSTANT_SIZE];
    plant_start(p, x);
    plant_constants(p, c);
    plant_sizes(p, b->size);
    b->asked = 1e-9 * (double)m->step_ns;
    b->sub_steps = sub_steps;
    b->fastest = fmax(b->fastest, fastest);
    for (int lane = b->lanes; lane < PLANT_LANES; lane++) {
        b->instance[lane] = instance;
        for (int k = 0; k < PLANT_STATES; k++) {
            b->x[k * PLANT_LANES + lane] = x[k];
        }
        for (int k = 0; k < PLANT_CONSTANTS; k++) {
            b->c[k * PLANT_LANES + lane] = c[k];
        }
    }
    b->lanes++;
}

static int plant_start_axis(struct fmu *f, int instance)
{
    double p[PLANT_PARAMETER_SIZE], x[PLANT_STATES], u[PLANT_INPUT_SIZE], packed[PLANT_INPUT_SIZE];
    const double h = 1e-9 * (double)f->s.m.step_ns;
    plant_parameters(&f->s.v, instance, p);
    const char *wrong = plant_check(p);
    if (wrong) {
        return fmu_fail(f, "axis %d: %s", instance + 1, wrong);
    }
    if (PLANT_CONTROLLED) {
        plant_place(f, instance, 1, p, 0.0);
        return 0;
    }
    plant_start(p, x);
    plant_inputs(&f->s.v, instance, u);
    for (int k = 0; k < PLANT_INPUTS; k++) {
        packed[k] = u[k * PLANT_LANES];
    }
    const double fastest = plant_stiffness(x, packed, p);
    const double steps = ceil(h * fastest / plant_h_lambda);
    if (!(steps <= PLANT_SUB_STEPS_MAX)) {
        return fmu_fail(f, "axis %d: too stiff, %g s would need %g sub-steps, more than %d",
            instance + 1, h, steps, PLANT_SUB_STEPS_MAX);
    }
    if (steps > 1.0) {
        fmu_event(f, "axis %d: stiff, %g sub-steps per micro step of %g s", instance + 1, steps, h);
    }
    plant_place(f, instance, steps > 1.0 ? (int)steps : 1, p, fastest);
    return 0;
}

static int model_start(struct fmu *f)
{
    const double y[PLANT_OUTPUT_SIZE] = {0.0};
    const double step = 1e9 * f->s.v.micro_step;
    const double tolerance = 1e-3; /* [ns] no clock means less; 25 us is 25000.000000000004 ns */
    memset(&f->s.m, 0, sizeof f->s.m);
    if (!(step >= FMU_TICK_NS && step <= 1e18) || fabs(step - round(step)) > tolerance
        || llround(step) % FMU_TICK_NS != 0) {
        return fmu_fail(f, "micro_step %.12g s is not a whole multiple of %d ns", f->s.v.micro_step,
            FMU_TICK_NS);
    }
    f->s.m.step_ns = llround(step);
    for (int i = 0; i < PLANT_INSTANCES; i++) {
        plant_show(&f->s.v, i, y);
        if (plant_active(&f->s.v, i) && plant_start_axis(f, i) != 0) {
            return -1;
        }
    }
    plant_read(f);
    return plant_publish(f, 0);
}

static const char *model_check(const struct state *s)
{
    const struct model *m = &s->m;
    if (m->step_ns < FMU_TICK_NS || m->blocks < 0 || m->blocks > PLANT_INSTANCES) {
        return "its micro step or its number of blocks";
    }
    for (int n = 0; n < m->blocks; n++) {
        const struct plant_block *b = &m->block[n];
        if (b->lanes < 1 || b->lanes > PLANT_LANES || b->sub_steps < 1
            || b->sub_steps > PLANT_SUB_STEPS_MAX) {
            return "the lanes or sub-steps of a block";
        }
        for (int lane = 0; lane < PLANT_LANES; lane++) {
            if (b->instance[lane] < 0 || b->instance[lane] >= PLANT_INSTANCES) {
                return "an axis of a block";
            }
        }
    }
    return NULL;
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    const int64_t h = f->s.m.step_ns, first = t0 / h * h, last = t1 / h * h;
    if (!f->s.m.watched) {
        f->s.m.watched = true;
        plant_watch(f, 1e-9 * (double)(t1 - t0));
    }
    for (int64_t now = first; now <= t1; now += h) {
        if (now > t0 && plant_advance(f, now) != 0) {
            return -1;
        }
        if (now >= t0 && now < t1) {
            plant_read(f);
        }
    }
    return last > t0 ? plant_publish(f, last) : 0;
}
