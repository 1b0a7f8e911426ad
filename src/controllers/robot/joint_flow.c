#include "joint_flow.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "shape_join.h"

/* So many pieces are free before a move is taken: its own, two where it is cut, one corner. */
enum { ROOM = JOINT_CURVE_PIECES + 3 };

/* At so many PLACES of a corner the tip is compared with so many (WAYS) of each of the two ways
 * that the corner replaces. Then the two steps about the worst place are divided into FINER parts,
 * for where the nearer way changes the distance has a peak. */
enum { PLACES = 64, WAYS = 24, FINER = 16 };

/* The largest corner is found by so many halvings, to a part of it. */
enum { HALVINGS = 10 };

/* Share of the zone that is used: the rest is for what lies between the places. */
static const double USED = 0.99;

/* Directions that differ by more turn back: the curve would come to a point. */
static const double BACK = 1.9;

/* Directions and bends that differ by less are the same. 1, [1/mm] */
static const double SAME = 1e-9;

/* A corner takes no less of a way than this, and a cut leaves no less of a line. [mm] */
static const double LEAST = 1e-3;

/* A cut leaves at least this part of a curve: a sliver's derivatives would be rounding. */
static const double SLIVER = 0.1;

/* A way of the tip this long has its direction. [mm] */
static const double NEAR = 1e-2;

/* A motion that has not got a next move for so many cycles, and will not get this much further [s]
 * before it has to brake, waits no longer. */
enum { GRACE = 2 };
static const double WAIT = 0.05;

static struct joint_flow_piece *piece_of(struct joint_flow *f, int64_t n)
{
    return &f->piece[n % JOINT_FLOW_PIECES];
}

static const struct joint_flow_piece *piece_at(const struct joint_flow *f, int64_t n)
{
    return &f->piece[n % JOINT_FLOW_PIECES];
}

void joint_flow_clear(struct joint_flow *f)
{
    f->made = f->joined = f->at = f->held = 0;
    f->open = false;
    f->base = 0.0;
    f->idle = 0;
    f->profile.count = 0;
}

bool joint_flow_busy(const struct joint_flow *f)
{
    return f->made > 0;
}

bool joint_flow_room(const struct joint_flow *f)
{
    return f->made - f->at + ROOM <= JOINT_FLOW_PIECES;
}

/* Give the speed profile the pieces that are known, up to one that ends at rest. */
static void join(struct joint_flow *f)
{
    const int64_t last = f->open ? f->held : f->made;

    while (!f->profile.closed && f->joined < last
           && speed_profile_join(&f->profile, &piece_at(f, f->joined)->curve)) {
        f->profile.closed = piece_at(f, f->joined)->curve.rest;
        f->joined++;
    }
}

/* A profile begins with the piece that comes next, at rest. */
static void set_out(struct joint_flow *f, const struct speed_limits *l)
{
    f->at = f->joined;
    f->base = 0.0;
    speed_profile_start(&f->profile, l);
}

/* The latest move ends at rest. */
static void close(struct joint_flow *f)
{
    f->open = false;
    piece_of(f, f->made - 1)->curve.rest = true;
}

/* A corner that is tried: `half` of the way before and behind it. */
struct corner {
    int64_t first, last; /* pieces that it cuts */
    double from, to;     /* [mm] where in these */
    struct segment curve;
};

/* The place `way` [mm] before the end of piece n (sign -1) or behind its start; *n goes to its
 * piece. */
static double find(const struct joint_flow *f, int64_t *n, double way, int sign)
{
    while (way > piece_at(f, *n)->curve.length && (sign < 0 || *n + 1 < f->made)) {
        way -= piece_at(f, *n)->curve.length;
        *n += sign;
    }
    const double length = piece_at(f, *n)->curve.length;
    return sign < 0 ? el_max(0.0, length - way) : el_min(way, length);
}

static void tip_of(const struct manipulator *arm, const struct segment *p, double u, double at[3])
{
    double joint[OPW_JOINTS];
    struct segment_state s;

    segment_at(p, u, &s);
    for (int i = 0; i < OPW_JOINTS; i++) {
        joint[i] = s.point[i] / JOINT_CURVE_LEVER;
    }
    const struct pose pose = manipulator_pose(arm, joint);
    memcpy(at, pose.at, sizeof pose.at);
}

