#include "shape_fit.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* A span has so many closest spacings at first, and that times SHAPE_CROWD vertices at most. */
enum { COARSE = 5 };

/* Spans are at least this part of the spacing. */
static const double LEAST = 1e-3;

/* Knots behind the one at `held`, closer where vertices crowd, until one is at `to` or there are no
 * more; returns the last. */
static int32_t spread(struct shape_fit *f, int32_t held, double to)
{
    struct shape_run *r = f->run;
    const struct shape_vertex *v = r->vertex;
    int32_t k = held, i = 1, crowd = 0;

    while (k < SHAPE_SPANS + 3) {
        double h = COARSE * shape_spacing(v[i].tolerance);
        while (i < f->end
               && (v[i].u <= r->knot[k]
                   || (v[i].u < r->knot[k] + h && crowd < COARSE * SHAPE_CROWD))) {
            crowd += v[i].u > r->knot[k];
            i++;
        }
        h = crowd >= COARSE * SHAPE_CROWD ? el_max(LEAST * h, el_min(h, v[i].u - r->knot[k])) : h;
        crowd = 0;
        r->knot[k + 1] = r->knot[k] + h;
        k++;
        if (r->knot[k] >= to) {
            break;
        }
    }
    return k;
}

/* The last knot, of those up to k, comes to the end of the run, those before it move along; returns
 * which it is. */
static int32_t put_end(struct shape_run *r, int32_t held, int32_t k, double at_end)
{
    const double from = r->knot[held];

    /* the last one at the end: drop it if it is nearer to the one before */
    if (k > held + 1 && k > SHAPE_SPANS_LEAST + 3
        && r->knot[k] - at_end > at_end - r->knot[k - 1]) {
        k--;
    }
    const double stretch = (at_end - from) / (r->knot[k] - from);
    for (int32_t j = held + 1; j <= k; j++) {
        r->knot[j] = from + (r->knot[j] - from) * stretch;
    }
    if (k < SHAPE_SPANS_LEAST + 3) { /* short: evenly */
        const int32_t n = SHAPE_SPANS_LEAST + 3 - held;
        k = SHAPE_SPANS_LEAST + 3;
        for (int32_t j = 1; j <= n; j++) {
            r->knot[held + j] = from + (at_end - from) * j / n;
        }
    }
    for (int j = 0; j <= 3; j++) {
        r->knot[k + j] = at_end;
    }
    return k;
}

bool shape_knots_put(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    const struct shape_vertex *v = r->vertex;
    const double to = v[f->end].u;
    int32_t held = r->begun ? 5 : 3;

    if (!r->begun) {
        for (int j = 0; j <= 3; j++) {
            r->knot[j] = v[0].u;
        }
    }
    if (!(to > r->knot[held])) {
        return false;
    }
    while (r->begun && held < r->kept && r->knot[held + 1] < to) {
        held++;
    }
    r->kept = 0;
    const int32_t k = spread(f, held, to);
    if (r->knot[k] < to && f->last) {
        return false;
    }
    while (f->end > 1 && v[f->end].u > r->knot[k]) {
        f->end--;
    }
    f->spans = put_end(r, held, k, v[f->end].u) - 3;
    return true;
}

bool shape_knots_halve(struct shape_fit *f, double longer)
{
    struct shape_run *r = f->run;
    const int32_t first = r->begun ? 2 : 0; /* before it knots hold */
    bool wide[SHAPE_SPANS] = { false };
    double knot[SHAPE_SPANS + 7];
    int32_t k = 0, n = 0, more = 0;

    for (int32_t i = 1; i <= f->end; i++) {
        const struct shape_vertex *v = &r->vertex[i];
        while (k < f->spans - 1 && v[-1].u >= r->knot[k + 4]) {
            k++;
        }
        for (int32_t j = k; j < f->spans && r->knot[j + 3] <= v->u && v->off > 1.0; j++) {
            wide[j] =
                wide[j]
                || (j >= first
                    && r->knot[j + 4] - r->knot[j + 3] > longer * shape_spacing(v->tolerance));
        }
    }
    memcpy(knot, r->knot, 3 * sizeof knot[0]);
    for (k = 0; k < f->spans; k++) {
        knot[3 + n++] = r->knot[k + 3];
        if (wide[k] && f->spans + more < SHAPE_SPANS) {
            knot[3 + n++] = 0.5 * (r->knot[k + 3] + r->knot[k + 4]);
            more++;
        }
    }
    memcpy(knot + n + 3, r->knot + f->spans + 3, 4 * sizeof knot[0]);
    if (more > 0) {
        shape_fit_split(f, n, knot);
    }
    return more > 0;
}
