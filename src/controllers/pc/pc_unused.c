#include "pc.h"

void pc_unused(const struct pc *pc, struct spans *s)
{
    mcc_unused(&pc->mcc, s);
    voltage_unused(&pc->voltage, s);
}
