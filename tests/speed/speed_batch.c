/* Rides along chains of segments in one call, for tests/helpers/speed_rides.py. */
#include <math.h>
#include <string.h>

#include "speed_profile.h"

struct told {
    double kind;                          /* enum segment_kind */
    double feed, cap, acc, dec, jerk;     /* [mm/s], [mm/s^2], [mm/s^3] */
    double length;                        /* [mm] of a curve */
    double control[SEGMENT_POINTS][AXES]; /* line, arc: start, end, then centre X Y, ccw */
};

/* What the motion is at one moment, and axis by axis. */
struct sample {
    double way, rate, gain, twitch;
    double point[AXES], velocity[AXES], acc[AXES], jerk[AXES];
};

static struct speed_profile profile;
static struct segment segments[100000];
static double starts[100001];

/* Make the segments; returns the length of the chain. [mm] */
double speed_batch_segments(int64_t n, const struct told *told)
{
    for (int64_t i = 0; i < n; i++) {
        const struct told *t = &told[i];
        struct segment *p = &segments[i];
        struct path path;
        memset(p, 0, sizeof *p);
        p->kind = (enum segment_kind)(int)t->kind;
        p->feed = t->feed;
        p->cap = t->cap;
        p->ramp = (struct ramp_limits){ t->acc, t->dec, t->jerk, t->jerk };
        p->length = t->length;
        if (p->kind == SEGMENT_CURVE) {
            memcpy(p->origin, t->control[0], sizeof p->origin);
            for (int k = 0; k < SEGMENT_POINTS * AXES; k++) {
                p->control[k / AXES][k % AXES] =
                    t->control[k / AXES][k % AXES] - p->origin[k % AXES];
            }
        } else if (p->kind == SEGMENT_ARC) {
            double miss;
            path_arc(&p->path, PATH_XY, t->control[0], t->control[1], t->control[2],
                     t->control[2][2] > 0.0, 1, &miss);
            p->length = p->path.length;
        } else {
            path_line(&path, t->control[0], t->control[1]);
            p->length = path.length;
            path_at(&path, 0.0, p->start, p->slope);
        }
        starts[i + 1] = starts[i] + p->length;
    }
    return starts[n];
}

static void look(int64_t *segment, int64_t n, struct sample *s)
{
    struct segment_state state;
    struct segment_bounds b;

    while (*segment + 1 < n && profile.at.way >= starts[*segment + 1]) {
        ++*segment;
    }
    double u = profile.at.way - starts[*segment];
    u = u < 0.0 ? 0.0 : u > segments[*segment].length ? segments[*segment].length : u;
    segment_at(&segments[*segment], u, &state);
    s->way = profile.at.way;
    s->rate = profile.at.rate;
    s->gain = profile.at.gain;
    s->twitch = profile.at.twitch;
    const double from = fmin(u, (1.0 - 1e-9) * segments[*segment].length);
    segment_bounds(&segments[*segment], from, from + 1e-9 * segments[*segment].length, &b);
    for (int k = 0; k < AXES; k++) {
        s->point[k] = state.point[k];
        s->velocity[k] = state.slope[k] * profile.at.rate;
        s->jerk[k] = b.low[2][k] * profile.at.rate * profile.at.rate * profile.at.rate
                     + 3.0 * state.bend[k] * profile.at.rate * profile.at.gain
                     + state.slope[k] * profile.at.twitch;
        s->acc[k] =
            state.bend[k] * profile.at.rate * profile.at.rate + state.slope[k] * profile.at.gain;
    }
}

/* Ride along the n segments that were made, of which `ahead` are known at a time (besides the one
 * of the motion), with an override for each of `count` steps of dt; the last one goes on. Returns
 * the time to the end [s], or -1 if there is none or a step spends all it may without its time;
 * samples (or NULL) are taken after each step. */
double speed_batch_ride(int64_t n, const struct speed_limits *l, int64_t ahead, double dt,
                        int64_t count, const double *override, int64_t most, struct sample *s)
{
    int64_t joined = 0, at = 0;

    speed_profile_start(&profile, l);
    for (int64_t i = 0; i < most; i++) {
        while (at + 1 < n && profile.at.way >= starts[at + 1]) {
            at++;
        }
        while (joined < n && joined <= at + ahead
               && speed_profile_join(&profile, &segments[joined])) {
            starts[++joined] = profile.end;
        }
        const double left =
            speed_profile_advance(&profile, override[i < count ? i : count - 1], dt);
        if (s) {
            look(&at, n, &s[i]);
        }
        if (joined == n && speed_profile_at_end(&profile)) {
            return dt * (double)(i + 1) - left;
        }
        if (left > 0.0 && profile.at.left > 0.0) {
            return -1.0;
        }
    }
    return -1.0;
}

