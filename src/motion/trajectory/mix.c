#include "mix.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

void mix_begin(struct mix *x, const struct command *c, double override)
{
    struct mix_move *m = &x->move[x->count++];
    m->command = *c;
    command_start(&m->command, override, &m->profile);
}

void mix_retire(struct mix *x)
{
    if (--x->count) {
        x->move[0] = x->move[1];
    }
}

void mix_replan(struct mix *x, double override)
{
    struct mix_move *m = &x->move[x->count - 1];
    if (x->count > 0 && m->command.type != COMMAND_DELAY) {
        const struct profile_limits l = { command_speed(&m->command, override), m->command.ramp };
        const struct scurve_start now = profile_state(&m->profile);
        profile_plan(&m->profile, &now, m->command.path.length, &l);
    }
}

bool mix_open(const struct mix *x)
{
    const struct mix_move *m = &x->move[0];
    return x->count == 1 && m->command.blend && m->profile.ends && command_blends(&m->command);
}

void mix_shift(struct mix *x, double dt)
{
    for (int i = 0; i < x->count; i++) {
        x->move[i].profile.t += dt;
    }
}

void mix_place(const struct mix *x, const double rest[AXES], double point[AXES],
               double velocity[AXES])
{
    memcpy(point, rest, AXES * sizeof *point);
    memset(velocity, 0, AXES * sizeof *velocity);
    for (int i = 0; i < x->count; i++) {
        const struct mix_move *m = &x->move[i];
        const struct scurve_start now = profile_state(&m->profile);
        double at[AXES], slope[AXES];
        path_at(&m->command.path, now.s, at, slope);
        for (int k = 0; k < AXES; k++) {
            point[k] = i == 0 ? at[k] : point[k] + (at[k] - m->command.path.start[k]);
            velocity[k] += now.v * slope[k];
        }
    }
}

static bool move_rests(const struct mix_move *m)
{
    return !m->profile.ends && profile_left(&m->profile) <= 0.0;
}

bool mix_rests(const struct mix *x, bool held)
{
    for (int i = 0; i < x->count; i++) {
        const struct mix_move *m = &x->move[i];
        if (m->command.type == COMMAND_DELAY ? !held : !move_rests(m)) {
            return false;
        }
    }
    return true;
}

bool mix_moves(const struct mix *x)
{
    for (int i = 0; i < x->count; i++) {
        if (x->move[i].command.type != COMMAND_DELAY && !move_rests(&x->move[i])) {
            return true;
        }
    }
    return false;
}

double mix_left(const struct mix *x)
{
    double left = 0.0;
    for (int i = 0; i < x->count; i++) {
        left = el_max(left, profile_left(&x->move[i].profile));
    }
    return left;
}

void mix_extent(const struct mix *x, const double rest[AXES], double low[AXES], double high[AXES])
{
    memcpy(low, rest, AXES * sizeof *low);
    memcpy(high, rest, AXES * sizeof *high);
    for (int i = 0; i < x->count; i++) {
        const struct path *way = &x->move[i].command.path;
        struct profile left = x->move[i].profile;
        const double s = profile_state(&left).s;
        left.t = left.total;
        const double end = profile_state(&left).s;
        for (int k = 0; k < AXES; k++) {
            double a, b;
            path_extent(way, k, s, end, &a, &b);
            low[k] = i == 0 ? a : low[k] + (a - way->start[k]);
            high[k] = i == 0 ? b : high[k] + (b - way->start[k]);
        }
    }
}

struct limited mix_limited(const struct mix *x, const struct mechanism *m)
{
    const struct mix_move *newest = &x->move[x->count - 1];
    const struct scurve_start now = profile_state(&newest->profile);
    double at[AXES], slope[AXES];

    if (newest->command.type == COMMAND_DELAY) {
        return (struct limited){ .by = LIMITED_DWELL };
    }
    path_at(&newest->command.path, now.s, at, slope);
    struct limited told = limited_profile(&newest->profile, limited_speed(m, slope, now.v));
    told.feed = newest->command.feed;
    return told;
}
