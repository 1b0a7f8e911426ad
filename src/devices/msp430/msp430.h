/* msp430 - the positioner: an MSP430F149 that positions one hydraulic axis, with its program, its
 * PWM output with filter and op-amps, and its converter, exact to the clock.
 *
 * Time is MCLK clocks from power-up. The processor accepts an interrupt when no other one is
 * served: that of the timer (vector 0xFFEC) before that of port 1 (0xFFE8); neither interrupts the
 * other. */
#ifndef MSP430_H
#define MSP430_H

#include <stdbool.h>
#include <stdint.h>

#include "port.h"
#include "pwm.h"
#include "quadrature.h"
#include "sequence.h"

struct msp430_config {
    struct sequence_config sequence;
    struct pwm_config pwm;
    enum port_clear clear; /* how the port's routine clears its flags */
    bool homed;            /* homed at power-up, ready at count 0: for studies */
    bool home_always;      /* the home interrupt (P1IE.0) is always on, else only in the search */
    int64_t timer_period;  /* [clocks] */
    int32_t timer_cycles;  /* [clocks] duration of the timer's routine, reti included */
    bool adc_on;           /* the converter scales the speed limit */
    double adc_reference;  /* [V] */
    double filter_start;   /* [V] at the filter's capacitor at power-up */
};

struct msp430_pins {
    bool home, pb1, pb2; /* home switch; buttons PB1, PB2 */
    int32_t target;      /* [counts] target position */
    double volts;        /* [V] at the converter */
};

/* The interrupt routine in progress: none; that of the port; the timer's before it has read its
 * inputs; the timer's before it has written the PWM. */
enum msp430_routine { MSP430_FREE = 0, MSP430_PORT, MSP430_READ, MSP430_WRITE };

struct msp430 {
    struct msp430_config config;
    int64_t clock;           /* [clock] all events up to and including it have happened */
    struct msp430_pins pins; /* as given at the latest instant */
    struct quadrature scale; /* lines A and B of the linear scale */
    struct port port;
    struct sequence sequence;
    struct pwm pwm;
    enum msp430_routine routine;
    int64_t next;       /* [clock] of the routine's next action */
    int64_t timer_next; /* [clock] of the timer's next firing */
    bool timer_flag;    /* a timer interrupt waits */
    int64_t ticks;      /* number of timer interrupts accepted */
    int64_t overruns;   /* number of firings lost because one was waiting */
};

/* Power up at clock 0. */
void msp430_reset(struct msp430 *m, const struct msp430_config *c);

/* An instant at `clock`: time passes up to it while the scale's phase [line periods] moves on a
 * straight line to `phase` and the other pins stay; then the pins become as given. An error, and
 * nothing changed, if the phase is not a number or moved by more than one edge per clock. */
enum quadrature_status msp430_sample(struct msp430 *m, double phase, const struct msp430_pins *pins,
                                     int64_t clock);

#endif
