/* binding_gcode - part programs for Python: their commands, faults and notes, and the time that a
 * machine needs for them. */
#include <string.h>

#include "binding.h"
#include "binding_text.h"
#include "interpreter.h"
#include "trajectory.h"
#include "waiting.h"

/* A program being read, and a machine for its cycle time. */
struct gcode_reader {
    struct binding_text text;
    struct source source;
    struct program program;
    struct interpreter in;
    double point[AXES], feed;                 /* [mm], [mm/s] at the start */
    double origin[INTERPRETER_SYSTEMS][AXES]; /* [mm] */
    struct tool_table tools;
    double period; /* [s] interpolation cycle */
    struct trajectory trajectory;
    struct ring ring;
    struct lookahead_mean mean;
    struct curve_plan curve;
    struct gcode_drive {
        int64_t commands, periods; /* of all that were given; that have passed */
        double left;               /* [s] of the period */
        bool amid;                 /* the last call stopped within a period */
    } drive;
};

#define OPTION_IN(m, name, unit, ...) ONE_IN(gcode_reader, m, name, unit, __VA_ARGS__)
#define OPTION(m, name, unit)         OPTION_IN(m, name, unit, SAME)
#define JOINTS(m, name, unit) \
    { name, \
      unit, \
      KIND(((struct gcode_reader *)0)->program.machine.joint[0].m), \
      OFFSET(gcode_reader, program.machine.joint[0].m), \
      AXES, \
      sizeof(struct joint), \
      SAME }
#define FLAT(type, m, name, unit) \
    { name,           unit, 'd', OFFSET(type, m), SIZE(type, m) / (int32_t)sizeof(double), \
      sizeof(double), SAME }
static const struct field reader_fields[] = {
    OPTION(program.block_delete, "block_delete", ""),
    OPTION(program.optional_stop, "optional_stop", ""),
    OPTION(program.angles, "angles", ""),
    OPTION(program.change_stops, "change_stops", ""),
    OPTION(program.fanuc, "fanuc", ""),
    OPTION(program.strict_feed, "strict_feed", ""),
    OPTION(program.least_increment, "least_increment", ""),
    OPTION(program.check_again, "check_again", "lines"),
    OPTION(program.arc.least, "arc_tolerance", "mm"),
    ROW(gcode_reader, program.machine.axis, "axes", ""),
    JOINTS(used, "used", ""),
    JOINTS(scale, "scale", "pulses/mm"),
    JOINTS(speed, "speed", "mm/s"),
    JOINTS(bounded, "bounded", ""),
    JOINTS(low, "low", "mm"),
    JOINTS(high, "high", "mm"),
    OPTION_IN(program.limits.feed, "max_feed", "mm/min", PER_MINUTE),
    OPTION(program.limits.rapid, "rapid", ""),
    OPTION(program.limits.up.acc, "acceleration", "mm/s^2"),
    OPTION(program.limits.down.acc, "deceleration", "mm/s^2"),
    OPTION(program.limits.up.jerk, "jerk", "mm/s^3"),
    OPTION(program.limits.down.jerk, "jerk_down", "mm/s^3"),
    OPTION(program.limits.up.time, "acc_time", "s"),
    OPTION(program.limits.down.time, "dec_time", "s"),
    OPTION(program.limits.up.share, "acc_share", ""),
    OPTION(program.limits.down.share, "dec_share", ""),
    OPTION(program.limits.smooth, "smooth", "s"),
    ROW(gcode_reader, curve.limits.speed, "axis_speed", "mm/s"),
    ROW(gcode_reader, curve.limits.acc, "axis_acc", "mm/s^2"),
    ROW(gcode_reader, curve.limits.jerk, "axis_jerk", "mm/s^3"),
    OPTION_IN(feed, "feed", "mm/min", PER_MINUTE),
    FLAT(gcode_reader, point, "point", "mm"),
    FLAT(gcode_reader, origin, "origin", "mm"),
    OPTION(period, "period", "s"),
    OPTION(in.line, "line", ""),
    OPTION(in.ended, "ended", ""),
};

