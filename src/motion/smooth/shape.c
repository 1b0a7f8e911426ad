#include "shape.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "el_extremes.h"
#include "shape_corner.h"
#include "shape_turn.h"
#include "shape_whole.h"

/* Commands longer than so many tolerances keep their geometry: 3 mm at 0.02 mm. */
static const double LONG = 150.0;

/* A shorter way is rounding and counts as none. [mm] */
static const double NONE = 1e-9;

/* A window is fitted once it has so many closest spacings of knots, or so many vertices. */
static const double WINDOW = 128.0;
enum { WINDOW_VERTICES = 600, ROOM = 2 * SHAPE_SPANS + 8 };

/* A window with so many spans has no room for more; one of so few vertices is not halved. */
enum { FULL = SHAPE_SPANS - 2, FEWEST = 60 };

void shape_start(struct shape *s, double merge)
{
    memset(s, 0, offsetof(struct shape, run));
    s->merge = merge;
}

/* The n oldest commands without a place get it: they begin at u. */
static void settle(struct shape *s, int32_t n, double u)
{
    for (; n > 0; n--) {
        s->mark[s->marks_set++ % SHAPE_MARKS].at = u;
    }
}

static void settle_loose(struct shape *s)
{
    settle(s, s->marks_loose, s->u);
    s->marks_loose = 0;
}

/* The long command that waited becomes a segment, up to a length; a corner before it is rounded. */
static void push_whole(struct shape *s, double to)
{
    if (to < s->whole.length) {
        shape_cut(&s->whole, 0.0, to);
    }
    shape_push(s, &s->whole);
    s->exact = false;
    if (s->corner) {
        shape_corner_round(s, s->whole_tolerance);
    }
}

static struct shape_vertex *push_vertex(struct shape *s, const double point[AXES], double length,
                                        double tolerance)
{
    struct shape_run *r = &s->run;
    struct shape_vertex *v = &r->vertex[r->vertices];

    memset(v, 0, sizeof *v);
    memcpy(v->point, point, sizeof v->point);
    v->s = r->vertices > 0 ? v[-1].s + length : 0.0;
    v->tolerance = tolerance;
    v->law = s->law;
    r->vertices++;
    return v;
}

static void push_chords(struct shape *s, const struct path *p, double from, double to,
                        double tolerance)
{
    const int32_t n = shape_chords(p, to - from, tolerance);
    if (n == 1 && to >= p->length && !p->arc && !p->cubic) { /* a short line */
        push_vertex(s, p->end, to - from, tolerance)->joint = true;
        return;
    }
    const double step = (to - from) / n;
    const double left = p->arc || p->cubic ? (1.0 - SHAPE_SAGITTA) * tolerance : tolerance;
    double at[AXES], slope[AXES];

    for (int32_t k = 1; k <= n; k++) {
        path_at(p, k == n ? to : from + k * step, at, slope);
        push_vertex(s, at, step, left);
    }
    s->run.vertex[s->run.vertices - 1].joint = true;
}

/* A run begins at the end of the segments, or on the long command before it. */
static void open_run(struct shape *s, const double start[AXES], double tolerance)
{
    struct shape_run *r = &s->run;

    s->running = true;
    s->looked = 0;
    s->grabbed = 0;
    s->closing = SHAPE_OPEN;
    r->vertices = r->spans = 0;
    r->placed = 1;
    r->begun = false;
    r->bound = s->exact;
    if (!s->exact) {
        settle_loose(s);
        push_vertex(s, start, 0.0, tolerance)->u = s->u;
        return;
    }
    const double at = s->whole.length - shape_grab(&s->whole, s->whole_tolerance);
    const struct path path = shape_whole_path(&s->whole);
    const double offset = s->whole.kind == SEGMENT_LINE ? 0.0 : s->whole.from;
    const struct shape_law newest = s->law;
    s->law = (struct shape_law){ s->whole.feed, s->whole.cap, s->whole.ramp };
    segment_at(&s->whole, at, &r->begin);
    push_vertex(s, r->begin.point, 0.0, tolerance)->u = s->u + at;
    push_chords(s, &path, offset + at, offset + s->whole.length, s->whole_tolerance);
    s->law = newest;
    s->grabbed = r->vertices - 1;
    r->vertex[s->grabbed].marks = s->marks_loose;
    s->marks_loose = 0;
}

