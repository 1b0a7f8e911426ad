/* Runs FMUs that are wired, as fmu_bits.c runs one: at each communication point the hash of what
 * every FMU shows, then all outputs are read, all inputs written, all FMUs step.
 *
 *     coupled_bits FMI WIRES {LIBRARY JOB}
 *
 * WIRES is a text file, a row each: KIND FROM REF COUNT TO REF, where FROM and TO are FMUs by their
 * places among the arguments, from 0. Step and number of steps are those of the first job.
 */
#define main fmu_bits
#include "fmu_bits.c"
#undef main

enum { PARTS = 16, WIRES = 4096 };

static __typeof__(run) parts[PARTS];
static struct wire {
    struct shown from;
    int source, target;
    uint32_t to;
    double x[64];
    int32_t n[64];
} wires[WIRES];
static int part_count, wire_count;

static void read_wires(const char *name)
{
    FILE *file = fopen(name, "rb");
    if (!file) {
        fail("cannot read", name);
    }
    for (struct wire *w = wires;
         fscanf(file, " %c %d %" SCNu32 " %d %d %" SCNu32, &w->from.kind, &w->source, &w->from.ref,
                &w->from.count, &w->target, &w->to)
         == 6;
         w++) {
        if (w->from.count > 64 || ++wire_count == WIRES) {
            fail("too much", name);
        }
    }
    fclose(file);
}

static void put(const struct wire *w)
{
    const size_t count = (size_t)w->from.count;
    void *c = parts[w->target].instance;
    uint32_t refs[64];
    bool b[64];
    for (int i = 0; i < w->from.count; i++) {
        refs[i] = w->to + (uint32_t)i;
        b[i] = w->n[i] != 0;
    }
    run = parts[w->target];
    if (run.fmi == 2) {
        good(w->from.kind == 'd'   ? CALL(2, SetReal)(c, refs, count, w->x)
             : w->from.kind == 'i' ? CALL(2, SetInteger)(c, refs, count, w->n)
                                   : CALL(2, SetBoolean)(c, refs, count, w->n),
             "set");
    } else {
        good(w->from.kind == 'd'   ? (int)CALL(3, SetFloat64)(c, refs, 1, w->x, count)
             : w->from.kind == 'i' ? (int)CALL(3, SetInt32)(c, refs, 1, w->n, count)
                                   : (int)CALL(3, SetBoolean)(c, refs, 1, b, count),
             "set");
    }
}

static void exchange(void)
{
    for (struct wire *w = wires; w < wires + wire_count; w++) {
        run = parts[w->source];
        get(&w->from, w->x, w->n);
    }
    for (const struct wire *w = wires; w < wires + wire_count; w++) {
        put(w);
    }
}

/* One call of each FMU: E enter, X exit Initialization Mode, P print, S step, T terminate. */
static void all(char call, long k)
{
    for (int i = 0; i < part_count; i++) {
        run = parts[i];
        void *c = run.instance;
        const double step = parts[0].size, t = (double)k * step;
        bool event, end, early;
        double last;
        if (call == 'P') {
            print(k);
        } else if (run.fmi == 2) {
            good(call == 'E'   ? CALL(2, EnterInitializationMode)(c)
                 : call == 'X' ? CALL(2, ExitInitializationMode)(c)
                 : call == 'S' ? CALL(2, DoStep)(c, t, step, 1)
                               : CALL(2, Terminate)(c),
                 "call");
        } else {
            good(call == 'E'   ? (int)CALL(3, EnterInitializationMode)(c, false, 0, 0, false, 0)
                 : call == 'X' ? (int)CALL(3, ExitInitializationMode)(c)
                 : call == 'S' ? (int)CALL(3, DoStep)(c, t, step, true, &event, &end, &early, &last)
                               : (int)CALL(3, Terminate)(c),
                 "call");
        }
    }
}

int main(int argc, char **argv)
{
    for (int i = 3; i + 1 < argc && part_count < PARTS; i += 2) {
        memset(&run, 0, sizeof run);
        run.fmi = argv[1][0] - '0';
        run.lib = OPEN(argv[i]);
        if (!run.lib) {
            fail("does not load", argv[i]);
        }
        read_job(argv[i + 1]);
        if (run.fmi == 2) {
            good(CALL(2, SetupExperiment)(run.instance, 0, 0.0, 0.0, 0, 0.0), "SetupExperiment");
        }
        parts[part_count++] = run;
    }
    read_wires(argv[2]);
    all('E', 0);
    exchange();
    all('X', 0);
    for (long k = 0; k < parts[0].steps; k++) {
        all('P', k);
        exchange();
        all('S', k);
    }
    all('T', 0);
    return 0;
}
