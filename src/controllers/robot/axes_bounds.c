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

/* The arm in the middle of the part, and what holds all over it. A joint that slides counts in m
 * where others count in rad. */
struct stand {
    const struct axes_motion *motion;
    const struct chain *chain;
    int pivot[N];            /* joint whose link a linkage keeps from being tilted by it; -1 */
    double inverse[N][6];    /* A [rad/mm], [1] */
    double weight[N][2];     /* lengths of the rows of A: for ways [rad/mm], for turns [1] */
    struct course axis[N];   /* of the joints */
    struct course origin[N]; /* [mm] of the joints */
    double arm[N][3];        /* [mm] from the joints to the tip */
    double link[N];          /* [mm] length from the joint before */
    double slid[N];          /* [mm] way that the joint before has slid; 0 if it turns */
    double rate[TERMS][N];   /* q', q'', q''' */
    double first[N][N];      /* A J' */
    double second[N][N];     /* A J'' */
    double tip[TERMS + 1];   /* lengths of v, v', v'', v''' */
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

/* A, by elimination; of fewer than six joints a left inverse. False: J is singular. */
static bool invert(int joints, double j[6][2 * N], double inverse[N][6])
{
    static const double PIVOT = 1e-13;

    for (int k = 0; k < joints; k++) {
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
        for (int i = 0; i < 6; i++) {
            const double factor = i == k ? 0.0 : j[i][k] / j[k][k];
            for (int n = k; n < 2 * N; n++) {
                j[i][n] -= factor * j[k][n];
            }
        }
    }
    for (int k = 0; k < joints; k++) {
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

/* Courses of axes and origins. The first derivative needs q', the second q'', too. */
static void courses(struct stand *s)
{
    struct course turning[N + 1] = { { { { 0.0 } } } }; /* behind so many joints */

    for (int j = 0; j < s->chain->joints; j++) {
        const struct chain_joint *c = &s->chain->joint[j];
        const struct course *before = &turning[j - c->level];
        struct course link = { { { 0.0 } } }, *axis = &s->axis[j], *origin = &s->origin[j];
        for (int i = 0; i < 3 && j > 0; i++) {
            link.of[0][i] = s->arm[j - 1][i] - s->arm[j][i];
        }
        carried(&turning[j], &link);
        carried(before, axis);
        memset(origin, 0, sizeof *origin);
        for (int i = 0; i < 3 && j > 0; i++) {
            const struct course *slide = &s->axis[j - 1];
            const bool slides = s->chain->joint[j - 1].slides;
            const double first = slides ? s->rate[0][j - 1] / MM : 0.0;
            const double second = slides ? s->rate[1][j - 1] / MM : 0.0;
            origin->of[1][i] = origin[-1].of[1][i] + link.of[1][i] + first * slide->of[0][i];
            origin->of[2][i] = origin[-1].of[2][i] + link.of[2][i] + second * slide->of[0][i]
                               + 2.0 * first * slide->of[1][i];
        }
        turning[j + 1] = *before;
        for (int i = 0; i < 3 && !c->slides; i++) {
            turning[j + 1].of[1][i] +=
                s->rate[1][j] * axis->of[0][i] + s->rate[0][j] * axis->of[1][i];
            turning[j + 1].of[0][i] += s->rate[0][j] * axis->of[0][i];
        }
    }
}

/* The n-th derivative of column j of J. */
static void column(const struct stand *s, int n, int j, double way[3], double turn[3])
{
    static const double NEWTON[TERMS][TERMS] = { { 1 }, { 1, 1 }, { 1, 2, 1 } }; /* Leibniz */
    const struct course *axis = &s->axis[j];
    const int pivot = s->pivot[j];

    memset(way, 0, 3 * sizeof *way);
    memset(turn, 0, 3 * sizeof *turn);
    if (s->chain->joint[j].slides) {
        for (int i = 0; i < 3; i++) {
            way[i] = axis->of[n][i] / MM;
        }
        return;
    }
    for (int k = 0; k <= n; k++) {
        const double *tip = k == 1 ? s->motion->slope : s->motion->bend;
        double away[3];
        for (int i = 0; i < 3; i++) {
            const double to = pivot >= 0 ? s->origin[pivot].of[k][i] : tip[i];
            away[i] = k > 0        ? to - s->origin[j].of[k][i]
                      : pivot >= 0 ? s->arm[j][i] - s->arm[pivot][i]
                                   : s->arm[j][i];
        }
        add_cross(NEWTON[n][k], axis->of[n - k], away, way);
    }
    if (pivot < 0) {
        memcpy(turn, axis->of[n], 3 * sizeof *turn);
    }
}

/* Columns of the n-th derivative of J, times A. */
static void columns(struct stand *s, int n, double product[N][N])
{
    courses(s);
    for (int j = 0; j < s->chain->joints; j++) {
        double way[3], turn[3];
        column(s, n, j, way, turn);
        for (int i = 0; i < s->chain->joints; i++) {
            product[i][j] = by_inverse(s, i, way, turn);
        }
    }
}

/* Derivatives of the joints in the middle. */
static void rates_of(struct stand *s)
{
    static const double none[3] = { 0.0, 0.0, 0.0 };
    const struct axes_motion *m = s->motion;
    const int joints = s->chain->joints;

    for (int i = 0; i < joints; i++) {
        s->rate[0][i] = by_inverse(s, i, m->slope, m->turn);
        s->rate[1][i] = 0.0;
    }
    columns(s, 1, s->first);
    for (int i = 0; i < joints; i++) {
        s->rate[1][i] = by_inverse(s, i, m->bend, none);
        for (int j = 0; j < joints; j++) {
            s->rate[1][i] -= s->first[i][j] * s->rate[0][j];
        }
    }
    columns(s, 2, s->second);
    for (int i = 0; i < joints; i++) {
        s->rate[2][i] = by_inverse(s, i, m->twist, none);
        for (int j = 0; j < joints; j++) {
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
    const struct chain *c = &m->axes.chain;
    const double at[3] = { MM * motion->at[0], MM * motion->at[1], MM * motion->at[2] };
    struct chain_axes axes;
    struct chain_pose end;

    s->motion = motion;
    s->chain = c;
    memcpy(q, joint, N * sizeof *q);
    chain_axes_at(c, q, &axes, &end);
    for (int i = 0; i < c->joints; i++) {
        double moves[6];
        memcpy(s->axis[i].of[0], axes.axis[i], sizeof axes.axis[i]);
        for (int k = 0; k < 3; k++) {
            s->arm[i][k] = motion->at[k] - axes.origin[i][k] / MM;
        }
        s->pivot[i] = chain_levelled(c, i);
        s->link[i] = i > 0 ? length3(c->joint[i].origin) / MM : 0.0;
        s->slid[i] = i > 0 && c->joint[i - 1].slides ? fabs(q[i - 1]) / MM : 0.0;
        chain_column(c, &axes, i, at, moves);
        for (int k = 0; k < 6; k++) {
            j[k][i] = moves[k];
        }
    }
    for (int k = 0; k < 6; k++) {
        j[k][N + k] = 1.0;
    }
    if (!invert(c->joints, j, s->inverse)) {
        return false;
    }
    for (int i = 0; i < c->joints; i++) {
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

/* Bounds, all over the part, of a quantity's first, second and third derivative. */
struct thrice {
    double of[3];
};

/* The same of a turned vector by those of its turning. */
static struct thrice turned(const struct thrice *w)
{
    const double *a = w->of;
    return (struct thrice){ { a[0], a[1] + a[0] * a[0],
                              a[2] + 3.0 * a[0] * a[1] + a[0] * a[0] * a[0] } };
}

/* Bounds of how the origin of joint j moves, by those of the joint before it, whose link is turned
 * so. Its link changes its length if that joint slides. */
static struct thrice origin_of(const struct stand *s, const struct rates *r, int j,
                               const struct thrice *before, const struct thrice *turn)
{
    const bool slides = j > 0 && s->chain->joint[j - 1].slides;
    struct thrice o = *before;
    double slide[3] = { 0.0 };

    for (int n = 0; n < 3 && slides; n++) {
        slide[n] = r->of[n][j - 1] / MM;
    }
    const double length = s->link[j] + s->slid[j] + s->motion->half * slide[0];
    for (int n = 0; n < 3; n++) {
        o.of[n] += length * turn->of[n] + slide[n];
    }
    o.of[1] += 2.0 * turn->of[0] * slide[0];
    o.of[2] += 3.0 * (turn->of[1] * slide[0] + turn->of[0] * slide[1]);
    return o;
}

/* Bounds of |A J'| and |A J''| all over the part: their middle, and half times how quickly columns
 * l_j = a_j x (tip - o_j) and a_j, or of a slide a_j alone, may change by their second and third
 * derivatives. */
static void spread(const struct stand *s, const struct rates *r, double first[N][N],
                   double second[N][N])
{
    const double half = s->motion->half;
    const struct chain *c = s->chain;
    struct thrice w[N + 1] = { { { 0.0 } } }; /* of the turning behind so many joints */
    struct thrice turn[N];                    /* of the directions of the axes */
    struct thrice origin[N];                  /* of where the joints are */

    for (int j = 0; j < c->joints; j++) {
        static const struct thrice none = { { 0.0, 0.0, 0.0 } };
        const struct thrice link = turned(&w[j]), *before = &w[j - c->joint[j].level];
        origin[j] = origin_of(s, r, j, j > 0 ? &origin[j - 1] : &none, &link);
        turn[j] = turned(before);
        w[j + 1] = *before;
        if (!c->joint[j].slides) {
            const double a = r->of[0][j], b = r->of[1][j];
            w[j + 1].of[2] += r->of[2][j] + 2.0 * b * turn[j].of[0] + a * turn[j].of[1];
            w[j + 1].of[1] += b + a * turn[j].of[0];
            w[j + 1].of[0] += a;
        }
    }
    for (int j = 0; j < c->joints; j++) {
        const double *t = turn[j].of, *to = s->pivot[j] < 0 ? s->tip : origin[s->pivot[j]].of;
        const bool turns = s->pivot[j] < 0 && !c->joint[j].slides;
        double way2 = t[1] / MM, way3 = t[2] / MM, away[4], arm[3];
        if (!c->joint[j].slides) {
            for (int n = 0; n < 3; n++) {
                away[n + 1] = to[n] + origin[j].of[n];
                arm[n] = s->arm[j][n] - (s->pivot[j] < 0 ? 0.0 : s->arm[s->pivot[j]][n]);
            }
            away[0] = length3(arm) + half * away[1];
            way2 = t[1] * away[0] + 2.0 * t[0] * away[1] + away[2];
            way3 = t[2] * away[0] + 3.0 * (t[1] * away[1] + t[0] * away[2]) + away[3];
        }
        for (int i = 0; i < c->joints; i++) {
            const double *a = s->weight[i];
            first[i][j] = fabs(s->first[i][j]) + half * (a[0] * way2 + turns * a[1] * t[1]);
            second[i][j] = fabs(s->second[i][j]) + half * (a[0] * way3 + turns * a[1] * t[2]);
        }
    }
}

/* What bounds give for the joints' derivatives. */
static void given(const struct stand *s, const struct rates *r, struct rates *next)
{
    const double half = s->motion->half;
    const int joints = s->chain->joints;
    double first[N][N], second[N][N];

    spread(s, r, first, second);
    for (int i = 0; i < joints; i++) {
        double sum[TERMS] = { s->weight[i][0] * half * s->tip[1], s->weight[i][0] * s->tip[1],
                              s->weight[i][0] * s->tip[2] };
        for (int j = 0; j < joints; j++) {
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
    const int joints = s->chain->joints;
    struct rates next;

    memcpy(r->of, s->rate, sizeof r->of);
    for (int n = 0; n < TERMS; n++) {
        for (int i = 0; i < joints; i++) {
            r->of[n][i] = fabs(r->of[n][i]);
        }
    }
    for (int k = 0; k < TRIES; k++) {
        bool good = true;
        given(s, r, &next);
        for (int n = 0; n < TERMS; n++) {
            for (int i = 0; i < joints; i++) {
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
    const int joints = s.chain->joints;
    given(&s, &r, &narrow);
    memset(b, 0, sizeof *b); /* of joints that are not there */
    for (int i = 0; i < joints; i++) {
        b->most.slope[i] = narrow.of[0][i];
        b->most.bend[i] = narrow.of[1][i];
        b->middle.slope[i] = fabs(s.rate[0][i]);
        b->middle.bend[i] = fabs(s.rate[1][i]);
    }
    return true;
}
