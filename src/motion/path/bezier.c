#include "bezier.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* An integral and the sum of its halves agree to this part of a length; a step of the search for t
 * that is shorter than this part of the length ends it. */
static const double AGREE = 1e-14;
static const double NEWTON = 1e-15;
static const double SLACK = 1e-3;   /* part by which a bound may be above what is reached */
static const double BEND_MAX = 1e4; /* [1/mm] curvature from which on a curve is refused */
static const double TOO_MUCH = 1e9; /* [1/mm], [1/mm^2] more need not be known better */

enum { HALVINGS = 40, STEPS = 60 };

/* Values of the derivatives at both ends of a part of the curve, and between them: B' is a curve of
 * degree 2 through d, B'' one of degree 1 through e. */
struct hodograph {
    double d[3][3], e[2][3], third[3];
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void derivatives(const struct bezier *b, const double start[3], const double end[3],
                        struct hodograph *h)
{
    for (int i = 0; i < 3; i++) {
        h->d[0][i] = 3.0 * (b->inner[0][i] - start[i]);
        h->d[1][i] = 3.0 * (b->inner[1][i] - b->inner[0][i]);
        h->d[2][i] = 3.0 * (end[i] - b->inner[1][i]);
        h->e[0][i] = 2.0 * (h->d[1][i] - h->d[0][i]);
        h->e[1][i] = 2.0 * (h->d[2][i] - h->d[1][i]);
        h->third[i] = h->e[1][i] - h->e[0][i];
    }
}

/* Blossom of B': B'(t) where both are t, the control point between two ends where they differ. */
static double blossom(const struct hodograph *h, int i, double s, double t)
{
    const double a = h->d[0][i] + s * (h->d[1][i] - h->d[0][i]);
    const double b = h->d[1][i] + s * (h->d[2][i] - h->d[1][i]);
    return a + t * (b - a);
}

/* Derivatives at both ends of the part from t0 to t1, still by the t of the whole curve. */
static void part_of(const struct hodograph *h, double t0, double t1, struct hodograph *part)
{
    for (int i = 0; i < 3; i++) {
        part->d[0][i] = blossom(h, i, t0, t0);
        part->d[1][i] = blossom(h, i, t0, t1);
        part->d[2][i] = blossom(h, i, t1, t1);
        part->e[0][i] = h->e[0][i] + t0 * (h->e[1][i] - h->e[0][i]);
        part->e[1][i] = h->e[0][i] + t1 * (h->e[1][i] - h->e[0][i]);
        part->third[i] = h->third[i];
    }
}

static void velocity(const struct hodograph *h, double t, double v[3])
{
    for (int i = 0; i < 3; i++) {
        v[i] = blossom(h, i, t, t);
    }
}

static double speed(const struct hodograph *h, double t)
{
    double v[3];
    velocity(h, t, v);
    return sqrt(dot(v, v));
}

/* Integral of |B'| by 10 points of Gauss and Legendre. */
static double gauss(const struct hodograph *h, double t0, double t1)
{
    static const double X
    [5] = { 0.14887433898163122, 0.43339539412924719, 0.67940956829902441, 0.86506336668898451,
            0.97390652851717172 };
    static const double W[5] = { 0.29552422471475287, 0.26926671930999636, 0.21908636251598204,
                                 0.14945134915058059, 0.06667134430868814 };
    const double middle = 0.5 * (t0 + t1), half = 0.5 * (t1 - t0);
    double sum = 0.0;

    for (int i = 0; i < 5; i++) {
        sum += W[i] * (speed(h, middle - half * X[i]) + speed(h, middle + half * X[i]));
    }
    return half * sum;
}

/* `known` is gauss() of it all; halves that differ from it by less than `least` are good. */
static double way(const struct hodograph *h, double t0, double t1, double known, double least,
                  int halvings)
{
    const double middle = 0.5 * (t0 + t1);
    const double a = gauss(h, t0, middle), b = gauss(h, middle, t1);

    if (fabs(a + b - known) <= least || halvings == 0) {
        return a + b;
    }
    return way(h, t0, middle, a, least, halvings - 1) + way(h, middle, t1, b, least, halvings - 1);
}

static double between(const struct hodograph *h, double t0, double t1, double size)
{
    return way(h, t0, t1, gauss(h, t0, t1), AGREE * size, HALVINGS);
}

/* The t at a length s. */
static double parameter(const struct bezier *b, const struct hodograph *h, double length, double s)
{
    int k = 0;

    while (k < BEZIER_PARTS - 1 && s >= b->upto[k]) {
        k++;
    }
    double low = (double)k / BEZIER_PARTS, high = (k + 1.0) / BEZIER_PARTS;
    const double from = k > 0 ? b->upto[k - 1] : 0.0;
    const double to = k < BEZIER_PARTS - 1 ? b->upto[k] : length;
    double t = low + (high - low) * el_max(0.0, el_min(1.0, (s - from) / (to - from)));
    double left = s - from - between(h, low, t, length);

    for (int i = 0; i < STEPS && fabs(left) > NEWTON * length; i++) {
        *(left > 0.0 ? &low : &high) = t;
        const double step = left / speed(h, t);
        const double next = t + step > low && t + step < high ? t + step : 0.5 * (low + high);
        if (next == t) {
            break;
        }
        left -= next > t ? between(h, t, next, length) : -between(h, next, t, length);
        t = next;
    }
    return t;
}

/* The quantity that is bounded: the share of an axis 0..2, the curvature k, or with |B'| = v
 *
 *     |P'''| <= |B'''| / v^3 + 4 k |B''| / v^2
 */
enum { CURVATURE = -1, TWIST = -2 };

static void cross(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) {
        c[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
}

static double twist(const struct hodograph *h, double k, double second, double v)
{
    return sqrt(dot(h->third, h->third)) / (v * v * v) + 4.0 * k * second / (v * v);
}

/* The quantity at the beginning of a part. */
static double value(const struct hodograph *h, int what)
{
    const double v = sqrt(dot(h->d[0], h->d[0]));
    double c[3];

    if (what >= 0) {
        return fabs(h->d[0][what]) / v;
    }
    cross(h->d[0], h->e[0], c);
    const double k = sqrt(dot(c, c)) / (v * v * v);
    return what == CURVATURE ? k : twist(h, k, sqrt(dot(h->e[0], h->e[0])), v);
}

/* A bound of the quantity in the part: control points of B' x B'' and of B' bound these. */
static double bound(const struct hodograph *h, int what)
{
    double along[3], most = 0.0, least = INFINITY;

    for (int i = 0; i < 3; i++) {
        along[i] = h->d[0][i] + 2.0 * h->d[1][i] + h->d[2][i];
    }
    const double size = sqrt(dot(along, along));
    for (int k = 0; k < 3; k++) {
        least = size > 0.0 ? el_min(least, dot(h->d[k], along) / size) : 0.0;
        most = what < 0 ? most : el_max(most, fabs(h->d[k][what]));
    }
    if (!(least > 0.0)) {
        return INFINITY;
    }
    if (what >= 0) {
        return most / least;
    }
    double c[2][3], sum[3];
    for (int n = 0; n < 4; n++) { /* B' x B'' has degree 3 */
        memset(c, 0, sizeof c);
        if (n < 3) {
            cross(h->d[n], h->e[0], c[0]);
        }
        if (n > 0) {
            cross(h->d[n - 1], h->e[1], c[1]);
        }
        for (int i = 0; i < 3; i++) {
            sum[i] = ((3 - n) * c[0][i] + n * c[1][i]) / 3.0;
        }
        most = el_max(most, sqrt(dot(sum, sum)));
    }
    const double k = most / (least * least * least);
    return what == CURVATURE
               ? k
               : twist(h, k, sqrt(el_max(dot(h->e[0], h->e[0]), dot(h->e[1], h->e[1]))), least);
}

/* Raise *top to a bound of the part from t0 to t1; *reached is the most that was seen so far. */
static void search(const struct hodograph *h, int what, double t0, double t1, int halvings,
                   double *reached, double *top)
{
    struct hodograph part;

    part_of(h, t0, t1, &part);
    *reached = el_max(*reached, value(&part, what));
    const double here = bound(&part, what);
    if (here <= *top || (what < 0 && *reached > TOO_MUCH)) {
        return;
    }
    if (here <= (1.0 + SLACK) * *reached || halvings == 0 || here < 1e-12) {
        *top = here;
        return;
    }
    const double middle = 0.5 * (t0 + t1);
    search(h, what, middle, t1, halvings - 1, reached, top);
    search(h, what, t0, middle, halvings - 1, reached, top);
}

static double highest(const struct hodograph *h, int what)
{
    struct hodograph end;
    double top = 0.0;

    part_of(h, 1.0, 1.0, &end);
    double reached = value(&end, what);
    search(h, what, 0.0, 1.0, HALVINGS, &reached, &top);
    return el_max(top, reached);
}

bool bezier_make(struct bezier *b, const double start[3], const double end[3], double *length)
{
    struct hodograph h;
    double size = 0.0;

    derivatives(b, start, end, &h);
    for (int k = 0; k < 3; k++) {
        size += sqrt(dot(h.d[k], h.d[k])) / 3.0;
    }
    *length = 0.0;
    if (!(size > 0.0) || !isfinite(size)) {
        return false;
    }
    b->bend = highest(&h, CURVATURE);
    if (!(b->bend < BEND_MAX)) {
        return false;
    }
    b->twist = highest(&h, TWIST);
    for (int k = 0; k < BEZIER_PARTS; k++) {
        *length += between(&h, (double)k / BEZIER_PARTS, (k + 1.0) / BEZIER_PARTS, size);
        if (k < BEZIER_PARTS - 1) {
            b->upto[k] = *length;
        }
    }
    return true;
}

static double place(const struct bezier *b, const double start[3], const double end[3], int i,
                    double t)
{
    const double u = 1.0 - t;
    return u * u * (u * start[i] + 3.0 * t * b->inner[0][i])
           + t * t * (3.0 * u * b->inner[1][i] + t * end[i]);
}

static double within(const struct bezier *b, const struct hodograph *h, double length, double s)
{
    return s >= length ? 1.0 : s <= 0.0 ? 0.0 : parameter(b, h, length, s);
}

void bezier_frame(const struct bezier *b, const double start[3], const double end[3], double length,
                  double s, double point[3], double slope[3], double bend[3])
{
    struct hodograph h;

    derivatives(b, start, end, &h);
    const double t = within(b, &h, length, s);
    velocity(&h, t, slope);
    const double v = sqrt(dot(slope, slope));
    for (int i = 0; i < 3; i++) {
        point[i] = place(b, start, end, i, t);
        slope[i] /= v;
        bend[i] = (h.e[0][i] + t * h.third[i]) / (v * v);
    }
    const double along = dot(bend, slope);
    for (int i = 0; i < 3; i++) {
        bend[i] -= along * slope[i];
    }
}

void bezier_at(const struct bezier *b, const double start[3], const double end[3], double length,
               double s, double point[3], double slope[3])
{
    double bend[3];
    bezier_frame(b, start, end, length, s, point, slope, bend);
}

void bezier_most(const struct bezier *b, const double start[3], const double end[3], double length,
                 double from, double to, double *bend, double *twist)
{
    struct hodograph h, part;

    derivatives(b, start, end, &h);
    part_of(&h, within(b, &h, length, from), within(b, &h, length, to), &part);
    *bend = el_min(b->bend, bound(&part, CURVATURE));
    *twist = el_min(b->twist, bound(&part, TWIST));
}

double bezier_share(const struct bezier *b, const double start[3], const double end[3], int axis)
{
    struct hodograph h;

    derivatives(b, start, end, &h);
    return el_min(1.0, highest(&h, axis));
}

void bezier_extent(const struct bezier *b, const double start[3], const double end[3],
                   double length, int axis, double from, double to, double *low, double *high)
{
    struct hodograph h;

    derivatives(b, start, end, &h);
    const double t0 = from <= 0.0 ? 0.0 : parameter(b, &h, length, el_min(from, length));
    const double t1 = to >= length ? 1.0 : parameter(b, &h, length, el_max(to, 0.0));
    /* B' = p t^2 + q t + r */
    const double r = h.d[0][axis], q = 2.0 * (h.d[1][axis] - r);
    const double p = h.d[2][axis] - 2.0 * h.d[1][axis] + r;
    const double under = q * q - 4.0 * p * r;
    const double half = -0.5 * (q + copysign(sqrt(el_max(0.0, under)), q));
    const double root[2] = { half / p, r / half }; /* neither loses digits */
    for (int k = 0; k < 2 && under >= 0.0; k++) {
        if (root[k] > t0 && root[k] < t1) {
            const double x = place(b, start, end, axis, root[k]);
            *low = el_min(*low, x);
            *high = el_max(*high, x);
        }
    }
}
