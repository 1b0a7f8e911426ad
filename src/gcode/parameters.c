#include "parameters.h"

#include <string.h>

#include "frame.h"
#include "modes.h"
#include "offsets.h"
#include "tools.h"
#include "waiting.h"

/* A coordinate of the nine X Y Z A B C U V W, from 0, in the units in force. */
static double coordinate(const struct interpreter *in, const struct program *p, int32_t letter,
                         const double of[AXES])
{
    const int axis = offsets_axis(p->angles, letter);
    const double unit = in->inch && !(p->angles && axis >= 3) ? 25.4 : 1.0;
    return axis < 0 ? 0.0 : of[axis] / unit;
}

/* Numbers with a meaning, a row each; false if it has none. */
static bool machine_value(const struct interpreter *in, const struct program *p, int32_t n,
                          double *value)
{
    double point[AXES];

    if (n >= 5021 && n <= 5029) {       /* where the axes stand, of the machine */
        *value = coordinate(in, p, n - 5021, in->point);
    } else if (n >= 5420 && n <= 5428) {        /* of the program */
        frame_program(in, in->point, point);
        *value = coordinate(in, p, n - 5420, point);
    } else {
        return offsets_parameter(in, p->angles, n, value) ||
               tools_parameter(in, p->angles, n, value) ||
               waiting_parameter(in, p->angles, n, value);
    }
    return true;
}

/* What only a name says, a row each. */
static bool named_value(const struct interpreter *in, const char *name, double *value)
{
    const struct { char name[PARAMETERS_NAME]; double value; } rows[] = {
        { "_value", in->flow.value },           { "_value_returned", in->flow.returned },
        { "_call_level", in->flow.level },      { "_line", in->line },
        { "_metric", !in->inch },               { "_imperial", in->inch },
        { "_absolute", !in->incremental },      { "_incremental", in->incremental },
    };

    for (int i = 0; i < (int)(sizeof rows / sizeof *rows); i++) {
        if (memcmp(rows[i].name, name, PARAMETERS_NAME) == 0) {
            *value = rows[i].value;
            return true;
        }
    }
    return false;
}

/* Names of one letter for the coordinates: _x is #5420. */
static int32_t number_of(const char *name)
{
    static const char letters[] = "xyzabcuvw";
    const char *const at = name[0] == '_' && name[1] && !name[2] ? strchr(letters, name[1]) : NULL;
    return at ? 5420 + (int32_t)(at - letters) : 0;
}

/* Its place among the names in force, or their count. */
static int32_t find(const struct interpreter *in, const char *name)
{
    const struct parameters *all = &in->parameters;
    const int32_t level = name[0] == '_' ? -1 : in->flow.level;
    int32_t i = 0;

    while (i < all->names && (all->named[i].level != level ||
                              memcmp(all->named[i].name, name, PARAMETERS_NAME) != 0)) {
        i++;
    }
    return i;
}

enum fault parameters_get(const struct interpreter *in, const struct program *p,
                          const struct parameter *which, double *value)
{
    const struct parameters *all = &in->parameters;

    if (which->number >= 1 && which->number <= PARAMETERS_NUMBERED) {
        *value = all->value[which->number - 1];
        return FAULT_NONE;
    }
    if (which->number) {
        return machine_value(in, p, which->number, value) ? FAULT_NONE : FAULT_PARAMETER;
    }
    const int32_t i = find(in, which->name);
    if (i < all->names) {
        *value = all->named[i].value;
        return FAULT_NONE;
    }
    return named_value(in, which->name, value) ||
                   machine_value(in, p, number_of(which->name), value) ? FAULT_NONE : FAULT_UNSET;
}

enum fault parameters_set(struct interpreter *in, const struct program *p,
                          const struct parameter *which, double value)
{
    struct parameters *all = &in->parameters;
    double now;

    if (which->number >= 1 && which->number <= PARAMETERS_NUMBERED) {
        all->value[which->number - 1] = value;
        return FAULT_NONE;
    }
    if (which->number) {
        return machine_value(in, p, which->number, &now) ? FAULT_FIXED : FAULT_PARAMETER;
    }
    if (named_value(in, which->name, &now) ||
        machine_value(in, p, number_of(which->name), &now)) {
        return FAULT_FIXED;
    }
    const int32_t i = find(in, which->name);
    if (i == PARAMETERS_NAMED) {
        return FAULT_NAMES;
    }
    if (i == all->names) {
        memcpy(all->named[i].name, which->name, PARAMETERS_NAME);
        all->named[i].level = which->name[0] == '_' ? -1 : in->flow.level;
        all->names++;
    }
    all->named[i].value = value;
    return FAULT_NONE;
}

void parameters_leave(struct parameters *all, int32_t level)
{
    int32_t kept = 0;

    for (int32_t i = 0; i < all->names; i++) {
        if (all->named[i].level != level) {
            all->named[kept++] = all->named[i];
        }
    }
    memset(all->named + kept, 0, sizeof *all->named * (size_t)(all->names - kept));
    all->names = kept;
}
