#include "interpreter.h"

#include <stddef.h>
#include <string.h>

#include "waiting.h"

/* State of a check, by which it leaves out faults that only follow from others. */
struct check {
    enum fault latest; /* fault of an axis since the latest command; or FAULT_NONE */
    int32_t axis;
    bool flow; /* an O word was wrong, so that ends of loops and conditions prove nothing */
};

/* Whether a fault is of an axis: all motions that follow may have it. */
static bool of_axis(enum fault f)
{
    return f == FAULT_SPEED || f == FAULT_RANGE || f == FAULT_TRAVEL || f == FAULT_AXIS;
}

/* Whether a fault only follows from one that is listed, or is a second one of its line. */
static bool follows(struct check *k, const struct fault_list *all, const struct fault_report *r)
{
    const bool word = r->fault >= FAULT_O_WORD && r->fault <= FAULT_CALLS;
    const bool same = of_axis(r->fault) && r->fault == k->latest && r->axis == k->axis;
    const bool end = (r->fault == FAULT_O_PLACE || r->fault == FAULT_O_END) && k->flow;
    bool again = false;

    for (int i = 0; i < all->count; i++) {
        again = again
                || (all->of[i].offset == r->offset
                    && memcmp(all->of[i].file, r->file, FAULT_FILE) == 0);
    }
    k->latest = of_axis(r->fault) ? r->fault : k->latest;
    k->axis = r->axis;
    k->flow = k->flow || word;
    return same || end || again;
}

/* Whether nothing can be read behind a fault. */
static bool last(enum fault f)
{
    return f == FAULT_READ || f == FAULT_ZERO || f == FAULT_ENDLESS || f == FAULT_ALARM;
}

/* List a note unless there is one of its kind. */
static void note(struct fault_list *all, const struct fault_note *told)
{
    for (int i = 0; i < all->notes; i++) {
        if (all->note[i].fault == told->what) {
            return;
        }
    }
    struct fault_report *n = &all->note[all->notes++];
    memset(n, 0, sizeof *n);
    n->fault = told->what;
    n->line = told->line;
    n->offset = told->offset;
    memcpy(n->file, told->file, FAULT_FILE);
    n->at = told->at;
    n->value = told->value;
    n->limit = told->limit;
    n->length = told->length;
}

/* List a fault; false: the check ends. */
static bool take(struct check *k, struct fault_list *all, const struct fault_report *r, int room)
{
    if (!follows(k, all, r)) {
        all->more = all->count == room;
        if (all->more) {
            return false;
        }
        all->of[all->count++] = *r;
    }
    return !last(r->fault);
}

/* Read the program to its end, or to the first fault if `room` is 1, or to fault room + 1. */
static void check(struct interpreter *in, const struct program *p, int room, struct fault_list *all)
{
    const int64_t most = p->check_again > 0 ? p->check_again : CHECK_AGAIN;
    struct check k = { FAULT_NONE, 0, false };
    struct fault_report r;
    struct command c;

    memset(&r, 0, sizeof r);
    while (all->count < room || room > 1) {
        const enum interpreter_result got = interpreter_read(in, p, &c, &r);
        for (int i = 0; i < r.notes; i++) {
            note(all, &r.note[i]);
        }
        if (got == INTERPRETER_END || got == INTERPRETER_LINES
            || (got == INTERPRETER_FAULT && !take(&k, all, &r, room))) {
            return;
        }
        if (got == INTERPRETER_WAIT) {
            waiting_pass(in);
        }
        if (got == INTERPRETER_COMMAND) {
            k.latest = FAULT_NONE;
        }
        if (in->flow.again > most) {
            struct fault_note end = { FAULT_NOTE_CHECKED, r.line, 0, 0, r.offset, "", 0.0, 0.0 };
            memcpy(end.file, r.file, FAULT_FILE);
            note(all, &end);
            return;
        }
        memset(&r.other_at, 0, sizeof r - offsetof(struct fault_report, other_at));
    }
}

void interpreter_check_all(const struct interpreter *from, const struct program *p,
                           struct fault_list *all)
{
    struct interpreter in = *from;

    memset(all, 0, sizeof *all);
    check(&in, p, FAULT_LIST, all);
}

void interpreter_check(const struct interpreter *from, const struct program *p,
                       struct fault_report *r)
{
    struct interpreter in = *from;
    struct fault_list all;

    memset(&all, 0, sizeof all);
    check(&in, p, 1, &all);
    *r = all.of[0];
}