#define SEEN(m, name, unit) ONE(command, m, name, unit)
static const struct field command_fields[] = {
    { "type", "", 'i', OFFSET(command, type), 1, sizeof(enum command_type), SAME },
    SEEN(line, "line", ""),
    SEEN(blend, "blend", ""),
    SEEN(tolerance, "tolerance", "mm"),
    SEEN(feed, "feed", "mm/s"),
    SEEN(dwell, "dwell", "s"),
    SEEN(set, "set", "bits"),
    SEEN(clear, "clear", "bits"),
    SEEN(spindle, "spindle", "rpm"),
    SEEN(coolant, "coolant", "bits"),
    SEEN(surface.speed, "surface", "mm/s"),
    SEEN(surface.centre, "surface_centre", "mm"),
    SEEN(overrides, "overrides", "bits"),
    SEEN(tool, "tool", ""),
    SEEN(changes, "changes", ""),
    SEEN(analog.set, "analog_set", "bits"),
    FLAT(command, analog.value, "analog", ""),
    SEEN(probes, "probes", ""),
    SEEN(path.arc, "arc", ""),
    SEEN(path.cubic, "cubic", ""),
    FLAT(command, path.bezier.inner, "inner", "mm"),
    { "plane", "", 'i', OFFSET(command, path.plane), 1, sizeof(enum path_plane), SAME },
    ROW(command, path.start, "start", "mm"),
    ROW(command, path.end, "end", "mm"),
    ROW(command, path.centre, "centre", "mm"),
    SEEN(path.radius, "radius", "mm"),
    SEEN(path.growth, "growth", "mm"),
    SEEN(path.angle, "angle", "rad"),
    SEEN(path.sweep, "sweep", "rad"),
    SEEN(path.length, "length", "mm"),
};
_Static_assert(sizeof(enum command_type) == sizeof(int32_t)
                   && sizeof(enum path_plane) == sizeof(int32_t),
               "an enum is read as an int32");

const struct table GCODE_TABLES[] = {
    { "gcode_reader", reader_fields, sizeof reader_fields, sizeof(struct gcode_reader) },
    { "gcode_command", command_fields, sizeof command_fields, sizeof(struct command) },
    { NULL, NULL, 0, 0 },
};

static const double PULSES_PER_MM = 1000.0; /* for the range of positions only */

/* Defaults: six axes without travel limits, fast enough for any program. */
void binding_gcode_defaults(struct gcode_reader *g)
{
    memset(g, 0, sizeof *g);
    for (int i = 0; i < AXES; i++) {
        g->program.machine.axis[i] = true;
        g->program.machine.joint[i] =
            (struct joint){ .used = true, .scale = PULSES_PER_MM, .speed = 500.0 };
    }
    g->program.limits = (struct motion_limits){
        .feed = 500.0, .rapid = 1.0, .up = { .acc = 1000.0 }, .down = { .acc = 1000.0 }
    };
    g->program.optional_stop = g->program.change_stops = true;
    g->program.has_inputs = g->program.has_probe = true;
    g->program.check_again = CHECK_AGAIN;
    g->feed = 10.0;
    g->period = 1e-3;
}

/* Add a line of a tool table. Returns NULL, or what is wrong with the text at *at. */
const char *binding_gcode_tool(struct gcode_reader *g, const char *text, int32_t length,
                               struct tool_text *at)
{
    return tool_table_line(&g->tools, text, length, g->program.angles, at);
}

/* Begin to read a text. It and the texts of files that it calls must stay in memory meanwhile. */
void binding_gcode_begin(struct gcode_reader *g, const char *text, int64_t length,
                         binding_file file)
{
    for (int i = 0; i < AXES; i++) {
        g->program.machine.joint[i].acc = g->curve.limits.acc[i];
        g->program.machine.joint[i].jerk = g->curve.limits.jerk[i];
    }
    g->text = binding_text_of(text, length, file);
    g->source = binding_source(&g->text);
    g->program.source = &g->source;
    interpreter_start(&g->in, g->point, g->feed, (const double(*)[AXES])g->origin);
    g->in.tools.table = g->tools;
}

/* Read the next commands, at most `room`; *result is the enum interpreter_result of the last one.
 * Waits for the machine are skipped; an endless program ends where a check of it ends. */
int64_t binding_gcode_read(struct gcode_reader *g, struct command *c, int64_t room, int32_t *result,
                           struct fault_report *r)
{
    int64_t count = 0;

    *result = INTERPRETER_COMMAND;
    while (count < room) {
        if (g->in.flow.again > g->program.check_again) {
            *result = INTERPRETER_END;
            break;
        }
        *result = (int32_t)interpreter_next(&g->in, &g->program, &c[count], r);
        if (*result == INTERPRETER_WAIT) {
            waiting_pass(&g->in);
        } else if (*result == INTERPRETER_COMMAND) {
            count++;
        } else {
            break;
        }
    }
    return count;
}

_Static_assert(FAULT_LIST + FAULT_NOTES <= BINDING_REPORTS, "they fit");

void binding_reports(const struct fault_list *all, struct fault_report *r, int32_t count[3])
{
    memcpy(r, all->of, (size_t)all->count * sizeof *r);
    memcpy(r + all->count, all->note, (size_t)all->notes * sizeof *r);
    count[0] = all->count;
    count[1] = all->notes;
    count[2] = all->more;
}

