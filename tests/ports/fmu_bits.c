/* Runs an FMU's library by itself and prints a hash of all outputs after initialisation and after
 * every step, to be built for any platform and compared:
 *
 *     fmu_bits LIBRARY FMI JOB
 *
 * JOB is a text file, a row each:
 *     token TEXT, resources TEXT       as the description says; where resources/ is
 *     steps N SIZE                     communication steps [s]
 *     real REF VALUE.., int REF VALUE, bool REF VALUE, string REF TEXT  set before initialisation
 *     show REAL|INT|BOOL REF COUNT     d, i or b: an output; elements have successive references
 *                                      in FMI 2, one in FMI 3
 *     values                           print the values, too
 */
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2FunctionTypes.h"
#ifdef __clang__
#pragma clang diagnostic ignored "-Wstrict-prototypes"
#endif
#include "fmi3FunctionTypes.h"

#ifdef _WIN32
#include <windows.h>
typedef HMODULE library;
#define OPEN(name)          LoadLibraryA(name)
#define FIND(library, name) ((any)(void *)GetProcAddress(library, name))
#else
#include <dlfcn.h>
typedef void *library;
#define OPEN(name)          dlopen(name, RTLD_NOW | RTLD_LOCAL)
#define FIND(library, name) ((any)(uintptr_t)dlsym(library, name))
#endif

typedef void (*any)(void);

enum { TEXT = 4096, SHOWN = 4096, WIDEST = 4096 };

struct shown {
    char kind;
    uint32_t ref;
    int count;
};

static struct {
    library lib;
    int fmi;
    void *instance;
    char token[TEXT], resources[TEXT];
    long steps;
    double size;
    struct shown shown[SHOWN];
    int count;
    bool values;
} run;

_Noreturn static void fail(const char *what, const char *which)
{
    fprintf(stderr, "%s: %s\n", what, which);
    exit(1);
}

/* A function of the standard: CALL(2, DoStep) has its type. */
#define CALL(version, name) ((fmi##version##name##TYPE *)find("fmi" #version #name))

static any find(const char *name)
{
    const any found = FIND(run.lib, name);
    if (!found) {
        fail("not in the library", name);
    }
    return found;
}

static void good(int status, const char *call)
{
    if (status != 0) {
        fail("status is not OK", call);
    }
}

static void log2_(fmi2ComponentEnvironment e, fmi2String name, fmi2Status status,
                  fmi2String category, fmi2String message, ...)
{
    (void)e, (void)name;
    fprintf(stderr, "%d %s: %s\n", (int)status, category, message);
}

static void log3_(fmi3InstanceEnvironment e, fmi3Status status, fmi3String category,
                  fmi3String message)
{
    (void)e;
    fprintf(stderr, "%d %s: %s\n", (int)status, category, message);
}

static void instantiate(void)
{
    static const fmi2CallbackFunctions callbacks = { log2_, calloc, free, NULL, NULL };
    run.instance = run.fmi == 2 ? CALL(2, Instantiate)("one", fmi2CoSimulation, run.token,
                                                       run.resources, &callbacks, 0, 0)
                                : CALL(3, InstantiateCoSimulation)("one", run.token, run.resources,
                                                                   false, false, false, false, NULL,
                                                                   0, NULL, log3_, NULL);
    if (!run.instance) {
        fail("no instance", run.token);
    }
}

static void set(const char *kind, uint32_t ref, const char *text)
{
    static double x[WIDEST];
    size_t count = 0; /* of the elements of an array of FMI 3 */
    for (char *end = (char *)(uintptr_t)text; *end && count < WIDEST && kind[0] == 'r'; count++) {
        x[count] = strtod(end, &end);
    }
    const int n = (int)strtol(text, NULL, 10);
    const bool b = n != 0;
    void *c = run.instance;
    int status;
    if (run.fmi == 2) {
        status = kind[0] == 'r'   ? CALL(2, SetReal)(c, &ref, 1, x)
                 : kind[0] == 'i' ? CALL(2, SetInteger)(c, &ref, 1, &n)
                 : kind[0] == 'b' ? CALL(2, SetBoolean)(c, &ref, 1, &n)
                                  : CALL(2, SetString)(c, &ref, 1, &text);
    } else {
        status = (int)(kind[0] == 'r'   ? CALL(3, SetFloat64)(c, &ref, 1, x, count)
                       : kind[0] == 'i' ? CALL(3, SetInt32)(c, &ref, 1, &n, 1)
                       : kind[0] == 'b' ? CALL(3, SetBoolean)(c, &ref, 1, &b, 1)
                                        : CALL(3, SetString)(c, &ref, 1, &text, 1));
    }
    good(status, kind);
}

