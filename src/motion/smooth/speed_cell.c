#include "speed_cell.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "speed_box.h"
#include "speed_pull.h"

/* A cell turns by at most TURN [rad], and r' leaves its chord over it by at most SAG. Found by
 * measuring: half as much gains less than 1 % of time. */
static const double TURN = 0.1, SAG = 0.005;

/* A part of an acceleration that is less than this counts as none. */
static const double LEAST = 0.01;

/* A bend that takes at most so much of an axis' acceleration at any speed is left out, and as much
 * of the acceleration. */
static const double SLIGHT = 0.002;

static double most(double a, double b)
{
    return a > b ? a : b;
}

static double larger(double low, double high)
{
    return most(fabs(low), fabs(high));
}

/* Whether b, between a and c by g0, says no more than they do together. */
static bool between(const double a[2], const double b[2], const double c[2])
{
    return (c[0] - a[0]) * (b[1] - a[1]) <= (c[1] - a[1]) * (b[0] - a[0]);
}

/* Add g0 x0 + g1 x1 <= 1. Planes are by rising g0, falling g1, and each says something that all
 * others together do not, for x0, x1 >= 0.
 * CCN 21: each condition compares a plane with its neighbours of one side or both. */
static void add_plane(struct speed_cell *c, double g0, double g1)
{
    const double g[2] = { g0, g1 };
    int32_t i = 0, from, to;

    while (i < c->planes && c->plane[i][0] < g0) {
        i++;
    }
    if ((g0 <= 0.0 && g1 <= 0.0) || (i < c->planes && c->plane[i][1] >= g1)
        || (i > 0 && i < c->planes && between(c->plane[i - 1], g, c->plane[i]))) {
        return;
    }
    for (from = i; from > 0
                   && (c->plane[from - 1][1] <= g1
                       || (from > 1 && between(c->plane[from - 2], c->plane[from - 1], g)));
         from--) {
    }
    for (to = i; to < c->planes
                 && (c->plane[to][0] <= g0
                     || (to + 1 < c->planes && between(g, c->plane[to], c->plane[to + 1])));
         to++) {
    }
    if (from == to && c->planes == SPEED_PLANES) { /* joined with a neighbour */
        i = from < c->planes ? from : from - 1;
        add_plane(c, most(g0, c->plane[i][0]), most(g1, c->plane[i][1]));
        return;
    }
    memmove(c->plane[from + 1], c->plane[to], (size_t)(c->planes - to) * sizeof c->plane[0]);
    memcpy(c->plane[from], g, sizeof g);
    c->planes += from + 1 - to;
}

/* A limit of an acceleration: at least -acc[0], at most acc[1]. */
struct row {
    struct speed_pull pull;
    double acc[2]; /* [mm/s^2] */
    double rest;   /* share of acc that is left where q x is left out */
    bool bends;    /* q x counts */
};

/* Adds the planes of a row (docs/theory/speed.md); |a| <= (x0 + x1) / (2 h). */
static void add_row(struct speed_cell *c, const struct row *r)
{
    const double per = 0.5 / c->length;

    for (int side = 0; side < 2; side++) {
        const double k = (side == 0 ? -1.0 : 1.0) / r->acc[side];
        if (!r->bends) {
            const double g = k * per * r->pull.most[0] / r->rest;
            add_plane(c, -g, g);
            continue;
        }
        const double sag = per * r->pull.sag / r->acc[side], stray = r->pull.stray / r->acc[side];
        const double p0 = k * per * r->pull.p[0], q0 = k * r->pull.q[0] + stray;
        const double p1 = k * per * r->pull.p[1], q1 = k * r->pull.q[1] + stray;
        add_plane(c, q0 - p0 + sag, p0 + sag);
        add_plane(c, 0.5 * (q1 - p0 - p1) + sag, 0.5 * (q0 + p0 + p1) + sag);
        add_plane(c, sag - p1, q1 + p1 + sag);
    }
}

