/* Outputs follow inputs, FMI 2.0: the types of the standard, from its headers alone. */
#include <string.h>

#include "fmi2_rest.h"

/* References: inputs and outputs of a type share an index; an output is OUT further. */
enum { OUT = 1000, REALS = 2, ROOM = 256 };

struct feed {
    double real[REALS];
    int whole, choice, flag;
    char text[ROOM];
};

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String place,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible,
                              fmi2Boolean logging)
{
    struct feed *f = calloc(1, sizeof *f);
    (void)name, (void)type, (void)guid, (void)place, (void)functions, (void)visible, (void)logging;
    if (f)
        f->choice = 2;
    return f;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real now, fmi2Real step, fmi2Boolean no_set)
{
    (void)now, (void)step, (void)no_set;
    return c ? fmi2OK : fmi2Error;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, const fmi2Real x[])
{
    for (size_t i = 0; i < n; i++) {
        if (r[i] >= REALS)
            return fmi2Error;
        ((struct feed *)c)->real[r[i]] = x[i];
    }
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Real x[])
{
    for (size_t i = 0; i < n; i++) {
        if (r[i] % OUT >= REALS)
            return fmi2Error;
        x[i] = ((const struct feed *)c)->real[r[i] % OUT];
    }
    return fmi2OK;
}

fmi2Status fmi2SetInteger(fmi2Component c, const fmi2ValueReference r[], size_t n,
                          const fmi2Integer x[])
{
    struct feed *f = c;
    for (size_t i = 0; i < n; i++)
        *(r[i] == 9 ? &f->choice : &f->whole) = x[i];
    return fmi2OK;
}

fmi2Status fmi2GetInteger(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Integer x[])
{
    const struct feed *f = c;
    for (size_t i = 0; i < n; i++)
        x[i] = r[i] % OUT == 9 ? f->choice : f->whole;
    return fmi2OK;
}

fmi2Status fmi2SetBoolean(fmi2Component c, const fmi2ValueReference r[], size_t n,
                          const fmi2Boolean x[])
{
    (void)r;
    for (size_t i = 0; i < n; i++)
        ((struct feed *)c)->flag = x[i];
    return fmi2OK;
}

fmi2Status fmi2GetBoolean(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2Boolean x[])
{
    (void)r;
    for (size_t i = 0; i < n; i++)
        x[i] = ((const struct feed *)c)->flag;
    return fmi2OK;
}

fmi2Status fmi2SetString(fmi2Component c, const fmi2ValueReference r[], size_t n,
                         const fmi2String x[])
{
    (void)r;
    for (size_t i = 0; i < n; i++)
        strncpy(((struct feed *)c)->text, x[i], ROOM - 1);
    return fmi2OK;
}

fmi2Status fmi2GetString(fmi2Component c, const fmi2ValueReference r[], size_t n, fmi2String x[])
{
    (void)r;
    for (size_t i = 0; i < n; i++)
        x[i] = ((const struct feed *)c)->text;
    return fmi2OK;
}
