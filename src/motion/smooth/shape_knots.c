#include "shape_fit.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* A span has so many closest spacings at first, and that times SHAPE_CROWD vertices at most. */
enum { COARSE = 5 };

/* Spans are at least this part of the spacing. */
static const double LEAST = 1e-3;

bool shape_knots_put(struct shape_fit *f)
{
    struct shape_run *r = f->run;
    const struct shape_vertex *v = r->vertex;
    const double to = v[f->end].u;
    int32_t k = r->begun ? 5 : 3, i = 1, crowd = 0;

    if (!r->begun) {
        for (int j = 0; j <= 3; j++) {
            r->knot[j] = v[0].u;
        }
    }
    if (!(to > r->knot[k])) {
        return false;
    }
    while (r->begun && k < r->kept && r->knot[k + 1] < to) {
        k++;
    }
    r->kept = 0;
    const double from = r->knot[k];
    const int32_t held = k;
    while (k < SHAPE_SPANS + 3) {
        double h = COARSE * shape_spacing(v[i].tolerance);
        while (i < f->end && (v[i].u <= r->knot[k]
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
    if (r->knot[k] < to && f->last) {
        return false;
    }
    while (f->end > 1 && v[f->end].u > r->knot[k]) {
        f->end--;
    }
    const double at_end = v[f->end].u;
    /* the last knot is the end: without the one before it if that is nearer */
    if (k > held + 1 && k > SHAPE_SPANS_LEAST + 3
        && r->knot[k] - at_end > at_end - r->knot[k - 1]) {
        k--;
    }
    int32_t n = k - held;
    const double stretch = (at_end - from) / (r->knot[k] - from);
    for (int32_t j = held + 1; j <= k; j++) {
        r->knot[j] = from + (r->knot[j] - from) * stretch;
    }
    if (k < SHAPE_SPANS_LEAST + 3) {      /* short: evenly */
        n = SHAPE_SPANS_LEAST + 3 - held;
        k = SHAPE_SPANS_LEAST + 3;
        for (int32_t j = 1; j <= n; j++) {
            r->knot[held + j] = from + (at_end - from) * j / n;
        }
    }
    r->knot[k] = at_end;
    for (int j = 1; j <= 3; j++) {
        r->knot[k + j] = at_end;
    }
    f->spans = k - 3;
    return true;
}

bool shape_knots_halve(struct shape_fit *f, double longer)
{
    struct shape_run *r = f->run;
    const int32_t first = r->begun ? 2 : 0;     /* before it knots hold */
    bool wide[SHAPE_SPANS] = { false };
    double knot[SHAPE_SPANS + 7];
    int32_t k = 0, n = 0, more = 0;

    for (int32_t i = 1; i <= f->end; i++) {
        const struct shape_vertex *v = &r->vertex[i];
        while (k < f->spans - 1 && v[-1].u >= r->knot[k + 4]) {
            k++;
        }
        for (int32_t j = k; j < f->spans && r->knot[j + 3] <= v->u && v->off > 1.0; j++) {
            wide[j] = wide[j] || (j >= first && r->knot[j + 4] - r->knot[j + 3]
                                > longer * shape_spacing(v->tolerance));
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
