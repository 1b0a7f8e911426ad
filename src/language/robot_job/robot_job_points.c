#include "robot_job_scan.h"

#include <math.h>
#include <string.h>

#include "robot_job_decimal.h"

#define JOINT_MAX 3600.0   /* [deg] ten turns: no arm's limit */
#define PLACE_MAX 100000.0 /* [mm] */
#define ANGLE_MAX 360.0    /* [deg] */

enum { COORDINATES = 0x3f }; /* all six are given */

static const char AXES[] = "XYZABC";
static const int TURNS[3] = { 1, 4, 6 }; /* joints */

/* Words of a configuration; those with an even index mean 0, the others 1. */
static const struct {
    char word[8];
} FLAGS[6] = { { "FRONT" }, { "BACK" }, { "UP" }, { "DOWN" }, { "NOFLIP" }, { "FLIP" } };

void robot_job_points_clear(struct robot_job_points *p, enum robot_job_outside outside)
{
    memset(p, 0, sizeof *p);
    p->outside = outside;
    p->tool[0].defined = p->user[0].defined = true;
}

static double coordinate_max(int32_t axis)
{
    return axis < 3 ? PLACE_MAX : ANGLE_MAX;
}

/* Index of a coordinate by its letter; -1: it is none. */
static int32_t axis_of(const struct robot_job_scan *s, struct robot_job_span w)
{
    for (int32_t i = 0; i < 6; i++) {
        const char letter[2] = { AXES[i], '\0' };
        if (robot_job_scan_is(s, w, letter)) {
            return i;
        }
    }
    return -1;
}

/* Take =value of coordinate or joint i; `seen` has a bit for each one given. */
static int take_value(struct robot_job_scan *s, struct robot_job_span w, int32_t i, double most,
                      int32_t *seen, double *value)
{
    if (*seen & 1 << i) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
    }
    *seen |= 1 << i;
    return robot_job_scan_take(s, '=') ? robot_job_scan_number(s, -most, most, value)
                                       : robot_job_scan_unexpected(s);
}

static int take_whole(struct robot_job_scan *s, struct robot_job_span w, int32_t low, int32_t high,
                      int32_t *value)
{
    if (*value != (low < 0 ? ROBOT_JOB_ANY_TURN : ROBOT_JOB_ANY)) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
    }
    return robot_job_scan_take(s, '=') ? robot_job_scan_whole(s, low, high, value)
                                       : robot_job_scan_unexpected(s);
}

/* Take =number of a tool or user frame, which must be defined. */
static int take_frame(struct robot_job_scan *s, struct robot_job_span w,
                      const struct robot_job_frame frames[ROBOT_JOB_FRAMES], int32_t *number)
{
    if (take_whole(s, w, 0, ROBOT_JOB_FRAMES - 1, number)) {
        return -1;
    }
    w.length = s->at - w.at;
    return frames[*number].defined ? 0 : robot_job_scan_fault(s, ROBOT_JOB_BAD_POINT_FRAME, w);
}

static int read_frame(struct robot_job_scan *s, struct robot_job_frame frames[ROBOT_JOB_FRAMES])
{
    int32_t number, seen = 0;
    if (robot_job_scan_whole(s, 1, ROBOT_JOB_FRAMES - 1, &number)) {
        return -1;
    }
    struct robot_job_frame *f = &frames[number];
    if (f->defined) {
        s->r->other = f->line;
        return robot_job_scan_fault_line(s, ROBOT_JOB_BAD_POINT_TWICE);
    }
    while (!robot_job_scan_over(s)) {
        const struct robot_job_span w = robot_job_scan_word(s);
        const int32_t i = axis_of(s, w);
        if (w.length == 0) {
            return robot_job_scan_unexpected(s);
        }
        if (i < 0) {
            return robot_job_scan_fault(s, ROBOT_JOB_BAD_WORD, w);
        }
        if (take_value(s, w, i, coordinate_max(i), &seen, &f->value[i])) {
            return -1;
        }
    }
    f->defined = true;
    f->line = s->line;
    return seen == COORDINATES ? 0 : robot_job_scan_fault_line(s, ROBOT_JOB_BAD_COORDINATES);
}

