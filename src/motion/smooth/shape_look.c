#include "shape_fit.h"

#include <math.h>

/* Weights grow where a distance is above this part of the tolerance. */
static const double GROWS = 0.9;

/* Least and most |r'| of a spline, and what counts as squared distance, in tolerance^2, where |r'|
 * is not between them. */
static const double SLOW = 0.5, FAST = 1.6, ASTRAY = 4.0;

/* Place and slope of the curve at an event on the way, a vertex or a knot. */
struct place {
    double u, point[AXES], slope[AXES];
};

/* Note a squared distance, in tolerance^2. */
static inline void note(struct shape_fit *f, int32_t vertex, double off)
{
    struct shape_vertex *v = &f->run->vertex[vertex];

    v->off = !(off <= v->off) ? off : v->off;
    if (!(off <= f->worst)) { /* not a number counts, too */
        f->worst = off;
        f->worst_vertex = vertex;
    }
}

/* Bernstein values of r over a span, for each axis that moves, from the run's origin. [mm] */
static void values(const struct shape_fit *f, int32_t span, double b[AXES][4])
{
    const double(*m)[4] = (const double(*)[4])f->extract[span];

    for (int x = 0; x < f->axes; x++) {
        const double(*c)[AXES] = (const double(*)[AXES]) & f->run->control[span][f->axis[x]];
        const double c0 = c[0][0], c1 = c[1][0], c2 = c[2][0], c3 = c[3][0];
        b[x][0] = m[0][0] * c0 + m[0][1] * c1 + m[0][2] * c2;
        b[x][1] = m[1][1] * c1 + m[1][2] * c2;
        b[x][2] = m[2][1] * c1 + m[2][2] * c2;
        b[x][3] = m[3][1] * c1 + m[3][2] * c2 + m[3][3] * c3;
    }
}

void shape_fit_look(struct shape_fit *f)
{
    struct shape_run *r = f->run;

    f->worst = 0.0;
    f->worst_vertex = f->end;
    for (int32_t k = 0; k < f->spans; k++) {
        const double(*c)[AXES] = (const double(*)[AXES])r->control + k;
        for (int x = 0; x < f->axes; x += 2) {
            const int a = f->axis[x], b = f->axis[x + 1];
            const double a0 = c[0][a], a1 = c[1][a], a2 = c[2][a], a3 = c[3][a];
            const double b0 = c[0][b], b1 = c[1][b], b2 = c[2][b], b3 = c[3][b];
            for (int32_t i = f->first[k]; i < f->first[k + 1]; i++) {
                struct shape_vertex *v = &r->vertex[i];
                const double *w = f->row[i], w0 = w[0], w1 = w[1], w2 = w[2], w3 = w[3];
                const double p =
                    v->point[a] - r->origin[a] - (w0 * a0 + w1 * a1 + w2 * a2 + w3 * a3);
                const double q =
                    v->point[b] - r->origin[b] - (w0 * b0 + w1 * b1 + w2 * b2 + w3 * b3);
                v->off = p * p + q * q + (x == 0 ? 0.0 : v->off);
            }
        }
        for (int32_t i = f->first[k]; i < f->first[k + 1]; i++) {
            const double off = r->vertex[i].off * f->per[i];
            r->vertex[i].off = off;
            if (!(off <= f->worst)) { /* not a number counts, too */
                f->worst = off;
                f->worst_vertex = i;
            }
        }
    }
}

/* Way from the place of a vertex on the curve to its foot, by a step of Newton. [mm] */
static double to_foot(const struct shape_fit *f, int32_t vertex, int32_t span,
                      const double b[AXES][4])
{
    const struct shape_vertex *v = &f->run->vertex[vertex];
    const double *t = f->run->knot + span, h = t[4] - t[3], z = (v->u - t[3]) / h, s = 1.0 - z;
    double along = 0.0, square = 0.0;

    for (int x = 0; x < f->axes; x++) {
        const int a = f->axis[x];
        const double p = s * b[x][0] + z * b[x][1], q = s * b[x][1] + z * b[x][2];
        const double w = s * b[x][2] + z * b[x][3], pq = s * p + z * q, qw = s * q + z * w;
        const double slope = qw - pq, d = v->point[a] - f->run->origin[a] - (s * pq + z * qw);
        along += d * slope;
        square += slope * slope;
    }
    return square > 0.0 ? along / square * h / 3.0 : 0.0;
}

