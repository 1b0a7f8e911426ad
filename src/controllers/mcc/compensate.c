#include "mcc.h"

#include <math.h>

#include "el_extremes.h"

/* The correction of a DDA time changes the speed by no more than the axis gains in a DDA time when
 * it takes acc_time to its safe speed; one pulse always fits. */
static struct comp_limits limits(const struct machine *m, const struct machine_axis *a)
{
    const double dda = machine_dda_time(m);     /* [s] */
    const double safe = a->rpm / 60.0 * a->ppr; /* [pulses/s] */
    const double gain = safe * dda * dda / m->acc_time;

    return (struct comp_limits){ .command = a->max_dda,
                                 .change = (int32_t)el_max(1.0, el_min(gain, COMP_LARGEST)) };
}

bool compensate_due(const struct mcc *m)
{
    for (int i = 0; i < AXES && !m->dry_run; i++) {
        if (m->machine.axis[i].used
            && !comp_done(&m->comp_table[i], &m->comp[i], m->trajectory.pulses[i])) {
            return true;
        }
    }
    return false;
}

void compensate_frame(struct mcc *m, struct point *p)
{
    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->machine.axis[i];
        if (m->dry_run) {
            p->frame[i] = 0;
        } else if (a->used) {
            const struct comp_limits l = limits(&m->machine, a);
            p->frame[i] += comp_step(&m->comp_table[i], &m->comp[i], p->pulses[i], p->frame[i], &l);
        }
        p->added[i] = m->comp[i].added;
    }
}
