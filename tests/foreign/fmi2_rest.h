/* What the FMUs of FMI 2.0 here have in common: calls that only say that they were made. */
#include <stdlib.h>

#include "fmi2Functions.h"

const char *fmi2GetTypesPlatform(void)
{
    return fmi2TypesPlatform;
}
const char *fmi2GetVersion(void)
{
    return "2.0";
}
void fmi2FreeInstance(fmi2Component c)
{
    free(c);
}
fmi2Status fmi2EnterInitializationMode(fmi2Component c)
{
    return c ? fmi2OK : fmi2Error;
}
fmi2Status fmi2ExitInitializationMode(fmi2Component c)
{
    return c ? fmi2OK : fmi2Error;
}
fmi2Status fmi2Terminate(fmi2Component c)
{
    return c ? fmi2OK : fmi2Error;
}

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t n, const fmi2String some[])
{
    (void)c, (void)on, (void)n, (void)some;
    return fmi2OK;
}

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean defined, fmi2Real tolerance,
                               fmi2Real start, fmi2Boolean ends, fmi2Real stop)
{
    (void)c, (void)defined, (void)tolerance, (void)start, (void)ends, (void)stop;
    return fmi2OK;
}