/* Take a word of the configuration. 1: taken, 0: the word is none. */
static int take_flag(struct robot_job_scan *s, struct robot_job_span w, struct robot_job_point *p)
{
    int32_t *const value[3] = { &p->shoulder, &p->elbow, &p->wrist };
    for (int32_t i = 0; i < 6; i++) {
        if (robot_job_scan_is(s, w, FLAGS[i].word)) {
            if (*value[i / 2] != ROBOT_JOB_ANY) {
                return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
            }
            *value[i / 2] = i % 2;
            return 1;
        }
    }
    for (int32_t i = 0; i < 3; i++) {
        const char word[6] = { 'T', 'U', 'R', 'N', (char)('0' + TURNS[i]), '\0' };
        if (robot_job_scan_is(s, w, word)) {
            return take_whole(s, w, -ROBOT_JOB_TURN_MAX, ROBOT_JOB_TURN_MAX, &p->turn[i]) ? -1 : 1;
        }
    }
    return 0;
}

/* Take =value of the axis outside the arm. */
static int take_external(struct robot_job_scan *s, struct robot_job_span w,
                         enum robot_job_outside outside, struct robot_job_point *p)
{
    int32_t seen = p->beside;
    if (outside == ROBOT_JOB_NO_AXIS) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_OTHER_AXES, w);
    }
    p->beside = true;
    return take_value(s, w, 0, PLACE_MAX, &seen, &p->external);
}

struct robot_job_point robot_job_point_open(void)
{
    return (struct robot_job_point){ .shoulder = ROBOT_JOB_ANY,
                                     .elbow = ROBOT_JOB_ANY,
                                     .wrist = ROBOT_JOB_ANY,
                                     .turn = { ROBOT_JOB_ANY_TURN, ROBOT_JOB_ANY_TURN,
                                               ROBOT_JOB_ANY_TURN },
                                     .tool = ROBOT_JOB_ANY,
                                     .user = ROBOT_JOB_ANY };
}

/* CCN 19: a case for each kind of word, and the kinds that exclude each other. */
static int read_tags(struct robot_job_scan *s, const struct robot_job_points *points,
                     struct robot_job_point *p)
{
    int32_t places = 0, joints = 0;
    bool configured = false;

    while (!robot_job_scan_over(s)) {
        const struct robot_job_span w = robot_job_scan_word(s);
        const int32_t axis = axis_of(s, w);
        const bool joint = w.length == 2 && (s->text[w.at] == 'J' || s->text[w.at] == 'j')
                           && s->text[w.at + 1] >= '1' && s->text[w.at + 1] <= '6';
        int status = 0;
        if (w.length == 0) {
            return robot_job_scan_unexpected(s);
        }
        if (axis >= 0) {
            status = take_value(s, w, axis, coordinate_max(axis), &places, &p->value[axis]);
        } else if (joint) {
            const int32_t i = s->text[w.at + 1] - '1';
            status = take_value(s, w, i, JOINT_MAX, &joints, &p->value[i]);
        } else if (robot_job_scan_is(s, w, "E")) {
            status = take_external(s, w, points->outside, p);
        } else if (robot_job_scan_is(s, w, "TOOL")) {
            status = take_frame(s, w, points->tool, &p->tool);
        } else if (robot_job_scan_is(s, w, "USER")) {
            status = take_frame(s, w, points->user, &p->user);
        } else {
            status = take_flag(s, w, p);
            if (status == 0) {
                return robot_job_scan_fault(s, ROBOT_JOB_BAD_WORD, w);
            }
            configured = true;
        }
        if (status < 0) {
            return -1;
        }
        if (joints && (places || configured)) {
            return robot_job_scan_fault(s, ROBOT_JOB_BAD_MIXED, w);
        }
    }
    p->kind = joints ? ROBOT_JOB_JOINTS : ROBOT_JOB_POSE;
    return joints + places == COORDINATES ? 0
                                          : robot_job_scan_fault_line(s, ROBOT_JOB_BAD_COORDINATES);
}

static int read_point(struct robot_job_scan *s, struct robot_job_points *points,
                      struct robot_job_span w)
{
    const int32_t number = robot_job_scan_digits(s, w);
    if (number < 0 || (s->text[w.at] != 'P' && s->text[w.at] != 'p')) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_WORD, w);
    }
    if (number >= ROBOT_JOB_POINTS) {
        s->r->high = ROBOT_JOB_POINTS - 1;
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_VALUE, w);
    }
    struct robot_job_point *p = &points->point[number];
    if (p->kind != ROBOT_JOB_NO_POINT) {
        s->r->other = p->line;
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_POINT_TWICE, w);
    }
    *p = robot_job_point_open();
    p->line = s->line;
    return read_tags(s, points, p);
}

