/* binding_mcc - the motion library with its card and ideal motors (a station) for Python. */
#include <string.h>

#include "binding.h"
#include "binding_text.h"
#include "station.h"

/* Settings have the names and units of the FMU's parameters. AXIS_IN: a member of every axis. */
#define AXIS_IN(m, name, unit, ...) \
    { name, \
      unit, \
      KIND(((struct station_config *)0)->machine.axis[0].m), \
      OFFSET(station_config, machine.axis[0].m), \
      AXES, \
      sizeof(struct machine_axis), \
      __VA_ARGS__ }
#define AXIS(m, name, unit) AXIS_IN(m, name, unit, SAME)

#define HOME(m, name, unit) \
    { "home_" name, \
      unit, \
      KIND(((struct station_config *)0)->pc.home[0].m), \
      OFFSET(station_config, pc.home[0].m), \
      AXES, \
      sizeof(struct home_config), \
      SAME }
#define ASYN(m, unit)        ROW(station_config, machine.asyn.m, "asyn_" #m, unit)
#define MACHINE(m, unit)     ONE(station_config, machine.m, #m, unit)
#define MODULE_TIME(m, name) ROW_IN(station_config, pc.m, "module_" name, "s", SECONDS)
#define PC(m, unit)          ONE(station_config, pc.m, #m, unit)
#define PC_TIME(m, name)     ONE_IN(station_config, pc.m, name, "s", SECONDS)
static const struct field config_fields[] = {
    AXIS(used, "active", ""),
    AXIS(pitch, "lead", "mm"),
    AXIS(gear_ratio, "gear_ratio", ""),
    AXIS(ppr, "ppr", ""),
    AXIS(rpm, "max_rpm", "rpm"),
    AXIS(p_gain, "p_gain", ""),
    AXIS(max_dda, "max_dda", "pulses"),
    AXIS(inverted, "pos2encoder_dir", ""),
    AXIS_IN(index_low, "index_on", "", OPPOSITE),
    AXIS(max_dda_acc, "max_dda_acc", "pulses"),
    AXIS(check_ot, "check_over_travel", ""),
    AXIS(high_limit, "high_limit", "mm"),
    AXIS(low_limit, "low_limit", "mm"),
    AXIS(hot_offset, "hot_offset", "mm"),
    AXIS(lot_offset, "lot_offset", "mm"),
    AXIS(track_limit, "track_error_limit", "counts"),
    AXIS(in_pos, "in_pos", ""),
    AXIS(inpos_tol, "inpos_tol", "mm"),
    AXIS(acc, "axis_acc", "mm/s2"),
    AXIS(jerk, "axis_jerk", "mm/s3"),
    MACHINE(limit_check, ""),
    MACHINE(limit_mode, ""),
    MACHINE(inpos_mode, ""),
    MACHINE(inpos_settle, "s"),
    MACHINE(inpos_timeout, "s"),
    MACHINE(dda_time, "s"),
    MACHINE(dda_length, "bit"),
    MACHINE(queue_depth, ""),
    ONE_IN(station_config, machine.feed, "feed", "mm/min", PER_MINUTE),
    ONE_IN(station_config, machine.max_feed, "max_feed", "mm/min", PER_MINUTE),
    MACHINE(arc_tolerance, "mm"),
    MACHINE(acc_time, "s"),
    MACHINE(dec_time, "s"),
    MACHINE(acc_type, ""),
    MACHINE(dec_type, ""),
    MACHINE(jerk_share, ""),
    MACHINE(ptp_ratio, ""),
    PC_TIME(bus, "bus_period"),
    PC_TIME(ipo, "ipo_period"),
    PC(ipo_event, ""),
    PC_TIME(latency, "irq_latency"),
    PC_TIME(jitter, "irq_jitter"),
    PC(seed, ""),
    PC(min_stock, ""),
    PC(batch, ""),
    PC(block_delete, ""),
    PC(optional_stop, ""),
    PC(dry_run, ""),
    ROW(station_config, pc.output_mode, "output_mode", ""),
    ROW(station_config, pc.isr.mask, "irq_sources", ""),
    ROW(station_config, pc.isr.priority, "irq_priority", ""),
    PC_TIME(isr.service, "service_time"),
    PC_TIME(interpreter, "interpreter_period"),
    PC_TIME(process, "process_period"),
    ROW(station_config, pc.priority, "module_priority", ""),
    MODULE_TIME(offset, "offset"),
    MODULE_TIME(time, "time"),
    MODULE_TIME(unit, "unit_time"),
    ROW(station_config, pc.most, "module_units", ""),
    ROW(station_config, software_gain, "software_gain", "V"),
    ASYN(acc_type, ""),
    ASYN(dec_type, ""),
    ASYN(acc_time, "s"),
    ASYN(dec_time, "s"),
    ROW(station_config, pc.home_order, "home_order", ""),
    PC(home_first, ""),
    PC(home_settle, "s"),
    ROW(station_config, pc.encoder_backward, "encoder_backward", ""),
    { "home_mode", "", 'i', OFFSET(station_config, pc.home[0].mode), AXES,
      sizeof(struct home_config), SAME },
    HOME(direction, "dir", "bits"),
    HOME(sensor_on, "sensor_on", ""),
    HOME(high_speed, "high_speed", "mm/s"),
    HOME(low_speed, "low_speed", "mm/s"),
    HOME(offset, "offset", "mm"),
    HOME(search, "search", "mm"),
    HOME(index_way, "index_way", "mm"),
};

