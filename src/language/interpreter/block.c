#include "block.h"

#include <math.h>
#include <string.h>

#include "cutter.h"
#include "el_extremes.h"
#include "feed.h"
#include "frame.h"
#include "spline.h"

static const char CENTRE_LETTERS[] = "IJK";
static const int TURNS_MAX = 10000; /* highest P of an arc */

/* Tolerance of the end of an arc whose start, end and centre a postprocessor has rounded to 0.01
 * mm, or with COARSER to 0.001 inch; LinuxCNC allows as much. */
static const struct path_tolerance POSTED = { 0.0283, 1e-3 };
static const double COARSER = 2.54; /* 0.001 inch over 0.01 mm */

struct kept_line block_line(const struct interpreter *in, const struct block *b,
                            const struct fault_report *r)
{
    return (struct kept_line){ .offset = r->offset,
                               .file = in->file,
                               .line = in->line,
                               .at = b->tokens.at,
                               .length = b->tokens.length };
}

enum fault block_at_line(const struct interpreter *in, const struct kept_line *l, enum fault f,
                         struct fault_report *r)
{
    r->line = l->line;
    r->offset = l->offset;
    memcpy(r->file, flow_file(in, l->file), FAULT_FILE);
    return fault_at(r, f, l->at, l->length);
}

struct command *block_command(struct interpreter *in)
{
    struct command *c = &in->made[in->count];
    memset(c, 0, sizeof *c);
    c->line = flow_line_shown(in);
    return c;
}

/* Count a command that is a motion of the program; outputs that wait for one go with it. */
static void accept(struct interpreter *in, struct command *c)
{
    c->set = in->set;
    c->clear = in->clear;
    in->set = in->clear = 0;
    c->analog = in->analog;
    in->analog.set = 0;
    memcpy(in->point, c->path.end, sizeof in->point);
    in->count++;
}

/* The fault of an arc that is refused. */
static enum fault of_path(enum path_status s)
{
    return s == PATH_NO_RADIUS      ? FAULT_ARC_RADIUS
           : s == PATH_MISSES_END   ? FAULT_ARC_END
           : s == PATH_SHORT_RADIUS ? FAULT_ARC_CHORD
           : s == PATH_OPEN         ? FAULT_ARC_CLOSED
                                    : FAULT_NONE;
}

enum fault block_refusal(enum command_status s, const struct command_refusal *why,
                         struct fault_report *r)
{
    if (s == COMMAND_FAST || s == COMMAND_OUTSIDE) {
        r->axis = why->joint;
        r->value = why->value;
        r->limit = why->limit;
        r->feed = s == COMMAND_FAST ? why->feed * 60.0 : 0.0;
    }
    return s == COMMAND_FAST      ? FAULT_SPEED
           : s == COMMAND_FAR     ? FAULT_RANGE
           : s == COMMAND_OUTSIDE ? FAULT_TRAVEL
                                  : FAULT_NONE;
}

enum command_status block_move(struct command *c, const struct program *p, enum command_type type,
                               double feed, struct command_refusal *why, struct fault_report *r)
{
    const enum command_status s = command_move(c, &p->machine, &p->limits, type, feed, why);

    if (s != COMMAND_FAST || p->strict_feed) {
        return s;
    }
    fault_note_limit(r, FAULT_NOTE_FEED, r->at, r->length, feed * 60.0, why->feed * 60.0);
    return command_move(c, &p->machine, &p->limits, type, why->feed, why);
}

enum fault block_complete(struct command *c, const struct program *p, struct fault_report *r)
{
    struct command_refusal why;
    enum command_status s = COMMAND_OK;

    if (c->type == COMMAND_PTP) {
        s = command_ptp(c, &p->machine, &p->limits, &why);
    } else if (command_lasts(c) && c->type != COMMAND_DELAY) {
        s = block_move(c, p, c->path.arc ? command_arc_type(&c->path) : COMMAND_LINE, c->feed, &why,
                       r);
    }
    return block_refusal(s, &why, r);
}

/* What the frame in force makes of an arc of the program. */
struct shape {
    double ratio; /* factor of the radius */
    bool ccw;
    struct path_tolerance tolerance;
};

/* Centre of an arc along the plane's axes, machine coordinates [mm], from R or two of I J K. */
static enum fault arc_centre(const struct interpreter *in, const struct block *b,
                             const struct shape *shape, const double end[AXES], double centre[2],
                             struct fault_report *r)
{
    const int axis[2] = { path_first(in->plane), path_second(in->plane) };
    const struct token *radius = gcode_word(&b->g, 'R');
    const char letters[3] = { CENTRE_LETTERS[axis[0]], CENTRE_LETTERS[axis[1]] };
    const struct token *any = gcode_first(&b->g, letters);
    const struct token *normal = gcode_word(&b->g, CENTRE_LETTERS[in->plane]);

