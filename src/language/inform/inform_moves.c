#include "inform_reading.h"

/* What may be asked for; a controller may do less. */
#define V_MIN      0.1     /* [mm/s] */
#define V_MAX      10000.0 /* [mm/s] */
#define VR_MIN     0.1     /* [deg/s] */
#define VR_MAX     1000.0  /* [deg/s] */
#define VJ_MIN     0.01    /* [%] */
#define VJ_MAX     100.0   /* [%] */
#define CORNER_MIN 0.1     /* [mm] */
#define CORNER_MAX 6553.5  /* [mm] as in the maker's language */

/* VJ, V or VR with its value: 1 taken, 0 none, -1. */
static int speed_tag(struct inform_scan *s, struct inform_piece w, enum inform_speed *tag,
                     double *value)
{
    *tag = inform_scan_is(s, w, "VJ")   ? INFORM_VJ
           : inform_scan_is(s, w, "V")  ? INFORM_V
           : inform_scan_is(s, w, "VR") ? INFORM_VR
                                        : INFORM_DEFAULT;
    if (*tag == INFORM_DEFAULT) {
        return 0;
    }
    if (!inform_scan_take(s, '=')) {
        return inform_scan_unexpected(s);
    }
    const double low = *tag == INFORM_VJ ? VJ_MIN : *tag == INFORM_V ? V_MIN : VR_MIN;
    const double high = *tag == INFORM_VJ ? VJ_MAX : *tag == INFORM_V ? V_MAX : VR_MAX;
    return inform_scan_number(s, low, high, value) ? -1 : 1;
}

/* P and a number, of a point that is there: 1 taken, 0 something else, -1. */
static int take_point(struct inform_reading *in, int32_t *point)
{
    struct inform_scan *s = &in->s;
    inform_scan_over(s);
    const int32_t at = s->at;
    const struct inform_piece w = inform_scan_word(s);
    *point = inform_scan_digits(s, w);
    if (*point < 0 || !inform_scan_is(s, (struct inform_piece){ w.at, 1 }, "P")) {
        s->at = at;
        return 0;
    }
    if (*point >= INFORM_POINTS || in->points->point[*point].kind == INFORM_NO_POINT) {
        return inform_scan_fault(s, INFORM_BAD_POINT, w);
    }
    return 1;
}

static int take_tag(struct inform_scan *s, struct inform_piece w, struct inform_code *c)
{
    enum inform_speed tag;
    double speed = 0.0;
    const int status = speed_tag(s, w, &tag, &speed);
    if (status < 0) {
        return -1;
    }
    if (status > 0) {
        if (c->tag != INFORM_DEFAULT) {
            return inform_scan_fault(s, INFORM_BAD_TWICE, w);
        }
        c->tag = tag;
        c->speed = speed;
        w.length = s->at - w.at;
        return (c->tag == INFORM_VJ) == (c->path == INFORM_JOINT)
                   ? 0
                   : inform_scan_fault(s, INFORM_BAD_KIND, w);
    }
    const bool level = inform_scan_is(s, w, "PL");
    if (!level && !inform_scan_is(s, w, "CR")) {
        return inform_scan_fault(s, INFORM_BAD_WORD, w);
    }
    if (c->level != INFORM_ANY || c->corner > 0.0) {
        return inform_scan_fault(s, INFORM_BAD_TWICE, w);
    }
    if (!inform_scan_take(s, '=')) {
        return inform_scan_unexpected(s);
    }
    return level ? inform_scan_whole(s, 0, INFORM_LEVELS, &c->level)
                 : inform_scan_number(s, CORNER_MIN, CORNER_MAX, &c->corner);
}

static int same_frames(struct inform_reading *in, int32_t via, int32_t end)
{
    const struct inform_point *a = &in->points->point[via], *b = &in->points->point[end];
    return a->tool == b->tool && a->user == b->user
               ? 0
               : inform_scan_fault_line(&in->s, INFORM_BAD_ARC_FRAMES);
}

int inform_move_arc_over(struct inform_reading *in)
{
    const bool wrong = in->arc == 1 || in->arc == 2;
    in->arc = 0;
    if (wrong) {
        in->s.line = in->arc_line;
        return inform_scan_fault(&in->s, INFORM_BAD_ARC_POINTS, in->arc_at);
    }
    return 0;
}

/* MOVC of one point: the first of three is a line, the second is kept, the third makes the arc. */
static int arc_point(struct inform_reading *in, struct inform_code *c)
{
    const struct inform_scan *s = &in->s;
    in->arc_line = s->line;
    in->arc_at = (struct inform_piece){ s->begin, s->end - s->begin };
    switch (++in->arc) {
    case 1: c->path = INFORM_LINE; return 0;
    case 2:
        in->via = *c;
        in->p->count--;
        return 0;
    case 3:
        c->via = in->via.to;
        if (c->tag != in->via.tag || c->speed != in->via.speed) {
            in->s.r->other = in->via.line;
            return inform_scan_fault_line(&in->s, INFORM_BAD_ARC_SPEED);
        }
        return same_frames(in, c->via, c->to);
    default: return inform_scan_fault_line(&in->s, INFORM_BAD_ARC_POINTS);
    }
}

int inform_move(struct inform_reading *in, enum inform_path path)
{
    struct inform_scan *s = &in->s;
    struct inform_code *c = inform_reading_add(in, INFORM_OP_MOVE);
    int second = 0;
    if (!c) {
        return -1;
    }
    c->path = path;
    const int status = take_point(in, &c->to);
    if (status <= 0) {
        return status < 0 ? -1 : inform_scan_unexpected(s);
    }
    if (path == INFORM_CIRCLE) {
        int32_t end;
        second = take_point(in, &end);
        if (second < 0) {
            return -1;
        }
        c->via = second ? c->to : 0;
        c->to = second ? end : c->to;
    }
    while (!inform_scan_over(s)) {
        const struct inform_piece w = inform_scan_word(s);
        if (w.length == 0) {
            return inform_scan_unexpected(s);
        }
        if (take_tag(s, w, c)) {
            return -1;
        }
    }
    if (path == INFORM_CIRCLE && !second) {
        return arc_point(in, c);
    }
    return second ? same_frames(in, c->via, c->to) : 0;
}

int inform_move_speed(struct inform_reading *in)
{
    struct inform_scan *s = &in->s;
    int32_t seen = 0;
    do {
        const int32_t at = s->at;
        const struct inform_piece w = inform_scan_word(s);
        struct inform_code *c = inform_reading_add(in, INFORM_OP_SPEED);
        if (!c) {
            return -1;
        }
        const int status = speed_tag(s, w, &c->tag, &c->speed);
        if (status <= 0) {
            s->at = at;
            return status < 0 ? -1 : inform_scan_unexpected(s);
        }
        if (seen & 1 << c->tag) {
            return inform_scan_fault(s, INFORM_BAD_TWICE, w);
        }
        seen |= 1 << c->tag;
    } while (!inform_scan_over(s));
    return 0;
}
