/* inform_run_damage - whether a run that came back as bytes stays within its arrays and ranges. */
#include "inform_run.h"

#include <math.h>

/* Counting on from here never overflows. */
#define MOVES_MAX ((int64_t)1 << 60)

static bool within(double x, double low, double high)
{
    return x >= low && x <= high;
}

bool inform_damaged(const struct inform_run *run, const struct inform_program *p)
{
    bool good = run->depth >= 0 && run->depth <= INFORM_CALLS;
    for (int32_t i = 0; i <= INFORM_CALLS; i++) {
        good = good && run->frame[i].pc >= 0 && run->frame[i].pc < p->count;
        for (int32_t k = 0; k < INFORM_LOOPS; k++) {
            good = good && run->frame[i].loop[k] >= -1;
        }
    }
    for (int32_t i = 0; i < INFORM_VARIABLES; i++) {
        for (int32_t kind = 0; kind < 3; kind++) {
            good = good && within(run->whole[kind][i],
                                  inform_low((enum inform_operand_kind)(INFORM_B + kind)),
                                  inform_high((enum inform_operand_kind)(INFORM_B + kind)));
        }
        good = good && isfinite(run->real[i]);
    }
    for (int32_t i = INFORM_VJ; i <= INFORM_VR; i++) {
        good = good && within(run->speed[i], 0.0, 1e6) && run->speed[i] > 0.0;
    }
    return !(good && run->moves >= 0 && run->moves <= MOVES_MAX && run->began >= -1
             && within(run->idle, 0, INFORM_IDLE_MAX) && within(run->rotary, 0, 1)
             && within(run->level, 0, INFORM_LEVELS)
             && within(run->tool, 0, INFORM_FRAMES - 1)
             && within(run->user, 0, INFORM_FRAMES - 1) && within(run->ended, 0, 1)
             && within(run->fault, INFORM_OK, INFORM_FAULT_COUNT - 1));
}