    if (normal && normal->value != 0.0) { /* postprocessors write K0 in XY */
        return tokens_at_word(r, FAULT_UNUSED, normal);
    }
    if (radius && any) {
        return tokens_at_line(r, FAULT_CENTRE_AND_R, &b->tokens);
    }
    if (radius) {
        const double size = radius->value * b->scale * shape->ratio;
        r->value = fabs(size);
        const enum path_status s =
            path_centre_by_radius(in->plane, in->point, end, size, shape->ccw,
                                  shape->tolerance.least, centre, &r->limit);
        return tokens_at_line(r, of_path(s), &b->tokens);
    }
    double place[AXES], way[3] = { 0.0, 0.0, 0.0 };
    frame_program(in, in->point, place);
    for (int i = 0; i < 2; i++) {
        const struct token *w = gcode_word(&b->g, CENTRE_LETTERS[axis[i]]);
        if (!any || (in->absolute_centre && !w)) {
            return tokens_at_line(r, FAULT_NO_CENTRE, &b->tokens);
        }
        place[axis[i]] = way[axis[i]] = w ? w->value * b->scale : 0.0;
    }
    frame_machine(in, place, place);
    frame_way(in, way);
    for (int i = 0; i < 2; i++) {
        centre[i] = in->absolute_centre ? place[axis[i]] : in->point[axis[i]] + way[axis[i]];
    }
    return FAULT_NONE;
}

static enum fault arc(const struct interpreter *in, const struct program *p, const struct block *b,
                      const double end[AXES], struct path *path, struct fault_report *r)
{
    const struct token *turns = gcode_word(&b->g, 'P');
    struct shape shape = { .tolerance = p->arc.least > 0.0 ? p->arc : POSTED };
    double centre[2];
    bool mirrored;

    if (!p->machine.axis[path_first(in->plane)] || !p->machine.axis[path_second(in->plane)]) {
        return tokens_at_line(r, FAULT_AXIS, &b->tokens);
    }
    if (turns
        && (turns->value < 1.0 || turns->value > TURNS_MAX
            || turns->value != round(turns->value))) {
        return tokens_at_word(r, FAULT_VALUE, turns);
    }
    if (!frame_circles(in, in->plane, &shape.ratio, &mirrored)) {
        return tokens_at_line(r, FAULT_OVAL, &b->tokens);
    }
    shape.ccw = (in->motion == 30) != mirrored;
    shape.tolerance.least *= (in->inch ? COARSER : 1.0) * shape.ratio;
    enum fault f = arc_centre(in, b, &shape, end, centre, r);
    if (f == FAULT_NONE) {
        f = of_path(path_arc_within(path, in->plane, in->point, end, centre, shape.ccw,
                                    turns ? (int)turns->value : 1, &shape.tolerance, &r->value));
        tokens_at_line(r, f, &b->tokens);
    }
    return f;
}

/* CCN 16: a straight line, an arc and a spline differ at each of the steps that they share. */
enum fault block_motion(struct interpreter *in, const struct program *p, const struct block *b,
                        struct fault_report *r)
{
    struct command *c = block_command(in);
    double end[AXES];
    enum fault f = frame_end(in, p, b, end, r);

