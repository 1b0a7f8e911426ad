#include "inform_fault.h"

#include "inform_decimal.h"

/* The texts themselves, not pointers to them, which would not be constant in a shared library. */
#define ROW(name, text)  [name] = text,
#define FITS(name, text) _Static_assert(sizeof text <= sizeof TEXT[0], #name " is too long");
static const char TEXT[INFORM_FAULT_COUNT][51] = { INFORM_FAULT_TEXTS(ROW) };
INFORM_FAULT_TEXTS(FITS)

const char *inform_fault_text(enum inform_fault f)
{
    return (uint32_t)f < INFORM_FAULT_COUNT ? TEXT[f] : "";
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
