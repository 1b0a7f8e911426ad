#include "interpreter.h"

/* Numbers of pages where none has been set are 0, as at the start; the first page with those of a
 * call is never left out. */
static void parameters_unused(const struct parameters *p, struct spans *s)
{
    int32_t from = PARAMETERS_PAGE;     /* the first number behind the latest page that is set */

    for (int32_t at = from; at < PARAMETERS_NUMBERED; at += PARAMETERS_PAGE) {
        if (p->given[at / PARAMETERS_PAGE]) {
            spans_zero(s, p->value + from, p->value + at);
            from = at + PARAMETERS_PAGE;
        }
    }
    if (from < PARAMETERS_NUMBERED) {
        spans_zero(s, p->value + from, p->value + PARAMETERS_NUMBERED);
    }
    spans_leave(s, &p->named[p->names], p->named + PARAMETERS_NAMED);
}

void interpreter_unused(const struct interpreter *in, struct spans *s)
{
    spans_ring(s, in->cutter.held, sizeof in->cutter.held[0], CUTTER_HELD, in->cutter.first,
               in->cutter.count);
    spans_leave(s, &in->tools.table.tool[in->tools.table.count],
                in->tools.table.tool + TOOL_TABLE_MAX);
    if (!in->rounding.waits) {
        spans_leave(s, &in->rounding.held, &in->rounding.held + 1);
    }
    spans_zero(s, in->origin[INTERPRETER_SYSTEMS + in->more], in->origin[INTERPRETER_ALL]);
    parameters_unused(&in->parameters, s);
    spans_leave(s, &in->flow.file[in->flow.files], in->flow.file + FLOW_FILES);
    spans_leave(s, &in->flow.open[in->flow.opens], in->flow.open + FLOW_OPEN);
    spans_leave(s, &in->saved[in->flow.level + 1], in->saved + FLOW_CALLS + 1);
    spans_leave(s, &in->flow.call[in->flow.level], in->flow.call + FLOW_CALLS);
    spans_leave(s, &in->made[in->count], in->made + INTERPRETER_MADE);
}
