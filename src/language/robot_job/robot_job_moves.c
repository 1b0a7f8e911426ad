#include "robot_job_reading.h"

/* Ranges of what a program may ask for; a controller may do less. */
#define V_MIN      0.1     /* [mm/s] */
#define V_MAX      10000.0 /* [mm/s] */
#define VR_MIN     0.1     /* [deg/s] */
#define VR_MAX     1000.0  /* [deg/s] */
#define VJ_MIN     0.01    /* [%] */
#define VJ_MAX     100.0   /* [%] */
#define CORNER_MIN 0.1     /* [mm] */
#define CORNER_MAX 6553.5  /* [mm] as in the maker's language */

/* By enum robot_job_speed. */
static const struct {
    double low, high, unit;
} SPEED[4] = {
    { 0.0, 0.0, 0.0 }, { VJ_MIN, VJ_MAX, 0.01 }, { V_MIN, V_MAX, 0.1 }, { VR_MIN, VR_MAX, 0.1 }
};

double robot_job_speed_low(enum robot_job_speed tag)
{
    return SPEED[tag].low;
}

double robot_job_speed_high(enum robot_job_speed tag)
{
    return SPEED[tag].high;
}

double robot_job_speed_unit(enum robot_job_speed tag)
{
    return SPEED[tag].unit;
}

/* Take VJ, V or VR and its value, a number or a variable, which is then c->right. 1: taken, 0:
 * there is none. */
static int speed_tag(struct robot_job_reading *in, struct robot_job_span w,
                     struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    const enum robot_job_speed tag = robot_job_scan_is(s, w, "VJ")   ? ROBOT_JOB_VJ
                                     : robot_job_scan_is(s, w, "V")  ? ROBOT_JOB_V
                                     : robot_job_scan_is(s, w, "VR") ? ROBOT_JOB_VR
                                                                     : ROBOT_JOB_DEFAULT;
    if (tag == ROBOT_JOB_DEFAULT) {
        return 0;
    }
    if (c->tag != ROBOT_JOB_DEFAULT) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
    }
    c->tag = tag;
    if (!robot_job_scan_take(s, '=')) {
        return robot_job_scan_unexpected(s);
    }
    const int named = robot_job_operand_whole(in, &c->right);
    return named                                                                  ? named
           : robot_job_scan_number(s, SPEED[tag].low, SPEED[tag].high, &c->speed) ? -1
                                                                                  : 1;
}

/* Whether a word is a position of axes outside the arm: BC00000, EC00000, BP000, EX000. */
static bool other_axes(const struct robot_job_scan *s, struct robot_job_span w)
{
    int32_t number;
    bool own;
    return robot_job_positions_outside(s, w, &own, &number) != ROBOT_JOB_NO_AXIS;
}

/* Take ACC or DEC with its share [%], a number or a variable. 1: taken, 0: the word is none. */
static int share_tag(struct robot_job_reading *in, struct robot_job_span w,
                     struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    const bool slows = robot_job_scan_is(s, w, "DEC");
    struct robot_job_operand *share = &c->acc[slows];
    if (!slows && !robot_job_scan_is(s, w, "ACC")) {
        return 0;
    }
    if (share->kind != ROBOT_JOB_NOTHING) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
    }
    if (!robot_job_scan_take(s, '=')) {
        return robot_job_scan_unexpected(s);
    }
    const int named = robot_job_operand_whole(in, share);
    if (named) {
        return named;
    }
    share->kind = ROBOT_JOB_CONSTANT;
    return robot_job_scan_number(s, ROBOT_JOB_ACC_MIN, ROBOT_JOB_ACC_MAX, &share->number) ? -1 : 1;
}

