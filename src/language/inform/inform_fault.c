#include "inform_fault.h"

#include "inform_decimal.h"

const char *inform_fault_text(enum inform_fault f)
{
    switch (f) {    /* no table: one of pointers would not be constant in a shared library */
    case INFORM_OK:                return "no fault";
    case INFORM_BAD_BYTE:          return "byte 0, which no text has, behind";
    case INFORM_BAD_TEXT_LENGTH:   return "text too long";
    case INFORM_BAD_LINE_LENGTH:   return "line too long";
    case INFORM_BAD_WORD:          return "unknown word";
    case INFORM_BAD_MISSING:       return "incomplete";
    case INFORM_BAD_EXTRA:         return "unexpected";
    case INFORM_BAD_TWICE:         return "given twice";
    case INFORM_BAD_NUMBER:        return "number with more than 15 digits";
    case INFORM_BAD_WHOLE:         return "no whole number";
    case INFORM_BAD_VALUE:         return "value out of range";
    case INFORM_BAD_POINT_TWICE:   return "defined twice";
    case INFORM_BAD_COORDINATES:   return "needs X Y Z A B C or J1 to J6";
    case INFORM_BAD_MIXED:         return "joints beside coordinates or configuration";
    case INFORM_BAD_POINT_FRAME:   return "tool or user frame not defined above";
    case INFORM_BAD_POINT:         return "point not in the points file";
    case INFORM_BAD_FRAME:         return "tool or user frame not in the points file";
    case INFORM_BAD_JOB:           return "no such job";
    case INFORM_BAD_LABEL:         return "no such label in this job";
    case INFORM_BAD_JOB_TWICE:     return "second job of this name";
    case INFORM_BAD_LABEL_TWICE:   return "second label of this name in the job";
    case INFORM_BAD_INTO_LOOP:     return "jump into a LOOP";
    case INFORM_BAD_NOT_OPEN:      return "does not end what is open";
    case INFORM_BAD_OPEN:          return "has no end";
    case INFORM_BAD_AFTER_ELSE:    return "behind ELSE";
    case INFORM_BAD_AFTER_END:     return "behind END";
    case INFORM_BAD_NAME:          return "name too long";
    case INFORM_BAD_ARC_POINTS:    return "MOVC of one point: three in a row, start, via, end";
    case INFORM_BAD_ARC_SPEED:     return "via and end with different speeds";
    case INFORM_BAD_ARC_FRAMES:    return "via and end with different tools or user frames";
    case INFORM_BAD_KIND:          return "operand of the wrong kind";
    case INFORM_BAD_COMPARE:       return "IN# and OT# compare by = or <> with ON or OFF";
    case INFORM_BAD_EMPTY:         return "no instruction";
    case INFORM_BAD_TOO_MANY:      return "too many";
    case INFORM_BAD_STACK:         return "CALL inside too many others";
    case INFORM_BAD_ZERO_DIVISION: return "division by zero";
    case INFORM_BAD_RANGE:         return "result out of range";
    case INFORM_BAD_ENDLESS:       return "endless without motion, input, output or wait";
    case INFORM_FAULT_COUNT:       break;
    }
    return "";
}

void inform_message(const struct inform_report *r, const char *text,
                    char message[INFORM_MESSAGE_MAX])
{
    struct inform_text t = { message, INFORM_MESSAGE_MAX, 0 };

    if (r->line > 0) {
        inform_text_add(&t, "line ");
        inform_text_number(&t, r->line);
        inform_text_add(&t, ": ");
    }
    inform_text_add(&t, inform_fault_text(r->fault));
    if (r->length > 0) {
        inform_text_add(&t, " \"");
        inform_text_bytes(&t, text + r->offset, r->length);
        inform_text_add(&t, "\"");
    }
    if (r->fault == INFORM_BAD_VALUE) {
        inform_text_add(&t, " (");
        inform_text_number(&t, r->low);
        inform_text_add(&t, " to ");
        inform_text_number(&t, r->high);
        inform_text_add(&t, ")");
    } else if (r->fault == INFORM_BAD_TOO_MANY || r->fault == INFORM_BAD_NAME
               || r->fault == INFORM_BAD_TEXT_LENGTH || r->fault == INFORM_BAD_LINE_LENGTH) {
        inform_text_add(&t, " (at most ");
        inform_text_number(&t, r->high);
        inform_text_add(&t, ")");
    }
    if (r->other > 0) {
        inform_text_add(&t, " (line ");
        inform_text_number(&t, r->other);
        inform_text_add(&t, ")");
    }
}
