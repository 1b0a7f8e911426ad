/* Rates of many states of the six-axis arm, as a step of its FMU asks for them. */
#include "plant.h"

void arm_constants(const double *p, double *c);
void arm_rates(long count, const double *x, const double *u, const double *c, double *dx);

void arm_constants(const double *p, double *c)
{
    plant_constants(p, c);
}

void arm_rates(long count, const double *x, const double *u, const double *c, double *dx)
{
    plant_function *rates = plant_has_avx2() ? plant_rhs_1_avx2 : plant_rhs_1;
    for (long k = 0; k < count; k++)
        rates(x + k * PLANT_STATES, u, c, dx + k * PLANT_STATES);
}
