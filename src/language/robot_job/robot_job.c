#include "robot_job.h"

#include <float.h>
#include <string.h>

#include "robot_job_reading.h"

/* End the job that is being read. */
static int end_job(struct robot_job_reading *in)
{
    if (in->p->jobs == in->jobs) {
        return 0;
    }
    in->s.line = in->last;
    in->splines = 0;
    if (robot_job_move_arc_over(in) || robot_job_block_all_closed(in)) {
        return -1;
    }
    return in->end_line > 0 || robot_job_reading_add(in, ROBOT_JOB_OP_RET)
               ? 0
               : robot_job_scan_fault(&in->s, ROBOT_JOB_BAD_TOO_MANY, in->last_at);
}

static int begin_job(struct robot_job_reading *in, const char *name, int32_t length)
{
    struct robot_job_program *p = in->p;
    if (p->jobs == ROBOT_JOB_JOBS) {
        in->s.r->high = ROBOT_JOB_JOBS;
        return robot_job_scan_fault_line(&in->s, ROBOT_JOB_BAD_TOO_MANY);
    }
    struct robot_job *job = &p->job[p->jobs++];
    memset(job, 0, sizeof *job);
    memcpy(job->name, name, (size_t)length);
    job->start = p->count;
    job->text = p->texts;
    job->line = in->last = in->s.line;
    in->end_line = 0;
    in->section = ROBOT_JOB_INSIDE;
    robot_job_positions_begin(in);
    return 0;
}

static int32_t job_of(const struct robot_job_program *p, const char *name, int32_t length)
{
    for (int32_t i = 0; i < p->jobs; i++) {
        int32_t n = 0;
        while (n < length && p->job[i].name[n] == name[n]) {
            n++;
        }
        if (n == length && p->job[i].name[n] == '\0') {
            return i;
        }
    }
    return -1;
}

/* Read JOB NAME or //NAME NAME. 1: it has been read, 0: the line is something else. */
static int header(struct robot_job_reading *in)
{
    struct robot_job_scan *s = &in->s;
    struct robot_job_span name;
    s->at = s->begin + s->slashes;
    if (!robot_job_scan_is(s, robot_job_scan_word(s), s->slashes == 2 ? "NAME" : "JOB")) {
        s->at = s->begin;
        return 0;
    }
    if (s->slashes == 1) {
        return 1; /* /JOB: its name follows */
    }
    const int32_t line = s->line, at = s->at;
    if (end_job(in)) {
        return -1;
    }
    s->line = line;
    s->at = at;
    if (robot_job_scan_name(s, ROBOT_JOB_NAME_MAX, &name)) {
        return -1;
    }
    if (!robot_job_scan_over(s)) {
        return robot_job_scan_unexpected(s);
    }
    const int32_t other = job_of(in->p, s->text + name.at, name.length);
    if (other >= 0) {
        s->r->other = in->p->job[other].text == in->p->texts ? in->p->job[other].line : 0;
        return robot_job_scan_fault(s, ROBOT_JOB_BAD_JOB_TWICE, name);
    }
    return begin_job(in, s->text + name.at, name.length) ? -1 : 1;
}

double robot_job_low(enum robot_job_operand_kind kind)
{
    switch (kind) {
    case ROBOT_JOB_B:
    case ROBOT_JOB_LB: return 0.0;
    case ROBOT_JOB_I:
    case ROBOT_JOB_LI: return INT16_MIN;
    case ROBOT_JOB_D:
    case ROBOT_JOB_LD: return INT32_MIN;
    default:           return -DBL_MAX;
    }
}

double robot_job_high(enum robot_job_operand_kind kind)
{
    switch (kind) {
    case ROBOT_JOB_B:
    case ROBOT_JOB_LB: return UINT8_MAX;
    case ROBOT_JOB_I:
    case ROBOT_JOB_LI: return INT16_MAX;
    case ROBOT_JOB_D:
    case ROBOT_JOB_LD: return INT32_MAX;
    default:           return DBL_MAX;
    }
}

int32_t robot_job_find(const struct robot_job_program *p, const char *name)
{
    int32_t length = 0;
    while (length <= ROBOT_JOB_NAME_MAX && name[length] != '\0') {
        length++;
    }
    return length <= ROBOT_JOB_NAME_MAX ? job_of(p, name, length) : -1;
}

/* Find the label of a jump, which must stand in the jump's own LOOP or in one around it. */
static int find_label(struct robot_job_reading *in, struct robot_job_instruction *c, int32_t job)
{
    struct robot_job_program *p = in->p;
    const struct robot_job_span name = { c->to, c->via };
    for (int32_t i = 0; i < p->labels; i++) {
        const struct robot_job_label *l = &p->label[i];
        const struct robot_job_span other = { l->offset, l->length };
        if (l->job != job || !robot_job_scan_same(in->s.text, other, name)) {
            continue;
        }
        for (int32_t loop = c->inside; loop != l->inside; loop = p->instruction[loop].inside) {
            if (loop < 0) {
                in->s.r->other = p->instruction[l->inside].line;
                return robot_job_scan_fault(&in->s, ROBOT_JOB_BAD_INTO_LOOP, name);
            }
        }
        c->to = l->to;
        return 0;
    }
    return robot_job_scan_fault(&in->s, ROBOT_JOB_BAD_LABEL, name);
}

