/* The FMI layer as FMI 2.0. */
#define FMI_VERSION     2
#define _POSIX_C_SOURCE 200809L /* kinds of files, fmu_file.h */
#include "fmi_dummy.h"
#include "fmi.inc"

static void logger(void *environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...);

static const fmi2CallbackFunctions callbacks = { logger, NULL, NULL, NULL, NULL };

static void *call_instantiate(const char *name, const char *token, const char *resources)
{
    return fmi2Instantiate(name, fmi2CoSimulation, token, resources, &callbacks, 0, 0);
}

static int call_enter(void *c, double start, double stop)
{
    int status = fmi2SetupExperiment(c, 0, 0.0, start, stop >= 0.0, stop);
    return status ? status : (int)fmi2EnterInitializationMode(c);
}

static void call_free(void *c)
{
    fmi2FreeInstance(c);
}
static int call_exit(void *c)
{
    return fmi2ExitInitializationMode(c);
}
static int call_step(void *c, double t, double h)
{
    return fmi2DoStep(c, t, h, 1);
}
static int call_terminate(void *c)
{
    return fmi2Terminate(c);
}
static int call_reset(void *c)
{
    return fmi2Reset(c);
}
static int call_get_state(void *c, void **s)
{
    return fmi2GetFMUstate(c, s);
}
static int call_set_state(void *c, void *s)
{
    return fmi2SetFMUstate(c, s);
}
static int call_free_state(void *c, void **s)
{
    return fmi2FreeFMUstate(c, s);
}

static int call_set_real(void *c, unsigned ref, size_t n, const double *x)
{
    const unsigned refs[3] = { ref, ref + 1, ref + 2 };
    return fmi2SetReal(c, refs, n, x);
}

static int call_get_real(void *c, unsigned ref, size_t n, double *x)
{
    const unsigned refs[3] = { ref, ref + 1, ref + 2 };
    return fmi2GetReal(c, refs, n, x);
}

static int call_get_y(void *c, double *y)
{
    return call_get_real(c, REF_Y, 2, y);
}

static int call_set_n(void *c, int n)
{
    return fmi2SetInteger(c, &(unsigned){ REF_N }, 1, &n);
}

static int call_set_name(void *c, const char *text)
{
    return fmi2SetString(c, &(unsigned){ REF_NAME }, 1, &text);
}

static const char *call_get_name(void *c)
{
    const char *text = NULL;
    return fmi2GetString(c, &(unsigned){ REF_NAME }, 1, &text) == fmi2OK ? text : "";
}

static int call_log(void *c, bool on, size_t n, const char *const *names)
{
    return fmi2SetDebugLogging(c, on, n, names);
}

static size_t call_state_size(void *c, void *state)
{
    size_t size = 0;
    return fmi2SerializedFMUstateSize(c, state, &size) == fmi2OK ? size : 0;
}

static int call_serialize(void *c, void *state, char *bytes, size_t size)
{
    return fmi2SerializeFMUstate(c, state, bytes, size);
}

static int call_deserialize(void *c, const char *bytes, size_t size, void **state)
{
    return fmi2DeSerializeFMUstate(c, bytes, size, state);
}

static double call_last(void *c)
{
    double time = NAN;
    return fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &time) == fmi2OK ? time : NAN;
}

static void test_own(void);

#include "fmi_cases.h"

/* As a C importer does: the message is a format. */
static void logger(void *environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...)
{
    (void)environment, (void)name, (void)status, (void)category;
    va_list args;
    va_start(args, message);
    vsnprintf(said, sizeof said, message, args);
    va_end(args);
}

static void test_own(void)
{
    void *c = make();
    CHECK(!fmi2Instantiate("one", fmi2ModelExchange, FMU_TOKEN, "", &callbacks, 0, 0));
    CHECK(!fmi2Instantiate("one", fmi2CoSimulation, FMU_TOKEN, "", NULL, 0, 0));
    CHECK_REFUSED(fmi2EnterInitializationMode(c), "call fmi2SetupExperiment first");
    CHECK_REFUSED(fmi2SetupExperiment(c, 0, 0.0, NAN, 0, 0.0), "startTime nan is not finite");
    CHECK_REFUSED(fmi2SetupExperiment(c, 0, 0.0, 1.0, 1, 0.5), "stopTime 0.5 s is before");
    CHECK_REFUSED(fmi2CancelStep(c), "no step is running");
    CHECK_REFUSED(fmi2GetDirectionalDerivative(c, NULL, 0, NULL, 0, NULL, NULL), "no derivatives");
    CHECK_REFUSED(fmi2SetRealInputDerivatives(c, NULL, 0, NULL, NULL), "interpolate");
    CHECK_REFUSED(fmi2GetRealOutputDerivatives(c, NULL, 0, NULL, NULL), "no derivatives");
    CHECK_REFUSED(fmi2GetIntegerStatus(c, fmi2DoStepStatus, NULL), "no status is an integer");
    int on[2] = { 2, 0 }, back[2];
    const unsigned refs[2] = { REF_ON, REF_ON + 1 };
    CHECK(fmi2SetBoolean(c, refs, 2, on) == fmi2OK && fmi2GetBoolean(c, refs, 2, back) == fmi2OK);
    CHECK(back[0] == fmi2True && back[1] == fmi2False);
    call_free(c);
    c = make_running(3.0, -1.0);
    fmi2Status status = fmi2Fatal;
    double time = 0.0;
    int ended = 1;
    CHECK(call_step(c, 3.0, 0.5) == 0);
    CHECK(fmi2GetStatus(c, fmi2DoStepStatus, &status) == fmi2OK && status == fmi2OK);
    CHECK(fmi2GetRealStatus(c, fmi2LastSuccessfulTime, &time) == fmi2OK && time == 3.5);
    CHECK(fmi2GetBooleanStatus(c, fmi2Terminated, &ended) == fmi2OK && ended == fmi2False);
    CHECK(strcmp(fmi2GetVersion(), "2.0") == 0 && strcmp(fmi2GetTypesPlatform(), "default") == 0);
    call_free(c);
}

int main(void)
{
    return test_all();
}