/* CCN 18: a case for each tag. */
static int take_tag(struct robot_job_reading *in, struct robot_job_span w,
                    struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    int status = speed_tag(in, w, c);
    if (status > 0) {
        w.length = s->at - w.at;
        return (c->tag == ROBOT_JOB_VJ) == (c->path == ROBOT_JOB_JOINT)
                   ? 0
                   : robot_job_scan_fault(s, ROBOT_JOB_BAD_KIND, w);
    }
    status = status == 0 ? share_tag(in, w, c) : status;
    if (status != 0) {
        return status < 0 ? -1 : 0;
    }
    if (robot_job_scan_is(s, w, "UNTIL")) {
        return c->until >= 0 ? robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w)
                             : robot_job_operand_until(in, c);
    }
    if (robot_job_scan_is(s, w, "NWAIT")) {
        if (c->early) {
            return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
        }
        c->early = true;
        return 0;
    }
    if (other_axes(s, w)) {
        return robot_job_positions_beside(in, w, c);
    }
    const bool level = robot_job_scan_is(s, w, "PL");
    if (!level && !robot_job_scan_is(s, w, "CR")) {
        return robot_job_scan_fault(s,
                                    robot_job_lacks(s, w) ? ROBOT_JOB_BAD_LACKING
                                                          : ROBOT_JOB_BAD_WORD,
                                    w);
    }
    if (c->level != ROBOT_JOB_ANY || c->corner > 0.0) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
    }
    if (!robot_job_scan_take(s, '=')) {
        return robot_job_scan_unexpected(s);
    }
    return level ? robot_job_scan_whole(s, 0, ROBOT_JOB_LEVELS, &c->level)
                 : robot_job_scan_number(s, CORNER_MIN, CORNER_MAX, &c->corner);
}

static int same_frames(struct robot_job_reading *in, const struct robot_job_instruction *c)
{
    if (c->to_by.kind != ROBOT_JOB_NOTHING || c->via_by.kind != ROBOT_JOB_NOTHING) {
        return 0; /* nobody knows yet */
    }
    const struct robot_job_point *a = robot_job_point(in->p, in->points, c->via),
                                 *b = robot_job_point(in->p, in->points, c->to);
    return a->kind == ROBOT_JOB_NO_POINT || b->kind == ROBOT_JOB_NO_POINT
                   || (a->tool == b->tool && a->user == b->user)
               ? 0
               : robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_ARC_FRAMES);
}

int robot_job_move_arc_over(struct robot_job_reading *in)
{
    const bool wrong = in->arc == 1 || in->arc == 2;
    in->arc = 0;
    if (wrong) {
        in->s.line = in->arc_line;
        return robot_job_scan_fault(&in->s, ROBOT_JOB_BAD_ARC_POINTS, in->arc_at);
    }
    return 0;
}

static bool same_operand(const struct robot_job_operand *a, const struct robot_job_operand *b)
{
    return a->kind == b->kind && a->index == b->index && a->by.kind == b->by.kind
           && a->by.index == b->by.index;
}

static bool same_shares(const struct robot_job_instruction *a,
                        const struct robot_job_instruction *b)
{
    bool same = true;
    for (int i = 0; i < 2; i++) {
        same = same && same_operand(&a->acc[i], &b->acc[i]) && a->acc[i].number == b->acc[i].number;
    }
    return same;
}

/* Whether the via of an arc has the axis outside the arm where its end has it, if it says so. */
static int same_outside(struct robot_job_reading *in, const struct robot_job_instruction *c)
{
    const int32_t via = in->via.beside, end = c->beside;
    const struct robot_job_position *p = in->p->position;
    return via < 0
                   || (end >= 0
                       && p[via - ROBOT_JOB_POINTS].point.external
                              == p[end - ROBOT_JOB_POINTS].point.external)
               ? 0
               : robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_ARC_OUTSIDE);
}

