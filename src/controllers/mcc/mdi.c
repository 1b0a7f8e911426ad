#include "mdi.h"

#include <string.h>

#include "mcc.h"
#include "resuming.h"
#include "task.h"

/* Place behind the last line. */
static int64_t end_of(const struct mdi *d)
{
    return d->base + d->length;
}

bool mdi_waits(const struct mdi *d)
{
    return d->until < end_of(d);
}

int32_t mdi_room(const struct mdi *d)
{
    return MDI_SIZE - (int32_t)(end_of(d) - d->from);
}

/* Number of ends of lines in a text. */
static int32_t ends(const char *text, int64_t length)
{
    int32_t n = 0;
    for (int64_t i = 0; i < length; i++) {
        n += text[i] == '\n';
    }
    return n;
}

/* Why no line is taken now; FAULT_NONE: it is. */
static enum fault occupied(const struct mcc *m)
{
    const bool program = m->running && !m->mdi.on;

    return m->error                             ? FAULT_WHILE_ERROR
           : trajectory_ordered(&m->trajectory) ? FAULT_WHILE_HAND
           : program || (!m->mdi.on && !m->trajectory.abort && !control_rests(m))
               ? FAULT_WHILE_PROGRAM
               : FAULT_NONE;
}

/* Refuse the line that was counted last. */
static void refuse(struct mdi *d, const struct fault_report *r)
{
    d->refused = d->line;
    d->refuses = true;
    d->fault = *r;
}

bool mdi_take(struct mcc *m, const char *text, int32_t length)
{
    struct mdi *d = &m->mdi;
    const int32_t all = length + (length == 0 || text[length - 1] != '\n');
    const enum fault f = occupied(m);

    if (f != FAULT_NONE) {
        struct fault_report r;
        memset(&r, 0, sizeof r);
        r.fault = f;
        d->line += ends(text, length) + all - length;
        d->ended = d->line;
        refuse(d, &r);
        return true;
    }
    if (all > mdi_room(d)) {
        return false;
    }
    if (d->from == end_of(d) || all > MDI_SIZE - d->length) {
        const int64_t gone = d->from - d->base;
        memmove(d->text, d->text + gone, (size_t)(d->length - gone));
        d->base += gone;
        d->length -= (int32_t)gone;
    }
    memcpy(d->text + d->length, text, (size_t)length);
    d->text[d->length + all - 1] = '\n';
    d->length += all;
    return true;
}

void mdi_start(struct mcc *m)
{
    struct mdi *d = &m->mdi;

    if (!mdi_waits(d) || m->running || m->trajectory.abort || occupied(m) != FAULT_NONE) {
        return;
    }
    task_resume(m, true);
    m->running = true;
}

void mdi_drop(struct mdi *d)
{
    d->line += ends(d->text + (d->until - d->base), end_of(d) - d->until);
    d->base = d->from = d->until = end_of(d);
    d->length = 0;
}

void mdi_look(struct mcc *m)
{
    struct mdi *d = &m->mdi;

    d->refuses = false;
    if (d->ended == d->line) {
        return;
    }
    if (!mdi_waits(d) && control_rests(m)) {
        d->ended = d->line;
    } else if (d->on && m->written.line < 0 && -m->written.line - 1 > d->ended) {
        d->ended = -m->written.line - 1;
    }
}

static int64_t look(void *context, const char *file, int64_t offset, const char **text)
{
    const struct mdi_view *v = context;
    const struct mdi *d = v->mdi;

    if (file[0]) {
        return v->files ? v->files->look(v->files->context, file, offset, text) : SOURCE_NONE;
    }
    if (offset < d->base || offset >= d->until) {
        return 0;
    }
    *text = d->text + (offset - d->base);
    return d->until - offset;
}

struct source mdi_source(struct mdi_view *v)
{
    return (struct source){ look, v };
}

void mdi_read(struct mcc *m)
{
    m->mdi.from = m->mdi.until;
    m->running = mdi_waits(&m->mdi);
}

bool mdi_next(struct mcc *m, const struct program *p)
{
    struct mdi *d = &m->mdi;
    struct interpreter *in = &m->program;
    struct fault_report r;

    if (d->from < d->until) {
        return true;
    }
    const char *text = d->text + (d->until - d->base);
    d->until += (const char *)memchr(text, '\n', (size_t)(end_of(d) - d->until)) + 1 - text;
    d->line++;
    in->offset = d->from;
    in->line = d->line - 1;
    in->flow.again = in->flow.idle = 0; /* each line has its own count of lines read again */
    interpreter_check(in, p, &r);
    if (r.fault == FAULT_NONE) {
        return true;
    }
    refuse(d, &r);
    resuming_text(in, d->until, d->line);
    mdi_read(m);
    return false;
}