/* Whether there is no room for the chords of another command. */
static bool full(const struct shape_run *r)
{
    return r->vertices + 3 * SHAPE_CHORDS > SHAPE_VERTICES;
}

/* The first n spans of the fit become segments. */
static void commit(struct shape *s, int32_t n)
{
    struct shape_run *r = &s->run;
    int32_t vertex = 0;
    struct segment p;

    if (s->grabbed > 0) {
        push_whole(s, r->vertex[0].u - s->u);
        s->cut_from = s->made;
        s->grabbed = 0;
    }
    for (int32_t k = 0; k < n; k++) {
        shape_run_segment(r, k, &vertex, &p);
        shape_push(s, &p);
    }
    if (s->corner) {
        shape_corner_round(s, 0.0);
    }
    s->u = r->knot[n + 3];
}

/* The first n vertices are gone, so the numbers of others change. */
static void forget(struct shape *s, int32_t n)
{
    s->looked = s->looked > n ? s->looked - n : 0;
    s->next_vertex -= n;
}

/* The run goes on behind a vertex, which is a corner or the end of what it was. */
static void restart(struct shape *s, int32_t v)
{
    struct shape_run *r = &s->run;

    for (int32_t k = 1; k <= v; k++) {
        settle(s, r->vertex[k].marks, r->vertex[k].u);
    }
    r->vertices -= v;
    memmove(r->vertex, r->vertex + v, (size_t)r->vertices * sizeof r->vertex[0]);
    for (int32_t k = 0; k < r->vertices; k++) {
        r->vertex[k].weight = 0.0;
    }
    r->vertex[0].u = s->u;
    r->vertex[0].marks = 0;
    r->placed = 1;
    r->begun = r->bound = false;
    forget(s, v);
    s->looked = 0;
    if (s->closing == SHAPE_BY_LONG && s->next_vertex == 0) {
        s->exact = true;
        s->whole = s->next;
        s->whole_tolerance = s->next_tolerance;
        s->running = false;
    } else if (r->vertices == 1 && s->closing != SHAPE_OPEN) {
        s->running = false;
        if (s->closing == SHAPE_BY_LONG) {
            s->exact = true;
            s->whole = s->next;
            s->whole_tolerance = s->next_tolerance;
            shape_cut(&s->whole, s->next_from, s->whole.length);
        }
    }
}

/* The first chord becomes a segment by itself, a line. */
static void push_chord(struct shape *s)
{
    const struct shape_vertex *v = s->run.vertex;
    struct segment p = shape_blank(&v[1].law);
    struct path path;
    double at[AXES];

    path_line(&path, v[0].point, v[1].point);
    if (path.length > 0.0) {
        p.kind = SEGMENT_LINE;
        p.length = path.length;
        path_at(&path, 0.0, at, p.slope);
        memcpy(p.start, path.start, sizeof p.start);
        shape_push(s, &p);
        if (s->corner) {
            shape_corner_round(s, v[1].tolerance);
        }
        s->run.vertex[1].u = s->u;
        shape_corner_begin(s, 1, v[1].tolerance);
    }
    restart(s, 1);
}

