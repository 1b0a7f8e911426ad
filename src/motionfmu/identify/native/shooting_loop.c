/* Motion of one axis in its loop, with derivatives: many short pieces of a record, each from a
 * start of its own.
 *
 * State of a piece: x of the plant, W of the laws. Behind each is a row of derivatives to the
 * directions: the elements of the start state, then the quantities that are free. plant_rates and
 * plant_shows are CasADi's C text of the plant's equation, plain_rates and plain_shows the same
 * without derivatives, for motions with no directions.
 */
#include <stddef.h>
#include <string.h>

#ifndef casadi_int
#define casadi_int long long int
#endif
int plant_rates(const double **arg, double **res, casadi_int *iw, double *w, int mem);
int plant_shows(const double **arg, double **res, casadi_int *iw, double *w, int mem);
int plain_rates(const double **arg, double **res, casadi_int *iw, double *w, int mem);
int plain_shows(const double **arg, double **res, casadi_int *iw, double *w, int mem);

/* Nonzero elements of a matrix. */
struct places {
    long long count;
    const long long *row, *column;
};

struct axis {
    long long n_x, n_u, n_p, n_q, n_y; /* states, inputs, parameters, moved ones, outputs */
    long long n_w, n_v, n_shown;       /* of the laws: memory, what they see, what is compared */
    long long n_driven;                /* of what they see, the first ones are the record's */
    long long cycle;                   /* communication steps after which the laws begin again */
    long long directions, first;       /* all; the first one that is a free quantity */
    long long sub_steps;               /* integration steps in a communication step */
    double step;                       /* [s] communication step */
    const double *p, *u;               /* parameters; inputs that stay */
    const double *dp, *du;             /* [moved or input][free quantity] */
    const long long *fed;              /* outputs that the laws see */
    struct places rates[3], shows[3];  /* of the derivatives to x, u and the moved parameters */
    const double *keep, *read, *take, *through, *show, *direct;
};

/* Room for the work of one piece. */
struct room {
    double *u, *s_u;       /* plant inputs and their derivatives */
    double *v, *s_v;       /* what the laws see */
    double *y, *s_y;       /* outputs of the plant */
    double *k, *s_k;       /* four rates and their derivatives */
    double *at, *s_at;     /* where a rate is taken */
    double *next, *s_next; /* W a communication step later */
    double *elements[3];   /* of the derivatives of the plant */
    double *casadi;        /* CasADi's own */
};

/* to += factor from, n long. */
static void add(double *restrict to, double factor, const double *restrict from, long long n)
{
    for (long long i = 0; i < n; i++) {
        to[i] += factor * from[i];
    }
}

/* Rates or outputs with their derivatives: s = A s_x + B s_u + Q dp. */
static void plant(const struct axis *a, const struct room *r, int shows, const double *x,
                  const double *s_x, double *f, double *s)
{
    const long long n = a->directions, rows = shows ? a->n_y : a->n_x;
    const double *arg[3] = { x, r->u, a->p };
    double *res[4] = { f, r->elements[0], r->elements[1], r->elements[2] };
    const struct places *places = shows ? a->shows : a->rates;
    if (n == 0) {
        (shows ? plain_shows : plain_rates)(arg, res, NULL, r->casadi, 0);
        return;
    }
    (shows ? plant_shows : plant_rates)(arg, res, NULL, r->casadi, 0);
    memset(s, 0, (size_t)(rows * n) * sizeof *s);
    for (long long e = 0; e < places[0].count; e++) {
        add(s + places[0].row[e] * n, r->elements[0][e], s_x + places[0].column[e] * n, n);
    }
    for (long long e = 0; e < places[1].count; e++) {
        add(s + places[1].row[e] * n, r->elements[1][e], r->s_u + places[1].column[e] * n, n);
    }
    for (long long e = 0; e < places[2].count; e++) {
        add(s + places[2].row[e] * n + a->first, r->elements[2][e],
            a->dp + places[2].column[e] * (n - a->first), n - a->first);
    }
}

/* to = m from (rows x columns), with the derivatives; added to what is there. */
static void product(const struct axis *a, const double *m, long long rows, long long columns,
                    const double *from, const double *s_from, double *to, double *s_to)
{
    const long long n = a->directions;
    for (long long i = 0; i < rows; i++) {
        for (long long j = 0; j < columns; j++) {
            const double factor = m[i * columns + j];
            if (factor != 0.0) {
                to[i] += factor * from[j];
                if (n > 0) {
                    add(s_to + i * n, factor, s_from + j * n, n);
                }
            }
        }
    }
}