/* CCN 19: one loop over the points for all of them and for those that are off. */
void shape_fit_push(struct shape_fit *f, bool all)
{
    struct shape_run *r = f->run;
    double least = r->knot[3], b[AXES][4];

    for (int32_t k = 0; k < f->spans; k++) {
        bool known = false;
        for (int32_t i = f->first[k]; i < f->first[k + 1]; i++) {
            struct shape_vertex *v = &r->vertex[i];
            const bool grows = v->off > GROWS * GROWS, stays = i == f->end && f->last;
            const double y = v->off / (GROWS * GROWS), z = y > 10.0 ? 10.0 : y * y;
            const double weight = grows ? v->weight * (z > 10.0 ? 10.0 : z) : v->weight;
            if (!all && !grows) {
                continue;
            }
            if (!known) {
                values(f, k, b);
                known = true;
            }
            const double u = stays ? v->u : v->u + to_foot(f, i, k, (const double(*)[4])b);
            if (all) {
                const double most = r->knot[f->spans + 3];
                v->weight = weight;
                v->u = u < least ? least : u > most ? most : u;
                least = v->u;
            } else {
                const double from = r->knot[k + 3], to = r->knot[k + 4];
                const double low = v[-1].u > from ? v[-1].u : from;
                const double high = i < f->end && v[1].u < to ? v[1].u : to;
                shape_solve_change(f, i, k, weight, u < low ? low : u > high ? high : u);
            }
        }
    }
}

/* The part of the curve between two events belongs to the chord that ends at a vertex. Note how far
 * its control points but the first are from that chord: the inner two, or all three. */
static void prove_chord(struct shape_fit *f, int32_t vertex, const struct place *a,
                        const struct place *b, int points)
{
    const struct shape_vertex *v = &f->run->vertex[vertex];
    const double third = (b->u - a->u) / 3.0;
    double ww = 0.0, wf[3] = { 0.0 }, ff[3] = { 0.0 }, most = 0.0;

    for (int k = 0; k < f->axes; k++) {
        const int x = f->axis[k];
        const double way = v->point[x] - v[-1].point[x];
        const double start = v[-1].point[x] - f->run->origin[x];
        const double from[3] = { a->point[k] + third * a->slope[k] - start,
                                 b->point[k] - third * b->slope[k] - start, b->point[k] - start };
        ww += way * way;
        for (int i = 0; i < points; i++) {
            wf[i] += way * from[i];
            ff[i] += from[i] * from[i];
        }
    }
    const double per = ww > 0.0 ? 1.0 / ww : 0.0;
    for (int i = 0; i < points; i++) { /* from the foot, the start or the end of the chord */
        const double square = wf[i] <= 0.0 ? ff[i]
                              : wf[i] < ww ? ff[i] - wf[i] * wf[i] * per
                                           : ff[i] - 2.0 * wf[i] + ww;
        most = square <= most ? most : square;
    }
    note(f, vertex, most / (SHAPE_USED * SHAPE_USED * v->tolerance * v->tolerance));
}

static void place_at(const struct shape_fit *f, int32_t span, const double b[AXES][4], double u,
                     struct place *p)
{
    const double *t = f->run->knot + span, h = t[4] - t[3], per = 3.0 / h;
    const double z = (u - t[3]) / h, s = 1.0 - z;

    p->u = u;
    for (int x = 0; x < f->axes; x++) {
        const double i = s * b[x][0] + z * b[x][1], j = s * b[x][1] + z * b[x][2];
        const double k = s * b[x][2] + z * b[x][3], ij = s * i + z * j, jk = s * j + z * k;
        p->point[x] = s * ij + z * jk;
        p->slope[x] = per * (jk - ij);
    }
}

/* Note how far a vertex is from its place, and whether |r'| is near 1 there (path.h's length). */
static void prove_vertex(struct shape_fit *f, int32_t vertex, const struct place *p)
{
    const struct shape_vertex *v = &f->run->vertex[vertex];
    double sum = 0.0, speed = 0.0;

    for (int x = 0; x < f->axes; x++) {
        const int a = f->axis[x];
        const double d = v->point[a] - f->run->origin[a] - p->point[x];
        sum += d * d;
        speed += a < 3 || f->axis[0] >= 3 ? p->slope[x] * p->slope[x] : 0.0;
    }
    note(f, vertex, sum * f->per[vertex]);
    if (!(speed > SLOW * SLOW && speed < FAST * FAST)) {
        f->worst = ASTRAY;
        f->worst_vertex = vertex;
    }
}

void shape_fit_prove(struct shape_fit *f, int32_t spans)
{
    const double *t = f->run->knot;
    struct place now, next;
    double b[AXES][4];

    f->worst = 0.0;
    f->worst_vertex = f->end;
    values(f, 0, b);
    place_at(f, 0, (const double(*)[4])b, t[3], &now);
    for (int32_t k = 0; k < spans; k++) {
        int32_t i = f->first[k];
        if (k > 0) {
            values(f, k, b);
        }
        for (; i < f->first[k + 1]; i++) {
            place_at(f, k, (const double(*)[4])b, f->run->vertex[i].u, &next);
            prove_chord(f, i, &now, &next, 2); /* the third is near the vertex itself */
            prove_vertex(f, i, &next);
            now = next;
        }
        if (i <= f->end) {
            place_at(f, k, (const double(*)[4])b, t[k + 4], &next);
            prove_chord(f, i, &now, &next, 3);
            now = next;
        }
    }
}