/* MOVC of one point: the first of three is a line, the second is kept, the third makes the arc. */
static int arc_point(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    const struct robot_job_scan *s = &in->s;
    in->arc_line = s->line;
    in->arc_at = (struct robot_job_span){ s->begin, s->end - s->begin };
    switch (++in->arc) {
    case 1: c->path = ROBOT_JOB_LINE; return 0;
    case 2:
        in->via = *c;
        in->p->count--;
        return 0;
    case 3:
        c->via = in->via.to;
        c->via_by = in->via.to_by;
        if (c->until != in->via.until || c->until_on != in->via.until_on) {
            in->s.r->other = in->via.line;
            return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_ARC_UNTIL);
        }
        if (c->tag != in->via.tag || c->speed != in->via.speed
            || !same_operand(&c->right, &in->via.right) || !same_shares(c, &in->via)) {
            in->s.r->other = in->via.line;
            return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_ARC_SPEED);
        }
        return same_outside(in, c) || same_frames(in, c) ? -1 : 0;
    default: return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_ARC_POINTS);
    }
}

/* MOVS: the first of a row is a line, and so is the second, until a third makes a curve of both. */
static void spline_point(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    c->path = ++in->splines > 2 ? ROBOT_JOB_SPLINE : ROBOT_JOB_LINE;
    if (in->splines > 2) {
        c[-1].path = ROBOT_JOB_SPLINE;
        c[-1].goes_on = true;
    }
}

/* Report what stands where a point is wanted. */
static int no_point(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    const int32_t at = s->at;
    const struct robot_job_span w = robot_job_scan_word(s);
    if (other_axes(s, w)) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_OTHER_AXES, w);
    }
    if (w.length > 1 && robot_job_scan_is(s, (struct robot_job_span){ w.at, 2 }, "LP")) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_LACKING, w);
    }
    s->at = at;
    return robot_job_scan_unexpected(s);
}

/* Whether the move of another robot follows, +MOVJ. */
static bool another_move(const struct robot_job_scan *s)
{
    return s->end - s->at > 4
           && robot_job_scan_is(s, (struct robot_job_span){ s->at + 1, 3 }, "MOV")
           && s->text[s->at] == '+';
}

/* Take BF, RF or the number of UF#(1), 0 being the base. 1: taken, 0: the word is none. */
static int base_or_user(struct robot_job_reading *in, struct robot_job_span at, int32_t *user)
{
    struct robot_job_scan *s = &in->s;
    if (robot_job_scan_is(s, at, "BF") || robot_job_scan_is(s, at, "RF")) {
        *user = 0;
        return 1;
    }
    if (!robot_job_scan_is(s, at, "UF")) {
        return 0;
    }
    if (robot_job_operand_channel(in, ROBOT_JOB_FRAMES - 1, user)) {
        return -1;
    }
    ++*user; /* user frames count from 1 here, 0 is the base */
    at.length = s->at - at.at;
    return in->points->user[*user].defined ? 1 : robot_job_scan_fault(s, ROBOT_JOB_BAD_FRAME, at);
}

int robot_job_move_frame(struct robot_job_reading *in, struct robot_job_span w,
                         struct robot_job_instruction *c)
{
    if (robot_job_scan_is(&in->s, w, "TF")) {
        c->increment = ROBOT_JOB_BY_TOOL;
        return 1;
    }
    return base_or_user(in, w, &c->increment);
}

/* Read the tags of a move to the end of its line. */
static int tags(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    while (!robot_job_scan_over(s)) {
        const struct robot_job_span w = robot_job_scan_word(s);
        if (w.length == 0) {
            return another_move(s) ? robot_job_scan_fault_line(s, ROBOT_JOB_BAD_OTHER_ROBOT)
                                   : robot_job_scan_unexpected(s);
        }
        int status = 0;
        if (c->increment != ROBOT_JOB_NOT_BY) {
            status = robot_job_move_frame(in, w, c);
        }
        if (status < 0 || (status == 0 && take_tag(in, w, c))) {
            return -1;
        }
    }
    return 0;
}

