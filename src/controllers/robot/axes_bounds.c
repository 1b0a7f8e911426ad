#include "axes_bounds.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

enum {
    N = OPW_JOINTS,
    TERMS = 3, /* derivatives of the joints that are known */
    TRIES = 12 /* to find bounds that give themselves again */
};

/* Bounds are tried so much larger than what they gave. */
static const double LARGER = 1.2;

static const double MM = 1e-3; /* [m] */

/* A vector with its first and second derivative by the length of the path. */
struct course {
    double of[TERMS][3];
};

/* The arm in the middle of the part, and what holds all over it. */
struct stand {
    const struct axes_motion *motion;
    double inverse[N][6];  /* A [rad/mm], [1] */
    double weight[N][2];   /* lengths of the rows of A: for ways [rad/mm], for turns [1] */
    struct course axis[N]; /* of the joints */
    double arm[N][3];      /* [mm] from the joints to the tip */
    double link[N];        /* [mm] length from the joint before */
    double rate[TERMS][N]; /* q', q'', q''' */
    double first[N][N];    /* A J' */
    double second[N][N];   /* A J'' */
    double tip[TERMS + 1]; /* lengths of v, v', v'', v''' */
};

/* Bounds of the joints' derivatives all over the part. */
struct rates {
    double of[TERMS][N];
};

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

/* A, by elimination. False: J is singular. */
static bool invert(double j[6][2 * N], double inverse[N][6])
{
    static const double PIVOT = 1e-13;

    for (int k = 0; k < N; k++) {
        int best = k;
        for (int i = k + 1; i < N; i++) {
            best = fabs(j[i][k]) > fabs(j[best][k]) ? i : best;
        }
        if (!(fabs(j[best][k]) > PIVOT)) {
            return false;
        }
        for (int n = 0; n < 2 * N; n++) {
            const double x = j[k][n];
            j[k][n] = j[best][n];
            j[best][n] = x;
        }
        for (int i = 0; i < N; i++) {
            const double factor = i == k ? 0.0 : j[i][k] / j[k][k];
            for (int n = k; n < 2 * N; n++) {
                j[i][n] -= factor * j[k][n];
            }
        }
    }
    for (int k = 0; k < N; k++) {
        for (int n = 0; n < 6; n++) {
            inverse[k][n] = j[k][N + n] / j[k][k];
        }
    }
    return true;
}

static void add_cross(double factor, const double a[3], const double b[3], double sum[3])
{
    double c[3];

    cross3(a, b, c);
    for (int i = 0; i < 3; i++) {
        sum[i] += factor * c[i];
    }
}

/* The derivatives of a vector that turns with w, whose own derivative is w'. */
static void carried(const struct course *w, struct course *v)
{
    for (int n = 1; n < TERMS; n++) {
        memset(v->of[n], 0, sizeof v->of[n]);
    }
    add_cross(1.0, w->of[0], v->of[0], v->of[1]);
    add_cross(1.0, w->of[1], v->of[0], v->of[2]);
    add_cross(1.0, w->of[0], v->of[1], v->of[2]);
}

/* Rate of joint i at which the tip moves by a way and a turn: its row of A times both. */
static double by_inverse(const struct stand *s, int i, const double way[3], const double turn[3])
{
    double sum = 0.0;

    for (int k = 0; k < 3; k++) {
        sum += s->inverse[i][k] * way[k] + s->inverse[i][k + 3] * turn[k];
    }
    return sum;
}

