/* What the FMUs of FMI 3.0 here have in common: calls that only say that they were made. */
#include <stdlib.h>

#include "fmi3Functions.h"

const char *fmi3GetVersion(void)
{
    return "3.0";
}
void fmi3FreeInstance(fmi3Instance c)
{
    free(c);
}
fmi3Status fmi3ExitInitializationMode(fmi3Instance c)
{
    return c ? fmi3OK : fmi3Error;
}
fmi3Status fmi3Terminate(fmi3Instance c)
{
    return c ? fmi3OK : fmi3Error;
}

fmi3Status fmi3SetDebugLogging(fmi3Instance c, fmi3Boolean on, size_t n, const fmi3String some[])
{
    (void)c, (void)on, (void)n, (void)some;
    return fmi3OK;
}