int robot_job_move(struct robot_job_reading *in, enum robot_job_path path)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_MOVE);
    int second = 0;
    if (!c) {
        return -1;
    }
    c->path = path;
    const int status = robot_job_place_take(in, &c->to, &c->to_by);
    if (status <= 0) {
        return status < 0 ? -1 : no_point(in);
    }
    if (path == ROBOT_JOB_CIRCLE) {
        int32_t end;
        struct robot_job_by by;
        second = robot_job_place_take(in, &end, &by);
        if (second < 0) {
            return -1;
        }
        if (second) {
            c->via = c->to;
            c->via_by = c->to_by;
            c->to = end;
            c->to_by = by;
        }
    }
    if (tags(in, c)) {
        return -1;
    }
    if (path == ROBOT_JOB_SPLINE) {
        spline_point(in, c);
    }
    if (path == ROBOT_JOB_CIRCLE && !second) {
        return arc_point(in, c);
    }
    return second ? same_frames(in, c) : 0;
}

/* Read IMOV P001 V=10.0 TF. */
int robot_job_move_by(struct robot_job_reading *in)
{
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_MOVE);
    if (!c) {
        return -1;
    }
    c->path = ROBOT_JOB_LINE;
    c->increment = 0;
    const int status = robot_job_place_take(in, &c->to, &c->to_by);
    return status > 0 ? tags(in, c) : status < 0 ? -1 : no_point(in);
}

/* Read the frame of a shift, if there is one: BF, RF or UF#(1). */
static int shift_frame(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    if (robot_job_scan_over(s)) {
        return 0;
    }
    const struct robot_job_span w = robot_job_scan_word(s);
    const int status = base_or_user(in, w, &c->via);
    if (status != 0) {
        return status < 0 ? -1 : 0;
    }
    s->at = w.length > 0 ? w.at : s->at;
    return robot_job_scan_is(s, w, "TF") || robot_job_scan_is(s, w, "MTF")
               ? robot_job_scan_fault(s, ROBOT_JOB_BAD_LACKING, w)
               : robot_job_scan_unexpected(s);
}

/* Whether the position of a line may be another one when the line is done, as far as is known. */
static bool may_change(const struct robot_job_reading *in, const struct robot_job_instruction *c)
{
    return c->to_by.kind != ROBOT_JOB_NOTHING
           || robot_job_point(in->p, in->points, c->to)->kind == ROBOT_JOB_NO_POINT
           || (c->to < ROBOT_JOB_POINTS && in->p->changed[c->to]) || in->p->changes_any;
}

/* Read SFTON P001, SFTON P001 BF or RF, SFTON P001 UF#(1). */
int robot_job_move_shift(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_SHIFT);
    if (!c) {
        return -1;
    }
    robot_job_scan_over(s);
    struct robot_job_span at = { s->at, 0 };
    const int status = robot_job_place_take(in, &c->to, &c->to_by);
    if (status <= 0) {
        return status < 0 ? -1 : robot_job_scan_unexpected(s);
    }
    at.length = s->at - at.at;
    if (may_change(in, c)) {
        return shift_frame(in, c); /* what it is shows where it is done */
    }
    const struct robot_job_point *p = robot_job_point(in->p, in->points, c->to);
    if (p->kind != ROBOT_JOB_POSE || p->value[3] != 0.0 || p->value[4] != 0.0
        || p->value[5] != 0.0) {
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_SHIFT, at);
    }
    return shift_frame(in, c);
}

int robot_job_move_speed(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    int32_t seen = 0;
    do {
        const int32_t at = s->at;
        const struct robot_job_span w = robot_job_scan_word(s);
        struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_SPEED);
        if (!c) {
            return -1;
        }
        const int status = speed_tag(in, w, c);
        if (status <= 0) {
            s->at = at;
            return status < 0 ? -1 : robot_job_scan_unexpected(s);
        }
        if (seen & 1 << c->tag) {
            return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
        }
        seen |= 1 << c->tag;
    } while (!robot_job_scan_over(s));
    return 0;
}
