#include "drive.h"

#include <math.h>

#define RAD_PER_S_PER_RPM  0.10471975511965977 /* 2 pi / 60 */
#define RPM_PER_TURN_PER_S 60.0

static double clamp(double value, double limit)
{
    return value > limit ? limit : value < -limit ? -limit : value;
}

/* PI with torque limit. The integral stands still while the torque is limited and the error would
 * push it further (conditional integration). So it never exceeds the limit itself, and the torque
 * leaves the limit in the very sample in which the error turns. */
static void velocity_loop(const struct drive_config *c, struct drive_state *s, double error,
                          bool first, struct drive_output *out)
{
    double p = c->velocity_gain * error;
    double step = 0.0;
    if (c->velocity_time <= 0.0)
        s->integral = 0.0;
    else if (first)
        s->integral = -p; /* bumpless: the torque starts from the zero it had */
    else
        step = p * c->period / c->velocity_time;
    double wanted = p + s->integral + step;
    double excess = wanted - clamp(wanted, c->torque_limit);
    if (excess * step > 0.0)
        step = 0.0;
    s->integral += step;
    out->torque = clamp(wanted, c->torque_limit);
    out->saturated = excess != 0.0;
}

/* Speed command [rpm] in velocity or position mode; position mode sets the following error, too.
 * `pulses` came since the latest sample. */
static double speed_command(const struct drive_config *c, struct drive_state *s,
                            const struct drive_input *in, int32_t pulses, struct drive_output *out)
{
    if (c->mode == DRIVE_VELOCITY)
        return clamp((in->volts + c->volt_offset) * c->speed_per_volt, c->speed_limit);
    double ppt = c->pulses_per_turn;
    out->following_error =
        (double)s->command / ppt - (double)(s->counts - s->zero) / c->encoder_counts;
    if (c->feed_forward_time > 0.0)
        s->forward += (pulses / (ppt * c->period) - s->forward)
                      * (c->period / (c->feed_forward_time + c->period));
    double forward = c->feed_forward_time > 0.0 ? c->feed_forward * s->forward
                                                : c->feed_forward * pulses / (ppt * c->period);
    double turns_per_s = c->position_gain * out->following_error + forward;
    return clamp(turns_per_s * RPM_PER_TURN_PER_S, c->speed_limit);
}

/* Overload alarm: the torque has been at its limit for longer than overload_time; samples below the
 * limit count back. A load beyond the torque limit keeps the torque there, a ramp for less time. */
static bool overloaded(const struct drive_config *c, struct drive_state *s, bool saturated)
{
    if (!(c->overload_time > 0.0))
        return false;
    s->load += saturated ? 1 : s->load > 0 ? -1 : 0;
    return (double)s->load * c->period > c->overload_time;
}

/* The drive is off: no torque but that of the holding brake, the torque that brings the motor to
 * rest from its speed [rpm] and keeps it there, limited to brake_torque. */
static void stand(const struct drive_config *c, struct drive_state *s, double speed,
                  struct drive_output *out)
{
    s->on = out->ready = false;
    out->torque = out->speed_command = 0.0;
    if (c->brake_torque > 0.0) {
        struct drive_config brake = *c;
        brake.torque_limit = c->brake_torque;
        s->integral = clamp(s->integral, c->brake_torque);
        velocity_loop(&brake, s, -speed * RAD_PER_S_PER_RPM, false, out);
    }
    out->saturated = false; /* the drive gives no torque */
}

/* A reset clears the alarm; an encoder that is not seen is one at once. */
static void look_at_reset(struct drive_state *s, const struct drive_input *in)
{
    if (in->alarm_reset && !s->reset)
        s->alarm = DRIVE_NO_ALARM;
    s->reset = in->alarm_reset;
    if (in->unplugged)
        s->alarm = DRIVE_ENCODER;
}

enum drive_status drive_tick(const struct drive_config *c, struct drive_state *s,
                             const struct drive_input *in, struct drive_output *out)
{
    double counts = floor(in->phase * c->encoder_counts / c->encoder_lines);
    if (!(fabs(counts) <= DRIVE_COUNTS_MAX))
        return DRIVE_BAD_PHASE;
    int64_t moved = s->primed ? (int64_t)counts - s->counts : 0;
    s->counts = (int64_t)counts;
    int32_t pulses = (int32_t)((uint32_t)in->pulses - (uint32_t)s->pulses);
    s->pulses = in->pulses;
    s->primed = true;
    look_at_reset(s, in);

    *out = (struct drive_output){ 0 };
    /* The brake sits on the shaft: it needs no encoder. */
    const double speed = (double)moved * RPM_PER_TURN_PER_S / (c->encoder_counts * c->period);
    out->speed = in->unplugged ? 0.0 : speed;
    bool run = in->enable && s->alarm == DRIVE_NO_ALARM;
    bool first = run && !s->on;
    if (first) {
        s->zero = s->counts;
        s->command = 0;
        s->forward = 0.0;
        s->load = 0;
        pulses = 0;
    }
    if (run) {
        s->command += pulses;
        out->speed_command = speed_command(c, s, in, pulses, out);
        if (fabs(out->following_error) > c->error_limit)
            s->alarm = DRIVE_FOLLOWING_ERROR;
        else if (fabs(out->speed) > DRIVE_OVERSPEED_RATIO * c->speed_limit)
            s->alarm = DRIVE_OVERSPEED;
        run = s->alarm == DRIVE_NO_ALARM;
    }
    if (run) {
        s->on = out->ready = true;
        velocity_loop(c, s, (out->speed_command - out->speed) * RAD_PER_S_PER_RPM, first, out);
        if (overloaded(c, s, out->saturated))
            s->alarm = DRIVE_OVERLOAD;
    }
    if (!run || s->alarm == DRIVE_OVERLOAD)
        stand(c, s, speed, out);
    out->alarm = s->alarm;
    return DRIVE_OK;
}