/* Squared distance of a point from a chord. [mm^2] */
static double off_chord(const double x[3], const double a[3], const double b[3])
{
    double ww = 0.0, wf = 0.0, sum = 0.0;

    for (int i = 0; i < 3; i++) {
        ww += (b[i] - a[i]) * (b[i] - a[i]);
        wf += (b[i] - a[i]) * (x[i] - a[i]);
    }
    const double t = wf <= 0.0 ? 0.0 : wf >= ww ? 1.0 : wf / ww;
    for (int i = 0; i < 3; i++) {
        const double d = x[i] - a[i] - t * (b[i] - a[i]);
        sum += d * d;
    }
    return sum;
}

/* Squared distance of the tip, at a part of a curve, from the ways. [mm^2] */
static double off_ways(const struct manipulator *arm, const struct segment *p, double part,
                       double way[2 * WAYS + 1][3])
{
    double at[3], nearest = INFINITY;

    tip_of(arm, p, part * p->length, at);
    for (int i = 0; i < 2 * WAYS; i++) {
        nearest = el_min(nearest, off_chord(at, way[i], way[i + 1]));
    }
    return nearest;
}

/* How far the chords of the two ways that meet in a vertex leave them: an eighth of the largest
 * second difference of their places. [mm] */
static double sag(double way[2 * WAYS + 1][3])
{
    double most = 0.0;

    for (int k = 1; k < 2 * WAYS; k++) {
        double sum = 0.0;
        for (int i = 0; i < 3 && k != WAYS; i++) {
            const double d = way[k + 1][i] - 2.0 * way[k][i] + way[k - 1][i];
            sum += d * d;
        }
        most = el_max(most, sum);
    }
    return 0.125 * sqrt(most);
}

/* Whether the tip is within `off` of the ways that a corner replaces, and the joints within their
 * limits, or no further out than these ways. */
static bool within(const struct joint_flow *f, const struct manipulator *arm, int64_t vertex,
                   double half, double off, const struct corner *c)
{
    double way[2 * WAYS + 1][3], most = 0.0;
    int worst = 1;

    for (int k = 0; k <= 2 * WAYS; k++) {
        const double d = half * (k - WAYS) / WAYS;
        int64_t n = d < 0.0 ? vertex - 1 : vertex;
        const double u = find(f, &n, fabs(d), d < 0.0 ? -1 : 1);
        tip_of(arm, &piece_at(f, n)->curve, u, way[k]);
    }
    const double left = el_max(0.0, USED * off - sag(way)), limit = left * left;
    for (int k = 1; k < PLACES; k++) {
        const double d = off_ways(arm, &c->curve, (double)k / PLACES, way);
        if (d > most) {
            most = d;
            worst = k;
        }
    }
    for (int k = 1; k < 2 * FINER && most <= limit; k++) {
        const double part = (worst - 1 + (double)k / FINER) / PLACES;
        most = el_max(most, off_ways(arm, &c->curve, part, way));
    }
    if (!(most <= limit)) {
        return false;
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        const double low = JOINT_CURVE_LEVER * arm->joint[i].low;
        const double high = JOINT_CURVE_LEVER * arm->joint[i].high;
        const double a = c->curve.origin[i], b = a + c->curve.control[SEGMENT_POINTS - 1][i];
        for (int k = 1; k < SEGMENT_POINTS - 1; k++) {
            const double r = a + c->curve.control[k][i];
            if (r < el_min(low, el_min(a, b)) || r > el_max(high, el_max(a, b))) {
                return false;
            }
        }
    }
    return true;
}

/* A quintic from about `half` before a vertex, the start of a piece, to as much behind it. */
static bool attempt(const struct joint_flow *f, const struct manipulator *arm, int64_t vertex,
                    double half, double off, struct corner *c)
{
    struct segment_state a, b;

    c->first = vertex - 1;
    c->last = vertex;
    const double from = find(f, &c->first, half, -1), to = find(f, &c->last, half, 1);
    const struct segment *x = &piece_at(f, c->first)->curve, *y = &piece_at(f, c->last)->curve;
    c->from = x->kind == SEGMENT_CURVE ? el_max(from, SLIVER * x->length) : from;
    c->from = c->from < LEAST ? 0.0 : c->from;
    c->to = y->kind == SEGMENT_CURVE ? el_min(to, (1.0 - SLIVER) * y->length) : to;
    segment_at(x, c->from, &a);
    segment_at(y, c->to, &b);
    segment_between(&c->curve, &a, &b, 2.0 * half - (c->from - from) - (to - c->to));
    return within(f, arm, vertex, half, off, c);
}

