/* plant_together - several runs of one plant stepped at once: blocks that are alike become lanes of
 * one wide block for a communication step. Each run has the bits that it has alone, because lanes
 * never meet. plant_model.c includes this for a part (fmu_part.h); it needs AVX2.
 */
#ifndef PLANT_TOGETHER_H
#define PLANT_TOGETHER_H

#include "fmu_part.h"

/* Blocks of several runs side by side: [quantity][run][lane of its block]. */
struct plant_row {
    double x[PLANT_STATES * PLANT_WIDEST];
    double u[PLANT_INPUT_ROWS * PLANT_WIDEST];
    double c[PLANT_CONSTANT_ROWS * PLANT_WIDEST];
    int lanes; /* of all runs, and more to one of PLANT_TOGETHER */
};

/* Runs whose blocks are alike. */
struct plant_set {
    struct fmu *f[FMU_PART_RUNS];
    bool *failed[FMU_PART_RUNS];
    int runs;
};

/* Copy rows of n values each, which are `to_step` and `from_step` apart. */
static PLANT_INLINE void plant_copy_of(int n, double *to, int to_step, const double *from,
                                       int from_step, int rows)
{
    for (int k = 0; k < rows; k++) {
        memcpy(&to[k * to_step], &from[k * from_step], (size_t)n * sizeof *to);
    }
}

static inline void plant_copy(int n, double *to, int to_step, const double *from, int from_step,
                              int rows)
{
#define COPY(m) PLANT_CASE(m, plant_copy_of(m, to, to_step, from, from_step, rows))
    switch (n) {
        PLANT_WIDTHS(COPY)
    }
#undef COPY
}

/* Copy the last lane in use to those behind it, which no run has: `used` and all lanes of a row. */
static void plant_pad(double *a, int used, int lanes, int rows)
{
    for (int k = 0; k < rows && used < lanes; k++) {
        for (int i = used; i < lanes; i++) {
            a[k * lanes + i] = a[k * lanes + used - 1];
        }
    }
}

/* Fill the states, inputs and constants of a row from the block n of each run. */
static void plant_gather(const struct plant_set *set, int n, struct plant_row *row)
{
    const int lanes = set->f[0]->s.m.block[n].lanes, used = set->runs * lanes, all = row->lanes;
    for (int r = 0; r < set->runs; r++) {
        const struct plant_block *b = &set->f[r]->s.m.block[n];
        const int at = r * lanes;
        plant_copy(lanes, &row->x[at], all, b->x, lanes, PLANT_STATES);
        plant_copy(lanes, &row->u[at], all, b->u, lanes, PLANT_INPUT_ROWS);
        plant_copy(lanes, &row->c[at], all, b->c, lanes, PLANT_CONSTANT_ROWS);
    }
    plant_pad(row->x, used, all, PLANT_STATES);
    plant_pad(row->u, used, all, PLANT_INPUT_ROWS);
    plant_pad(row->c, used, all, PLANT_CONSTANT_ROWS);
}

/* Read the inputs of the block n of each run, in its state and in the row. */
static void plant_read_row(const struct plant_set *set, int n, struct plant_row *row)
{
    const int lanes = set->f[0]->s.m.block[n].lanes;
    for (int r = 0; r < set->runs; r++) {
        struct plant_block *b = &set->f[r]->s.m.block[n];
        plant_read_block(set->f[r], b);
        plant_copy(lanes, &row->u[r * lanes], row->lanes, b->u, lanes, PLANT_INPUT_ROWS);
    }
    plant_pad(row->u, set->runs * lanes, row->lanes, PLANT_INPUT_ROWS);
}