static void limit_rows(struct speed_cell *c, struct row row[AXES + 1], int count)
{
    double sum = 0.0;
    bool any = false;

    for (int i = 0; i < count; i++) {
        struct row *r = &row[i];
        const double bend = r->pull.most[1] / el_min(r->acc[0], r->acc[1]);
        const double takes = bend > 0.0 ? bend * c->cap * c->cap : 0.0;
        r->bends = takes > SLIGHT;
        r->rest = r->bends ? 1.0 : 1.0 - takes;
        any = any || r->bends;
        c->bend = r->bends ? most(c->bend, bend) : c->bend;
        c->down = most(c->down, r->pull.most[0] / (r->rest * r->acc[0]));
        c->up = most(c->up, r->pull.most[0] / (r->rest * r->acc[1]));
    }
    for (int i = 0; any && i < count; i++) {
        add_row(c, &row[i]);
    }
    for (int32_t i = 0; i < c->planes; i++) {
        sum = most(sum, c->plane[i][0] + c->plane[i][1]);
    }
    c->flat = sum > 0.0 ? 1.0 / sum : INFINITY;
}

/* Limits of the cell, a part of a segment. */
static void limit(struct speed_cell *c, const struct segment *p, const struct speed_limits *l,
                  const struct segment_bounds *b)
{
    struct row row[AXES + 1];
    double pull = 0.0;
    int count = 0;

    c->planes = 0;
    c->bend = c->up = c->down = c->most = c->top = 0.0;
    const double way = p->even ? 1.0 : b->most[0];
    c->feed = p->feed / way;
    c->cap = p->cap / way;
    for (int32_t i = 0; i < b->axes; i++) {
        const int k = b->axis[i];
        if (l->speed[k] > 0.0) {
            c->cap = el_min(c->cap, l->speed[k] / larger(b->low[0][k], b->high[0][k]));
        }
        if (l->acc[k] > 0.0) {
            row[count].acc[0] = row[count].acc[1] = l->acc[k];
            speed_pull_axis(&row[count++].pull, k, c->length, b);
            pull = most(pull, larger(b->low[0][k], b->high[0][k]) / l->acc[k]);
        }
    }
    if (!speed_by_axes(l)) {
        const double across = speed_pull_path(&row[0].pull, p, c->length, b);
        c->cap = el_min(c->cap, sqrt(el_min(p->ramp.acc, p->ramp.dec) / across));
        row[0].acc[0] = p->ramp.dec;
        row[0].acc[1] = p->ramp.acc;
        count = 1;
    }
    if (p->share[0] > 0.0 || p->share[1] > 0.0) { /* the way by itself */
        row[count++] = (struct row){ .pull = { .most = { pull, 0.0, 0.0 } },
                                     .acc = { p->share[1] > 0.0 ? p->share[1] : INFINITY,
                                              p->share[0] > 0.0 ? p->share[0] : INFINITY } };
    }
    limit_rows(c, row, count);
}

void speed_part_first(struct speed_part *part, const struct segment *p)
{
    const struct segment_bounds *b = &part->bounds;

    part->segment = p;
    part->next = 0;
    part->to = 0.0;
    segment_rest_start(&part->rest, p);
    segment_rest_bounds(&part->rest, &part->bounds);
    const double turn = b->most[1] * p->length / TURN;
    const double sag = p->length * sqrt(b->most[2] / 8.0 / SAG);
    const double n = ceil(most(turn, sag));
    part->count = p->kind == SEGMENT_LINE || n < 1.0 ? 1
                  : n < SPEED_SPLIT                  ? (int32_t)n
                                                     : SPEED_SPLIT;
}

bool speed_part_next(struct speed_part *part)
{
    const double length = part->segment->length;

    if (part->next == part->count) {
        return false;
    }
    part->from = part->to;
    part->next++;
    part->to = part->next < part->count ? length * part->next / part->count : length;
    if (part->count > 1) {
        segment_rest_cut(&part->rest, part->to, &part->bounds);
    }
    return true;
}

int32_t speed_cut(const struct segment *p, const struct speed_limits *l,
                  struct speed_cell cell[SPEED_SPLIT])
{
    struct speed_part part;
    int32_t n = 0;