#define READ(m, unit)     ONE(station_reading, m, #m, unit)
#define READ_ROW(m, unit) ROW(station_reading, m, #m, unit)
static const struct field reading_fields[] = {
    READ(clock, "clocks"),
    READ_ROW(pulses, "pulses"),
    READ_ROW(counts, "counts"),
    READ_ROW(errors, "counts"),
    READ_ROW(volts, "V"),
    READ_ROW(motor, "counts"),
    READ_ROW(table, "mm"),
    READ_ROW(position, "mm"),
    READ(path_feed, "mm/s"),
    READ_ROW(stock, "commands"),
    READ_ROW(underflows, ""),
    READ(frames_taken, ""),
    READ(frames_refused, ""),
    READ(interrupts, ""),
    READ(irq_clock, "clocks"),
    READ(services, ""),
    ONE_IN(station_reading, latency, "latency", "s", SECONDS),
    READ(missed, ""),
    READ(ipo_cycle, ""),
    READ(queue, "points"),
    READ(starved, ""),
    READ(status, ""),
    READ(error, ""),
    READ(line, ""),
    READ(command, ""),
    READ(digital_out, "bits"),
    READ(coolant, "bits"),
    READ(spindle_speed, "rpm"),
    READ(stopped, ""),
};

#define PIN(m) ONE(station, lines.local.m, #m, "")
static const struct field pin_fields[] = {
    ROW(station, lines.phase, "phase", "periods"),
    PIN(home),
    PIN(up),
    PIN(down),
    PIN(stop),
    PIN(ldi),
    PIN(dfi),
    PIN(power),
};

/* The parameters of the source document and their places in struct mcc. */
#define PARAM(m, unit) \
    { #m, \
      unit, \
      KIND(((struct mcc *)0)->epcio_axis_param[0].m), \
      OFFSET(mcc, epcio_axis_param[0].m), \
      AXES, \
      sizeof(MCC_MACH_PARAM), \
      SAME }
static const struct field param_fields[] = {
    PARAM(type, ""),         PARAM(pos2encoder_dir, ""),
    PARAM(PPR, ""),          PARAM(RPM, "rpm"),
    PARAM(pitch, "mm"),      PARAM(gear_ratio, ""),
    PARAM(high_limit, "mm"), PARAM(low_limit, "mm"),
    PARAM(HOT_offset, "mm"), PARAM(LOT_offset, "mm"),
    PARAM(sensor_on, ""),    PARAM(index_on, ""),
    PARAM(home_dir, "bits"), ONE(mcc, cart_max_speed, "cart_max_speed", "mm/s"),
};

static const struct field comp_fields[] = {
    ONE(comp_table, interval, "interval", "pulses"),
    ONE(comp_table, home, "home", ""),
    ROW(comp_table, forward, "forward", "pulses"),
    ROW(comp_table, backward, "backward", "pulses"),
};

#define REPORT(m) ONE(fault_report, m, #m, "")
static const struct field report_fields[] = {
    { "fault", "", 'i', OFFSET(fault_report, fault), 1, sizeof(enum fault), SAME },
    REPORT(line),
    REPORT(offset),
    REPORT(at),
    REPORT(length),
    REPORT(other_at),
    REPORT(other_length),
    REPORT(axis),
    REPORT(value),
    REPORT(limit),
    ROW(fault_report, file, "file", ""),
};
_Static_assert(sizeof(enum fault) == sizeof(int32_t) && sizeof(enum home_mode) == sizeof(int32_t),
               "an enum is read as an int32");

const struct table MCC_TABLES[] = {
    { "config", config_fields, sizeof config_fields, sizeof(struct station_config) },
    { "reading", reading_fields, sizeof reading_fields, sizeof(struct station_reading) },
    { "station", pin_fields, sizeof pin_fields, sizeof(struct station) },
    { "report", report_fields, sizeof report_fields, sizeof(struct fault_report) },
    { "mcc", NULL, 0, sizeof(struct mcc) },
    { "param", param_fields, sizeof param_fields, sizeof(struct mcc) },
    { "comp", comp_fields, sizeof comp_fields, sizeof(struct comp_table) },
    { NULL, NULL, 0, 0 },
};

void binding_defaults(struct station_config *config)
{
    *config = station_defaults();
}

/* The motion library of a station; the machine of a configuration. */
struct mcc *binding_mcc(struct station *s)
{
    return &s->pc.mcc;
}

const struct machine *binding_machine(const struct station_config *config)
{
    return &config->machine;
}

/* Functions with the text of a part program in memory (NULL: none) and the files that it calls.
 * They run a station, check the program, or plan it as the task does and take the points as a card
 * would, which gives at most `room` frames [pulses]. */
int binding_run(struct station *s, int64_t until, const char *text, int64_t length,
                binding_file file)
{
    struct binding_text t = binding_text_of(text, length, file);
    const struct source source = binding_source(&t);
    return station_run(s, until, text ? &source : NULL);
}

void binding_check(const struct mcc *m, const char *text, int64_t length, binding_file file,
                   struct fault_report *r, int32_t count[3])
{
    struct binding_text t = binding_text_of(text, length, file);
    const struct source source = binding_source(&t);
    struct fault_list all;
    task_check_all(m, &source, &all);
    binding_reports(&all, r, count);
}

int32_t binding_take(struct mcc *m, const char *text, int64_t length, binding_file file,
                     int32_t (*frame)[AXES], int32_t room)
{
    struct binding_text t = binding_text_of(text, length, file);
    const struct source source = binding_source(&t);
    for (int32_t n = 0; n < room; n++) {
        task_run(m, text ? &source : NULL);
        if (m->queue.count == 0) {
            return n;
        }
        m->written = *queue_peek(&m->queue, 0);
        memcpy(frame[n], m->written.frame, sizeof *frame);
        queue_drop(&m->queue, 1);
    }
    return room;
}
