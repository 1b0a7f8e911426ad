#include "external.h"

static const double METRE = 1000.0; /* [mm] */
static const double DEGREE = 0.017453292519943295;

void external_to_world(const struct external *e, double place, double at[3])
{
    for (int i = 0; i < 3 && e->kind == EXTERNAL_TRACK; i++) {
        at[i] += METRE * place * e->along[i];
    }
}

void external_to_arm(const struct external *e, double place, double at[3])
{
    external_to_world(e, -place, at);
}

double external_unit(const struct external *e)
{
    return e->kind == EXTERNAL_TRACK ? 1.0 / METRE : DEGREE;
}

bool external_outside(const struct external *e, double from, double place, double *limit)
{
    const bool high = place > e->high;

    *limit = high ? e->high : e->low;
    return high ? place > from : place < e->low && place < from;
}