    for (speed_part_first(&part, p); speed_part_next(&part); n++) {
        cell[n].length = part.to - part.from;
        limit(&cell[n], p, l, &part.bounds);
    }
    return n;
}

/* x at both ends of a cell. */
struct ends {
    double x[2];
};

/* The point of the plane with the most x0 that keeps the first n others, 0 <= x0 <= most and
 * 0 <= x1 <= x1_most. */
static struct ends along(const struct speed_cell *c, int32_t n, const double most[2])
{
    const double *g = c->plane[n], size = g[0] * g[0] + g[1] * g[1];
    const double foot[2] = { g[0] / size, g[1] / size };
    const double to[2] = { g[1] >= 0.0 ? g[1] : -g[1], g[1] >= 0.0 ? -g[0] : g[0] };
    double low = -INFINITY, high = INFINITY;

    for (int32_t i = -2; i < n; i++) {
        double room[2] = { 0.0, 0.0 }, rise;
        if (i < 0) { /* -foot / to .. (most - foot) / to */
            rise = to[i + 2];
            room[0] = most[i + 2] - foot[i + 2];
            room[1] = -foot[i + 2];
            if (rise != 0.0) {
                low = el_max(low, room[rise > 0.0] / rise);
                high = el_min(high, room[rise < 0.0] / rise);
            }
            continue;
        }
        rise = c->plane[i][0] * to[0] + c->plane[i][1] * to[1];
        room[0] = 1.0 - c->plane[i][0] * foot[0] - c->plane[i][1] * foot[1];
        if (rise > 0.0) {
            high = el_min(high, room[0] / rise);
        } else if (rise < 0.0) {
            low = el_max(low, room[0] / rise);
        }
    }
    return (struct ends){ { foot[0] + to[0] * high, foot[1] + to[1] * high } };
}

double speed_back(const struct speed_cell *c, double x1, double most, double *end)
{
    const double bound[2] = { most, x1 };
    struct ends best = { { most, x1 } };

    for (int32_t i = 0; i < c->planes; i++) {
        if (c->plane[i][0] * best.x[0] + c->plane[i][1] * best.x[1] > 1.0) {
            best = along(c, i, bound);
        }
    }
    *end = el_min(x1, el_max(0.0, best.x[1]));
    return el_min(most, el_max(0.0, best.x[0]));
}

double speed_top(const struct speed_cell *c, double x1, double most)
{
    double top = INFINITY;

    for (int32_t i = 0; i < c->planes; i++) {
        if (c->plane[i][0] > 0.0) {
            top = el_min(top, (1.0 - c->plane[i][1] * x1) / c->plane[i][0]);
        }
    }
    const double box = x1 + 2.0 * c->length * el_max(0.0, 1.0 - c->bend * most) / c->down;
    return c->planes > 0 ? el_max(box, top) : box;
}

struct speed_span speed_span(const struct speed_cell *c, double left, double x)
{
    const double gone = c->length - left;
    struct speed_span s = { -x / (2.0 * left), gone > 0.0 ? x / (2.0 * gone) : INFINITY };

    if (c->planes == 0) { /* straight, or the path's ramp */
        return (struct speed_span){ -1.0 / c->down, 1.0 / c->up };
    }
    for (int32_t i = 0; i < c->planes; i++) {
        const double *g = c->plane[i], lever = 2.0 * (g[1] * left - g[0] * gone);
        const double room = 1.0 - (g[0] + g[1]) * x;
        if (lever > 0.0) {
            s.high = el_min(s.high, room / lever);
        } else if (lever < 0.0) {
            s.low = el_max(s.low, room / lever);
        }
    }
    return s;
}

double speed_rise(const struct speed_cell *c, double x, double *until)
{
    const double all = 1.0 - c->bend * *until, half = 0.5 * (1.0 - c->bend * x);

    if (half < LEAST) {
        return -INFINITY;
    }
    if (all >= half) {
        return all / c->up;
    }
    *until = x + half / c->bend;
    return half / c->up;
}

double speed_fall(const struct speed_cell *c, double x)
{
    return el_max(0.0, 1.0 - c->bend * x) / c->down;
}