int robot_job_points_read(struct robot_job_points *p, enum robot_job_outside outside,
                          const char *text, int64_t length, struct robot_job_report *r)
{
    struct robot_job_scan s;
    int status;
    if (robot_job_scan_begin(&s, text, length, r)) {
        return -1;
    }
    robot_job_points_clear(p, outside);
    while ((status = robot_job_scan_line(&s)) > 0) {
        struct robot_job_span w;
        if (s.slashes > 0 || (w = robot_job_scan_word(&s)).length == 0) {
            s.at = s.begin;
            return robot_job_scan_unexpected(&s);
        }
        if (robot_job_scan_is(&s, w, "TOOL")) {
            status = read_frame(&s, p->tool);
        } else if (robot_job_scan_is(&s, w, "USER")) {
            status = read_frame(&s, p->user);
        } else {
            status = read_point(&s, p, w);
        }
        if (status) {
            return -1;
        }
    }
    return status;
}

/* Whether the reader would take this value.
 * CCN 20: a row of limits that all must hold. */
static bool writable(int32_t number, const struct robot_job_point *p)
{
    bool good = number >= 0 && number < ROBOT_JOB_POINTS
                && (p->kind == ROBOT_JOB_JOINTS || p->kind == ROBOT_JOB_POSE)
                && p->shoulder >= ROBOT_JOB_ANY && p->shoulder <= 1 && p->elbow >= ROBOT_JOB_ANY
                && p->elbow <= 1 && p->wrist >= ROBOT_JOB_ANY && p->wrist <= 1
                && p->tool >= ROBOT_JOB_ANY && p->tool < ROBOT_JOB_FRAMES
                && p->user >= ROBOT_JOB_ANY && p->user < ROBOT_JOB_FRAMES;
    good &= !p->beside || fabs(p->external) <= PLACE_MAX;
    for (int32_t i = 0; i < 3; i++) {
        good &= p->turn[i] == ROBOT_JOB_ANY_TURN
                || (p->turn[i] >= -ROBOT_JOB_TURN_MAX && p->turn[i] <= ROBOT_JOB_TURN_MAX);
    }
    for (int32_t i = 0; i < 6; i++) {
        good &= fabs(p->value[i]) <= (p->kind == ROBOT_JOB_JOINTS ? JOINT_MAX : coordinate_max(i));
    }
    return good;
}

static void tag(struct robot_job_text *t, const char *name, double value)
{
    robot_job_text_add(t, " ");
    robot_job_text_add(t, name);
    robot_job_text_add(t, "=");
    robot_job_text_number(t, value);
}

int robot_job_point_write(int32_t number, const struct robot_job_point *p,
                          char text[ROBOT_JOB_POINT_TEXT])
{
    if (!writable(number, p)) {
        return -1;
    }
    const int32_t flag[3] = { p->shoulder, p->elbow, p->wrist };
    const char name[5] = { 'P', (char)('0' + number / 100), (char)('0' + number / 10 % 10),
                           (char)('0' + number % 10), '\0' };
    struct robot_job_text t = { text, ROBOT_JOB_POINT_TEXT, 0 };
    robot_job_text_add(&t, name);
    for (int32_t i = 0; i < 6; i++) {
        const char joint[3] = { 'J', (char)('1' + i), '\0' }, axis[2] = { AXES[i], '\0' };
        tag(&t, p->kind == ROBOT_JOB_JOINTS ? joint : axis, p->value[i]);
    }
    for (int32_t i = 0; p->kind == ROBOT_JOB_POSE && i < 3; i++) {
        if (flag[i] != ROBOT_JOB_ANY) {
            robot_job_text_add(&t, " ");
            robot_job_text_add(&t, FLAGS[2 * i + flag[i]].word);
        }
    }
    for (int32_t i = 0; p->kind == ROBOT_JOB_POSE && i < 3; i++) {
        const char turn[6] = { 'T', 'U', 'R', 'N', (char)('0' + TURNS[i]), '\0' };
        if (p->turn[i] != ROBOT_JOB_ANY_TURN) {
            tag(&t, turn, p->turn[i]);
        }
    }
    if (p->beside) {
        tag(&t, "E", p->external);
    }
    if (p->tool != ROBOT_JOB_ANY) {
        tag(&t, "TOOL", p->tool);
    }
    if (p->user != ROBOT_JOB_ANY) {
        tag(&t, "USER", p->user);
    }
    return 0;
}
