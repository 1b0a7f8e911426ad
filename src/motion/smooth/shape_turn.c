#include "shape_turn.h"

#include <math.h>

/* Way over which the direction before and behind a corner is taken, in tolerances; where it really
 * turns, it does so over a third of it, too. */
static const double AROUND = 15.0, CLOSE = 1.0 / 3.0;

/* A corner is looked for once so much of the way behind it is known, in tolerances; within half of
 * that there is only one. */
static const double AHEAD = 30.0;

/* sin^2 of half the angle of a turn that is a corner before any spline has been tried: 53 degrees.
 * Measured: with 25 degrees an outline with radii of 0.4 mm takes 9 % longer. */
static const double SHARP = 0.2;

/* sin^2 of half of 25 degrees, the least turn; ratio of sin^2 where an angle is 0.6 of another. */
static const double TURN = 0.0468, SAME_TURN = 0.36;

/* sin^2 of half the angle at a vertex between its chords to the points so far away; 0 if it is not
 * above `least`. */
static double turn_at(const struct shape_run *r, int32_t v, double reach, double least)
{
    double in[AXES], out[AXES], dot = 0.0, aa = 0.0, bb = 0.0;
    int32_t a = v - 1, b = v + 1;

    while (a > 0 && r->vertex[v].s - r->vertex[a].s < reach) {
        a--;
    }
    while (b < r->vertices - 1 && r->vertex[b].s - r->vertex[v].s < reach) {
        b++;
    }
    /* on the chords a, a + 1 and b - 1, b */
    const struct shape_vertex *x = &r->vertex[a], *y = &r->vertex[b];
    double p = (r->vertex[v].s - reach - x->s) / (x[1].s - x->s);
    double q = (r->vertex[v].s + reach - y[-1].s) / (y->s - y[-1].s);
    p = p > 0.0 ? p : 0.0;
    q = q < 1.0 ? q : 1.0;
    for (int i = 0; i < AXES; i++) {
        in[i] = r->vertex[v].point[i] - (x->point[i] + p * (x[1].point[i] - x->point[i]));
        out[i] = y[-1].point[i] + q * (y->point[i] - y[-1].point[i]) - r->vertex[v].point[i];
        dot += in[i] * out[i];
        aa += in[i] * in[i];
        bb += out[i] * out[i];
    }
    const double cosine = 1.0 - 2.0 * least;
    if (!(aa > 0.0 && bb > 0.0) || (dot > 0.0 && dot * dot >= cosine * cosine * (aa * bb))) {
        return 0.0;
    }
    return 0.5 - 0.5 * dot / sqrt(aa * bb);
}

double shape_turn(const struct shape_run *r, int32_t v)
{
    const double reach = AROUND * r->vertex[v].tolerance;

    if (!r->vertex[v].joint) {
        return 0.0;
    }
    const double turn = turn_at(r, v, reach, TURN);
    return turn > TURN && turn_at(r, v, CLOSE * reach, SAME_TURN * turn) > SAME_TURN * turn ? turn
                                                                                            : 0.0;
}

int32_t shape_turn_most(const struct shape_run *r, int32_t vertex, int32_t end)
{
    const struct shape_vertex *v = r->vertex;
    const double reach = 0.5 * AHEAD * v[vertex].tolerance;
    int32_t best = vertex;
    double most = 0.0;

    for (int32_t k = 1; k < end; k++) {
        const double turn = fabs(v[k].s - v[vertex].s) < reach ? shape_turn(r, k) : 0.0;
        best = turn > most ? k : best;
        most = turn > most ? turn : most;
    }
    return best;
}

int32_t shape_turn_next(struct shape_run *r, int32_t *looked, bool waits, bool goes_on)
{
    const int32_t last = r->vertices - 1;

    for (int32_t v = *looked + 1; v < last; v++) {
        if (r->vertex[v].corner) {
            return v;
        }
        const double reach = 0.5 * AHEAD * r->vertex[v].tolerance;
        if (waits && r->vertex[last].s - r->vertex[v].s < 2.0 * reach) {
            return 0;
        }
        double most = shape_turn(r, v);
        if (most > SHARP) {
            int32_t best = v;
            for (int32_t k = v + 1; k < last && r->vertex[k].s < r->vertex[v].s + reach; k++) {
                if (r->vertex[k].corner) {
                    break;
                }
                const double turn = shape_turn(r, k);
                best = turn > most ? k : best;
                most = turn > most ? turn : most;
            }
            r->vertex[best].corner = true;
            return best;
        }
        *looked = v;
    }
    *looked = goes_on ? *looked : last;
    return 0;
}