    if (f == FAULT_NONE && gcode_arc(in->motion)) {
        f = arc(in, p, b, end, &c->path, r);
    } else if (f == FAULT_NONE && gcode_spline(in->motion)) {
        f = spline_path(in, p, b, end, &c->path, r);
    } else if (f == FAULT_NONE) {
        path_line(&c->path, in->point, end);
    }
    in->words.spline = in->words.spline && in->motion == 50;
    if (f != FAULT_NONE || c->path.length == 0.0) {
        return f;
    }
    double feed = 0.0;
    if (in->motion != 0) {
        f = feed_of(in, p, b, c->path.length, false, &feed, r);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    c->blend = in->blend;
    c->tolerance = in->tolerance;
    c->merge = in->merge;
    c->curve = in->tolerance > 0.0;
    if (cutter_on(in)) { /* a motion of the contour, not of the tool's centre */
        c->type = in->motion == 0 ? COMMAND_PTP : COMMAND_LINE;
        c->feed = feed;
        accept(in, c);
        return FAULT_NONE;
    }
    struct command_refusal why;
    enum command_status s;
    if (in->motion == 0) {
        s = command_ptp(c, &p->machine, &p->limits, &why);
    } else {
        const enum command_type type = c->path.arc     ? command_arc_type(&c->path)
                                       : c->path.cubic ? COMMAND_CUBIC
                                                       : COMMAND_LINE;
        tokens_at_line(r, FAULT_NONE, &b->tokens);
        s = block_move(c, p, type, feed, &why, r);
    }
    accept(in, c);
    return tokens_at_line(r, block_refusal(s, &why, r), &b->tokens);
}

enum fault block_straight(struct interpreter *in, const struct program *p, const double end[AXES],
                          double feed, bool exact, struct fault_report *r)
{
    struct command *c = block_command(in);

    path_line(&c->path, in->point, end);
    in->words.spline = false;
    if (c->path.length == 0.0) {
        return FAULT_NONE;
    }
    struct command_refusal why;
    const enum command_status s =
        feed == 0.0 ? command_ptp(c, &p->machine, &p->limits, &why)
        : exact     ? command_move(c, &p->machine, &p->limits, COMMAND_LINE, feed, &why)
                    : block_move(c, p, COMMAND_LINE, feed, &why, r);
    accept(in, c);
    return block_refusal(s, &why, r);
}

enum fault block_curve(struct interpreter *in, const struct program *p, const double end[AXES],
                       const double inner[2][3], double feed, double joined, struct fault_report *r)
{
    struct command *c = block_command(in);
    struct command_refusal why;

    if (!inner) {
        path_line(&c->path, in->point, end);
    } else if (path_cubic(&c->path, in->point, end, inner) != PATH_OK) {
        return FAULT_CUSP;
    }
    if (c->path.length == 0.0) {
        return FAULT_NONE;
    }
    c->tolerance = el_max(in->tolerance, joined);
    c->merge = el_max(in->merge, joined);
    c->blend = c->curve = true;
    const enum command_type type = c->path.cubic ? COMMAND_CUBIC : COMMAND_LINE;
    const enum command_status s = block_move(c, p, type, feed, &why, r);
    accept(in, c);
    return block_refusal(s, &why, r);
}

static enum fault rapid(struct interpreter *in, const struct program *p, const struct block *b,
                        const double end[AXES], struct fault_report *r)
{
    return tokens_at_line(r, block_straight(in, p, end, 0.0, false, r), &b->tokens);
}

enum fault block_home(struct interpreter *in, const struct program *p, const struct block *b,
                      struct fault_report *r)
{
    const bool all = !gcode_first(&b->g, BLOCK_AXES) && !b->g.idle;
    double via[AXES], home[AXES];
    const double *park = in->words.park[b->g.code[GCODE_NONMODAL] == 300];
    enum fault f = frame_end(in, p, b, via, r);

    for (int i = 0; i < AXES; i++) {
        const bool goes = all ? p->machine.axis[i] : gcode_word(&b->g, BLOCK_AXES[i]) != NULL;
        home[i] = goes ? park[i] : via[i];
    }
    if (f == FAULT_NONE) {
        f = rapid(in, p, b, via, r);
    }
    return f != FAULT_NONE ? f : rapid(in, p, b, home, r);
}

bool block_moves(const struct block *b)
{
    const int code = b->g.code[GCODE_MOTION];

    return gcode_first(&b->g, BLOCK_AXES "@^") || (code != GCODE_ABSENT && code != GCODE_NO_MOTION);
}

double block_seconds(const struct program *p, const struct token *w)
{
    const bool scaled = p->least_increment > 0.0 && w->letter != 'P';
    return !p->fanuc || !w->whole ? w->value
                                  : w->value / (scaled ? p->least_increment : 1.0) / 1000.0;
}

enum fault block_dwell(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r)
{
    const struct token *wait = gcode_word(&b->g, 'P'), *extra = NULL;

    if (!wait && p->fanuc) {
        wait = gcode_first(&b->g, "XU");
        for (const char *c = BLOCK_AXES; *c && !extra; c++) {
            extra = gcode_word(&b->g, *c) != wait ? gcode_word(&b->g, *c) : NULL;
        }
    }
    if (!block_moves(b)) {
        extra = extra ? extra : gcode_first(&b->g, "IJKR");
    }
    if (extra) {
        return tokens_at_word(r, FAULT_UNUSED, extra);
    }
    if (!wait) {
        return tokens_at_line(r, FAULT_NO_DWELL, &b->tokens);
    }
    const double seconds = block_seconds(p, wait);
    if (seconds < 0.0 || seconds > BLOCK_DWELL_MAX) {
        return tokens_at_word(r, FAULT_VALUE, wait);
    }
    command_delay(block_command(in), in->point, seconds);
    in->count++;
    return FAULT_NONE;
}
