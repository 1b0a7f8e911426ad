#include "jet.h"

#include <math.h>

#include "el_extremes.h"

/* Range of the products of two ranges. */
static struct jet_range times(struct jet_range a, struct jet_range b)
{
    const double p = a.low * b.low, q = a.low * b.high, r = a.high * b.low, s = a.high * b.high;
    return (struct jet_range){ el_min(el_min(p, q), el_min(r, s)),
                               el_max(el_max(p, q), el_max(r, s)) };
}

/* Range of the differences of two ranges. */
static struct jet_range less(struct jet_range a, struct jet_range b)
{
    return (struct jet_range){ a.low - b.high, a.high - b.low };
}

/* Range of the reciprocals of a range without 0. */
static struct jet_range inverse(struct jet_range a)
{
    return (struct jet_range){ 1.0 / a.high, 1.0 / a.low };
}

/* Narrow the ranges by the mean value theorem: f^(k) differs from its value in the middle by at
 * most h max|f^(k+1)|. With ck = f^(k) / k! that is (k + 1) h max|c(k+1)|. */
static struct jet narrowed(struct jet a)
{
    for (int k = JET_TERMS - 2; k >= 0; k--) {
        const double reach = (k + 1) * a.half * jet_most(&a.all[k + 1]);
        a.all[k].low = el_max(a.all[k].low, a.middle[k] - reach);
        a.all[k].high = el_min(a.all[k].high, a.middle[k] + reach);
    }
    return a;
}

struct jet jet_constant(double value, double half)
{
    return (struct jet){ half, { value }, { { value, value } } };
}

struct jet jet_sum(const struct jet *a, const struct jet *b)
{
    struct jet c = { .half = a->half };

    for (int k = 0; k < JET_TERMS; k++) {
        c.middle[k] = a->middle[k] + b->middle[k];
        c.all[k].low = a->all[k].low + b->all[k].low;
        c.all[k].high = a->all[k].high + b->all[k].high;
    }
    return narrowed(c);
}

struct jet jet_difference(const struct jet *a, const struct jet *b)
{
    struct jet c = { .half = a->half };

    for (int k = 0; k < JET_TERMS; k++) {
        c.middle[k] = a->middle[k] - b->middle[k];
        c.all[k] = less(a->all[k], b->all[k]);
    }
    return narrowed(c);
}

struct jet jet_scaled(const struct jet *a, double factor)
{
    const struct jet_range f = { factor, factor };
    struct jet c = { .half = a->half };

    for (int k = 0; k < JET_TERMS; k++) {
        c.middle[k] = a->middle[k] * factor;
        c.all[k] = times(a->all[k], f);
    }
    return c;
}

/* The k-th term of a product times a factor: factor * sum of a_i b_(k-i) for i = 0 .. k. */
static void term(const struct jet *a, const struct jet *b, int k, double factor, struct jet *c)
{
    const struct jet_range f = { factor, factor };
    struct jet_range all = { 0.0, 0.0 };
    double middle = 0.0;

    for (int i = 0; i <= k; i++) {
        const struct jet_range p = times(a->all[i], b->all[k - i]);
        middle += a->middle[i] * b->middle[k - i];
        all.low += p.low;
        all.high += p.high;
    }
    c->middle[k] = factor * middle;
    c->all[k] = times(all, f);
}

struct jet jet_product(const struct jet *a, const struct jet *b)
{
    struct jet c = { .half = a->half };

    for (int k = 0; k < JET_TERMS; k++) {
        term(a, b, k, 1.0, &c);
    }
    return narrowed(c);
}

/* Term by term from q b = a: q_k = (a_k - sum of q_i b_(k-i) for i < k) / b_0. */
struct jet jet_quotient(const struct jet *a, const struct jet *b, bool *good)
{
    struct jet q = { .half = a->half };

    if (!(b->all[0].low > 0.0 || b->all[0].high < 0.0)) {
        *good = false;
        return q;
    }
    const struct jet_range per = inverse(b->all[0]);
    for (int k = 0; k < JET_TERMS; k++) {
        struct jet_range rest = a->all[k];
        double left = a->middle[k];
        for (int i = 0; i < k; i++) {
            left -= q.middle[i] * b->middle[k - i];
            rest = less(rest, times(q.all[i], b->all[k - i]));
        }
        q.middle[k] = left / b->middle[0];
        q.all[k] = times(rest, per);
    }
    return narrowed(q);
}

