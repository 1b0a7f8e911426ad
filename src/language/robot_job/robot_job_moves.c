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

/* Take VJ, V or VR and its value. 1: taken, 0: there is none. */
static int speed_tag(struct robot_job_scan *s, struct robot_job_span w, enum robot_job_speed *tag,
                     double *value)
{
    *tag = robot_job_scan_is(s, w, "VJ")   ? ROBOT_JOB_VJ
           : robot_job_scan_is(s, w, "V")  ? ROBOT_JOB_V
           : robot_job_scan_is(s, w, "VR") ? ROBOT_JOB_VR
                                           : ROBOT_JOB_DEFAULT;
    if (*tag == ROBOT_JOB_DEFAULT) {
        return 0;
    }
    if (!robot_job_scan_take(s, '=')) {
        return robot_job_scan_unexpected(s);
    }
    const double low = *tag == ROBOT_JOB_VJ ? VJ_MIN : *tag == ROBOT_JOB_V ? V_MIN : VR_MIN;
    const double high = *tag == ROBOT_JOB_VJ ? VJ_MAX : *tag == ROBOT_JOB_V ? V_MAX : VR_MAX;
    return robot_job_scan_number(s, low, high, value) ? -1 : 1;
}

/* Take P and the number of a point that is in the points file or stands in a job, or C and that of
 * a position of this job. 1: taken, 0: something else stands here. */
static int take_point(struct robot_job_reading *in, int32_t *point)
{
    struct robot_job_scan *s = &in->s;
    robot_job_scan_over(s);
    const int32_t at = s->at;
    const struct robot_job_span w = robot_job_scan_word(s);
    const struct robot_job_span letter = { w.at, 1 };
    const bool own = robot_job_scan_is(s, letter, "C");
    *point = robot_job_scan_digits(s, w);
    if (*point < 0 || !(own || robot_job_scan_is(s, letter, "P"))) {
        s->at = at;
        return 0;
    }
    if (own) {
        *point = robot_job_positions_find(in, 'C', *point);
        return *point >= 0 ? 1 : robot_job_scan_fault(s, ROBOT_JOB_BAD_POSITION, w);
    }
    if (*point >= ROBOT_JOB_POINTS || in->points->point[*point].kind == ROBOT_JOB_NO_POINT) {
        *point = robot_job_positions_find(in, 'P', *point);
    }
    return *point >= 0 ? 1 : robot_job_scan_fault(s, ROBOT_JOB_BAD_POINT, w);
}

/* Whether a word is a position of axes outside the arm: BC00000, EC00000, BP000, EX000. */
static bool other_axes(const struct robot_job_scan *s, struct robot_job_span w)
{
    const struct robot_job_span two = { w.at, 2 };
    return w.length > 2 && s->text[w.at + 2] >= '0' && s->text[w.at + 2] <= '9'
           && (robot_job_scan_is(s, two, "BC") || robot_job_scan_is(s, two, "EC")
               || robot_job_scan_is(s, two, "BP") || robot_job_scan_is(s, two, "EX"));
}

static int take_tag(struct robot_job_scan *s, struct robot_job_span w,
                    struct robot_job_instruction *c)
{
    enum robot_job_speed tag;
    double speed = 0.0;
    const int status = speed_tag(s, w, &tag, &speed);
    if (status < 0) {
        return -1;
    }
    if (status > 0) {
        if (c->tag != ROBOT_JOB_DEFAULT) {
            return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
        }
        c->tag = tag;
        c->speed = speed;
        w.length = s->at - w.at;
        return (c->tag == ROBOT_JOB_VJ) == (c->path == ROBOT_JOB_JOINT)
                   ? 0
                   : robot_job_scan_fault(s, ROBOT_JOB_BAD_KIND, w);
    }
    if (robot_job_scan_is(s, w, "NWAIT")) {
        if (c->early) {
            return robot_job_scan_fault(s, ROBOT_JOB_BAD_TWICE, w);
        }
        c->early = true;
        return 0;
    }
    const bool level = robot_job_scan_is(s, w, "PL");
    if (!level && !robot_job_scan_is(s, w, "CR")) {
        return robot_job_scan_fault(s,
                                    other_axes(s, w)        ? ROBOT_JOB_BAD_OTHER_AXES
                                    : robot_job_lacks(s, w) ? ROBOT_JOB_BAD_LACKING
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

static int same_frames(struct robot_job_reading *in, int32_t via, int32_t end)
{
    const struct robot_job_point *a = robot_job_point(in->p, in->points, via),
                                 *b = robot_job_point(in->p, in->points, end);
    return a->tool == b->tool && a->user == b->user
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
        if (c->tag != in->via.tag || c->speed != in->via.speed) {
            in->s.r->other = in->via.line;
            return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_ARC_SPEED);
        }
        return same_frames(in, c->via, c->to);
    default: return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_ARC_POINTS);
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

int robot_job_move(struct robot_job_reading *in, enum robot_job_path path)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_instruction *c = robot_job_reading_add(in, ROBOT_JOB_OP_MOVE);
    int second = 0;
    if (!c) {
        return -1;
    }
    c->path = path;
    const int status = take_point(in, &c->to);
    if (status <= 0) {
        return status < 0 ? -1 : no_point(in);
    }
    if (path == ROBOT_JOB_CIRCLE) {
        int32_t end;
        second = take_point(in, &end);
        if (second < 0) {
            return -1;
        }
        c->via = second ? c->to : 0;
        c->to = second ? end : c->to;
    }
    while (!robot_job_scan_over(s)) {
        const struct robot_job_span w = robot_job_scan_word(s);
        if (w.length == 0) {
            return another_move(s) ? robot_job_scan_fault_line(s, ROBOT_JOB_BAD_OTHER_ROBOT)
                                   : robot_job_scan_unexpected(s);
        }
        if (take_tag(s, w, c)) {
            return -1;
        }
    }
    if (path == ROBOT_JOB_CIRCLE && !second) {
        return arc_point(in, c);
    }
    return second ? same_frames(in, c->via, c->to) : 0;
}

/* Read the frame of a shift, if there is one: BF, RF or UF#(1). */
static int shift_frame(struct robot_job_reading *in, struct robot_job_instruction *c)
{
    struct robot_job_scan *s = &in->s;
    if (robot_job_scan_over(s)) {
        return 0;
    }
    struct robot_job_span at = robot_job_scan_word(s);
    if (robot_job_scan_is(s, at, "BF") || robot_job_scan_is(s, at, "RF")) {
        return 0;
    }
    if (!robot_job_scan_is(s, at, "UF")) {
        s->at = at.length > 0 ? at.at : s->at;
        return robot_job_scan_is(s, at, "TF") || robot_job_scan_is(s, at, "MTF")
                   ? robot_job_scan_fault(s, ROBOT_JOB_BAD_LACKING, at)
                   : robot_job_scan_unexpected(s);
    }
    if (robot_job_operand_channel(in, ROBOT_JOB_FRAMES - 1, &c->via)) {
        return -1;
    }
    c->via++; /* user frames count from 1 here, 0 is the base */
    at.length = s->at - at.at;
    return in->points->user[c->via].defined ? 0 : robot_job_scan_fault(s, ROBOT_JOB_BAD_FRAME, at);
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
    const int status = take_point(in, &c->to);
    if (status <= 0) {
        return status < 0 ? -1 : robot_job_scan_unexpected(s);
    }
    at.length = s->at - at.at;
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
        const int status = speed_tag(s, w, &c->tag, &c->speed);
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
