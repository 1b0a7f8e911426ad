/* law - the library's own control law: error counters to voltages, once a sampling period.
 *
 *   u = Kp (F(c) - p) + kff F(c)' + Q n          [mm/s], then volts of the drive
 *
 * c are the pulses put out, p the counts, F a first-order lag (matched-lag pre-filter), Q the
 * cross-coupled control: W(e) along the normal n of the path at its point nearest to the tool, e
 * the distance from there, W a PI or PID law.
 */
#ifndef LAW_H
#define LAW_H

#include "commanded_path.h"

struct law_axis {
    bool on;             /* a voltage is wanted */
    double gain;         /* [V/pulse] P law */
    double volts;        /* [V s/pulse] of the drive's speed */
    double feed_forward; /* 0..1 part of the commanded speed */
    double lag;          /* [s] of the pre-filter; 0 none */
};

struct law_config {
    double period; /* [s] */
    struct law_axis axis[AXES];
    double pulses_per_mm[3];
    double cross_p, cross_i, cross_d; /* [1/s], [1/s^2], [1] cross-coupled control of X Y Z */
};

/* What the law sees at an instant. */
struct law_look {
    int32_t pulses[AXES];            /* [pulses] put out */
    int32_t error[AXES];             /* [pulses] less counts, at the instant before */
    double speed[AXES];              /* [pulses/s] of the commanded point */
    struct commanded_path_foot foot; /* for cross-coupled control */
};

struct law {
    bool begun;
    int32_t pulses[AXES];            /* at the instant before */
    double behind[AXES];             /* [pulses] c - F(c) */
    double speed[AXES];              /* [pulses/s] F(c') */
    struct commanded_path_foot foot; /* at the instant before */
    double sum[3];                   /* [mm s] of the contour error, across the path */
};

/* Voltages of the axes that are on, within +-limit [V]; the others stay as they are. */
void law_tick(const struct law_config *c, struct law *s, const struct law_look *look, double limit,
              double volts[AXES]);

/* True if cross-coupled control has a gain. */
bool law_crosses(const struct law_config *c);

#endif