/* Columns of the n-th derivative of J, times A. The first needs q', the second q'', too. */
static void columns(struct stand *s, int n, double product[N][N])
{
    struct course turning = { { { 0.0 } } }, origin = { { { 0.0 } } };

    for (int j = 0; j < N; j++) {
        struct course link = { { { 0.0 } } }, *axis = &s->axis[j];
        double away[TERMS][3], way[3] = { 0.0 };
        for (int i = 0; i < 3 && j > 0; i++) {
            link.of[0][i] = s->arm[j - 1][i] - s->arm[j][i];
        }
        carried(&turning, &link);
        carried(&turning, axis);
        for (int i = 0; i < 3; i++) {
            origin.of[1][i] += link.of[1][i];
            origin.of[2][i] += link.of[2][i];
            away[0][i] = s->arm[j][i];
            away[1][i] = s->motion->slope[i] - origin.of[1][i];
            away[2][i] = s->motion->bend[i] - origin.of[2][i];
        }
        for (int k = 0; k <= n; k++) { /* Leibniz: 1 1, 1 2 1 */
            add_cross(n == 2 && k == 1 ? 2.0 : 1.0, axis->of[n - k], away[k], way);
        }
        for (int i = 0; i < N; i++) {
            product[i][j] = by_inverse(s, i, way, axis->of[n]);
        }
        for (int i = 0; i < 3; i++) {
            turning.of[1][i] += s->rate[1][j] * axis->of[0][i] + s->rate[0][j] * axis->of[1][i];
            turning.of[0][i] += s->rate[0][j] * axis->of[0][i];
        }
    }
}

/* Derivatives of the joints in the middle. */
static void rates_of(struct stand *s)
{
    static const double none[3] = { 0.0, 0.0, 0.0 };
    const struct axes_motion *m = s->motion;

    for (int i = 0; i < N; i++) {
        s->rate[0][i] = by_inverse(s, i, m->slope, m->turn);
        s->rate[1][i] = 0.0;
    }
    columns(s, 1, s->first);
    for (int i = 0; i < N; i++) {
        s->rate[1][i] = by_inverse(s, i, m->bend, none);
        for (int j = 0; j < N; j++) {
            s->rate[1][i] -= s->first[i][j] * s->rate[0][j];
        }
    }
    columns(s, 2, s->second);
    for (int i = 0; i < N; i++) {
        s->rate[2][i] = by_inverse(s, i, m->twist, none);
        for (int j = 0; j < N; j++) {
            s->rate[2][i] -= 2.0 * s->first[i][j] * s->rate[1][j] + s->second[i][j] * s->rate[0][j];
        }
    }
}

/* The arm in the middle. Ways are in metres while J is inverted, so that its rows are of one
 * size. */
static bool stand_of(const struct manipulator *m, const double joint[N],
                     const struct axes_motion *motion, struct stand *s)
{
    double j[6][2 * N] = { { 0.0 } }, q[CHAIN_JOINTS] = { 0.0 };
    struct chain_axes axes;
    struct chain_pose end;

    s->motion = motion;
    memcpy(q, joint, N * sizeof *q);
    chain_axes_at(&m->axes.chain, q, &axes, &end);
    for (int i = 0; i < N; i++) {
        double way[3];
        memcpy(s->axis[i].of[0], axes.axis[i], sizeof axes.axis[i]);
        for (int k = 0; k < 3; k++) {
            s->arm[i][k] = motion->at[k] - axes.origin[i][k] / MM;
        }
        s->link[i] = i > 0 ? length3(m->axes.chain.joint[i].origin) / MM : 0.0;
        cross3(axes.axis[i], s->arm[i], way);
        for (int k = 0; k < 3; k++) {
            j[k][i] = MM * way[k];
            j[k + 3][i] = axes.axis[i][k];
        }
        j[i][N + i] = 1.0;
    }
    if (!invert(j, s->inverse)) {
        return false;
    }
    for (int i = 0; i < N; i++) {
        for (int k = 0; k < 3; k++) {
            s->inverse[i][k] *= MM;
        }
        s->weight[i][0] = length3(s->inverse[i]);
        s->weight[i][1] = length3(s->inverse[i] + 3);
    }
    s->tip[0] = length3(motion->slope);
    s->tip[1] = length3(motion->bend);
    s->tip[2] = length3(motion->twist);
    s->tip[3] = s->tip[2] * motion->swing;
    rates_of(s);
    return true;
}

/* Bounds of |A J'| and |A J''| all over the part: their middle, and half times how quickly columns
 * l_j = a_j x (tip - o_j) and a_j may change by their second and third derivatives. */
