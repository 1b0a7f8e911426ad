#include "inform_scan.h"

#include <math.h>
#include <string.h>

#include "inform_decimal.h"

#define JOINT_MAX 3600.0   /* [deg] ten turns: no arm's limit */
#define PLACE_MAX 100000.0 /* [mm] */
#define ANGLE_MAX 360.0    /* [deg] */

enum { COORDINATES = 0x3f }; /* all six are given */

static const char AXES[] = "XYZABC";
static const int TURNS[3] = { 1, 4, 6 }; /* joints */

/* Words of a configuration: the even ones are 0, the odd ones 1. */
static const struct {
    char word[8];
} FLAGS[6] = { { "FRONT" }, { "BACK" }, { "UP" }, { "DOWN" }, { "NOFLIP" }, { "FLIP" } };

void inform_points_clear(struct inform_points *p)
{
    memset(p, 0, sizeof *p);
    p->tool[0].defined = p->user[0].defined = true;
}

static double coordinate_max(int32_t axis)
{
    return axis < 3 ? PLACE_MAX : ANGLE_MAX;
}

/* Index of a coordinate's letter, -1: none. */
static int32_t axis_of(const struct inform_scan *s, struct inform_piece w)
{
    for (int32_t i = 0; i < 6; i++) {
        const char letter[2] = { AXES[i], '\0' };
        if (inform_scan_is(s, w, letter)) {
            return i;
        }
    }
    return -1;
}

/* Take =value of coordinate or joint i; `seen` has a bit for each one given. */
static int take_value(struct inform_scan *s, struct inform_piece w, int32_t i, double most,
                      int32_t *seen, double value[6])
{
    if (*seen & 1 << i) {
        return inform_scan_fault(s, INFORM_BAD_TWICE, w);
    }
    *seen |= 1 << i;
    return inform_scan_take(s, '=') ? inform_scan_number(s, -most, most, &value[i])
                                    : inform_scan_unexpected(s);
}

static int take_whole(struct inform_scan *s, struct inform_piece w, int32_t low, int32_t high,
                      int32_t *value)
{
    if (*value != (low < 0 ? INFORM_ANY_TURN : INFORM_ANY)) {
        return inform_scan_fault(s, INFORM_BAD_TWICE, w);
    }
    return inform_scan_take(s, '=') ? inform_scan_whole(s, low, high, value)
                                    : inform_scan_unexpected(s);
}

/* Number of a tool or user frame that is defined. */
static int take_frame(struct inform_scan *s, struct inform_piece w,
                      const struct inform_frame frames[INFORM_FRAMES], int32_t *number)
{
    if (take_whole(s, w, 0, INFORM_FRAMES - 1, number)) {
        return -1;
    }
    w.length = s->at - w.at;
    return frames[*number].defined ? 0 : inform_scan_fault(s, INFORM_BAD_POINT_FRAME, w);
}

static int read_frame(struct inform_scan *s, struct inform_frame frames[INFORM_FRAMES])
{
    int32_t number, seen = 0;
    if (inform_scan_whole(s, 1, INFORM_FRAMES - 1, &number)) {
        return -1;
    }
    struct inform_frame *f = &frames[number];
    if (f->defined) {
        s->r->other = f->line;
        return inform_scan_fault_line(s, INFORM_BAD_POINT_TWICE);
    }
    while (!inform_scan_over(s)) {
        const struct inform_piece w = inform_scan_word(s);
        const int32_t i = axis_of(s, w);
        if (w.length == 0) {
            return inform_scan_unexpected(s);
        }
        if (i < 0) {
            return inform_scan_fault(s, INFORM_BAD_WORD, w);
        }
        if (take_value(s, w, i, coordinate_max(i), &seen, f->value)) {
            return -1;
        }
    }
    f->defined = true;
    f->line = s->line;
    return seen == COORDINATES ? 0 : inform_scan_fault_line(s, INFORM_BAD_COORDINATES);
}

/* A word of the configuration: 1 taken, 0 none, -1. */
static int take_flag(struct inform_scan *s, struct inform_piece w, struct inform_point *p)
{
    int32_t *const value[3] = { &p->shoulder, &p->elbow, &p->wrist };
    for (int32_t i = 0; i < 6; i++) {
        if (inform_scan_is(s, w, FLAGS[i].word)) {
            if (*value[i / 2] != INFORM_ANY) {
                return inform_scan_fault(s, INFORM_BAD_TWICE, w);
            }
            *value[i / 2] = i % 2;
            return 1;
        }
    }
    for (int32_t i = 0; i < 3; i++) {
        const char word[6] = { 'T', 'U', 'R', 'N', (char)('0' + TURNS[i]), '\0' };
        if (inform_scan_is(s, w, word)) {
            return take_whole(s, w, -INFORM_TURN_MAX, INFORM_TURN_MAX, &p->turn[i]) ? -1 : 1;
        }
    }
    return 0;
}

static struct inform_point no_point(void)
{
    return (struct inform_point){ .shoulder = INFORM_ANY,
                                  .elbow = INFORM_ANY,
                                  .wrist = INFORM_ANY,
                                  .turn = { INFORM_ANY_TURN, INFORM_ANY_TURN, INFORM_ANY_TURN },
                                  .tool = INFORM_ANY,
                                  .user = INFORM_ANY };
}

/* CCN 18: a case for each kind of word, and the kinds that exclude each other. */
static int read_tags(struct inform_scan *s, const struct inform_points *points,
                     struct inform_point *p)
{
    int32_t places = 0, joints = 0;
    bool configured = false;