static void read_job(const char *name)
{
    char line[TEXT], kind[16];
    int at;
    FILE *file = fopen(name, "rb");
    if (!file) {
        fail("cannot read", name);
    }
    while (fgets(line, sizeof line, file)) {
        struct shown *s = &run.shown[run.count];
        uint32_t ref;
        line[strcspn(line, "\r\n")] = '\0';
        if (sscanf(line, "show %c %" SCNu32 " %d", &s->kind, &s->ref, &s->count) == 3) {
            if (s->count > WIDEST || ++run.count == SHOWN) {
                fail("too much", line);
            }
        } else if (strncmp(line, "token ", 6) == 0) {
            strcpy(run.token, line + 6);
        } else if (strncmp(line, "resources ", 10) == 0) {
            strcpy(run.resources, line + 10);
        } else if (strcmp(line, "values") == 0) {
            run.values = true;
        } else if (sscanf(line, "steps %ld %lf", &run.steps, &run.size) == 2) {
            instantiate(); /* what comes behind it are values */
        } else if (sscanf(line, "%15s %" SCNu32 " %n", kind, &ref, &at) == 2 && run.instance) {
            set(kind, ref, line + at);
        } else {
            fail("what is this", line);
        }
    }
    fclose(file);
}

/* The bytes of an output, Booleans and integers as int32_t. */
static size_t get(const struct shown *s, double *x, int32_t *n)
{
    static uint32_t refs[WIDEST];
    static bool b[WIDEST];
    const size_t count = (size_t)s->count;
    void *c = run.instance;
    for (int i = 0; i < s->count; i++) {
        refs[i] = s->ref + (uint32_t)i;
    }
    if (run.fmi == 2) {
        good(s->kind == 'd'   ? CALL(2, GetReal)(c, refs, count, x)
             : s->kind == 'i' ? CALL(2, GetInteger)(c, refs, count, n)
                              : CALL(2, GetBoolean)(c, refs, count, n),
             "get");
    } else {
        good(s->kind == 'd'   ? (int)CALL(3, GetFloat64)(c, refs, 1, x, count)
             : s->kind == 'i' ? (int)CALL(3, GetInt32)(c, refs, 1, n, count)
                              : (int)CALL(3, GetBoolean)(c, refs, 1, b, count),
             "get");
        for (size_t i = 0; s->kind == 'b' && i < count; i++) {
            n[i] = b[i];
        }
    }
    return count * (s->kind == 'd' ? sizeof *x : sizeof *n);
}

/* FNV-1a of all outputs. */
static void print(long step)
{
    static double x[WIDEST];
    static int32_t n[WIDEST];
    uint64_t hash = 0xcbf29ce484222325u;
    for (int k = 0; k < run.count; k++) {
        const struct shown *s = &run.shown[k];
        const size_t size = get(s, x, n);
        const unsigned char *p = s->kind == 'd' ? (const void *)x : (const void *)n;
        for (size_t i = 0; i < size; i++) {
            hash = (hash ^ p[i]) * 0x100000001b3u;
        }
        for (int i = 0; run.values && i < s->count; i++) {
            uint64_t bits;
            memcpy(&bits, &x[i], sizeof bits);
            if (s->kind == 'd') {
                printf("%ld %" PRIu32 "[%d] %016" PRIx64 " %.17g\n", step, s->ref, i, bits, x[i]);
            } else {
                printf("%ld %" PRIu32 "[%d] %" PRId32 "\n", step, s->ref, i, n[i]);
            }
        }
    }
    printf("%ld %016" PRIx64 "\n", step, hash);
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fail("wanted", "LIBRARY FMI JOB");
    }
    run.lib = OPEN(argv[1]);
    run.fmi = argv[2][0] - '0';
    if (!run.lib) {
        fail("does not load", argv[1]);
    }
    read_job(argv[3]);
    void *c = run.instance;
    if (run.fmi == 2) {
        good(CALL(2, SetupExperiment)(c, 0, 0.0, 0.0, 0, 0.0), "SetupExperiment");
        good(CALL(2, EnterInitializationMode)(c), "EnterInitializationMode");
        good(CALL(2, ExitInitializationMode)(c), "ExitInitializationMode");
    } else {
        good((int)CALL(3, EnterInitializationMode)(c, false, 0.0, 0.0, false, 0.0),
             "EnterInitializationMode");
        good((int)CALL(3, ExitInitializationMode)(c), "ExitInitializationMode");
    }
    print(0);
    for (long k = 0; k < run.steps; k++) {
        const double t = (double)k * run.size;
        if (run.fmi == 2) {
            good(CALL(2, DoStep)(c, t, run.size, 1), "DoStep");
        } else {
            bool event, end, early;
            double last;
            good((int)CALL(3, DoStep)(c, t, run.size, true, &event, &end, &early, &last), "DoStep");
        }
        print(k + 1);
    }
    if (run.fmi == 2) {
        good(CALL(2, Terminate)(c), "Terminate");
        CALL(2, FreeInstance)(c);
    } else {
        good((int)CALL(3, Terminate)(c), "Terminate");
        CALL(3, FreeInstance)(c);
    }
    return 0;
}
