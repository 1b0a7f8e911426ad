/* fmi_dummy - a small model for the tests of the FMI layer, with the tables that the generator
 * would write. y integrates gain * u; the first letter of `name` chooses which function fails. */
#ifndef FMI_DUMMY_H
#define FMI_DUMMY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "fmi_vars.h"

#define FMU_NAME       "Dummy"
#define FMU_TOKEN      "{dummy}"
#define FMU_VERSION    "1.0"
#define FMU_TICK_NS    25
#define FMU_STRING_MAX 64
#define FMU_STRICT     strict_step
#define FMU_NVARS      9
#define FMU_NREFS      13

struct vars {
    char name[FMU_STRING_MAX];
    double gain;
    double trim;
    double u[3];
    int32_t n;
    bool on[2];
    double y[2];
    int32_t steps;
    bool strict_step;
};

enum {
    REF_NAME,
    REF_GAIN,
    REF_TRIM,
    REF_U,
    REF_N = 6,
    REF_ON,
    REF_Y = 9,
    REF_STEPS = 11,
    REF_STRICT
};

static const struct vars vars_start = { .name = "good", .gain = 2.0, .u = { 1.0, 2.0, 3.0 } };

static const struct var_info var_table[FMU_NVARS] = {
    { "name", 0, 1, offsetof(struct vars, name), VAR_STRING, CAUSE_PARAMETER, VARY_FIXED, -DBL_MAX,
      DBL_MAX, false },
    { "gain", 1, 1, offsetof(struct vars, gain), VAR_F64, CAUSE_PARAMETER, VARY_FIXED, 0.0, 100.0,
      false },
    { "trim", 2, 1, offsetof(struct vars, trim), VAR_F64, CAUSE_PARAMETER, VARY_TUNABLE, -DBL_MAX,
      DBL_MAX, false },
    { "u", 3, 3, offsetof(struct vars, u), VAR_F64, CAUSE_INPUT, VARY_DISCRETE, -DBL_MAX, DBL_MAX,
      false },
    { "n", 6, 1, offsetof(struct vars, n), VAR_I32, CAUSE_INPUT, VARY_DISCRETE, -5, 5, false },
    { "on", 7, 2, offsetof(struct vars, on), VAR_BOOL, CAUSE_INPUT, VARY_DISCRETE, -DBL_MAX,
      DBL_MAX, false },
    { "y", 9, 2, offsetof(struct vars, y), VAR_F64, CAUSE_OUTPUT, VARY_CONTINUOUS, -DBL_MAX,
      DBL_MAX, false },
    { "steps", 11, 1, offsetof(struct vars, steps), VAR_I32, CAUSE_LOCAL, VARY_DISCRETE, -DBL_MAX,
      DBL_MAX, false },
    { "strict_step", 12, 1, offsetof(struct vars, strict_step), VAR_BOOL, CAUSE_PARAMETER,
      VARY_FIXED, -DBL_MAX, DBL_MAX, true },
};

static const uint16_t var_of_ref[FMU_NREFS] = { 0, 1, 2, 3, 3, 3, 4, 5, 5, 6, 6, 7, 8 };

enum { KEPT = 100 };

struct model {
    double sum[2];
    int32_t at;
    int32_t first, used; /* of `kept`, a ring: what is not in use holds nothing that is read */
    double kept[KEPT];
};

#define MODEL_BLOB
#define MODEL_IN_USE FMU_RING(kept, first, used, 0)
#include "fmi_model.h"

static int blobs_open; /* number of blobs open in the whole test; must be 0 at its end */
static int opens;      /* number of calls of model_open */

static int model_open(struct fmu *f)
{
    opens++;
    blobs_open++;
    f->blob = calloc(1, FMU_STRING_MAX);
    return f->s.v.name[0] == 'o' ? fmu_fail(f, "name = %s does not open 100%%", f->s.v.name) : 0;
}

static void model_close(struct fmu *f)
{
    free(f->blob);
    blobs_open--;
}

static int model_end(struct fmu *f)
{
    return f->s.v.name[0] == 'e' ? fmu_fail(f, "name = %s does not end", f->s.v.name) : 0;
}

static int model_start(struct fmu *f)
{
    static const struct model cleared;
    if (memcmp(&f->s.m, &cleared, sizeof cleared) != 0) {
        return fmu_fail(f, "the memory of the model was not cleared");
    }
    if (f->s.v.name[0] == 's') {
        return fmu_fail(f, "name = %s does not start", f->s.v.name);
    }
    f->s.v.y[0] = f->s.v.gain * f->s.v.u[0];
    f->s.v.y[1] += 1.0; /* 1 only if it was cleared */
    f->s.m.sum[0] = f->s.v.y[0];
    fmu_event(f, "started with gain %g", f->s.v.gain);
    fmu_warn(f, "resources in \"%s\"", fmu_resources(f));
    return 0;
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    if (f->s.v.u[0] == 66.0) {
        return fmu_fail(f, "u = 66 does not step");
    }
    f->s.m.sum[f->s.m.at] += f->s.v.gain * f->s.v.u[0] * (double)(t1 - t0);
    f->s.v.y[0] = f->s.m.sum[0] + f->s.v.trim;
    f->s.v.steps++;
    return 0;
}

#endif