    while (!inform_scan_over(s)) {
        const struct inform_piece w = inform_scan_word(s);
        const int32_t axis = axis_of(s, w);
        const bool joint = w.length == 2 && (s->text[w.at] == 'J' || s->text[w.at] == 'j')
                           && s->text[w.at + 1] >= '1' && s->text[w.at + 1] <= '6';
        int status = 0;
        if (w.length == 0) {
            return inform_scan_unexpected(s);
        }
        if (axis >= 0) {
            status = take_value(s, w, axis, coordinate_max(axis), &places, p->value);
        } else if (joint) {
            status = take_value(s, w, s->text[w.at + 1] - '1', JOINT_MAX, &joints, p->value);
        } else if (inform_scan_is(s, w, "TOOL")) {
            status = take_frame(s, w, points->tool, &p->tool);
        } else if (inform_scan_is(s, w, "USER")) {
            status = take_frame(s, w, points->user, &p->user);
        } else {
            status = take_flag(s, w, p);
            if (status == 0) {
                return inform_scan_fault(s, INFORM_BAD_WORD, w);
            }
            configured = true;
        }
        if (status < 0) {
            return -1;
        }
        if (joints && (places || configured)) {
            return inform_scan_fault(s, INFORM_BAD_MIXED, w);
        }
    }
    p->kind = joints ? INFORM_JOINTS : INFORM_POSE;
    return joints + places == COORDINATES ? 0 : inform_scan_fault_line(s, INFORM_BAD_COORDINATES);
}

static int read_point(struct inform_scan *s, struct inform_points *points, struct inform_piece w)
{
    const int32_t number = inform_scan_digits(s, w);
    if (number < 0 || (s->text[w.at] != 'P' && s->text[w.at] != 'p')) {
        return inform_scan_fault(s, INFORM_BAD_WORD, w);
    }
    if (number >= INFORM_POINTS) {
        s->r->high = INFORM_POINTS - 1;
        return inform_scan_fault(s, INFORM_BAD_VALUE, w);
    }
    struct inform_point *p = &points->point[number];
    if (p->kind != INFORM_NO_POINT) {
        s->r->other = p->line;
        return inform_scan_fault(s, INFORM_BAD_POINT_TWICE, w);
    }
    *p = no_point();
    p->line = s->line;
    return read_tags(s, points, p);
}

int inform_points_read(struct inform_points *p, const char *text, int64_t length,
                       struct inform_report *r)
{
    struct inform_scan s;
    int status;
    if (inform_scan_begin(&s, text, length, r)) {
        return -1;
    }
    inform_points_clear(p);
    while ((status = inform_scan_line(&s)) > 0) {
        struct inform_piece w;
        if (s.name || (w = inform_scan_word(&s)).length == 0) {
            s.at = s.begin;
            return inform_scan_unexpected(&s);
        }
        if (inform_scan_is(&s, w, "TOOL")) {
            status = read_frame(&s, p->tool);
        } else if (inform_scan_is(&s, w, "USER")) {
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

/* Whether the reader would take it.
 * CCN 19: a row of limits that all must hold. */
static bool writable(int32_t number, const struct inform_point *p)
{
    bool good = number >= 0 && number < INFORM_POINTS
                && (p->kind == INFORM_JOINTS || p->kind == INFORM_POSE) && p->shoulder >= INFORM_ANY
                && p->shoulder <= 1 && p->elbow >= INFORM_ANY && p->elbow <= 1
                && p->wrist >= INFORM_ANY && p->wrist <= 1 && p->tool >= INFORM_ANY
                && p->tool < INFORM_FRAMES && p->user >= INFORM_ANY && p->user < INFORM_FRAMES;
    for (int32_t i = 0; i < 3; i++) {
        good &= p->turn[i] == INFORM_ANY_TURN
                || (p->turn[i] >= -INFORM_TURN_MAX && p->turn[i] <= INFORM_TURN_MAX);
    }
    for (int32_t i = 0; i < 6; i++) {
        good &= fabs(p->value[i]) <= (p->kind == INFORM_JOINTS ? JOINT_MAX : coordinate_max(i));
    }
    return good;
}

static void tag(struct inform_text *t, const char *name, double value)
{
    inform_text_add(t, " ");
    inform_text_add(t, name);
    inform_text_add(t, "=");
    inform_text_number(t, value);
}

int inform_point_write(int32_t number, const struct inform_point *p, char text[INFORM_POINT_TEXT])
{
    if (!writable(number, p)) {
        return -1;
    }
    const int32_t flag[3] = { p->shoulder, p->elbow, p->wrist };
    const char name[5] = { 'P', (char)('0' + number / 100), (char)('0' + number / 10 % 10),
                           (char)('0' + number % 10), '\0' };
    struct inform_text t = { text, INFORM_POINT_TEXT, 0 };
    inform_text_add(&t, name);
    for (int32_t i = 0; i < 6; i++) {
        const char joint[3] = { 'J', (char)('1' + i), '\0' }, axis[2] = { AXES[i], '\0' };
        tag(&t, p->kind == INFORM_JOINTS ? joint : axis, p->value[i]);
    }
    for (int32_t i = 0; p->kind == INFORM_POSE && i < 3; i++) {
        if (flag[i] != INFORM_ANY) {
            inform_text_add(&t, " ");
            inform_text_add(&t, FLAGS[2 * i + flag[i]].word);
        }
    }
    for (int32_t i = 0; p->kind == INFORM_POSE && i < 3; i++) {
        const char turn[6] = { 'T', 'U', 'R', 'N', (char)('0' + TURNS[i]), '\0' };
        if (p->turn[i] != INFORM_ANY_TURN) {
            tag(&t, turn, p->turn[i]);
        }
    }
    if (p->tool != INFORM_ANY) {
        tag(&t, "TOOL", p->tool);
    }
    if (p->user != INFORM_ANY) {
        tag(&t, "USER", p->user);
    }
    return 0;
}