/* Term by term from r r = a: r_k = (a_k - sum of r_i r_(k-i) for 0 < i < k) / (2 r_0). */
struct jet jet_root(const struct jet *a, bool *good)
{
    struct jet r = { .half = a->half };

    if (!(a->all[0].low > 0.0)) {
        *good = false;
        return r;
    }
    r.middle[0] = sqrt(a->middle[0]);
    r.all[0] = (struct jet_range){ sqrt(a->all[0].low), sqrt(a->all[0].high) };
    const struct jet_range twice = { 2.0 * r.all[0].low, 2.0 * r.all[0].high };
    const struct jet_range per = inverse(twice);
    for (int k = 1; k < JET_TERMS; k++) {
        struct jet_range rest = a->all[k];
        double left = a->middle[k];
        for (int i = 1; i < k; i++) {
            left -= r.middle[i] * r.middle[k - i];
            rest = less(rest, times(r.all[i], r.all[k - i]));
        }
        r.middle[k] = left / (2.0 * r.middle[0]);
        r.all[k] = times(rest, per);
    }
    return narrowed(r);
}

struct jet jet_rate(const struct jet *a)
{
    struct jet r = { .half = a->half };
    const int last = JET_TERMS - 1;

    for (int k = 0; k < last; k++) {
        r.middle[k] = (k + 1) * a->middle[k + 1];
        r.all[k].low = (k + 1) * a->all[k + 1].low;
        r.all[k].high = (k + 1) * a->all[k + 1].high;
    }
    r.all[last] = (struct jet_range){ -INFINITY, INFINITY };
    return r;
}

/* The derivative of atan2(y, x): (x y' - y x') / (x^2 + y^2). */
struct jet jet_angle_rate(const struct jet *x, const struct jet *y, bool *good)
{
    const struct jet dx = jet_rate(x), dy = jet_rate(y);
    const struct jet forth = jet_product(x, &dy), back = jet_product(y, &dx);
    const struct jet xx = jet_product(x, x), yy = jet_product(y, y);
    const struct jet cross = jet_difference(&forth, &back), square = jet_sum(&xx, &yy);

    return jet_quotient(&cross, &square, good);
}

/* Term by term from c' = -w s and s' = w c, with w the derivative of the angle. */
void jet_direction(double cosine, double sine, const struct jet *rate, struct jet out[2])
{
    const double middle[2] = { cosine, sine }, reach = rate->half * jet_most(&rate->all[0]);

    for (int i = 0; i < 2; i++) {
        out[i] = jet_constant(middle[i], rate->half);
        out[i].all[0].low = el_max(-1.0, middle[i] - reach);
        out[i].all[0].high = el_min(1.0, middle[i] + reach);
    }
    for (int k = 0; k + 1 < JET_TERMS; k++) {
        struct jet next[2];
        term(rate, &out[1], k, -1.0 / (k + 1), &next[0]);
        term(rate, &out[0], k, 1.0 / (k + 1), &next[1]);
        for (int i = 0; i < 2; i++) {
            out[i].middle[k + 1] = next[i].middle[k];
            out[i].all[k + 1] = next[i].all[k];
        }
    }
    out[0] = narrowed(out[0]);
    out[1] = narrowed(out[1]);
}

static void cross3(const double a[3], const double b[3], double c[3])
{
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        c[i] = a[j] * b[k] - a[k] * b[j];
    }
}

static double length3(const double a[3])
{
    return sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/* The k-th derivative of a vector that turns evenly is turn x .. x turn x v, whose length is the
 * same all over the part. */
void jet_turning(const double at[3], const double turn[3], double half, struct jet out[3])
{
    const double rate = length3(turn);
    double now[3] = { at[0], at[1], at[2] }, next[3], part = 1.0, most = 0.0;

    for (int k = 0; k < JET_TERMS; k++) {
        cross3(turn, now, next);
        most = k == 0 ? length3(next) : most * rate;
        for (int i = 0; i < 3; i++) {
            out[i].half = half;
            out[i].middle[k] = part * now[i];
            out[i].all[k].low = part * (now[i] - half * most);
            out[i].all[k].high = part * (now[i] + half * most);
            now[i] = next[i];
        }
        part /= k + 1;
    }
}

double jet_most(const struct jet_range *r)
{
    return el_max(fabs(r->low), fabs(r->high));
}
