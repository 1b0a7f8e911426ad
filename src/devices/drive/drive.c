#include "drive.h"

#include <math.h>

#define RAD_PER_S_PER_RPM  0.10471975511965977 /* 2 pi / 60 */
#define RPM_PER_TURN_PER_S 60.0
/* The command's filter has arrived when it is this far behind [pulses]: below any encoder count. */
#define ARRIVED 1e-9

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

/* The command behind its moving mean and its filter of first order [pulses]; `pulses` came since
 * the latest sample, `*moved` is how far the smoothed one went. The mean is a sum of whole numbers
 * and the filter keeps what it lacks, so at rest the command has gone all pulses, exactly. */
static double smoothed(const struct drive_config *c, struct drive_state *s, int32_t pulses,
                       double *moved)
{
    double command = (double)s->command;
    *moved = pulses;
    if (c->command_mean > 1) {
        s->window += (int64_t)pulses - s->past[s->place];
        s->past[s->place] = pulses;
        s->place = (s->place + 1) % c->command_mean;
        s->sum += s->window;
        command = (double)s->sum / c->command_mean;
        *moved = (double)s->window / c->command_mean;
    }
    if (c->command_time > 0.0) {
        const double before = s->lag;
        s->lag = (before + *moved) * (c->command_time / (c->command_time + c->period));
        if (*moved == 0.0 && fabs(s->lag) < ARRIVED)
            s->lag = 0.0;
        command -= s->lag;
        *moved -= s->lag - before;
    }
    return command;
}

/* Speed command [rpm] in velocity or position mode; position mode sets the following error, too.
 * `pulses` came since the latest sample. */
