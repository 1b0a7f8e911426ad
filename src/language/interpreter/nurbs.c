#include "nurbs.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "block.h"
#include "el_extremes.h"
#include "feed.h"
#include "frame.h"

/* Distance [mm] between the curve and its cubics at most; and the tolerance [mm] within which these
 * are driven without a rest. */
static const double AWAY = 1e-4, JOINED = 1e-3;
static const double SHORTEST = 1.0 / 4096.0; /* of a span: made at any distance */

enum { PROBES = 5 }; /* number of places at which a segment is compared with the curve */

/* Knot j: 0 for the first `order` ones, then 1, 2, ...; beyond the curve's end that of the end. */
static double knot(const struct nurbs *n, int32_t j)
{
    const int32_t last = n->ended && j > n->count - 1 ? n->count : j;
    return last < n->order ? 0.0 : last - n->order + 1.0;
}

/* Point [mm] and its derivative by the parameter t, 0 .. 1 within a span, by de Boor's algorithm on
 * weighted points (w x, w y, w z, w). */
static void curve(const struct nurbs *n, int32_t span, double t, double point[3], double slope[3])
{
    const int32_t degree = n->order - 1;
    double d[NURBS_ORDER][4], rate[4] = { 0.0 };

    for (int32_t j = 0; j <= degree; j++) {
        const double *q = n->point[span - n->first + j];
        for (int k = 0; k < 4; k++) {
            d[j][k] = k < 3 ? q[k] * q[3] : q[3];
        }
    }
    for (int32_t row = 1; row <= degree; row++) {
        for (int k = 0; k < 4 && row == degree; k++) {
            rate[k] = degree * (d[degree][k] - d[degree - 1][k]);
        }
        for (int32_t j = degree; j >= row; j--) {
            const double low = knot(n, span + j), high = knot(n, span + j + n->order - row);
            const double share = (span + t - low) / (high - low);
            for (int k = 0; k < 4; k++) {
                d[j][k] = (1.0 - share) * d[j - 1][k] + share * d[j][k];
            }
        }
    }
    for (int k = 0; k < 3; k++) {
        point[k] = d[degree][k] / d[degree][3];
        slope[k] = (rate[k] - rate[3] * point[k]) / d[degree][3];
    }
}

/* The cubic from n->from to `to` in the span, 0 .. 1: its end and inner points; returns its largest
 * distance from the curve at PROBES places [mm]. */
static double segment(const struct nurbs *n, double to, double end[3], double inner[2][3])
{
    const double size = to - n->from;
    double begin[3], first[3], last[3], most = 0.0;

    curve(n, n->span, n->from, begin, first);
    curve(n, n->span, to, end, last);
    for (int k = 0; k < 3; k++) {
        inner[0][k] = begin[k] + first[k] * size / 3.0;
        inner[1][k] = end[k] - last[k] * size / 3.0;
    }
    for (int i = 1; i <= PROBES; i++) {
        const double t = i / (PROBES + 1.0), u = 1.0 - t;
        double there[3], slope[3], square = 0.0;
        curve(n, n->span, n->from + t * size, there, slope);
        for (int k = 0; k < 3; k++) {
            const double away = u * u * u * begin[k] + 3.0 * u * u * t * inner[0][k]
                                + 3.0 * u * t * t * inner[1][k] + t * t * t * end[k] - there[k];
            square += away * away;
        }
        most = el_max(most, sqrt(square));
    }
    return most;
}

/* Whether the inner points of a cubic lie within AWAY of its chord and between its ends, so that a
 * line can stand for it. */
static bool straight(const double begin[3], const double end[3], const double inner[2][3])
{
    double chord[3], length = 0.0;

    for (int k = 0; k < 3; k++) {
        chord[k] = end[k] - begin[k];
        length += chord[k] * chord[k];
    }
    for (int i = 0; i < 2 && length > 0.0; i++) {
        double along = 0.0, square = 0.0;
        for (int k = 0; k < 3; k++) {
            along += (inner[i][k] - begin[k]) * chord[k] / length;
            square += (inner[i][k] - begin[k]) * (inner[i][k] - begin[k]);
        }
        if (square - along * along * length > AWAY * AWAY || along < 0.0 || along > 1.0) {
            return false;
        }
    }
    return true;
}

