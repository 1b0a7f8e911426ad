/* The positioner's MSP430F149 with its analogue parts, exact to the clock.
 *
 * Time is MCLK clocks from power-up. The processor accepts an interrupt when it is free: that of
 * the timer (vector 0xFFEC) before that of port 1 (0xFFE8); neither interrupts the other. */
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
    enum port_clear clear;
    bool homed;           /* at power-up: ready at count 0, for studies */
    bool home_always;     /* P1IE.0 is on always, else in the homing search only */
    int64_t timer_period; /* [clocks] */
    int32_t timer_cycles; /* [clocks] of the timer's routine, reti included */
    bool adc_on;          /* the converter sets the speed */
    double adc_reference; /* [V] */
    double filter_start;  /* [V] capacitor of the filter at power-up */
};

struct msp430_pins {
    bool home, pb1, pb2;
    int32_t target; /* [counts] */
    double volts;   /* [V] at the converter */
};

enum msp430_routine { MSP430_FREE = 0, MSP430_PORT, MSP430_READ, MSP430_WRITE };

struct msp430 {
    struct msp430_config config;
    int64_t clock;
    struct msp430_pins pins;
    struct quadrature scale;
    struct port port;
    struct sequence sequence;
    struct pwm pwm;
    enum msp430_routine routine;
    int64_t next;       /* [clock] of what the routine does next */
    int64_t timer_next; /* [clock] of the timer's next firing */
    bool timer_flag;
    int64_t ticks;    /* timer interrupts accepted */
    int64_t overruns; /* firings lost because one was waiting */
};

void msp430_reset(struct msp430 *m, const struct msp430_config *c);

/* An instant at `clock`: the scale's phase there; everything is carried to `clock` with the phase
 * on a straight line and the other pins as they were; then the pins are as given. */
enum quadrature_status msp430_sample(struct msp430 *m, double phase, const struct msp430_pins *pins,
                                     int64_t clock);

#endif