static double speed_command(const struct drive_config *c, struct drive_state *s,
                            const struct drive_input *in, int32_t pulses, struct drive_output *out)
{
    if (c->mode == DRIVE_VELOCITY)
        return clamp((in->volts + c->volt_offset) * c->speed_per_volt, c->speed_limit);
    double ppt = c->pulses_per_turn;
    double moved = 0.0; /* [pulses] */
    const double command = smoothed(c, s, pulses, &moved);
    out->following_error = command / ppt - (double)(s->counts - s->zero) / c->encoder_counts;
    if (c->feed_forward_time > 0.0)
        s->forward += (moved / (ppt * c->period) - s->forward)
                      * (c->period / (c->feed_forward_time + c->period));
    double forward = c->feed_forward_time > 0.0 ? c->feed_forward * s->forward
                                                : c->feed_forward * moved / (ppt * c->period);
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

/* Heat of the windings: the square of the torque in units of the rated one through a low pass. The
 * alarm comes above the square of thermal_limit: by RMS torque, at ratio r from cold after
 * -thermal_time ln(1 - (thermal_limit/r)^2). */
static bool too_hot(const struct drive_config *c, struct drive_state *s, double torque)
{
    if (!(c->rated_torque > 0.0))
        return false;
    const double ratio = torque / c->rated_torque;
    s->heat += (ratio * ratio - s->heat) * (c->period / (c->thermal_time + c->period));
    return s->heat > c->thermal_limit * c->thermal_limit;
}

/* Whether the loops go on for a drive that is switched off and its brake still open. The brake is
 * told to close once the motor rests, at brake_run_time at the latest, and bears brake_close_time
 * later. */
static bool run_down(const struct drive_config *c, struct drive_state *s, double speed, bool hold)
{
    const bool rests = fabs(speed) <= c->brake_speed;
    if (!s->released)
        return false;
    if (s->off == 0)
        s->holding = rests;
    s->off++;
    if (s->signal > 0 || rests || (double)s->off * c->period > c->brake_run_time)
        s->signal++;
    const double told = (double)s->signal * c->period; /* [s] since the brake's signal */
    s->holding = s->holding && hold && !(told > c->brake_hold_time);
    s->released = s->holding || s->signal == 0 || !(told > c->brake_close_time);
    return s->holding;
}

/* The drive is off: no torque but that of the holding brake, the torque that brings the motor to
 * rest from its speed [rpm] and keeps it there, limited to brake_torque. */
static void stand(const struct drive_config *c, struct drive_state *s, double speed,
                  struct drive_output *out)
{
    s->on = out->ready = false;
    out->torque = out->speed_command = 0.0;
    if (c->brake_torque > 0.0 && !s->released) {
        struct drive_config brake = *c;
        brake.torque_limit = c->brake_torque;
        s->integral = clamp(s->integral, c->brake_torque);
        velocity_loop(&brake, s, -speed * RAD_PER_S_PER_RPM, false, out);
    }
    out->saturated = false; /* the drive gives no torque */
}

/* The loops are switched on: the command begins where the motor is. */
static void switch_on(const struct drive_config *c, struct drive_state *s)
{
    s->zero = s->counts;
    s->command = s->sum = s->window = 0;
    s->forward = s->lag = 0.0;
    s->load = 0;
    s->place = 0;
    for (int i = 0; i < c->command_mean; i++)
        s->past[i] = 0;
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

/* The speed command of loops that run, `pulses` of it new; a drive that is switched off holds its
 * place. False: an alarm ends them. */
static bool follow(const struct drive_config *c, struct drive_state *s,
                   const struct drive_input *in, int32_t pulses, bool wanted,
                   struct drive_output *out)
{
    struct drive_input seen = *in;
    if (!wanted)
        seen.volts = -c->volt_offset;
    s->command += pulses;
    out->speed_command = speed_command(c, s, &seen, pulses, out);
    if (fabs(out->following_error) > c->error_limit)
        s->alarm = DRIVE_FOLLOWING_ERROR;
    else if (fabs(out->speed) > DRIVE_OVERSPEED_RATIO * c->speed_limit)
        s->alarm = DRIVE_OVERSPEED;
    return s->alarm == DRIVE_NO_ALARM;
}

/* CCN 20: what a sample does, in its order. */
enum drive_status drive_tick(const struct drive_config *c, struct drive_state *s,
                             const struct drive_input *in, struct drive_output *out)
{
    const double exact = in->phase * c->encoder_counts / c->encoder_lines;
    if (!(fabs(exact) <= DRIVE_COUNTS_MAX)) /* so large are whole numbers alone */
        return DRIVE_BAD_PHASE;
    const int64_t counts = (int64_t)floor(exact);
    const int64_t moved = s->primed ? counts - s->counts : 0;
    s->counts = counts;
    int32_t pulses = (int32_t)((uint32_t)in->pulses - (uint32_t)s->pulses);
    s->pulses = in->pulses;
    s->primed = true;
    look_at_reset(s, in);

    *out = (struct drive_output){ 0 };
    /* The brake sits on the shaft: it needs no encoder. */
    const double speed = (double)moved * RPM_PER_TURN_PER_S / (c->encoder_counts * c->period);
    out->speed = in->unplugged ? 0.0 : speed;
    const bool wanted = in->enable && s->alarm == DRIVE_NO_ALARM;
    const bool first = wanted && !s->on;
    if (first)
        switch_on(c, s);
    if (wanted) {
        s->released = true;
        s->off = s->signal = 0;
    }
    const bool loops = wanted || run_down(c, s, out->speed, s->alarm == DRIVE_NO_ALARM);
    const bool run = loops && follow(c, s, in, wanted && !first ? pulses : 0, wanted, out);
    if (run) {
        s->on = true;
        out->ready = wanted;
        velocity_loop(c, s, (out->speed_command - out->speed) * RAD_PER_S_PER_RPM, first, out);
        if (overloaded(c, s, out->saturated))
            s->alarm = DRIVE_OVERLOAD;
    }
    if (too_hot(c, s, run ? out->torque : 0.0) && run)
        s->alarm = DRIVE_OVERLOAD;
    out->load_ratio = sqrt(s->heat);
    if (!run || s->alarm == DRIVE_OVERLOAD) {
        if (wanted)
            run_down(c, s, out->speed, false); /* an alarm takes the torque at once */
        stand(c, s, speed, out);
    }
    out->alarm = s->alarm;
    return DRIVE_OK;
}
