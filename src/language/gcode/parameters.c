#include "parameters.h"

#include <string.h>

#include "frame.h"
#include "modes.h"
#include "offsets.h"
#include "tools.h"
#include "waiting.h"

_Static_assert(PARAMETERS_PAGE == 64, "a bit of a word for each number");

/* Coordinate of a letter, of X Y Z A B C U V W from 0, in the program's units; 0: no such axis. */
static double coordinate(const struct interpreter *in, const struct program *p, int32_t letter,
                         const double of[AXES])
{
    const int axis = offsets_axis(p->angles, letter);
    const double unit = in->inch && !(p->angles && axis >= 3) ? 25.4 : 1.0;
    return axis < 0 ? 0.0 : of[axis] / unit;
}

/* Value of a number above 5000; false: it has no meaning.
 * CCN 16: each number, or range of numbers, is a row of the language's table. */
static bool machine_value(const struct interpreter *in, const struct program *p, int32_t n,
                          double *value)
{
    double point[AXES];

    frame_here(in, point);
    if (n >= 5021 && n <= 5029) { /* where the axes stand, machine coordinates */
        *value = coordinate(in, p, n - 5021, point);
    } else if (p->fanuc && ((n >= 5001 && n <= 5006) || (n >= 5041 && n <= 5046))) {
        frame_program(in, point, point); /* the axes in their order */
        *value = point[(n - 1) % 20] / (in->inch && !(p->angles && (n - 1) % 20 >= 3) ? 25.4 : 1.0);
    } else if (n == 5599) { /* whether (DEBUG, ) comments get a note */
        *value = in->parameters.debug;
    } else if (n >= 5420 && n <= 5428) { /* where the axes stand, program coordinates */
        frame_program(in, point, point);
        *value = coordinate(in, p, n - 5420, point);
    } else {
        return offsets_parameter(in, p, n, value) || tools_parameter(in, p->angles, n, value)
               || waiting_parameter(in, p->angles, n, value);
    }
    return true;
}

/* Number of the coordinate that a name _x .. _w or _abs_x .. _abs_w has; 0: it is no such name. */
static int32_t number_of(const char *name)
{
    static const char LETTERS[] = "xyzabcuvw";
    const bool machine = memcmp(name, "_abs_", 5) == 0;
    const char *letter = name + (machine ? 5 : 1);
    const char *at = name[0] == '_' && *letter && !letter[1] ? strchr(LETTERS, *letter) : NULL;
    return at ? (machine ? 5021 : 5420) + (int32_t)(at - LETTERS) : 0;
}

/* Pocket of a tool; 0: the table does not have the tool. */
static int32_t pocket_of(const struct interpreter *in, int32_t number)
{
    struct tool tool;
    return number > 0 && tool_table_find(&in->tools.table, number, &tool) ? tool.pocket : 0;
}

/* F in the program's units per minute or turn; 0 with G93, where it counts for its block alone. */
static double feed_of_program(const struct interpreter *in)
{
    const double unit = in->inch ? 25.4 : 1.0;
    const int mode = in->words.feed_mode;
    return mode == 950 ? in->words.per_turn / unit : mode == 940 ? in->feed * 60.0 / unit : 0.0;
}

/* Values that only have a name, as LinuxCNC gives it, in the order of its modal groups. */
#define NAMES(X) \
    X(_line, in->line) \
    X(_task, 1) \
    X(_value, in->flow.value) \
    X(_value_returned, in->flow.returned) \
    X(_call_level, in->flow.level) \
    X(_motion_mode, in->motion) \
    X(_plane, in->plane == PATH_XY ? 170 : in->plane == PATH_ZX ? 180 : 190) \
    X(_ccomp, in->cutter.side == 0 ? 400 : in->cutter.side > 0 ? 410 : 420) \
    X(_metric, !in->inch) \
    X(_imperial, in->inch) \
    X(_absolute, !in->incremental) \
    X(_incremental, in->incremental) \
    X(_inverse_time, in->words.feed_mode == 930) \
    X(_units_per_minute, in->words.feed_mode == 940) \
    X(_units_per_rev, in->words.feed_mode == 950) \
    X(_coord_system, in->system < 6                     ? 540 + 10 * in->system \
                     : in->system < INTERPRETER_SYSTEMS ? 585 + in->system \
                                                        : 541) \
    X(_tool_offset, tools_any_length(in)) \
    X(_retract_r_plane, in->cycle.to_r) \
    X(_retract_old_z, !in->cycle.to_r) \
    X(_spindle_rpm_mode, !in->switches.by_radius) \
    X(_spindle_css_mode, in->switches.by_radius) \
    X(_ijk_absolute_mode, in->absolute_centre) \
    X(_spindle_on, in->switches.turning != 0) \
    X(_spindle_cw, in->switches.turning > 0) \
    X(_mist, (in->switches.coolant & OUTPUTS_MIST) != 0) \
    X(_flood, (in->switches.coolant & OUTPUTS_FLOOD) != 0) \
    X(_speed_override, !(in->switches.overrides & OUTPUTS_SPEED_FIXED)) \
    X(_feed_override, !(in->switches.overrides & OUTPUTS_FEED_FIXED)) \
    X(_adaptive_feed, (in->switches.overrides & OUTPUTS_ADAPTIVE) != 0) \
    X(_feed_hold, !(in->switches.overrides & OUTPUTS_HOLD_OFF)) \
    X(_feed, feed_of_program(in)) \
    X(_rpm, in->switches.speed) \
    X(_current_tool, in->tools.loaded) \
    X(_current_pocket, pocket_of(in, in->tools.loaded)) \
    X(_selected_tool, in->tools.chosen ? in->tools.next : -1) \
    X(_selected_pocket, in->tools.chosen ? pocket_of(in, in->tools.next) : -1) \
    X(_lathe_diameter_mode, 0) \
    X(_lathe_radius_mode, 0) \
    X(_remap_level, 0) \
    X(_vmajor, 2.9) \
    X(_vminor, 0)

