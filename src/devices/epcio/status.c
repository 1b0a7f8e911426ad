#include "status.h"

#include "bus.h"

/* A table of the texts themselves; pointers to them would need relocation in a shared library. */
#define ROW(name, text)  [name] = text,
#define FITS(name, text) _Static_assert(sizeof text <= sizeof TEXT[0], #name " is too long");
static const char TEXT[EPCIO_STATUS_COUNT][65] = { EPCIO_STATUS_TEXTS(ROW) };
EPCIO_STATUS_TEXTS(FITS)

const char *card_status_text(enum epcio_status status)
{
    return (uint32_t)status < EPCIO_STATUS_COUNT ? TEXT[status] : "unknown status";
}

_Static_assert(BUS_FRAMES == 16 && BUS_DEPTH == 8, "the texts name these numbers");