/* Faults and notes of the program, of which nothing has been read yet. */
void binding_gcode_check(struct gcode_reader *g, struct fault_report *r, int32_t count[3])
{
    struct fault_list all;

    interpreter_check_all(&g->in, &g->program, &all);
    binding_reports(&all, r, count);
}

/* Stand before the first command, as binding_gcode_time begins. */
void binding_gcode_stand(struct gcode_reader *g)
{
    memset(&g->drive, 0, sizeof g->drive);
    ring_clear(&g->ring);
    memset(&g->mean, 0, sizeof g->mean);
    trajectory_start(&g->trajectory);
    trajectory_stand(&g->trajectory, &g->program.machine, g->point);
    g->trajectory.override[0] = g->trajectory.override[1] = 1.0;
}

/* Commands of one call, and how many of them have been taken. */
struct gcode_block {
    struct command *c;
    int64_t count, taken;
    bool last; /* no others follow */
};

/* Move commands into the ring and number them. Returns whether it is as full as it can be. */
static bool fill(struct gcode_reader *g, struct gcode_block *b)
{
    for (; b->taken < b->count && !ring_full(&g->ring); b->taken++) {
        struct command *c = &b->c[b->taken];
        g->drive.commands++;
        c->index = command_lasts(c) ? (int32_t)g->drive.commands : 0;
        ring_push(&g->ring, c);
    }
    return b->last || ring_full(&g->ring);
}

/* Interpolate to the end of a period. Returns whether the commands reached so far. */
static bool drive_on(struct gcode_reader *g, struct gcode_block *b,
                     const struct trajectory_beside *beside)
{
    struct gcode_drive *d = &g->drive;

    if (!d->amid) {
        d->left = g->period;
    }
    do {
        if (!d->amid) {
            if (!fill(g, b)) {
                return false;
            }
            g->curve.last = b->last && b->taken == b->count;
            d->left = trajectory_advance(&g->trajectory, beside, d->left);
        }
        d->amid = true;
        if (!fill(g, b)) {
            return false;
        }
        d->amid = false;
    } while (d->left > 0.0 && !trajectory_resting(&g->trajectory, &g->ring));
    return true;
}

/* Interpolate commands as the machine would, with stops and waits skipped: all of a program, or
 * its next ones, of which the last call has one at least. `seconds` has a number for each command
 * of all calls, to which the time is added for which it was the latest one begun [s]. Unless NULL,
 * `places` gets the position at the end of each period from the first on [mm]. Returns the number
 * of periods. */
int64_t binding_gcode_time(struct gcode_reader *g, struct command *c, int64_t count, int32_t last,
                           double *seconds, double (*places)[AXES])
{
    const struct trajectory_beside beside = { &g->ring, &g->mean, &g->curve };
    struct gcode_block block = { c, count, 0, last != 0 };
    struct gcode_drive *d = &g->drive;

    while (drive_on(g, &block, &beside)) {
        struct point point;
        trajectory_point(&g->trajectory, &beside, &g->program.machine, g->period, &point);
        trajectory_accept(&g->trajectory, &beside, &point);
        if (places) {
            memcpy(places[d->periods], point.place, sizeof point.place);
        }
        d->periods++;
        if (g->trajectory.started > 0) {
            seconds[g->trajectory.started - 1] += g->period - d->left;
        }
        if (trajectory_waits(&g->trajectory, &g->ring)) {
            trajectory_continue(&g->trajectory);
        } else if (block.last && block.taken == count
                   && trajectory_resting(&g->trajectory, &g->ring)) {
            break;
        }
    }
    return d->periods;
}

/* Points on the paths of commands [mm]: for command i the points from[i] .. from[i + 1] - 1, evenly
 * spaced from its start to its end. */
void binding_gcode_points(const struct command *c, int64_t count, const int64_t *from,
                          double (*points)[AXES])
{
    for (int64_t i = 0; i < count; i++) {
        const int64_t n = from[i + 1] - from[i];
        for (int64_t k = 0; k < n; k++) {
            double slope[AXES];
            const double share = n > 1 ? (double)k / (double)(n - 1) : 1.0;
            path_at(&c[i].path, share * c[i].path.length, points[from[i] + k], slope);
        }
    }
}

/* Smallest and largest coordinates of the paths of commands [mm], exact. */
void binding_gcode_extents(const struct command *c, int64_t count, double (*low)[AXES],
                           double (*high)[AXES])
{
    for (int64_t k = 0; k < count; k++) {
        const struct path *p = &c[k].path;
        for (int i = 0; i < AXES; i++) {
            low[k][i] = p->start[i] < p->end[i] ? p->start[i] : p->end[i];
            high[k][i] = p->start[i] > p->end[i] ? p->start[i] : p->end[i];
            if (p->arc || p->cubic) {
                path_extent(p, i, 0.0, p->length, &low[k][i], &high[k][i]);
            }
        }
    }
}