/* Make the command of a segment from where the tool is; *to is halved towards n->from until it
 * fits. Where control points coincide, the derivative may be 0: a line is made there. */
static enum fault make(struct interpreter *in, const struct program *p, double *to,
                       struct fault_report *r)
{
    const struct nurbs *n = &in->nurbs;
    double end[AXES], inner[2][3];

    memcpy(end, in->point, sizeof end);
    for (;;) {
        const double away = segment(n, *to, end, inner);
        const bool shortest = *to - n->from <= SHORTEST;
        if (away <= AWAY || shortest) {
            const bool line = straight(in->point, end, (const double(*)[3])inner);
            const enum fault f = block_curve(in, p, end, line ? NULL : (const double(*)[3])inner,
                                             n->feed, JOINED, r);
            if (f != FAULT_CUSP || shortest) {
                return f;
            }
        }
        *to = 0.5 * (n->from + *to);
    }
}

static void next_span(struct nurbs *n)
{
    n->from = 0.0;
    n->span++;
    n->running = n->span < n->upto;
    if (!n->running && n->ended) {
        n->count = 0;
    }
}

void nurbs_skip(struct interpreter *in)
{
    struct nurbs *n = &in->nurbs;

    if (n->running) {
        n->span = n->upto - 1;
        next_span(n);
    }
}

enum fault nurbs_next(struct interpreter *in, const struct program *p, struct fault_report *r)
{
    struct nurbs *n = &in->nurbs;
    enum fault f = FAULT_NONE;

    block_at_line(in, &n->line, FAULT_NONE, r);
    while (n->running && in->count == 0 && f == FAULT_NONE) {
        double to = 1.0;
        f = make(in, p, &to, r);
        n->from = to;
        if (to == 1.0) {
            next_span(n);
        }
    }
    if (f != FAULT_NONE) {
        n->running = false;
        n->count = 0;
        return block_at_line(in, &n->line, f, r);
    }
    return f;
}

/* Keep a control point, and forget those on which no span to come depends. */
static void add(struct nurbs *n, const double point[AXES], double weight)
{
    if (n->span > n->first) {
        const int32_t gone = n->span - n->first;
        memmove(n->point, n->point + gone, (NURBS_WINDOW - (size_t)gone) * sizeof *n->point);
        n->first = n->span;
    }
    double *q = n->point[n->count++ - n->first];
    memcpy(q, point, 3 * sizeof *q);
    q[3] = weight;
}

/* Let those spans be made whose control points are all known. */
static void run(struct interpreter *in, const struct block *b, const struct fault_report *r)
{
    struct nurbs *n = &in->nurbs;

    n->upto = n->ended ? n->count - n->order + 1 : n->count - 2 * n->order + 3;
    n->running = n->span < n->upto;
    n->stop = b->g.code[GCODE_STOP];
    n->line = block_line(in, b, r);
}

static enum fault begin(struct interpreter *in, const struct block *b, double weight,
                        struct fault_report *r)
{
    struct nurbs *n = &in->nurbs;
    const struct token *l = gcode_word(&b->g, 'L');

    if (l && !(l->value >= 3.0 && l->value <= NURBS_ORDER && l->value == round(l->value))) {
        return tokens_at_word(r, FAULT_VALUE, l);
    }
    memset(n, 0, sizeof *n);
    n->order = l ? (int32_t)l->value : 3;
    n->plane = in->plane;
    add(n, in->point, weight);
    return FAULT_NONE;
}

/* Add the control point of a block; with G91 its words count from the control point before. */
static enum fault add_point(struct interpreter *in, const struct program *p, const struct block *b,
                            double weight, struct fault_report *r)
{
    struct nurbs *n = &in->nurbs;
    double here[AXES], end[AXES];

    memcpy(here, in->point, sizeof here);
    memcpy(in->point, n->point[n->count - 1 - n->first], 3 * sizeof *here);
    const enum fault f = frame_end(in, p, b, end, r);
    memcpy(in->point, here, sizeof here);
    if (f == FAULT_NONE) {
        add(n, end, weight);
    }
    return f;
}

static enum fault end_block(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    struct nurbs *n = &in->nurbs;
    const struct token *by = b->g.by[GCODE_MOTION];

    in->motion = GCODE_NO_MOTION;
    if (n->count == 0) {
        return tokens_at_word(r, FAULT_NURBS_NONE, by);
    }
    if (n->count < n->order) {
        n->count = 0;
        return tokens_at_word(r, FAULT_NURBS_FEW, by);
    }
    n->ended = true;
    run(in, b, r);
    return FAULT_NONE;
}

