#include "fpga.h"

#include <math.h>

#include "el_extremes.h"

/* Voltage quantised to 16 bits for +-10 V: -32768 .. 32767 steps of 10 V / 2^15, saturated. */
static double quantised(double volts)
{
    const double steps = 32768.0, range = 10.0; /* [V] */
    const double code = rint(volts / range * steps);
    return el_max(-steps, el_min(code, steps - 1.0)) * range / steps;
}

/* Count a post as late if the exchange that its clock meant has happened already. */
static void count_late(struct fpga *f, int64_t clock)
{
    f->late += clock > 0 && fpga_exchange_of(f, clock) <= f->clock;
}

enum fpga_status fpga_post_entry(struct fpga *f, const struct fpga_entry *e)
{
    if (f->entering == FPGA_WAITING)
        return fpga_refuse(f, FPGA_ON_THE_WAY);
    count_late(f, e->clock);
    int32_t i = f->entering++;
    for (; i > 0 && f->entries[i - 1].clock > e->clock; i--)
        f->entries[i] = f->entries[i - 1];
    f->entries[i] = *e;
    return FPGA_OK;
}

enum fpga_status fpga_post_ao(struct fpga *f, const struct fpga_ao *a)
{
    if (f->ao_waiting == FPGA_AO_WRITES)
        return fpga_refuse(f, FPGA_ON_THE_WAY);
    count_late(f, a->clock);
    struct fpga_ao *to = &f->aos[f->ao_waiting++];
    to->clock = a->clock;
    for (int i = 0; i < FPGA_ANALOG; i++)
        to->volts[i] = quantised(a->volts[i]);
    return FPGA_OK;
}

void fpga_set_host(struct fpga *f, bool run, uint32_t servo)
{
    f->run = run;
    f->pending |= servo != f->host_servo;
    f->host_servo = servo;
}

void fpga_reset_stop(struct fpga *f)
{
    f->pending = f->reset = true;
}

uint32_t fpga_inputs_changed(const struct fpga *f, uint32_t levels)
{
    return levels ^ f->inputs.level ^ f->inputs.coming;
}

void fpga_change_input(struct fpga *f, int channel, int64_t clock)
{
    struct fpga_inputs *in = &f->inputs;
    const uint32_t bit = (uint32_t)1 << channel;
    const bool was_coming = in->coming & bit;
    in->coming &= ~bit;
    if (was_coming && in->clock[channel] > f->clock)
        return; /* the change that was to come is cancelled */
    if (was_coming)
        in->level ^= bit;
    count_late(f, clock);
    if (clock > f->clock) {
        in->first = in->coming && in->first < clock ? in->first : clock;
        in->coming |= bit;
        in->clock[channel] = clock;
    } else {
        in->level ^= bit;
    }
    f->pending = true;
}

void fpga_set_ai(struct fpga *f, const double volts[FPGA_ANALOG])
{
    for (int i = 0; i < FPGA_ANALOG; i++)
        f->ai[i] = quantised(volts[i]);
}

void fpga_set_drives(struct fpga *f, uint32_t drives, bool emergency_stop)
{
    f->pending |= drives != f->drive_pins || emergency_stop != f->emergency;
    f->drive_pins = drives;
    f->emergency = emergency_stop;
}