/* Jumps get the numbers of the instructions that their labels stand for. */
static int find_labels(struct robot_job_reading *in)
{
    struct robot_job_program *p = in->p;
    int32_t job = in->jobs - 1;
    for (int32_t i = in->first; i < p->count; i++) {
        struct robot_job_instruction *c = &p->instruction[i];
        while (job + 1 < p->jobs && p->job[job + 1].start <= i) {
            job++;
        }
        in->s.line = c->line;
        if (c->op == ROBOT_JOB_OP_JUMP && c->level == 0) {
            if (find_label(in, c, job)) {
                return -1;
            }
            c->level = ROBOT_JOB_ANY;
            c->via = 0;
        }
    }
    return 0;
}

void robot_job_begin_reading(struct robot_job_program *p)
{
    p->count = p->jobs = p->labels = p->callees = p->positions = p->terms = p->texts = 0;
    memset(p->wanted, 0, sizeof p->wanted);
    memset(p->changed, 0, sizeof p->changed);
    p->changes_any = false;
}

/* Read one line. */
static int read_line(struct robot_job_reading *in)
{
    int status = header(in);
    if (status == 0 && in->p->jobs == in->jobs) {
        status = begin_job(in, "MAIN", 4);
    }
    if (status == 0 && in->s.slashes > 0) {
        status = robot_job_positions_word(in) ? -1 : 1;
    }
    if (status == 0 && in->section != ROBOT_JOB_INSIDE) {
        status = robot_job_positions_line(in);
    }
    in->last = in->s.line;
    in->last_at = (struct robot_job_span){ in->s.begin, in->s.end - in->s.begin };
    return status == 0 ? robot_job_words(in) : status < 0 ? -1 : 0;
}

int robot_job_read_text(struct robot_job_program *p, const struct robot_job_points *points,
                        const char *text, int64_t length, struct robot_job_report *r)
{
    struct robot_job_reading in = { .p = p, .points = points, .first = p->count, .jobs = p->jobs };
    int status = robot_job_scan_begin(&in.s, text, length, r);

    r->text = p->texts;
    if (status) {
        return -1;
    }
    while ((status = robot_job_scan_line(&in.s)) > 0) {
        if (read_line(&in)) {
            return -1;
        }
    }
    if (status < 0 || end_job(&in)) {
        return -1;
    }
    if (p->jobs == in.jobs) {
        return robot_job_scan_fault(&in.s, ROBOT_JOB_BAD_EMPTY, (struct robot_job_span){ 0, 0 });
    }
    if (find_labels(&in)) {
        return -1;
    }
    p->texts++;
    return 0;
}

static int32_t job_called(const struct robot_job_program *p, int32_t callee)
{
    return robot_job_find(p, p->callee[callee].name);
}

bool robot_job_wanted(const struct robot_job_program *p, int32_t callee)
{
    return job_called(p, callee) < 0;
}

/* Positions that instructions want must be in a file, or set by the program. */
static int find_wanted(const struct robot_job_program *p, struct robot_job_report *r)
{
    const struct robot_job_mention *first = NULL;
    for (int32_t i = 0; i < ROBOT_JOB_POINTS && !p->changes_any; i++) {
        const struct robot_job_mention *m = &p->wanted[i];
        bool found = m->line == 0 || p->changed[i];
        for (int32_t k = 0; k < p->positions && !found; k++) {
            found = p->position[k].job < 0 && p->position[k].number == i;
        }
        if (!found
            && (!first || m->text < first->text
                || (m->text == first->text && m->offset < first->offset))) {
            first = m;
        }
    }
    if (!first) {
        return 0;
    }
    *r = (struct robot_job_report){ .fault = ROBOT_JOB_BAD_POINT,
                                    .line = first->line,
                                    .column = first->column,
                                    .offset = first->offset,
                                    .length = first->length,
                                    .text = first->text };
    return -1;
}

int robot_job_end_reading(struct robot_job_program *p, struct robot_job_report *r)
{
    *r = (struct robot_job_report){ .fault = ROBOT_JOB_OK };
    if (find_wanted(p, r)) {
        return -1;
    }
    for (int32_t i = 0; i < p->count; i++) {
        struct robot_job_instruction *c = &p->instruction[i];
        if (c->level != 1 || (c->op != ROBOT_JOB_OP_JUMP && c->op != ROBOT_JOB_OP_CALL)) {
            continue;
        }
        const struct robot_job_callee *name = &p->callee[c->to];
        const int32_t there = job_called(p, c->to);
        if (there < 0) {
            *r = (struct robot_job_report){ .fault = ROBOT_JOB_BAD_JOB,
                                            .line = name->line,
                                            .column = name->column,
                                            .offset = name->offset,
                                            .length = name->length,
                                            .text = name->text };
            return -1;
        }
        c->to = p->job[there].start;
        c->level = ROBOT_JOB_ANY;
    }
    return 0;
}

int robot_job_read(struct robot_job_program *p, const struct robot_job_points *points,
                   const char *text, int64_t length, struct robot_job_report *r)
{
    robot_job_begin_reading(p);
    return robot_job_read_text(p, points, text, length, r) || robot_job_end_reading(p, r) ? -1 : 0;
}

const struct robot_job_point *robot_job_point(const struct robot_job_program *p,
                                              const struct robot_job_points *points, int32_t number)
{
    return number < ROBOT_JOB_POINTS ? &points->point[number]
                                     : &p->position[number - ROBOT_JOB_POINTS].point;
}