/* Check the words of a line of G5.2: it has both axes of the plane or neither, and P above 0. */
static enum fault words_of(const struct interpreter *in, const struct program *p,
                           const struct block *b, const struct token *other, struct fault_report *r)
{
    const struct token *weight = gcode_word(&b->g, 'P');
    const bool one = gcode_word(&b->g, "XYZ"[path_first(in->plane)]),
               two = gcode_word(&b->g, "XYZ"[path_second(in->plane)]);

    if (other || (weight && !(weight->value > 0.0))) {
        return tokens_at_word(r, other ? FAULT_UNUSED : FAULT_VALUE, other ? other : weight);
    }
    if (p->plain || in->words.feed_mode == 930) {
        return tokens_at_line(r, p->plain ? FAULT_PLAIN : FAULT_NURBS_FEED, &b->tokens);
    }
    if (one != two || (!one && in->nurbs.count > 0)) {
        return tokens_at_line(r, FAULT_NURBS_POINT, &b->tokens);
    }
    return FAULT_NONE;
}

/* A line of G5.2 whose words are right: the first one begins the curve, and its point is added. */
static enum fault take_line(struct interpreter *in, const struct program *p, const struct block *b,
                            struct fault_report *r)
{
    struct nurbs *n = &in->nurbs;
    const struct token *weight = gcode_word(&b->g, 'P');
    const bool point = gcode_word(&b->g, "XYZ"[path_first(in->plane)]);
    const double w = weight ? weight->value : 1.0;
    enum fault f = feed_of(in, p, b, 1.0, false, &n->feed, r);
    const double feed = n->feed;

    if (f == FAULT_NONE && n->count == 0) {
        f = begin(in, b, point ? 1.0 : w, r);
        n->feed = feed;
    } else if (f == FAULT_NONE && gcode_word(&b->g, 'L')) {
        f = tokens_at_word(r, FAULT_UNUSED, gcode_word(&b->g, 'L'));
    }
    if (f == FAULT_NONE && point) {
        f = add_point(in, p, b, w, r);
    }
    if (f == FAULT_NONE) {
        run(in, b, r);
    }
    return f;
}

enum fault nurbs_block(struct interpreter *in, const struct program *p, const struct block *b,
                       struct fault_report *r)
{
    struct nurbs *n = &in->nurbs;
    const struct token *other = gcode_first(&b->g, "UVW@^");
    const bool one = gcode_word(&b->g, "XYZ"[path_first(in->plane)]),
               two = gcode_word(&b->g, "XYZ"[path_second(in->plane)]);

    other = other ? other : gcode_word(&b->g, "XYZ"[in->plane]);
    if (b->g.code[GCODE_MOTION] == 53 && !one && !two && !other) {
        return end_block(in, b, r);
    }
    if (in->motion != 52 || (n->count > 0 && in->plane != n->plane)) {
        n->count = 0;
        return tokens_at_line(r, FAULT_NURBS, &b->tokens);
    }
    const enum fault f = words_of(in, p, b, other, r);
    return f == FAULT_NONE ? take_line(in, p, b, r) : f;
}

enum fault nurbs_between(struct interpreter *in, const struct block *b, struct fault_report *r)
{
    const int other = b->g.code[GCODE_NONMODAL], stop = b->g.code[GCODE_STOP];
    const bool home = other == 280 || other == 300;
    const bool over = b->g.code[GCODE_MOTION] != 53
                      && (stop == 20 || stop == 300 || (stop == 990 && in->flow.level == 0));

    if (in->nurbs.count == 0 || !(home || over)) {
        return FAULT_NONE;
    }
    in->nurbs.count = 0;
    return tokens_at_word(r, FAULT_NURBS, b->g.by[home ? GCODE_NONMODAL : GCODE_STOP]);
}

enum fault nurbs_end(struct interpreter *in, struct fault_report *r)
{
    struct nurbs *n = &in->nurbs;

    if (n->count == 0 || n->running) {
        return FAULT_NONE;
    }
    n->count = 0;
    return block_at_line(in, &n->line, FAULT_NURBS_END, r);
}
