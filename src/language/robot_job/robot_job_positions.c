/* robot_job_positions - the positions that stand in a pendant's job, between //POS and //INST. */
#include "robot_job_reading.h"

#define PULSES_MAX 1e9      /* [pulses] */
#define PLACE_MAX  100000.0 /* [mm] */
#define ANGLE_MAX  360.0    /* [deg] */
#define JOINT_MAX  3600.0   /* [deg] */

enum { AXES = 6, ROBOT_OF_ALL = -1 };

void robot_job_positions_begin(struct robot_job_reading *in)
{
    in->kind = ROBOT_JOB_PULSES;
    in->position = robot_job_point_open();
    in->in_user = false;
}

/* ///TOOL n, ///USER n: read the number of a frame that the points file has. */
static int take_frame(struct robot_job_reading *in, const struct robot_job_frame *frames,
                      int32_t *number)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    struct robot_job_span at = { s->at, 0 };
    if (robot_job_scan_whole(s, 0, ROBOT_JOB_FRAMES - 1, number)) {
        return -1;
    }
    at.length = s->at - at.at;
    s->at = s->end; /* other tools of other robots follow */
    return frames[*number].defined ? 0 : robot_job_scan_fault(s, ROBOT_JOB_BAD_FRAME, at);
}

/* ///POSTYPE PULSE, BASE, ROBOT or USER; ANGLE, and JOINT, which no pendant writes: degrees. */
static int take_type(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    const struct robot_job_span w = robot_job_scan_word(s);
    const bool angles = robot_job_scan_is(s, w, "JOINT") || robot_job_scan_is(s, w, "ANGLE");
    in->kind = robot_job_scan_is(s, w, "PULSE") ? ROBOT_JOB_PULSES
               : angles                         ? ROBOT_JOB_JOINTS
                                                : ROBOT_JOB_POSE;
    in->in_user = robot_job_scan_is(s, w, "USER");
    if (w.length == 0) {
        return robot_job_scan_unexpected(s);
    }
    return in->kind != ROBOT_JOB_POSE || in->in_user || robot_job_scan_is(s, w, "BASE")
                   || robot_job_scan_is(s, w, "ROBOT")
               ? 0
               : robot_job_scan_fault(s, ROBOT_JOB_BAD_LACKING, w);
}

/* ///RCONF flip, lower arm, rear, turns of joints 4, 6, 1, and more that nobody uses. A turn other
 * than 0 is one to either side, which is nearer. */
static int take_configuration(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_point *p = &in->position;
    static const int TURN[3] = { 1, 2, 0 }; /* places of joints 4, 6, 1 in turn[] */
    int32_t value[AXES];
    for (int i = 0; i < AXES; i++) {
        if (i > 0 && !robot_job_scan_take(s, ',')) {
            return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_CONFIGURATION);
        }
        if (robot_job_scan_whole(s, i < 3 ? 0 : -ROBOT_JOB_TURN_MAX, i < 3 ? 1 : ROBOT_JOB_TURN_MAX,
                                 &value[i])) {
            return -1;
        }
    }
    p->wrist = value[0] == 0 ? ROBOT_JOB_WRIST_NEAR : ROBOT_JOB_WRIST_FAR;
    p->elbow = value[1];
    p->shoulder = value[2];
    for (int i = 0; i < 3; i++) {
        p->turn[TURN[i]] = value[3 + i] == 0 ? 0 : ROBOT_JOB_ANY_TURN;
    }
    s->at = s->end;
    return 0;
}

int robot_job_positions_word(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    s->at = s->begin + s->slashes;
    const struct robot_job_span w = robot_job_scan_word(s);
    if (s->slashes == 2) {
        in->section = robot_job_scan_is(s, w, "POS")    ? ROBOT_JOB_POSITIONED
                      : robot_job_scan_is(s, w, "INST") ? ROBOT_JOB_INSIDE
                                                        : ROBOT_JOB_SKIPPED;
        return 0;
    }
    if (in->section != ROBOT_JOB_POSITIONED) {
        return 0; /* a comment elsewhere */
    }
    if (robot_job_scan_is(s, w, "TOOL")) {
        return take_frame(in, in->points->tool, &in->position.tool);
    }
    if (robot_job_scan_is(s, w, "USER")) {
        return take_frame(in, in->points->user, &in->position.user);
    }
    if (robot_job_scan_is(s, w, "POSTYPE")) {
        return take_type(in);
    }
    if (robot_job_scan_is(s, w, "RCONF")) {
        return take_configuration(in);
    }
    in->kind = robot_job_scan_is(s, w, "PULSE")   ? ROBOT_JOB_PULSES
               : robot_job_scan_is(s, w, "ANGLE") ? ROBOT_JOB_JOINTS
                                                  : ROBOT_JOB_POSE;
    return 0;
}