/* No spline from where the run begins: it begins with a corner instead. */
static void begin_again(struct shape *s)
{
    struct shape_run *r = &s->run;

    if (s->grabbed > 0) {
        const int32_t v = s->grabbed;
        s->grabbed = 0;
        push_whole(s, s->whole.length);
        shape_corner_begin(s, -1, s->whole_tolerance);
        r->vertex[v].u = s->u;
        restart(s, v);
        return;
    }
    /* it begins where the segments end, near a chord */
    double way = 0.0, along = 0.0, off = 0.0;
    struct segment_state at;
    struct shape_vertex *v = r->vertex;
    const struct segment *p = shape_made(s, s->made - 1);
    segment_at(p, p->length, &at);
    for (int i = 0; i < AXES; i++) {
        way += (v[1].point[i] - v[0].point[i]) * (v[1].point[i] - v[0].point[i]);
        along += (v[1].point[i] - v[0].point[i]) * (at.point[i] - v[0].point[i]);
    }
    const double t = way > 0.0 ? el_min(1.0, el_max(0.0, along / way)) : 0.0;
    for (int i = 0; i < AXES; i++) {
        const double d = at.point[i] - v[0].point[i] - t * (v[1].point[i] - v[0].point[i]);
        off += d * d;
    }
    v[0].u = s->u;
    shape_corner_begin(s, 0, v[0].tolerance);
    s->tail_points = 0;
    memcpy(v[0].point, at.point, sizeof v[0].point);
    v[0].s = v[1].s - shape_distance(v[0].point, v[1].point);
    v[1].tolerance -= sqrt(off);
    restart(s, 0);
}

/* The fit of 0 .. end fails: near where it is farthest out there is a corner, where the run turns
 * most. */
static void break_up(struct shape *s, int32_t end, int32_t worst)
{
    const int32_t near = worst < end ? worst : end - 1;

    if (end == 1) {
        if (s->run.begun || s->run.bound) {
            begin_again(s);
        } else {
            push_chord(s);
        }
        return;
    }
    s->run.vertex[shape_turn_most(&s->run, near, end)].corner = true;
    shape_run_afresh(&s->run);
    s->looked = 0;
}

/* Fit a window of the run, and make segments of its first part. */
static void pass_window(struct shape *s, int32_t end)
{
    struct shape_run *r = &s->run;
    int32_t bad = shape_run_fit(r, end, false, NULL);

    while (bad >= 0 && r->spans >= FULL && end > FEWEST) { /* a shorter one has room */
        shape_run_afresh(r);
        end /= 2;
        bad = shape_run_fit(r, end, false, NULL);
    }
    if (bad >= 0) {
        break_up(s, end, bad);
        return;
    }
    const int32_t n = r->proved;
    commit(s, n);
    for (int32_t k = 1; k < r->vertices && r->vertex[k].u <= r->knot[n + 3]; k++) {
        settle(s, r->vertex[k].marks, r->vertex[k].u);
        r->vertex[k].marks = 0;
    }
    forget(s, shape_run_drop(r, n));
}

/* Fit the run, or its part before a corner, up to a vertex, and make segments of it. */
static void finish(struct shape *s, int32_t end, bool stop)
{
    struct shape_run *r = &s->run;
    struct segment_state at;

    if (end == 1 && !r->begun && !r->bound && !stop) {
        push_chord(s);
        return;
    }
    if (stop) {
        segment_at(&s->next, s->next_from, &at);
    }
    const int32_t bad = shape_run_fit(r, end, true, stop ? &at : NULL);
    if (bad == -2) {
        pass_window(s, end);
        return;
    }
    if (bad >= 0) {
        break_up(s, end, bad);
        return;
    }
    commit(s, r->spans);
    if (stop) {
        s->cut_from = s->made;
    } else {
        shape_corner_begin(s, end, 0.0);
    }
    restart(s, end);
}

/* Make all segments that can be made now. */
static void pump(struct shape *s)
{
    struct shape_run *r = &s->run;

    while (s->running && s->made - s->gone + ROOM <= SHAPE_SEGMENTS) {
        const bool open = s->closing == SHAPE_OPEN;
        const int32_t corner = shape_turn_next(r, &s->looked, open && !full(r), open);
        const double reach = r->vertex[s->looked].s - r->vertex[0].s;
        if (corner > 0) {
            finish(s, corner, false);
        } else if (s->closing != SHAPE_OPEN) {
            finish(s, r->vertices - 1, s->closing == SHAPE_BY_LONG);
        } else if (reach > WINDOW * shape_spacing(r->vertex[s->looked].tolerance)
                   || s->looked > WINDOW_VERTICES) {
            pass_window(s, s->looked);
        } else {
            return;
        }
    }
    if (s->ended && !s->running && s->made - s->gone + 2 <= SHAPE_SEGMENTS) {
        if (s->exact) {
            push_whole(s, s->whole.length);
        }
        settle_loose(s);
        s->corner = false;
        s->cut_from = s->made + SHAPE_HELD; /* all are finished */
        if (s->made > s->gone) {
            shape_made(s, s->made - 1)->rest = true;
        }
    }
}

