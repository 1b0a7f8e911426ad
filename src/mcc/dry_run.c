/* dry_run - everything is read, planned, checked and reported, but the frames carry no pulses. */
#include <string.h>

#include "mcc.h"

int MCC_enable_dry_run(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->dry_run) {
        return MCC_NO_ERR;
    }
    if (!MCC_check_stop(m)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    m->dry_run = true;
    memcpy(m->dry_place, m->mover.rest, sizeof m->dry_place);
    memcpy(m->dry_pulses, m->mover.pulses, sizeof m->dry_pulses);
    return MCC_NO_ERR;
}

int MCC_disable_dry_run(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!m->dry_run) {
        return MCC_NO_ERR;
    }
    if (!MCC_check_stop(m)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    m->dry_run = false;
    memcpy(m->end, m->dry_place, sizeof m->end);
    memcpy(m->mover.rest, m->dry_place, sizeof m->mover.rest);
    memcpy(m->mover.pulses, m->dry_pulses, sizeof m->mover.pulses);
    memcpy(m->written.place, m->dry_place, sizeof m->written.place);
    memcpy(m->written.pulses, m->dry_pulses, sizeof m->written.pulses);
    return MCC_NO_ERR;
}

int MCC_check_dry_run(const struct mcc *m)
{
    return m->dry_run ? 0 : 1;
}
