#include "fmi3Functions.h"
#include "holds.h"
#include "sides.h"

static void logger(void *environment, fmi3Status status, fmi3String category, fmi3String message)
{
    (void)environment;
    side_tell(3, status, category, message);
}

static void *instantiate(const char *token, const char *resources)
{
    return fmi3InstantiateCoSimulation("two", token, resources, false, true, false, false, NULL, 0,
                                       NULL, logger, NULL);
}

static int enter(void *c, double start, bool stops, double stop, bool hasty)
{
    (void)hasty;
    return fmi3EnterInitializationMode(c, false, 0.0, start, stops, stop);
}

static int step(void *c, double point, double size)
{
    bool event, terminate, early;
    double last = 0.0;
    const int status = fmi3DoStep(c, point, size, true, &event, &terminate, &early, &last);
    HOLDS(!event && !terminate && !early);
    return status;
}

static int leave(void *c)
{
    return fmi3ExitInitializationMode(c);
}
static int terminate(void *c)
{
    return fmi3Terminate(c);
}
static int reset(void *c)
{
    return fmi3Reset(c);
}
static int get_state(void *c, void **s)
{
    return fmi3GetFMUState(c, s);
}
static int set_state(void *c, void *s)
{
    return fmi3SetFMUState(c, s);
}
static int free_state(void *c, void **s)
{
    return fmi3FreeFMUState(c, s);
}

static int size_of(void *c, void *s, size_t *size)
{
    return fmi3SerializedFMUStateSize(c, s, size);
}

static int serialize(void *c, void *s, char *bytes, size_t size)
{
    return fmi3SerializeFMUState(c, s, (fmi3Byte *)bytes, size);
}

static int deserialize(void *c, const char *bytes, size_t size, void **s)
{
    return fmi3DeserializeFMUState(c, (const fmi3Byte *)bytes, size, s);
}

static int switch_log(void *c, bool on, size_t n, const char *const *names)
{
    return fmi3SetDebugLogging(c, on, n, names);
}

/* A variable has one reference. */
#define EACH(Set, member) \
    for (size_t i = 0; i < n; i++) { \
        member[i] = x[i].member; \
    } \
    return Set(c, &ref, 1, member, n)
#define EVERY(Get, member) \
    do { \
        const int status = Get(c, &ref, 1, member, n); \
        for (size_t i = 0; i < n && status == 0; i++) { \
            x[i].member = member[i]; \
        } \
        return status; \
    } while (0)

static int set(void *c, int type, uint32_t ref, size_t n, const union side_value *x)
{
    static double real[SIDE_ELEMENTS];
    static int32_t integer[SIDE_ELEMENTS];
    static bool boolean[SIDE_ELEMENTS];
    static const char *string[SIDE_ELEMENTS];
    switch (type) {
    case SIDE_REAL:    EACH(fmi3SetFloat64, real);
    case SIDE_INTEGER: EACH(fmi3SetInt32, integer);
    case SIDE_BOOLEAN: EACH(fmi3SetBoolean, boolean);
    default:           EACH(fmi3SetString, string);
    }
}

static int get(void *c, int type, uint32_t ref, size_t n, union side_value *x)
{
    static double real[SIDE_ELEMENTS];
    static int32_t integer[SIDE_ELEMENTS];
    static bool boolean[SIDE_ELEMENTS];
    static const char *string[SIDE_ELEMENTS];
    switch (type) {
    case SIDE_REAL:    EVERY(fmi3GetFloat64, real);
    case SIDE_INTEGER: EVERY(fmi3GetInt32, integer);
    case SIDE_BOOLEAN: EVERY(fmi3GetBoolean, boolean);
    default:           EVERY(fmi3GetString, string);
    }
}

static int odd(void *c, unsigned which)
{
    const fmi3ValueReference ref = UINT32_MAX;
    double x = 0.0;
    switch (which % SIDE_ODDS) {
    case 0:  return fmi3EnterEventMode(c);
    case 1:  return fmi3GetFloat64(c, &ref, 1, &x, 1);
    case 2:  return fmi3SetFloat64(c, &ref, 1, &x, 1);
    case 3:  return fmi3GetFloat64(c, NULL, 1, &x, 1);
    case 4:  return fmi3SetFloat64(c, &ref, 1, NULL, 1);
    case 5:  return fmi3GetDirectionalDerivative(c, &ref, 1, &ref, 1, &x, 1, &x, 1);
    case 6:  return fmi3GetFMUState(c, NULL);
    default: return fmi3SetFMUState(c, NULL);
    }
}

static void release(void *c)
{
    fmi3FreeInstance(c);
}

const struct side side_3 = { instantiate, release,   enter,       leave,      step,      terminate,
                             reset,       set,       get,         get_state,  set_state, free_state,
                             size_of,     serialize, deserialize, switch_log, odd };
