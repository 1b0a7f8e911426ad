#include "interpreter.h"

/* Numbers of pages where none has been set are 0, as at the start. */
static void parameters_unused(const struct parameters *p, struct spans *s)
{
    int32_t from = PARAMETERS_PAGE;     /* the first number behind the latest page that is set */

    for (int32_t at = from; at < PARAMETERS_NUMBERED; at += PARAMETERS_PAGE) {
        const uint32_t page = (uint32_t)at / PARAMETERS_PAGE;
        if (p->set[page / 64] >> page % 64 & 1) {
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
    parameters_unused(&in->parameters, s);
    spans_leave(s, &in->flow.open[in->flow.opens], in->flow.open + FLOW_OPEN);
    spans_leave(s, &in->flow.call[in->flow.level], in->flow.call + FLOW_CALLS);
    spans_leave(s, &in->made[in->count], in->made + INTERPRETER_MADE);
}