static bool room(const struct shape *s)
{
    return s->made - s->gone + ROOM <= SHAPE_SEGMENTS && s->marks - s->marks_gone < SHAPE_MARKS
           && (!s->running || (s->closing == SHAPE_OPEN && !full(&s->run)));
}

static void push_mark(struct shape *s, const struct command *c)
{
    struct shape_mark *m = &s->mark[s->marks++ % SHAPE_MARKS];

    *m = (struct shape_mark){ 0.0, c->index, c->line, c->set, c->clear, c->analog, { 0.0F } };
    for (int i = 0; i < AXES; i++) {
        m->end[i] = (float)c->path.end[i];
    }
    s->marks_loose++;
}

static void take_long(struct shape *s, const struct path *path, double tolerance)
{
    const struct segment p = shape_whole(path, &s->law);

    if (s->running) {
        struct shape_run *r = &s->run;
        s->next = p;
        s->next_tolerance = tolerance;
        s->next_from = shape_grab(&p, tolerance);
        s->next_vertex = r->vertices - 1;
        s->closing = SHAPE_BY_LONG;
        r->vertex[s->next_vertex].marks += s->marks_loose;
        s->marks_loose = 0;
        push_chords(s, path, 0.0, s->next_from, tolerance);
        r->vertex[r->vertices - 1].joint = false;
        pump(s);
        return;
    }
    if (s->exact) {
        push_whole(s, s->whole.length);
        shape_corner_begin(s, -1, s->whole_tolerance);
    }
    settle_loose(s);
    s->exact = true;
    s->whole = p;
    s->whole_tolerance = tolerance;
}

/* CCN 16: a command may be refused, wait for room, be taken whole, or begin or go on a run. */
enum shape_status shape_take(struct shape *s, const struct command *c)
{
    const double merge = s->merge < c->tolerance ? s->merge : c->tolerance;
    struct path path;

    if (s->ended || !command_blends(c) || !(c->tolerance > 0.0)
        || (s->started && shape_distance(s->end, c->path.start) > 1e-6)) {
        return SHAPE_OTHER;
    }
    pump(s);
    if (!room(s)) {
        return SHAPE_FULL;
    }
    if (!s->started) {
        memcpy(s->end, c->path.start, sizeof s->end);
        s->started = true;
    }
    push_mark(s, c);
    path = c->path;
    if (!path.arc && !path.cubic && memcmp(path.start, s->end, sizeof path.start) != 0) {
        path_line(&path, s->end, c->path.end);
    }
    if (path.length <= NONE) {
        return SHAPE_TAKEN;
    }
    s->law = (struct shape_law){ c->feed, c->cap, c->ramp };
    if (!(path.length < LONG * merge && shape_chords(&path, path.length, merge) > 0)) {
        take_long(s, &path, c->tolerance);
    } else {
        if (!s->running) {
            open_run(s, s->end, merge);
        } else {
            s->run.vertex[s->run.vertices - 1].marks += s->marks_loose;
            s->marks_loose = 0;
        }
        push_chords(s, &path, 0.0, path.length, merge);
    }
    memcpy(s->end, path.end, sizeof s->end);
    pump(s);
    return SHAPE_TAKEN;
}

void shape_end(struct shape *s)
{
    s->ended = true;
    if (s->running && s->closing == SHAPE_OPEN) {
        s->closing = SHAPE_BY_END;
    }
    pump(s);
}

void shape_drop(struct shape *s, int32_t n)
{
    s->gone += n;
    pump(s);
}
