/* scurve_leg - an S-curve in units of the jerk: start inside the limits, fastest change of speed.
 *
 * All lengths are divided by the jerk, so that the jerk is 1: accelerations are times [s], speeds
 * [s^2], ways [s^3]. A leg that goes down first is solved as its mirror image.
 */
#ifndef SCURVE_LEG_H
#define SCURVE_LEG_H

enum { SCURVE_LEG_PHASES = 7, SCURVE_LEG_BRAKES = 2 };

struct scurve_leg {
    double v, a;     /* [s^2], [s] start */
    double way, v1;  /* [s^3], [s^2] target, reached with a = 0 */
    double acc, dec; /* [s] -dec <= a <= acc */
    double top;      /* [s^2] -top <= v <= top */
};

/* Jerk, as a multiple of the leg's own, of the phases that the functions below give times of. */
extern const double SCURVE_LEG_JERK[SCURVE_LEG_PHASES];

/* The leg seen in the direction sign, 1 or -1. */
struct scurve_leg scurve_leg_seen(const struct scurve_leg *l, double sign);

/* Phases (jerk, time) that bring a, then if `speed` v, within the limits; they move the start
 * of the leg to their end. The speed v is brought back as fast as possible, but not so that it
 * would leave the limits at the other side. */
void scurve_leg_brake(struct scurve_leg *l, int speed, double jerk[SCURVE_LEG_BRAKES],
                      double t[SCURVE_LEG_BRAKES]);

/* Direction of the jerk that begins the fastest change to v1. */
double scurve_leg_sign(const struct scurve_leg *l);

/* Fastest change to v1 of a leg whose sign is 1: times of its phases, the last four 0. Returns its
 * way; *rounding bounds what is lost in it. [s^3] */
double scurve_leg_speed(const struct scurve_leg *l, double t[SCURVE_LEG_PHASES], double *rounding);

/* Peak of a pulse of acceleration that changes the speed by d, at most `most`, and how long it is
 * held there; d below 0 counts as 0. [s] */
double scurve_leg_peak(double d, double most, double *hold);

#endif