/* So many steps of h [s] of a row. */
EL_AVX2 static void plant_steps_row(struct plant_row *row, double h, int64_t steps)
{
#define STEPS(n) \
    PLANT_CASE(n, plant_steps_of(n, plant_rhs_##n##_avx2, row->x, row->u, row->c, h, steps))
    switch (row->lanes) {
        PLANT_TOGETHER(STEPS)
    }
#undef STEPS
}

/* Compute the outputs y of a row. Returns whether all states and outputs are finite. */
static bool plant_outputs_row(const struct plant_row *row, double *y)
{
    bool good = false;
#define OUTPUTS(n) \
    PLANT_CASE(n, good = plant_outputs_of(n, plant_outputs_##n##_avx2, row->x, row->u, row->c, y))
    switch (row->lanes) {
        PLANT_TOGETHER(OUTPUTS)
    }
#undef OUTPUTS
    return good;
}

/* Set the outputs of the block n of each run at the grid instant `now` [ns]. If a value is not
 * finite, each run looks for itself, so that only whose value it is fails. */
static void plant_publish_row(const struct plant_set *set, int n, const struct plant_row *row,
                              int64_t now)
{
    double y[PLANT_OUTPUTS * PLANT_WIDEST];
    const bool good = plant_outputs_row(row, y);
    for (int r = 0; r < set->runs; r++) {
        const struct plant_block *b = &set->f[r]->s.m.block[n];
        if (good) {
            plant_show_block(set->f[r], b, &y[r * b->lanes], row->lanes);
        } else if (!*set->failed[r]) {
            *set->failed[r] = plant_publish_block(set->f[r], b, now) != 0;
        }
    }
}

/* As plant_run, of the block n of each run, for a step in which a micro step ends. */
static void plant_run_row(const struct plant_set *set, int n, int64_t t0, int64_t t1)
{
    const struct model *m = &set->f[0]->s.m;
    const int64_t h = m->step_ns, last = t1 / h * h;
    int64_t now = t0 / h * h;
    const int lanes = m->block[n].lanes, sub_steps = m->block[n].sub_steps;
    const double part = 1e-9 * (double)h / sub_steps;
    struct plant_row row;
    row.lanes = PLANT_WIDEST;
#define NARROWER(w) \
    if (set->runs * lanes <= w && w < row.lanes) { \
        row.lanes = w; \
    }
    PLANT_TOGETHER(NARROWER)
#undef NARROWER
    plant_gather(set, n, &row);
    if (now < t0) {
        plant_steps_row(&row, part, sub_steps);
        now += h;
    }
    if (now < t1) {
        plant_read_row(set, n, &row);
    }
    plant_steps_row(&row, part, (last - now) / h * sub_steps);
    for (int r = 0; r < set->runs; r++) {
        plant_copy(lanes, set->f[r]->s.m.block[n].x, lanes, &row.x[r * lanes], row.lanes,
                   PLANT_STATES);
    }
    plant_publish_row(set, n, &row, last);
}

/* Whether blocks of two runs may be lanes of one block. */
static bool plant_alike(const struct model *a, const struct model *b)
{
    bool same = a->step_ns == b->step_ns && a->blocks == b->blocks;
    for (int n = 0; same && n < a->blocks; n++) {
        same = a->block[n].lanes == b->block[n].lanes
               && a->block[n].sub_steps == b->block[n].sub_steps;
    }
    return same;
}

/* Number of runs whose blocks fit into one. */
static int plant_room(const struct model *m)
{
    int most = 1;
    for (int n = 0; n < m->blocks; n++) {
        most = m->block[n].lanes > most ? m->block[n].lanes : most;
    }
    return PLANT_WIDEST / most;
}

static void plant_run_set(const struct plant_set *set, int64_t t0, int64_t t1)
{
    const int64_t h = set->f[0]->s.m.step_ns;
    if (set->runs == 1 || t1 / h * h <= t0) {
        for (int r = 0; r < set->runs; r++) {
            *set->failed[r] = plant_run(set->f[r], t0, t1) != 0;
        }
        return;
    }
    for (int n = 0; n < set->f[0]->s.m.blocks; n++) {
        plant_run_row(set, n, t0, t1);
    }
}

static void model_together(void *const *part, int runs, int64_t t0, int64_t t1, bool *failed)
{
    bool left[FMU_PART_RUNS];
    for (int r = 0; r < runs; r++) {
        failed[r] = failed[r] || plant_ready(part[r], t0, t1) != 0;
        left[r] = !failed[r];
    }
    for (int first = 0; first < runs; first++) {
        if (!left[first]) {
            continue;
        }
        struct plant_set set = { .runs = 0 };
        const struct model *m = &((const struct fmu *)part[first])->s.m;
        const int room = plant_has_avx2() ? plant_room(m) : 1;
        for (int r = first; r < runs && set.runs < room; r++) {
            struct fmu *f = part[r];
            if (left[r] && plant_alike(m, &f->s.m)) {
                left[r] = false;
                set.f[set.runs] = f;
                set.failed[set.runs++] = &failed[r];
            }
        }
        plant_run_set(&set, t0, t1);
    }
}

#define MODEL_TOGETHER model_together

#endif
