/* The FMI layer as FMI 3.0. */
#define FMI_VERSION     3
#define _POSIX_C_SOURCE 200809L /* kinds of files, fmu_file.h */
#include "fmi_dummy.h"
#include "fmi.inc"

static void logger(void *environment, fmi3Status status, fmi3String category, fmi3String message);

static void *call_instantiate(const char *name, const char *token, const char *resources)
{
    return fmi3InstantiateCoSimulation(name, token, resources, false, false, false, false, NULL, 0,
                                       NULL, logger, NULL);
}

static int call_enter(void *c, double start, double stop)
{
    return fmi3EnterInitializationMode(c, false, 0.0, start, stop >= 0.0, stop);
}

static int call_step(void *c, double t, double h)
{
    bool event = true, terminate = true, early = true;
    double last = NAN, time = NAN;
    int status = fmi3DoStep(c, t, h, true, &event, &terminate, &early, &last);
    if (status == fmi3OK) {
        fmi3GetFloat64(c, &(unsigned){ FMU_NREFS }, 1, &time, 1);
    }
    return status == fmi3OK
                   && (event || terminate || early || last != time || fabs(last - t - h) > 1e-5)
               ? (int)fmi3Fatal
               : status;
}

static void call_free(void *c)
{
    fmi3FreeInstance(c);
}
static int call_exit(void *c)
{
    return fmi3ExitInitializationMode(c);
}
static int call_terminate(void *c)
{
    return fmi3Terminate(c);
}
static int call_reset(void *c)
{
    return fmi3Reset(c);
}
static int call_get_state(void *c, void **s)
{
    return fmi3GetFMUState(c, s);
}
static int call_set_state(void *c, void *s)
{
    return fmi3SetFMUState(c, s);
}
static int call_free_state(void *c, void **s)
{
    return fmi3FreeFMUState(c, s);
}

static int call_set_real(void *c, unsigned ref, size_t n, const double *x)
{
    return fmi3SetFloat64(c, &ref, 1, x, n);
}

static int call_get_real(void *c, unsigned ref, size_t n, double *x)
{
    return fmi3GetFloat64(c, &ref, 1, x, n);
}

static int call_get_y(void *c, double *y)
{
    return call_get_real(c, REF_Y, 2, y);
}

static int call_set_n(void *c, int n)
{
    return fmi3SetInt32(c, &(unsigned){ REF_N }, 1, &n, 1);
}

static int call_set_name(void *c, const char *text)
{
    return fmi3SetString(c, &(unsigned){ REF_NAME }, 1, &text, 1);
}

static const char *call_get_name(void *c)
{
    const char *text = NULL;
    return fmi3GetString(c, &(unsigned){ REF_NAME }, 1, &text, 1) == fmi3OK ? text : "";
}

static int call_log(void *c, bool on, size_t n, const char *const *names)
{
    return fmi3SetDebugLogging(c, on, n, names);
}

static size_t call_state_size(void *c, void *state)
{
    size_t size = 0;
    return fmi3SerializedFMUStateSize(c, state, &size) == fmi3OK ? size : 0;
}

static int call_serialize(void *c, void *state, char *bytes, size_t size)
{
    return fmi3SerializeFMUState(c, state, (fmi3Byte *)bytes, size);
}

static int call_deserialize(void *c, const char *bytes, size_t size, void **state)
{
    return fmi3DeserializeFMUState(c, (const fmi3Byte *)bytes, size, state);
}

static double call_last(void *c)
{
    double time = NAN;
    return fmi3GetFloat64(c, &(unsigned){ FMU_NREFS }, 1, &time, 1) == fmi3OK ? time : NAN;
}

static void test_own(void);

#include "fmi_cases.h"

static void logger(void *environment, fmi3Status status, fmi3String category, fmi3String message)
{
    (void)environment, (void)status, (void)category;
    snprintf(said, sizeof said, "%s", message);
}

static void test_arrays_and_time(void)
{
    void *c = make();
    double u[4] = { 0 }, time;
    unsigned inside = REF_U + 1, clock = FMU_NREFS;
    CHECK_REFUSED(fmi3SetFloat64(c, &(unsigned){ REF_U }, 1, u, 2), "nValues is 2, the variables");
    CHECK_REFUSED(fmi3SetFloat64(c, &(unsigned){ REF_U }, 1, u, 4), "have 3");
    CHECK_REFUSED(fmi3GetFloat64(c, &(unsigned){ REF_U }, 1, u, 2), "have 3");
    CHECK_REFUSED(fmi3GetFloat64(c, &inside, 1, u, 1), "inside the array u, whose own is 3");
    CHECK_REFUSED(fmi3GetFloat64(c, &clock, 1, &time, 1), "time has no value before");
    CHECK_REFUSED(fmi3SetFloat64(c, &clock, 1, &time, 1), "unknown value reference 13");
    bool on[2] = { true, false }, back[2] = { false, true };
    CHECK(fmi3SetBoolean(c, &(unsigned){ REF_ON }, 1, on, 2) == fmi3OK);
    CHECK(fmi3GetBoolean(c, &(unsigned){ REF_ON }, 1, back, 2) == fmi3OK && back[0] && !back[1]);
    CHECK(call_enter(c, -2.0, -1.0) == 0);
    CHECK(fmi3GetFloat64(c, &clock, 1, &time, 1) == fmi3OK && time == -2.0);
    CHECK(call_exit(c) == 0 && call_step(c, -2.0, 0.5) == 0);
    CHECK(fmi3GetFloat64(c, &clock, 1, &time, 1) == fmi3OK && time == -1.5);
    call_free(c);
}

static void test_own(void)
{
    test_arrays_and_time();
    CHECK(!fmi3InstantiateModelExchange("one", FMU_TOKEN, "", false, false, NULL, logger));
    CHECK(strstr(said, "co-simulation only"));
    CHECK(!fmi3InstantiateScheduledExecution("one", FMU_TOKEN, "", false, false, NULL, logger, NULL,
                                             NULL, NULL));
    CHECK(!fmi3InstantiateCoSimulation("one", FMU_TOKEN, "", false, false, true, false, NULL, 0,
                                       NULL, logger, NULL));
    CHECK(strstr(said, "eventModeUsed is true"));
    void *c = make();
    size_t n = 1;
    CHECK(fmi3GetNumberOfVariableDependencies(c, REF_Y, &n) == fmi3OK && n == 0);
    CHECK(fmi3GetVariableDependencies(c, REF_Y, NULL, NULL, NULL, NULL, 0) == fmi3OK);
    CHECK_REFUSED(fmi3GetVariableDependencies(c, REF_Y, NULL, NULL, NULL, NULL, 1), "there are 0");
    CHECK_REFUSED(fmi3GetNumberOfVariableDependencies(c, REF_U, &n), "not that of an output");
    CHECK(fmi3GetFloat32(c, NULL, 0, NULL, 0) == fmi3OK);
    CHECK_REFUSED(fmi3GetFloat32(c, &(unsigned){ REF_U }, 1, NULL, 1), "no variable has this type");
    CHECK_REFUSED(fmi3EnterEventMode(c), "no event mode");
    CHECK_REFUSED(fmi3EnterConfigurationMode(c), "no structural parameters");
    CHECK_REFUSED(fmi3GetNumberOfContinuousStates(c, &n), "not for model exchange");
    CHECK_REFUSED(call_enter(c, NAN, -1.0), "startTime nan is not finite");
    CHECK(strcmp(fmi3GetVersion(), "3.0") == 0);
    call_free(c);
}

int main(void)
{
    return test_all();
}