/* One classic Runge-Kutta step of h [s]. */
static void advance(const struct axis *a, const struct room *r, double h, double *x, double *s_x)
{
    static const double part[4] = { 0.0, 0.5, 0.5, 1.0 }, weight[4] = { 1.0, 2.0, 2.0, 1.0 };
    const long long n = a->n_x, wide = n * a->directions;
    for (int q = 0; q < 4; q++) {
        memcpy(r->at, x, (size_t)n * sizeof *x);
        memcpy(r->s_at, s_x, (size_t)wide * sizeof *x);
        if (q > 0) {
            add(r->at, part[q] * h, r->k + (q - 1) * n, n);
            add(r->s_at, part[q] * h, r->s_k + (q - 1) * wide, wide);
        }
        plant(a, r, 0, r->at, r->s_at, r->k + q * n, r->s_k + q * wide);
    }
    for (int q = 0; q < 4; q++) {
        add(x, h / 6.0 * weight[q], r->k + q * n, n);
        add(s_x, h / 6.0 * weight[q], r->s_k + q * wide, wide);
    }
}

/* What the laws see and set at a communication point; outputs of the plant and of the laws go to
 * `y` and `s_y`, those of the laws behind. */
static void exchange(const struct axis *a, const struct room *r, const double *driven, long long j,
                     const double *x, const double *s_x, const double *w, const double *s_w,
                     double *y, double *s_y)
{
    const long long n = a->directions;
    plant(a, r, 1, x, s_x, y, s_y);
    memcpy(r->v, driven, (size_t)a->n_driven * sizeof *driven);
    memset(r->s_v, 0, (size_t)(a->n_v * n) * sizeof *r->s_v);
    for (long long k = a->n_driven; k < a->n_v; k++) {
        r->v[k] = y[a->fed[k - a->n_driven]];
        memcpy(r->s_v + k * n, s_y + a->fed[k - a->n_driven] * n, (size_t)n * sizeof *s_y);
    }
    memset(r->s_u, 0, (size_t)(a->n_u * n) * sizeof *r->s_u);
    for (long long i = 0; i < a->n_u; i++) {
        r->u[i] = a->u[i];
        memcpy(r->s_u + i * n + a->first, a->du + i * (n - a->first),
               (size_t)(n - a->first) * sizeof *r->s_u);
    }
    product(a, a->take + j * a->n_u * a->n_w, a->n_u, a->n_w, w, s_w, r->u, r->s_u);
    product(a, a->through + j * a->n_u * a->n_v, a->n_u, a->n_v, r->v, r->s_v, r->u, r->s_u);
    y += a->n_y;
    s_y += a->n_y * n;
    memset(y, 0, (size_t)a->n_shown * sizeof *y);
    memset(s_y, 0, (size_t)(a->n_shown * n) * sizeof *s_y);
    product(a, a->show + j * a->n_shown * a->n_w, a->n_shown, a->n_w, w, s_w, y, s_y);
    product(a, a->direct + j * a->n_shown * a->n_v, a->n_shown, a->n_v, r->v, r->s_v, y, s_y);
}

/* Laws from one communication point to the next. */
static void laws(const struct axis *a, const struct room *r, long long j, double *w, double *s_w)
{
    const long long n = a->directions;
    memset(r->next, 0, (size_t)a->n_w * sizeof *w);
    memset(r->s_next, 0, (size_t)(a->n_w * n) * sizeof *w);
    product(a, a->keep + j * a->n_w * a->n_w, a->n_w, a->n_w, w, s_w, r->next, r->s_next);
    product(a, a->read + j * a->n_w * a->n_v, a->n_w, a->n_v, r->v, r->s_v, r->next, r->s_next);
    memcpy(w, r->next, (size_t)a->n_w * sizeof *w);
    memcpy(s_w, r->s_next, (size_t)(a->n_w * n) * sizeof *w);
}

