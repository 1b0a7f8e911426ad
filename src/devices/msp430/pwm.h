/* pwm - the positioner's analogue output to the valve: PWM on P4.1 (Timer_B, up mode, output
 * reset/set), RC filter, two op-amps.
 *
 *     pin high for `duty` of `period` clocks, from the start of each period, where a new duty acts
 *     tau dVc/dt = Vpin - Vc             voltage = gain (Vc - offset), within +-limit
 *
 * While the pin keeps its level Vc is an exponential, so voltage and mean are exact, also where the
 * limit cuts off. Ripple, peak to peak, at a constant duty d (0 .. 1) with the period T:
 *     gain Vhigh (1 - e^(-d T/tau)) (1 - e^(-(1 - d) T/tau)) / (1 - e^(-T/tau)) */
#ifndef PWM_H
#define PWM_H

#include <stdint.h>

struct pwm_config {
    int32_t period; /* [clocks] of the PWM, 2 .. 65536; also the number of steps of duty */
    double tau;     /* [clocks] time constant R C */
    double high;    /* [V] of the pin when high */
    double offset;  /* [V] set by VR1, subtracted by the first op-amp */
    double gain;    /* of the second op-amp */
    double limit;   /* [V] saturation of the second op-amp, both ways */
};

struct pwm {
    int32_t wanted;     /* [clocks] TBCCR1 as written */
    int32_t duty;       /* [clocks] high time, as latched at the start of this period */
    int64_t begin;      /* [clock] of this period */
    int64_t clock;      /* [clock] up to which the filter has been computed */
    double filtered;    /* [V] Vc at that clock */
    double area;        /* [V clocks] integral of the voltage since area_begin */
    int64_t area_begin; /* [clock] of the latest pwm_mean */
    double least, most; /* [V] extremes of the voltage in this period so far */
    double ripple;      /* [V] most - least of the latest whole period */
};

/* Start at clock 0, with the capacitor at `filtered` [V] and a duty [clocks]. */
void pwm_reset(struct pwm *p, const struct pwm_config *c, double filtered, int32_t duty);

/* Let time pass to `clock`. To write a duty at a clock, call this for the clock first. */
void pwm_run(struct pwm *p, const struct pwm_config *c, int64_t clock);

/* Write TBCCR1 [clocks], limited to 0 .. period. */
void pwm_write(struct pwm *p, const struct pwm_config *c, int32_t duty);

/* Voltage behind the op-amps now [V]. */
double pwm_voltage(const struct pwm *p, const struct pwm_config *c);

/* Mean of the voltage since the latest call [V]; the present voltage if no time has passed. */
double pwm_mean(struct pwm *p, const struct pwm_config *c);

#endif
