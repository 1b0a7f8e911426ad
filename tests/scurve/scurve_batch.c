/* Many S-curves in one call, for tests/helpers/scurve_moves.py. */
#include "scurve.h"

struct move {
    struct scurve_start from;
    double s1, v1; /* [mm], [mm/s] */
    struct scurve_limits limits;
};

/* Durations of n moves, to v1 at s1 or `anywhere`. Returns how many were refused. [s] */
int64_t scurve_batch_totals(int64_t n, const struct move *m, int anywhere, double *total)
{
    int64_t refused = 0;
    for (int64_t i = 0; i < n; i++) {
        const struct move *x = &m[i];
        struct scurve p;
        refused += SCURVE_OK
                   != (anywhere ? scurve_plan_speed(&p, &x->from, x->v1, &x->limits)
                                : scurve_plan_through(&p, &x->from, x->s1, x->v1, &x->limits));
        total[i] = scurve_total(&p);
    }
    return refused;
}

/* Positions of n moves to v1 at s1, each at `count` equidistant moments from its start to its end.
 * Returns how many were refused. [mm] */
int64_t scurve_batch_positions(int64_t n, const struct move *m, int64_t count, double *s)
{
    int64_t refused = 0;
    for (int64_t i = 0; i < n; i++) {
        struct scurve p;
        refused += SCURVE_OK != scurve_plan_through(&p, &m[i].from, m[i].s1, m[i].v1, &m[i].limits);
        for (int64_t k = 0; k < count; k++) {
            double v, a, j;
            scurve_state(&p, p.total * (double)k / (double)(count - 1), s++, &v, &a, &j);
        }
    }
    return refused;
}