/* Whether a name is that of a pin or a setting of LinuxCNC. */
static bool foreign(const char *name)
{
    return memcmp(name, "_hal[", 5) == 0 || memcmp(name, "_ini[", 5) == 0;
}

/* Whether a number from 1 to PARAMETERS_NUMBERED has been set. */
static bool given(const struct parameters *all, int32_t number)
{
    const uint32_t i = (uint32_t)(number - 1);
    return all->given[i / PARAMETERS_PAGE] >> i % PARAMETERS_PAGE & 1;
}

static bool named_value(const struct interpreter *in, const char *name, double *value)
{
#define NAME(word, is) #word,
#define VALUE(word, is) \
    case VALUE_##word: *value = is; break;
#define NUMBER(word, is) VALUE_##word,
    static const char ALL[][PARAMETERS_NAME] = { NAMES(NAME) };
    enum { NAMES(NUMBER) COUNT };
    int i = 0;

    while (i < COUNT && memcmp(ALL[i], name, PARAMETERS_NAME) != 0) {
        i++;
    }
    switch (i) {
        NAMES(VALUE)
    default: return false;
    }
    return true;
}

/* Index of a name among those that are set, for the call that runs; their count: it is not set. */
static int32_t find(const struct interpreter *in, const char *name)
{
    const struct parameters *all = &in->parameters;
    const int32_t level = name[0] == '_' ? -1 : in->flow.level;
    int32_t i = 0;

    while (i < all->names
           && (all->named[i].level != level
               || memcmp(all->named[i].name, name, PARAMETERS_NAME) != 0)) {
        i++;
    }
    return i;
}

enum fault parameters_get(const struct interpreter *in, const struct program *p,
                          const struct parameter *which, double *value)
{
    const struct parameters *all = &in->parameters;

    if (which->number >= 1 && which->number <= PARAMETERS_NUMBERED) {
        *value = given(all, which->number) ? all->value[which->number - 1] : p->fanuc ? NAN : 0.0;
        return FAULT_NONE;
    }
    if (which->number == PARAMETERS_ZERO) {
        *value = NAN;
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
    return named_value(in, which->name, value)
                   || machine_value(in, p, number_of(which->name), value)
               ? FAULT_NONE
           : foreign(which->name) ? FAULT_FOREIGN
                                  : FAULT_UNSET;
}

enum fault parameters_set(struct interpreter *in, const struct program *p,
                          const struct parameter *which, double value)
{
    struct parameters *all = &in->parameters;
    double now;

    if (which->number >= 1 && which->number <= PARAMETERS_NUMBERED) {
        const uint32_t i = (uint32_t)(which->number - 1);
        const uint64_t bit = UINT64_C(1) << i % PARAMETERS_PAGE;
        uint64_t *const page = &all->given[i / PARAMETERS_PAGE];
        *page = parameters_vacant(value) ? *page & ~bit : *page | bit;
        all->value[i] = parameters_number(value);
        return FAULT_NONE;
    }
    value = parameters_number(value);
    if (which->number == PARAMETERS_ZERO) {
        return FAULT_FIXED;
    }
    if (which->number == 5599) {
        all->debug = value;
        return FAULT_NONE;
    }
    if (which->number) {
        return waiting_set(in, p->angles, which->number, value) ? FAULT_NONE
               : machine_value(in, p, which->number, &now)      ? FAULT_FIXED
                                                                : FAULT_PARAMETER;
    }
    if (named_value(in, which->name, &now) || machine_value(in, p, number_of(which->name), &now)) {
        return FAULT_FIXED;
    }
    if (foreign(which->name)) {
        return FAULT_FOREIGN;
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