/* Whether the way goes on smoothly through a vertex as it is. */
static bool smooth(const struct segment_state *in, const struct segment_state *out)
{
    bool same = true;

    for (int i = 0; i < OPW_JOINTS; i++) {
        same = same && fabs(out->slope[i] - in->slope[i]) <= SAME
               && fabs(out->bend[i] - in->bend[i]) <= SAME;
    }
    return same;
}

/* How far an arc of a radius leaves the tip's two ways that it joins at a vertex. [mm] */
static double off_arc(const struct joint_flow *f, const struct manipulator *arm, int64_t vertex,
                      double radius)
{
    const struct segment *in = &piece_at(f, vertex - 1)->curve, *out = &piece_at(f, vertex)->curve;
    double at[3], before[3], behind[3], a[3], b[3], cosine = 0.0, aa = 0.0, bb = 0.0;

    tip_of(arm, out, 0.0, at);
    tip_of(arm, in, in->length - el_min(NEAR, 0.5 * in->length), before);
    tip_of(arm, out, el_min(NEAR, 0.5 * out->length), behind);
    for (int i = 0; i < 3; i++) {
        a[i] = at[i] - before[i];
        b[i] = behind[i] - at[i];
        cosine += a[i] * b[i];
        aa += a[i] * a[i];
        bb += b[i] * b[i];
    }
    cosine = aa > 0.0 && bb > 0.0 ? el_max(-1.0, cosine / sqrt(aa * bb)) : 1.0;
    return radius * (1.0 - sqrt(el_max(0.0, 0.5 * (1.0 + cosine))));
}

/* The largest corner about a vertex, between these states, that keeps its zone; false: none. */
static bool corner(const struct joint_flow *f, const struct manipulator *arm, int64_t vertex,
                   double room, const struct segment_state *in, const struct segment_state *out,
                   struct corner *c)
{
    const double off = f->zone.radius > 0.0 ? off_arc(f, arm, vertex, f->zone.radius) : f->zone.off;
    double turn = 0.0, good = 0.0, bad = room;
    struct corner tried;

    for (int i = 0; i < OPW_JOINTS; i++) {
        turn += (out->slope[i] - in->slope[i]) * (out->slope[i] - in->slope[i]);
    }
    if (turn > BACK * BACK) {
        return false;
    }
    tried = *c;
    for (int k = 0; (k < HALVINGS || good <= 0.0) && good < room && bad > LEAST; k++) {
        const double half = k == 0 ? room : 0.5 * (good + bad);
        if (attempt(f, arm, vertex, half, off, &tried)) {
            good = half;
            *c = tried;
        } else {
            bad = half;
        }
    }
    return good > 0.0;
}

/* Take the least of the limits of the pieces that a corner cuts. */
static void obey(const struct joint_flow *f, struct corner *c)
{
    c->curve.feed = c->curve.cap = INFINITY;
    for (int64_t n = c->first; n <= c->last; n++) {
        c->curve.feed = el_min(c->curve.feed, piece_at(f, n)->curve.feed);
        c->curve.cap = el_min(c->curve.cap, piece_at(f, n)->curve.cap);
        for (int i = 0; i < 2; i++) {
            const double share = piece_at(f, n)->curve.share[i], so_far = c->curve.share[i];
            c->curve.share[i] = share <= 0.0    ? so_far
                                : so_far <= 0.0 ? share
                                                : el_min(share, so_far);
        }
    }
}

/* Put a corner in the place of what it cuts; the move before ends with it. */
static void insert(struct joint_flow *f, int64_t vertex, const struct corner *c)
{
    struct joint_flow_piece whole = *piece_at(f, c->last);
    struct joint_flow_piece middle = *piece_at(f, vertex);
    int64_t to = c->first;

    shape_cut(&piece_of(f, c->first)->curve, 0.0, c->from);
    to += c->from > 0.0;
    shape_cut(&whole.curve, c->to, whole.curve.length);
    const int64_t rest = f->made - c->last - 1, shift = to + 2 - (c->last + 1);
    middle.curve = c->curve;
    if (shift > 0) {
        for (int64_t n = rest - 1; n >= 0; n--) {
            *piece_of(f, c->last + 1 + n + shift) = *piece_at(f, c->last + 1 + n);
        }
    } else {
        for (int64_t n = 0; n < rest; n++) {
            *piece_of(f, c->last + 1 + n + shift) = *piece_at(f, c->last + 1 + n);
        }
    }
    *piece_of(f, to) = middle;
    *piece_of(f, to + 1) = whole;
    f->made += shift;
}