/* Number of doubles in the room, `casadi` of them CasADi's; with room, its parts. */
static long long furnish(const struct axis *a, long long casadi, double *all, struct room *r)
{
    const long long n = a->directions;
    long long most[3] = { 0 }, sizes[16], total = 0;
    for (int k = 0; k < 3; k++) {
        most[k] = a->rates[k].count > a->shows[k].count ? a->rates[k].count : a->shows[k].count;
    }
    double **parts[16] = { &r->u,           &r->s_u,         &r->v,           &r->s_v,
                           &r->y,           &r->s_y,         &r->k,           &r->s_k,
                           &r->at,          &r->s_at,        &r->next,        &r->s_next,
                           &r->elements[0], &r->elements[1], &r->elements[2], &r->casadi };
    const long long shown = a->n_y + a->n_shown;
    const long long widths[16] = { a->n_u,  a->n_u * n, a->n_v,     a->n_v * n,
                                   shown,   shown * n,  4 * a->n_x, 4 * a->n_x * n,
                                   a->n_x,  a->n_x * n, a->n_w,     a->n_w * n,
                                   most[0], most[1],    most[2],    casadi };
    for (int k = 0; k < 16; k++) {
        sizes[k] = widths[k] + 1;
        if (all) {
            *parts[k] = all + total;
        }
        total += sizes[k];
    }
    return total;
}

__attribute__((visibility("default"))) long long loop_room(const struct axis *a, long long casadi)
{
    struct room r;
    return furnish(a, casadi, NULL, &r);
}

/* Pieces of the record: piece i begins at communication point begin[i] and has length[i] steps. x,
 * w and their derivatives are the starts and become the ends. Where joined[i] (if given) is not 0,
 * the start of x and w is the end of the piece before. Every `every`th point of a piece from
 * its first on is a sample: outputs of the plant there, of the laws `late` steps later, go
 * to y and s_y, one piece behind the other. */
__attribute__((visibility("default"))) void
loop_run(const struct axis *a, long long pieces, const long long *begin, const long long *length,
         const unsigned char *joined, long long every, long long late, const double *driven,
         double *x, double *s_x, double *w, double *s_w, double *y, double *s_y, long long casadi,
         double *all)
{
    struct room r;
    furnish(a, casadi, all, &r);
    const long long n = a->directions, shown = a->n_y + a->n_shown;
    for (long long i = 0; i < pieces; i++) {
        if (joined && joined[i]) {
            memcpy(x, x - a->n_x, (size_t)a->n_x * sizeof *x);
            memcpy(w, w - a->n_w, (size_t)a->n_w * sizeof *w);
        }
        for (long long k = 0; k < length[i]; k++) {
            const long long point = begin[i] + k, j = point % a->cycle;
            exchange(a, &r, driven + point * a->n_driven, j, x, s_x, w, s_w, r.y, r.s_y);
            double *to = y + k / every * shown, *s_to = s_y + k / every * shown * n;
            if (k % every == 0) {
                memcpy(to, r.y, (size_t)a->n_y * sizeof *y);
                memcpy(s_to, r.s_y, (size_t)(a->n_y * n) * sizeof *s_y);
            }
            if (k % every == late) {
                memcpy(to + a->n_y, r.y + a->n_y, (size_t)a->n_shown * sizeof *y);
                memcpy(s_to + a->n_y * n, r.s_y + a->n_y * n,
                       (size_t)(a->n_shown * n) * sizeof *s_y);
            }
            laws(a, &r, j, w, s_w);
            for (long long q = 0; q < a->sub_steps; q++) {
                advance(a, &r, a->step / (double)a->sub_steps, x, s_x);
            }
        }
        y += (length[i] + every - 1) / every * shown;
        s_y += (length[i] + every - 1) / every * shown * n;
        x += a->n_x;
        s_x += a->n_x * n;
        w += a->n_w;
        s_w += a->n_w * n;
    }
}

/* The laws alone along a record of what they see: their memory and what they show at all points. */
__attribute__((visibility("default"))) void loop_laws(const struct axis *a, long long points,
                                                      const double *seen, double *w, double *shown)
{
    for (long long k = 0; k < points; k++, w += a->n_w, seen += a->n_v, shown += a->n_shown) {
        const long long j = k % a->cycle;
        memset(shown, 0, (size_t)a->n_shown * sizeof *w);
        memset(w + a->n_w, 0, (size_t)a->n_w * sizeof *w);
        product(a, a->show + j * a->n_shown * a->n_w, a->n_shown, a->n_w, w, NULL, shown, NULL);
        product(a, a->direct + j * a->n_shown * a->n_v, a->n_shown, a->n_v, seen, NULL, shown,
                NULL);
        product(a, a->keep + j * a->n_w * a->n_w, a->n_w, a->n_w, w, NULL, w + a->n_w, NULL);
        product(a, a->read + j * a->n_w * a->n_v, a->n_w, a->n_v, seen, NULL, w + a->n_w, NULL);
    }
}