/* Number of a position of an axis outside the arm, or with NO_AXIS of the arm; -1: there is
 * none. */
static int32_t find(const struct robot_job_reading *in, enum robot_job_outside outside, bool own,
                    int32_t number)
{
    const struct robot_job_program *p = in->p;
    const int32_t job = own ? p->jobs - 1 : ROBOT_OF_ALL;
    for (int32_t i = p->positions; i > 0; i--) {
        const struct robot_job_position *q = &p->position[i - 1];
        if (q->job == job && q->number == number && q->outside == outside) {
            return ROBOT_JOB_POINTS + i - 1;
        }
    }
    return -1;
}

int32_t robot_job_positions_find(const struct robot_job_reading *in, char letter, int32_t number)
{
    return find(in, ROBOT_JOB_NO_AXIS, letter == 'C', number);
}

enum robot_job_outside robot_job_positions_outside(const struct robot_job_scan *s,
                                                   struct robot_job_span w, bool *own,
                                                   int32_t *number)
{
    static const struct {
        char word[3];
        enum robot_job_outside outside;
        bool own;
    } KIND[4] = { { "BC", ROBOT_JOB_BASE_AXIS, true },
                  { "BP", ROBOT_JOB_BASE_AXIS, false },
                  { "EC", ROBOT_JOB_STATION_AXIS, true },
                  { "EX", ROBOT_JOB_STATION_AXIS, false } };
    const struct robot_job_span two = { w.at, 2 }, rest = { w.at + 1, w.length - 1 };
    for (int i = 0; i < 4 && w.length > 2; i++) {
        *number = robot_job_scan_is(s, two, KIND[i].word) ? robot_job_scan_digits(s, rest) : -1;
        if (*number >= 0) {
            *own = KIND[i].own;
            return KIND[i].outside;
        }
    }
    return ROBOT_JOB_NO_AXIS;
}

int robot_job_positions_beside(struct robot_job_reading *in, struct robot_job_span w,
                               struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    int32_t number;
    bool own;
    const enum robot_job_outside outside = robot_job_positions_outside(s, w, &own, &number);
    if (outside != in->points->outside || c->increment != ROBOT_JOB_NOT_BY) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_OTHER_AXES, w);
    }
    if (c->beside >= 0) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
    }
    c->beside = find(in, outside, own, number);
    if (c->beside < 0) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_POSITION, w);
    }
    return in->p->position[c->beside - ROBOT_JOB_POINTS].more
               ? robot_job_scan_fault(s, ROBOT_JOB_BAD_OTHER_AXES, w)
               : 0;
}

/* Read the values of a position behind its =. */
static int take_values(struct robot_job_reading *in, struct robot_job_point *p)
{
    struct robot_job_scan *s = &in->s;
    for (int i = 0; i < AXES; i++) {
        const double most = in->kind == ROBOT_JOB_PULSES   ? PULSES_MAX
                            : in->kind == ROBOT_JOB_JOINTS ? JOINT_MAX
                            : i < 3                        ? PLACE_MAX
                                                           : ANGLE_MAX;
        if (i > 0 && !robot_job_scan_take(s, ',')) {
            return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_AXES);
        }
        if (robot_job_scan_number(s, -most, most, &p->value[i])) {
            return -1;
        }
    }
    return robot_job_scan_over(s) ? 0 : robot_job_scan_fault_line(s, ROBOT_JOB_BAD_AXES);
}

