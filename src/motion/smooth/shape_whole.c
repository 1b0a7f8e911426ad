#include "shape_whole.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "elementary.h"

/* A run takes at most this part of a long command, and so many tolerances. */
static const double SHARE = 1.0 / 3.0, GRAB = 60.0;

enum { HALVINGS = 60 };

struct segment shape_blank(const struct shape_law *l)
{
    return (struct segment){ .feed = l->feed, .cap = l->cap, .ramp = l->ramp };
}

struct segment shape_whole(const struct path *path, const struct shape_law *law)
{
    struct segment p = shape_blank(law);
    double at[AXES];

    p.length = path->length;
    if (path->arc || path->cubic) {
        p.kind = path->arc ? SEGMENT_ARC : SEGMENT_CUBIC;
        p.path = *path;
        return p;
    }
    p.kind = SEGMENT_LINE;
    path_at(path, 0.0, at, p.slope);
    memcpy(p.start, path->start, sizeof p.start);
    return p;
}

struct path shape_whole_path(const struct segment *p)
{
    struct path path;
    double end[AXES];

    if (p->kind != SEGMENT_LINE) {
        return p->path;
    }
    for (int i = 0; i < AXES; i++) {
        end[i] = p->start[i] + p->slope[i] * p->length;
    }
    path_line(&path, p->start, end);
    return path;
}

static double arc_bend(const struct path *p)
{
    const double per = p->sweep / p->length, r = fabs(p->radius) + fabs(p->growth);
    return fabs(per) * el_hypot(per * r, 2.0 * p->growth / p->length);
}

int32_t shape_chords(const struct path *p, double length, double tolerance)
{
    if (!p->arc && !p->cubic && length <= shape_spacing(tolerance)) {
        return 1;
    }
    double n = ceil(length / shape_spacing(tolerance));

    if (p->arc || p->cubic) {
        const double bend = p->arc ? arc_bend(p) : p->bezier.bend;
        n = el_max(n, ceil(length / sqrt(8.0 * SHAPE_SAGITTA * tolerance / bend)));
    }
    return n <= SHAPE_CHORDS ? (int32_t)el_max(1.0, n) : 0;
}

double shape_grab(const struct segment *p, double tolerance)
{
    const struct path path = shape_whole_path(p);
    double way = el_min(SHARE * p->length, GRAB * tolerance);

    for (int k = 0; k < HALVINGS && shape_chords(&path, way, tolerance) == 0; k++) {
        way *= 0.5;
    }
    return way;
}
