#include "lines.h"

struct lines lines_of_quarter(int64_t quarter)
{
    return (struct lines){ (quarter & 2) == 0, (((uint64_t)quarter + 1) & 2) != 0 };
}

struct lines lines_wired(struct lines l, uint32_t wiring)
{
    bool a = l.a != ((wiring & LINES_A_INVERSE) != 0);
    bool b = l.b != ((wiring & LINES_B_INVERSE) != 0);
    return wiring & LINES_SWAP ? (struct lines){ b, a } : (struct lines){ a, b };
}
