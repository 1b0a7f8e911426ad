#include "groups_unused.h"

void groups_unused(const struct groups *g, struct spans *s)
{
    for (int i = 0; i < GROUP_MAX; i++) {
        const struct group *one = &g->group[i];
        if (one->used) {
            mcc_unused(&one->mcc, s);
        } else {
            spans_leave(s, &one->mcc, &one->mcc + 1);
        }
        if (one->used && one->voltage) {
            voltage_unused(&one->servo.voltage, s);
        } else {
            spans_leave(s, &one->servo, &one->servo + 1);
        }
    }
}
