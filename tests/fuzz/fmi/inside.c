/* The FMU itself as FMI 3.0, so that its static names can be seen. */
#include "fmi3/fmu_main.c"

#include "holds.h"
#include "inside.h"

/* An input takes as long as its states are large; a plant with more branches than are tried in
 * every combination takes long at each start. */
#ifdef PLANT_H
enum { SLOW = PLANT_BRANCHES > 8 };
#else
enum { SLOW = 0 };
#endif
const int fuzz_count = sizeof(struct fmi_snapshot) < 1 << 15 && !SLOW ? 1000
                       : sizeof(struct fmi_snapshot) < 1 << 20        ? 150
                                                                      : 25;

_Static_assert((int)SIDE_REAL == (int)VAR_F64 && (int)SIDE_INTEGER == (int)VAR_I32
                   && (int)SIDE_BOOLEAN == (int)VAR_BOOL && (int)SIDE_STRING == (int)VAR_STRING,
               "one numbering of types");

size_t inside_count(void)
{
    return FMU_NVARS;
}

struct inside_variable inside_variable(size_t i)
{
    const struct var_info *v = &var_table[i];
    const bool input = v->causality == CAUSE_INPUT;
    const bool parameter = v->causality == CAUSE_PARAMETER;
    return (struct inside_variable){ v->ref,
                                     v->count,
                                     v->type,
                                     input || parameter,
                                     input || (parameter && v->variability == VARY_TUNABLE),
                                     v->min,
                                     v->max };
}

union side_value inside_start(size_t i, size_t k)
{
    const struct var_info *v = &var_table[i];
    const char *at = (const char *)&vars_start + v->offset + k * fmi_size_here(v->type);
    switch (v->type) {
    case VAR_F64:  return (union side_value){ .real = *(const double *)at };
    case VAR_I32:  return (union side_value){ .integer = *(const int32_t *)at };
    case VAR_BOOL: return (union side_value){ .boolean = *(const bool *)at };
    default:       return (union side_value){ .string = at };
    }
}

const char *inside_token(void)
{
    return FMU_TOKEN;
}

int inside_tick(void)
{
    return FMU_TICK_NS;
}

int inside_string_max(void)
{
    return FMU_STRING_MAX;
}

bool inside_strict(const void *c)
{
    return ((const struct fmi_instance *)c)->f.s.v.FMU_STRICT;
}

size_t inside_most(void)
{
    return sizeof(struct fmi_snapshot) + FMU_SPANS * sizeof(struct fmu_span);
}

size_t inside_size(const char *state)
{
    uint64_t size;
    memcpy(&size, state + offsetof(struct fmi_snapshot, size), sizeof size);
    return size;
}

bool inside_alike(const char *a, const char *b)
{
    const size_t hash = offsetof(struct fmi_snapshot, hash), behind = hash + sizeof(uint64_t);
    const size_t model = offsetof(struct fmi_snapshot, s.m);
    return memcmp(a, b, hash) == 0 && memcmp(a + behind, b + behind, model - behind) == 0;
}
