#include "fmi2Functions.h"
#include "holds.h"
#include "sides.h"

static void logger(void *environment, fmi2String name, fmi2Status status, fmi2String category,
                   fmi2String message, ...)
{
    (void)environment;
    HOLDS(name && name[0]);
    side_tell(2, status, category, message);
}

static const fmi2CallbackFunctions callbacks = { logger, NULL, NULL, NULL, NULL };

static void *instantiate(const char *token, const char *resources)
{
    return fmi2Instantiate("two", fmi2CoSimulation, token, resources, &callbacks, 0, 1);
}

static int enter(void *c, double start, bool stops, double stop, bool hasty)
{
    if (hasty) {
        HOLDS(fmi2EnterInitializationMode(c) == fmi2Error);
        side_told[0].errors = 0;
    }
    const int status = fmi2SetupExperiment(c, 0, 0.0, start, stops, stop);
    return status ? status : (int)fmi2EnterInitializationMode(c);
}

static int leave(void *c)
{
    return fmi2ExitInitializationMode(c);
}
static int step(void *c, double point, double size)
{
    return fmi2DoStep(c, point, size, 1);
}
static int terminate(void *c)
{
    return fmi2Terminate(c);
}
static int reset(void *c)
{
    return fmi2Reset(c);
}
static int get_state(void *c, void **s)
{
    return fmi2GetFMUstate(c, s);
}
static int set_state(void *c, void *s)
{
    return fmi2SetFMUstate(c, s);
}
static int free_state(void *c, void **s)
{
    return fmi2FreeFMUstate(c, s);
}

static int size_of(void *c, void *s, size_t *size)
{
    return fmi2SerializedFMUstateSize(c, s, size);
}

static int serialize(void *c, void *s, char *bytes, size_t size)
{
    return fmi2SerializeFMUstate(c, s, bytes, size);
}

static int deserialize(void *c, const char *bytes, size_t size, void **s)
{
    return fmi2DeSerializeFMUstate(c, bytes, size, s);
}

static int switch_log(void *c, bool on, size_t n, const char *const *names)
{
    return fmi2SetDebugLogging(c, on, n, names);
}

/* Every element has a reference of its own. */
#define EACH(Get, member) \
    for (size_t i = 0; i < n; i++) { \
        member[i] = x[i].member; \
    } \
    return Get(c, refs, n, member)
#define EVERY(Get, member) \
    do { \
        const int status = Get(c, refs, n, member); \
        for (size_t i = 0; i < n && status == 0; i++) { \
            x[i].member = member[i]; \
        } \
        return status; \
    } while (0)

static int set(void *c, int type, uint32_t ref, size_t n, const union side_value *x)
{
    static fmi2ValueReference refs[SIDE_ELEMENTS];
    static double real[SIDE_ELEMENTS];
    static int integer[SIDE_ELEMENTS], boolean[SIDE_ELEMENTS];
    static const char *string[SIDE_ELEMENTS];
    for (size_t i = 0; i < n; i++) {
        refs[i] = ref + (uint32_t)i;
    }
    switch (type) {
    case SIDE_REAL:    EACH(fmi2SetReal, real);
    case SIDE_INTEGER: EACH(fmi2SetInteger, integer);
    case SIDE_BOOLEAN: EACH(fmi2SetBoolean, boolean);
    default:           EACH(fmi2SetString, string);
    }
}

static int get(void *c, int type, uint32_t ref, size_t n, union side_value *x)
{
    static fmi2ValueReference refs[SIDE_ELEMENTS];
    static double real[SIDE_ELEMENTS];
    static int integer[SIDE_ELEMENTS], boolean[SIDE_ELEMENTS];
    static const char *string[SIDE_ELEMENTS];
    for (size_t i = 0; i < n; i++) {
        refs[i] = ref + (uint32_t)i;
    }
    switch (type) {
    case SIDE_REAL:    EVERY(fmi2GetReal, real);
    case SIDE_INTEGER: EVERY(fmi2GetInteger, integer);
    case SIDE_BOOLEAN: EVERY(fmi2GetBoolean, boolean);
    default:           EVERY(fmi2GetString, string);
    }
}

static int odd(void *c, unsigned which)
{
    const fmi2ValueReference ref = UINT32_MAX;
    double x = 0.0;
    switch (which % SIDE_ODDS) {
    case 0:  return fmi2CancelStep(c);
    case 1:  return fmi2GetReal(c, &ref, 1, &x);
    case 2:  return fmi2SetReal(c, &ref, 1, &x);
    case 3:  return fmi2GetReal(c, NULL, 1, &x);
    case 4:  return fmi2SetReal(c, &ref, 1, NULL);
    case 5:  return fmi2GetDirectionalDerivative(c, &ref, 1, &ref, 1, &x, &x);
    case 6:  return fmi2GetFMUstate(c, NULL);
    default: return fmi2SetFMUstate(c, NULL);
    }
}

static void release(void *c)
{
    fmi2FreeInstance(c);
}

const struct side side_2 = { instantiate, release,   enter,       leave,      step,      terminate,
                             reset,       set,       get,         get_state,  set_state, free_state,
                             size_of,     serialize, deserialize, switch_log, odd };
