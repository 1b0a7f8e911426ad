/* Analogue output: PWM on P4.1 (Timer_B, up mode, output reset/set), RC filter, two op-amps.
 *
 *     pin high for `duty` of `period` clocks, from the start of each period, where a new duty acts
 *     tau dVc/dt = Vpin - Vc             voltage = gain (Vc - offset), within +-limit
 *
 * Within a level Vc is an exponential, so everything here is exact, also what the limit cuts off.
 * Ripple, peak to peak, of a duty d that stands, T the period:
 *     gain Vhigh (1 - e^(-d T/tau)) (1 - e^(-(1 - d) T/tau)) / (1 - e^(-T/tau)) */
#ifndef PWM_H
#define PWM_H

#include <stdint.h>

struct pwm_config {
    int32_t period; /* [clocks] of the PWM, 2 .. 65536; as many steps of duty */
    double tau;     /* [clocks] R C */
    double high;    /* [V] pin when high */
    double offset;  /* [V] VR1, first op-amp */
    double gain;    /* of the second */
    double limit;   /* [V] saturation of the second, both ways */
};

struct pwm {
    int32_t wanted;     /* [clocks] TBCCR1 as written */
    int32_t duty;       /* [clocks] as latched at the start of this period */
    int64_t begin;      /* [clock] of this period */
    int64_t clock;      /* [clock] the filter stands at */
    double filtered;    /* [V] Vc there */
    double area;        /* [V clocks] integral of the voltage since pwm_mean */
    int64_t area_begin; /* [clock] */
    double least, most; /* [V] of the voltage in this period so far */
    double ripple;      /* [V] most - least of the latest whole period */
};

/* At clock 0, with the capacitor at `filtered` [V] and a duty. */
void pwm_reset(struct pwm *p, const struct pwm_config *c, double filtered, int32_t duty);

/* Advance to `clock`; a duty must be written at its clock, after this. */
void pwm_run(struct pwm *p, const struct pwm_config *c, int64_t clock);

/* Write TBCCR1: what is below 0 or above the period is the end of the range. */
void pwm_write(struct pwm *p, const struct pwm_config *c, int32_t duty);

/* [V] behind the op-amps now. */
double pwm_voltage(const struct pwm *p, const struct pwm_config *c);

/* [V] mean of the voltage since the latest call, or its value if no time has passed. */
double pwm_mean(struct pwm *p, const struct pwm_config *c);

#endif
