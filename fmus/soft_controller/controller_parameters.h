/* controller_parameters - checks the parameters of the soft_controller FMU and converts them to the
 * configuration of the robot controller. Included after fmi_model.h. */
#ifndef CONTROLLER_PARAMETERS_H
#define CONTROLLER_PARAMETERS_H

#include <math.h>

/* Interrupt latencies [s] of kinds of PCs (latency.h), from LatencyMon reports of ordinary PCs. */
static const struct pc_wait {
    const char *name;
    double mean, rare, most;
} PC_WAIT[] = {
    { "document", 0.0, 0.0, 0.0 },
    { "good", 1.2e-6, 1e-5, 160e-6 },
    { "graphics", 2.7e-6, 1e-5, 667e-6 },
};

static int set_wait(struct fmu *f, struct controller_settings *s)
{
    const char *pc = f->s.v.pc;

    for (size_t i = 0; i < sizeof PC_WAIT / sizeof *PC_WAIT; i++) {
        if (strcmp(pc, PC_WAIT[i].name) == 0) {
            s->irq_mean = PC_WAIT[i].mean;
            s->irq_rare = PC_WAIT[i].rare;
            s->irq_longest = PC_WAIT[i].most;
            return 0;
        }
    }
    return strcmp(pc, "own") == 0
               ? 0
               : fmu_fail(f, "pc = \"%s\": one of document, good, graphics, own is wanted", pc);
}

static int config_of(struct fmu *f, struct controller_config *c)
{
    const struct vars *v = &f->s.v;
    struct controller_settings s;
    struct controller_wrong w;

#define SETTING(type, name, elements, unit, start, low, high) LINK_CARRY(s.name, v->name)
    CONTROLLER_SETTINGS(SETTING)
    if (!controller_settings_good(&s, &w)) {
        return fmu_fail(f, "%s = %.17g (element %d): %s", w.name, w.value, (int)w.index + 1,
                        w.why ? w.why : "out of range");
    }
    if (set_wait(f, &s)) {
        return -1;
    }
    controller_configure(&s, c);
    if (2 * c->bus > c->slots * c->slot) {
        fmu_warn(f,
                 "bus_period = %g s is more than half of the %g s that a memory plays: its "
                 "slots come too late",
                 v->bus_period, c->robot.cycle);
    }
    return 0;
}

#endif
