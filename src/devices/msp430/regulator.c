#include "regulator.h"

#include "fixed.h"

static void integrate(const struct regulator_config *c, struct regulator *s, int16_t error)
{
    if (c->band > 0 && (error >= c->band || error <= -c->band)) {
        if (c->outside == REGULATOR_RESET) {
            s->count = 0;
            s->sum = 0;
        }
        return;
    }
    if (c->kind == REGULATOR_LITERAL)
        s->count = fixed_saturate16(s->count + 1);
    else
        s->sum = fixed_saturate32((int64_t)s->sum + error);
}

int16_t regulator_tick(const struct regulator_config *c, struct regulator *s, int16_t error)
{
    s->proportional = fixed_saturate16(fixed_scale(fixed_multiply(c->p_gain, error), c->p_shift));
    s->integral = 0;
    if (c->kind != REGULATOR_P) {
        integrate(c, s, error);
        const int32_t factor = c->kind == REGULATOR_SUM ? s->sum : fixed_multiply(error, s->count);
        s->integral =
            fixed_saturate16(fixed_scale(fixed_multiply48(c->i_gain, factor), c->i_shift));
    }
    return fixed_saturate16((int32_t)s->proportional + s->integral);
}

void regulator_move(struct regulator *s)
{
    s->count = 0;
}
