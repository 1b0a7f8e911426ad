/* FMU that records traces: row k has the inputs at k * period. Rows are kept in memory and written
 * to files if the run ends well. */
#include <math.h>

#include "trace_file.h"
#include "vars.h"

struct model {
    int64_t period; /* [ns] */
};

#define MODEL_BLOB
#include "fmi_model.h"
#include "fmu_output.h"

enum {
    GROUP = 6,      /* channels of an axes_ input */
    TRIPLE = 3,     /* channels of a triple_ input */
    QUAD = 4,       /* channels of a quad_ input */
    REAL_AXES = 60, /* channels before real_1 */
    INT_AXES = 54,  /* channels before int_1 */
    FIRST = 1024    /* rows of the first buffer; it doubles when full */
};

/* Recorded rows. A restored FMU state may be from before or after the last of them. */
struct rows {
    double *real;  /* rows x real_columns */
    int32_t *ints; /* rows x int_columns */
    int64_t room;  /* number of rows for which there is memory */
    int64_t held;  /* number of rows recorded */
};

enum { FILES = 3 };

/* The files, in the order in which they are written; the last one only if `csv` is true. */
static const struct {
    const char *ending;
    bool (*write)(FILE *file, const struct trace *t);
} files[FILES] = {
    { ".real.npy", trace_write_real },
    { ".int.npy", trace_write_int },
    { ".csv", trace_write_csv },
};

/* The channels of one type follow one another in struct vars, as the files' columns do. */
#define AT(name) offsetof(struct vars, name)
_Static_assert(AT(real_1) == AT(axes_real_1) + REAL_AXES * sizeof(double), "real channels");
_Static_assert(AT(real_4) == AT(real_1) + 3 * sizeof(double), "real channels");
_Static_assert(AT(triple_real_6) == AT(triple_real_1) + 5 * TRIPLE * sizeof(double), "triples");
_Static_assert(AT(quad_real_3) == AT(quad_real_1) + 2 * QUAD * sizeof(double), "quads");
_Static_assert(AT(int_1) == AT(axes_int_1) + INT_AXES * sizeof(int32_t), "integer channels");
_Static_assert(AT(int_10) == AT(int_1) + 9 * sizeof(int32_t), "integer channels");

static size_t real_columns(const struct vars *v)
{
    return (size_t)(GROUP * v->axes_real_used + v->real_used + TRIPLE * v->triple_real_used
                    + QUAD * v->quad_real_used);
}

static size_t int_columns(const struct vars *v)
{
    return (size_t)(GROUP * v->axes_int_used + v->int_used);
}

static bool recording(const struct vars *v)
{
    return v->file[0] != '\0';
}

/* Path of a trace file. */
static struct fmu_path path_of(const struct fmu *f, int file)
{
    struct fmu_path p = fmu_path(f, f->s.v.file, FMU_WRITTEN);
    if (p.good) {
        const size_t n = strlen(p.text);
        snprintf(p.text + n, sizeof p.text - n, "%s", files[file].ending);
    }
    return p;
}

/* Number of files that this run writes. */
static int files_of(const struct vars *v)
{
    return v->csv ? FILES : FILES - 1;
}

static int cannot_write(struct fmu *f, int file, const char *why)
{
    return fmu_fail(f, "cannot write %s%s: %s", f->s.v.file, files[file].ending, why);
}

/* Check before the run, not after it, that the files can be written. */
static int model_open(struct fmu *f)
{
    if (!recording(&f->s.v)) {
        return 0;
    }
    for (int k = 0; k < files_of(&f->s.v); k++) {
        const struct fmu_path path = path_of(f, k);
        const char *why = path.good ? output_try(path.text, NULL, 0) : path.text;
        if (why) {
            return cannot_write(f, k, why);
        }
    }
    f->blob = calloc(1, sizeof(struct rows));
    return f->blob ? 0 : fmu_fail(f, "no memory for the recording");
}

static void model_close(struct fmu *f)
{
    struct rows *r = f->blob;
    if (r) {
        free(r->real);
        free(r->ints);
        free(r);
    }
}

static int model_start(struct fmu *f)
{
    const double tick_tolerance = 1e-6; /* [ticks] a period in decimals is not exact as a double */
    double ticks = f->s.v.period * 1e9 / FMU_TICK_NS;
    double whole = floor(ticks + 0.5);
    if (!(fabs(ticks - whole) <= tick_tolerance && whole < 1e15)) {
        return fmu_fail(f, "period = %.15g s is not a whole number of %d ns", f->s.v.period,
                        FMU_TICK_NS);
    }
    f->s.m.period = (int64_t)whole * FMU_TICK_NS;
    return 0;
}

