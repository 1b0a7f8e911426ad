#include "fault.h"

#include <string.h>

enum fault fault_at(struct fault_report *r, enum fault f, int32_t at, int32_t length)
{
    r->at = at;
    r->length = length;
    r->other_length = 0;
    return f;
}

void fault_note(struct fault_report *r, enum fault what, int32_t at, int32_t length)
{
    fault_note_limit(r, what, at, length, 0.0, 0.0);
}

void fault_note_limit(struct fault_report *r, enum fault what, int32_t at, int32_t length,
                      double value, double limit)
{
    int i = 0;

    while (i < r->notes && r->note[i].what != what) {
        i++;
    }
    if (i == r->notes) {
        r->note[r->notes] =
            (struct fault_note){ what, r->line, at, length, r->offset, "", value, limit };
        memcpy(r->note[r->notes++].file, r->file, FAULT_FILE);
    }
}

/* The texts themselves, not pointers to them, which would not be constant in a shared library. */
#define ROW(name, text)  [name] = text,
#define FITS(name, text) _Static_assert(sizeof text <= sizeof TEXT[0], #name " is too long");
static const char TEXT[FAULT_COUNT][76] = { FAULT_TEXTS(ROW) };
FAULT_TEXTS(FITS)

const char *fault_text(enum fault f)
{
    return (uint32_t)f < FAULT_COUNT ? TEXT[f] : "";
}