/* The last `way` of the latest move is kept back. */
static void hold_back(struct joint_flow *f, double way)
{
    int64_t n = f->made - 1;
    const double left = find(f, &n, way, -1), length = piece_at(f, n)->curve.length;

    f->open = true;
    f->held = n;
    if (left > LEAST && length - left > LEAST) {
        for (int64_t k = f->made; k > n; k--) {
            *piece_of(f, k) = *piece_at(f, k - 1);
        }
        f->made++;
        shape_cut(&piece_of(f, n)->curve, 0.0, left);
        shape_cut(&piece_of(f, n + 1)->curve, left, length);
        f->held = n + 1;
    }
}

/* Round the vertex, with what has been held back of the move before it, or rest there. */
static void round_off(struct joint_flow *f, const struct manipulator *arm, int64_t vertex,
                      double room)
{
    const struct segment *before = &piece_at(f, vertex - 1)->curve;
    struct corner c = { .curve = { .even = true, .joint = true } };
    struct segment_state in, out;

    segment_at(before, before->length, &in);
    segment_at(&piece_at(f, vertex)->curve, 0.0, &out);
    if (smooth(&in, &out)) {
        return;
    }
    if (corner(f, arm, vertex, room, &in, &out, &c)) {
        obey(f, &c);
        insert(f, vertex, &c);
    } else {
        piece_of(f, vertex - 1)->curve.rest = true;
    }
}

void joint_flow_add(struct joint_flow *f, const struct manipulator *arm,
                    const struct speed_limits *l, const struct joint_flow_move *move, int32_t count,
                    const struct segment *piece)
{
    const int64_t vertex = f->made;
    double length = 0.0;

    if (f->made == 0) {
        set_out(f, l);
    }
    for (int32_t n = 0; n < count; n++) {
        struct joint_flow_piece *p = piece_of(f, f->made++);
        *p = (struct joint_flow_piece){ piece[n], move->line, move->solved };
        memcpy(p->curve.share, move->share, sizeof move->share);
        length += piece[n].length;
    }
    if (f->open) {
        round_off(f, arm, vertex, el_min(f->room, f->zone.part * length));
    }
    f->open = false;
    f->idle = 0;
    f->zone = move->zone;
    f->room = move->zone.part * length;
    if (move->goes_on) {
        f->zone = (struct joint_flow_zone){ 0.0, 0.0, 0.0 };
        f->room = 0.0;
        f->open = true;
        f->held = f->made - 1;
    } else if (move->zone.off > 0.0 || move->zone.radius > 0.0) {
        hold_back(f, f->room);
    } else {
        close(f);
    }
}

static bool starves(const struct joint_flow *f)
{
    return f->open && f->idle > GRACE
           && speed_profile_nears_end(&f->profile, WAIT * f->profile.at.rate);
}

double joint_flow_advance(struct joint_flow *f, double override, double dt)
{
    if (starves(f)) {
        close(f);
    }
    f->idle++;
    join(f);
    dt = speed_profile_advance(&f->profile, override, dt);
    while (f->profile.closed && speed_profile_at_end(&f->profile) && f->joined < f->made && dt > 0.0
           && override > 0.0) {
        const struct speed_limits l = f->profile.limits;
        set_out(f, &l);
        join(f);
        dt = speed_profile_advance(&f->profile, override, dt);
    }
    return !f->open && f->joined == f->made && speed_profile_at_end(&f->profile) ? dt : 0.0;
}

const struct joint_flow_piece *joint_flow_joints(struct joint_flow *f, double joint[OPW_JOINTS])
{
    const double way = f->profile.at.way;
    struct segment_state s;

    while (way >= f->base + piece_at(f, f->at)->curve.length && f->at + 1 < f->joined) {
        f->base += piece_at(f, f->at++)->curve.length;
    }
    const struct joint_flow_piece *p = piece_at(f, f->at);
    segment_at(&p->curve, el_min(el_max(way - f->base, 0.0), p->curve.length), &s);
    for (int i = 0; i < OPW_JOINTS; i++) {
        joint[i] = s.point[i] / JOINT_CURVE_LEVER;
    }
    return p;
}

bool joint_flow_rests(const struct joint_flow *f)
{
    return f->profile.at.rate == 0.0;
}

bool joint_flow_feeds(const struct joint_flow *f, double share)
{
    return f->profile.at.rate >= share * piece_at(f, f->at)->curve.feed;
}