static int make_room(struct fmu *f, struct rows *r, int64_t rows)
{
    if (rows <= r->room) {
        return 0;
    }
    int64_t room = r->room ? 2 * r->room : FIRST;
    while (room < rows) {
        room *= 2;
    }
    /* One byte more, so that NULL always means no memory, also without columns. */
    double *real = realloc(r->real, (size_t)room * real_columns(&f->s.v) * sizeof *real + 1);
    r->real = real ? real : r->real;
    int32_t *ints = realloc(r->ints, (size_t)room * int_columns(&f->s.v) * sizeof *ints + 1);
    r->ints = ints ? ints : r->ints;
    if (!real || !ints) {
        return fmu_fail(f, "no memory for row %" PRId64 " of %s", rows, f->s.v.file);
    }
    r->room = room;
    return 0;
}

/* Fill rows that are not known, because a restored state is of another instance. */
static void fill_gap(const struct vars *v, struct rows *r, int64_t end)
{
    size_t nr = real_columns(v), ni = int_columns(v);
    for (; r->held < end; r->held++) {
        for (size_t i = 0; i < nr; i++) {
            r->real[(size_t)r->held * nr + i] = NAN;
        }
        memset(r->ints + (size_t)r->held * ni, 0, ni * sizeof *r->ints);
    }
}

/* Copy `count` channels; returns the place for the next ones. */
static double *put(double *to, const char *from, int32_t count)
{
    memcpy(to, from, (size_t)count * sizeof *to);
    return to + count;
}

static int record(struct fmu *f, struct rows *r)
{
    const struct vars *v = &f->s.v;
    int64_t k = v->rows;
    if (k == INT32_MAX) {
        return fmu_fail(f, "%s holds no more than %" PRId64 " rows", v->file, k);
    }
    if (make_room(f, r, k + 1) != 0) {
        return -1;
    }
    fill_gap(v, r, k);
    size_t nr = real_columns(v), ni = int_columns(v);
    size_t ni_axes = (size_t)(GROUP * v->axes_int_used);
    double *real = r->real + (size_t)k * nr;
    int32_t *ints = r->ints + (size_t)k * ni;
    const char *in = (const char *)v;
    real = put(real, in + AT(axes_real_1), GROUP * v->axes_real_used);
    real = put(real, in + AT(real_1), v->real_used);
    real = put(real, in + AT(triple_real_1), TRIPLE * v->triple_real_used);
    put(real, in + AT(quad_real_1), QUAD * v->quad_real_used);
    memcpy(ints, in + AT(axes_int_1), ni_axes * sizeof *ints);
    memcpy(ints + ni_axes, in + AT(int_1), (ni - ni_axes) * sizeof *ints);
    r->held = k + 1;
    f->s.v.rows = (int32_t)(k + 1);
    return 0;
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    (void)t0; /* every row before it is recorded */
    if (recording(&f->s.v)) {
        while (f->s.v.rows * f->s.m.period < t1) {
            if (record(f, f->blob) != 0) {
                return -1;
            }
        }
    }
    return 0;
}

/* Write one file in full under its temporary name. */
static const char *write_part(struct fmu *f, int k, const struct trace *t, struct output *o)
{
    const struct fmu_path path = path_of(f, k);
    const char *why = output_check(path.text, NULL, 0);
    why = why ? why : output_begin(o, path.text);
    if (why) {
        return why;
    }
    errno = 0;
    const bool good = files[k].write(o->file, t);
    return output_end(o, good);
}

/* Either all files appear, or none with one message; then older files stay. */
static int model_end(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct rows *r = f->blob;
    if (!recording(v)) {
        return 0;
    }
    if (make_room(f, r, (int64_t)v->rows + 1) != 0) { /* buffers exist even without a row */
        return -1;
    }
    fill_gap(v, r, v->rows);
    struct trace t = { r->real, r->ints, v->rows, real_columns(v), int_columns(v), f->s.m.period };
    struct output out[FILES] = { 0 };
    const int n = files_of(v);
    const char *why = NULL;
    int begun = 0, bad = 0;
    for (; begun < n && !why; begun++) {
        bad = begun;
        why = write_part(f, begun, &t, &out[begun]);
    }
    why = why ? why : output_show(out, n, &bad);
    if (!why) {
        return 0;
    }
    output_drop(out, begun);
    return cannot_write(f, bad, why);
}