/* Where the ride would come to rest now. [mm] */
double speed_batch_stop_way(void)
{
    return speed_profile_stop_way(&profile);
}

/* Widest gap between the parts that the ride knows with limited jerk, or behind them. [mm] */
double speed_batch_gap(void)
{
    double widest = 0.0;

    for (int32_t i = 0; i < profile.count; i++) {
        const struct speed_box *g = &profile.ring[(profile.at.head + i) % SPEED_PROFILE_CELLS].box;
        const double next =
            i + 1 < profile.count
                ? profile.ring[(profile.at.head + i + 1) % SPEED_PROFILE_CELLS].box.from
                : profile.end;
        widest = fmax(widest, fabs(next - (g->from + g->length)));
    }
    return widest;
}

/* Go on with the ride as it is; returns the time left at its end, and the sample. [s] */
double speed_batch_go(int64_t n, double override, double dt, struct sample *s)
{
    int64_t at = 0;
    const double left = speed_profile_advance(&profile, override, dt);

    look(&at, n, s);
    return left;
}

/* The path at n ways. */
void speed_batch_path(int64_t segments_made, int64_t n, const double *way, struct segment_state *s)
{
    int64_t at = 0;

    for (int64_t i = 0; i < n; i++) {
        while (at + 1 < segments_made && way[i] >= starts[at + 1]) {
            at++;
        }
        segment_at(&segments[at], way[i] - starts[at], &s[i]);
    }
}

/* What a plan knows of a cell: its length [mm], the most x of the feed, of a = 0 within the limits,
 * at its start and its end [mm^2/s^2] (speed_cell.h), and its planes [s^2/mm^2]. */
struct known {
    double length, feed, flat, most, top, planes;
    double plane[SPEED_PLANES][2];
};

/* Plan the n segments, which must fit, from rest. */
static void plan_all(int64_t n, const struct speed_limits *l, double override)
{
    speed_profile_start(&profile, l);
    for (int64_t i = 0; i < n; i++) {
        speed_profile_join(&profile, &segments[i]);
    }
    speed_profile_advance(&profile, override, 0.0);
}

/* The cells of that plan without limited jerk, at most so many; returns their number. */
int64_t speed_batch_cells(int64_t n, const struct speed_limits *l, double override, int64_t most,
                          struct known *known)
{
    plan_all(n, l, override);
    const int64_t count = profile.count < most ? profile.count : most;
    for (int64_t i = 0; i < count; i++) {
        const struct speed_cell *c =
            &profile.ring[(profile.at.head + i) % SPEED_PROFILE_CELLS].cell;
        const double feed = fmin(c->feed * override, c->cap);
        known[i] = (struct known){ c->length, feed * feed, c->flat,    c->most,
                                   c->top,    c->planes,   { { 0.0 } } };
        memcpy(known[i].plane, c->plane, sizeof known[i].plane);
    }
    return count;
}

/* The nodes of that plan with limited jerk, at most so many; returns their number. */
int64_t speed_batch_nodes(int64_t n, const struct speed_limits *l, double override, int64_t most,
                          struct speed_node *node)
{
    plan_all(n, l, override);
    const struct speed_plan *plan = &profile.plan[profile.held];
    const int64_t count = SPEED_NODES - plan->first < most ? SPEED_NODES - plan->first : most;
    memcpy(node, plan->node + plan->first, (size_t)count * sizeof *node);
    return count;
}

/* The boxes of that plan: start and length [mm], the most x of the feed and of the limits
 * [mm^2/s^2]; returns their number. */
int64_t speed_batch_boxes(int64_t most, double (*box)[4])
{
    const int64_t count = profile.count < most ? profile.count : most;
    for (int64_t i = 0; i < count; i++) {
        const struct speed_box *g = &profile.ring[(profile.at.head + i) % SPEED_PROFILE_CELLS].box;
        const double row[4] = { g->from, g->length, g->feed * g->feed, g->cap * g->cap };
        memcpy(box[i], row, sizeof row);
    }
    return count;
}
