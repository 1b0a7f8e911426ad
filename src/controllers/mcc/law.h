/* law - the library's own position control in software: from error counters to voltages, once a
 * sampling period.
 *
 *   u = Kp (F(c) - p) + kff F(c)' + W(e) n       speed [mm/s], then voltage of the drive [V]
 *
 * c are the pulses put out, p the encoder counts and F a first-order lag, the matched-lag
 * pre-filter. W(e) n is cross-coupled control: e is the contour error, n the normal of the path at
 * the point nearest to the tool, W a PI or PID law.
 */
#ifndef LAW_H
#define LAW_H

#include "commanded_path.h"

struct law_axis {
    bool on;             /* the axis gets a voltage */
    double gain;         /* [V/pulse] gain of the P law */
    double volts;        /* [V s/pulse] voltage of the drive for a speed */
    double feed_forward; /* 0..1 share of the commanded speed that is fed forward */
    double lag;          /* [s] time constant of the pre-filter; 0: none */
};

struct law_config {
    double period; /* [s] sampling period */
    struct law_axis axis[AXES];
    double pulses_per_mm[3];
    double cross_p, cross_i, cross_d; /* [1/s], [1/s^2], [1] gains of W for X Y Z */
};

/* What the law sees at an instant of the bus grid. */
struct law_look {
    int32_t pulses[AXES];            /* [pulses] put out */
    int32_t error[AXES];             /* [pulses] pulses less counts, at the instant before */
    double speed[AXES];              /* [pulses/s] speed of the commanded point */
    struct commanded_path_foot foot; /* point of the path nearest to the tool */
};

struct law {
    bool begun;                      /* there was an instant before */
    int32_t pulses[AXES];            /* [pulses] put out at that instant */
    double behind[AXES];             /* [pulses] c - F(c) */
    double speed[AXES];              /* [pulses/s] F(c') */
    struct commanded_path_foot foot; /* at the instant before */
    double sum[3];                   /* [mm s] integral of the contour error, across the path */
};

/* Compute the voltages of the axes that are on, within +-limit [V]; the others keep theirs. */
void law_tick(const struct law_config *c, struct law *s, const struct law_look *look, double limit,
              double volts[AXES]);

/* True if cross-coupled control has a gain. */
bool law_crosses(const struct law_config *c);

#endif