/* Read the places of axes outside the arm behind the =. */
static int take_places(struct robot_job_reading *in, struct robot_job_position *q)
{
    struct robot_job_scan *s = &in->s;
    const double most = in->kind == ROBOT_JOB_PULSES ? PULSES_MAX : PLACE_MAX;
    q->point.beside = true;
    if (robot_job_scan_number(s, -most, most, &q->point.external)) {
        return -1;
    }
    for (int i = 1; i < AXES && robot_job_scan_take(s, ','); i++) {
        double further;
        if (robot_job_scan_number(s, -most, most, &further)) {
            return -1;
        }
        q->more = q->more || further != 0.0;
    }
    return robot_job_scan_over(s) ? 0 : robot_job_scan_unexpected(s);
}

/* Whether two points mean the same, wherever they are written. */
static bool same(const struct robot_job_point *a, const struct robot_job_point *b)
{
    bool good = a->kind == b->kind && a->shoulder == b->shoulder && a->elbow == b->elbow
                && a->wrist == b->wrist && a->tool == b->tool && a->user == b->user
                && a->external == b->external;
    for (int i = 0; i < AXES; i++) {
        good &= a->value[i] == b->value[i];
    }
    return good;
}

/* Keep a position. One of all jobs may be in several files, as pendants write it, but is one. */
static int keep(struct robot_job_reading *in, struct robot_job_span w,
                const struct robot_job_position *q)
{
    struct robot_job_program *p = in->p;
    struct robot_job_scan *s = &in->s;
    const int32_t before = find(in, q->outside, q->job >= 0, q->number);
    if (before >= 0) {
        const struct robot_job_point *other = &p->position[before - ROBOT_JOB_POINTS].point;
        return q->job < 0 && same(other, &q->point)
                   ? 0
                   : robot_job_scan_fault(s, ROBOT_JOB_BAD_POINT_TWICE, w);
    }
    if (q->job < 0 && q->outside == ROBOT_JOB_NO_AXIS && q->number < ROBOT_JOB_POINTS
        && in->points->point[q->number].kind != ROBOT_JOB_NO_POINT) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_POINT_TWICE, w);
    }
    if (p->positions == ROBOT_JOB_POSITIONS) {
        s->r->high = ROBOT_JOB_POSITIONS;
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_TOO_MANY);
    }
    p->position[p->positions++] = *q;
    return 0;
}

/* CCN 18: a line is one of the arm, one of an axis outside, or no position. */
int robot_job_positions_line(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    if (in->section == ROBOT_JOB_SKIPPED) {
        return 1;
    }
    const struct robot_job_span w = robot_job_scan_word(s);
    if (w.length == 0 || !robot_job_scan_take(s, '=')) {
        s->at = s->begin;
        in->section = ROBOT_JOB_INSIDE; /* instructions without //INST in front of them */
        return 0;
    }
    const bool own = robot_job_scan_is(s, (struct robot_job_span){ w.at, 1 }, "C");
    struct robot_job_position q = { .job = own ? in->p->jobs - 1 : ROBOT_OF_ALL,
                                    .number = robot_job_scan_digits(s, w),
                                    .point = in->position };
    int32_t number;
    bool outside_own;
    q.outside = robot_job_positions_outside(s, w, &outside_own, &number);
    if (q.outside != ROBOT_JOB_NO_AXIS && q.outside == in->points->outside) {
        q.job = outside_own ? in->p->jobs - 1 : ROBOT_OF_ALL;
        q.number = number;
        q.point.kind = in->kind;
        q.point.line = s->line;
        return take_places(in, &q) || keep(in, w, &q) ? -1 : 1;
    }
    q.outside = ROBOT_JOB_NO_AXIS;
    if (q.number < 0 || !(own || robot_job_scan_is(s, (struct robot_job_span){ w.at, 1 }, "P"))) {
        return 1; /* of axes outside the arm: a move that goes there is refused */
    }
    q.point.kind = in->kind;
    q.point.line = s->line;
    q.point.user = in->kind == ROBOT_JOB_POSE && !in->in_user ? 0 : q.point.user;
    if (in->kind != ROBOT_JOB_POSE) {
        q.point.shoulder = q.point.elbow = q.point.wrist = ROBOT_JOB_ANY;
        q.point.turn[0] = q.point.turn[1] = q.point.turn[2] = ROBOT_JOB_ANY_TURN;
    }
    return take_values(in, &q.point) || keep(in, w, &q) ? -1 : 1;
}