static void spread(const struct stand *s, const struct rates *r, double first[N][N],
                   double second[N][N])
{
    const double half = s->motion->half;
    const double *c = r->of[0], *d = r->of[1], *e = r->of[2];
    double w[3] = { 0.0 };      /* of the turning that carries joint j and its derivatives */
    double origin[3] = { 0.0 }; /* of the first to third derivative of where it is */

    for (int j = 0; j < N; j++) {
        const double turn[3] = { w[0], w[1] + w[0] * w[0],
                                 w[2] + 3.0 * w[0] * w[1] + w[0] * w[0] * w[0] };
        double away[4];
        for (int n = 0; n < 3; n++) {
            origin[n] += s->link[j] * turn[n];
            away[n + 1] = s->tip[n] + origin[n];
        }
        away[0] = length3(s->arm[j]) + half * away[1];
        const double way2 = turn[1] * away[0] + 2.0 * turn[0] * away[1] + away[2];
        const double way3 =
            turn[2] * away[0] + 3.0 * (turn[1] * away[1] + turn[0] * away[2]) + away[3];
        for (int i = 0; i < N; i++) {
            const double *a = s->weight[i];
            first[i][j] = fabs(s->first[i][j]) + half * (a[0] * way2 + a[1] * turn[1]);
            second[i][j] = fabs(s->second[i][j]) + half * (a[0] * way3 + a[1] * turn[2]);
        }
        w[2] += e[j] + 2.0 * d[j] * turn[0] + c[j] * turn[1];
        w[1] += d[j] + c[j] * turn[0];
        w[0] += c[j];
    }
}

/* What bounds give for the joints' derivatives. */
static void given(const struct stand *s, const struct rates *r, struct rates *next)
{
    const double half = s->motion->half;
    double first[N][N], second[N][N];

    spread(s, r, first, second);
    for (int i = 0; i < N; i++) {
        double sum[TERMS] = { s->weight[i][0] * half * s->tip[1], s->weight[i][0] * s->tip[1],
                              s->weight[i][0] * s->tip[2] };
        for (int j = 0; j < N; j++) {
            sum[0] += half * first[i][j] * r->of[0][j];
            sum[1] += first[i][j] * (r->of[0][j] + half * r->of[1][j]);
            sum[2] +=
                first[i][j] * (2.0 * r->of[1][j] + half * r->of[2][j]) + second[i][j] * r->of[0][j];
        }
        /* Each differs from its middle by the next one at most. */
        next->of[2][i] = sum[2];
        next->of[1][i] = el_min(sum[1], fabs(s->rate[1][i]) + half * r->of[2][i]);
        next->of[0][i] =
            el_min(fabs(s->rate[0][i]) + sum[0], fabs(s->rate[0][i]) + half * fabs(s->rate[1][i])
                                                     + 0.5 * half * half * r->of[2][i]);
    }
}

/* Bounds that give themselves again. */
static bool closed(const struct stand *s, struct rates *r)
{
    struct rates next;

    memcpy(r->of, s->rate, sizeof r->of);
    for (int n = 0; n < TERMS; n++) {
        for (int i = 0; i < N; i++) {
            r->of[n][i] = fabs(r->of[n][i]);
        }
    }
    for (int k = 0; k < TRIES; k++) {
        bool good = true;
        given(s, r, &next);
        for (int n = 0; n < TERMS; n++) {
            for (int i = 0; i < N; i++) {
                good = good && next.of[n][i] <= r->of[n][i];
                r->of[n][i] =
                    good || next.of[n][i] <= r->of[n][i] ? r->of[n][i] : LARGER * next.of[n][i];
            }
        }
        if (good) {
            *r = next;
            return true;
        }
    }
    return false;
}

bool axes_bounds_of(const struct manipulator *m, const double joint[N],
                    const struct axes_motion *motion, struct bounds *b)
{
    struct stand s;
    struct rates r, narrow;

    if (!stand_of(m, joint, motion, &s) || !closed(&s, &r)) {
        return false;
    }
    given(&s, &r, &narrow);
    for (int i = 0; i < N; i++) {
        b->most.slope[i] = narrow.of[0][i];
        b->most.bend[i] = narrow.of[1][i];
        b->middle.slope[i] = fabs(s.rate[0][i]);
        b->middle.bend[i] = fabs(s.rate[1][i]);
    }
    return true;
}
