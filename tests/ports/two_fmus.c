/* Two FMUs from their packed sources in one program: each runs ten steps, in turns with the other,
 * and a hash of its Float64 outputs is printed. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "fmi3FunctionTypes.h"

struct fmu {
    const char *token;
    fmi3InstantiateCoSimulationTYPE *instantiate;
    fmi3EnterInitializationModeTYPE *enter;
    fmi3ExitInitializationModeTYPE *leave;
    fmi3DoStepTYPE *step;
    fmi3GetFloat64TYPE *get;
    fmi3FreeInstanceTYPE *release;
    const struct {
        uint32_t ref, count;
    } *outputs;
};

#define FMU(id) \
    fmi3InstantiateCoSimulationTYPE id##_fmi3InstantiateCoSimulation; \
    fmi3EnterInitializationModeTYPE id##_fmi3EnterInitializationMode; \
    fmi3ExitInitializationModeTYPE id##_fmi3ExitInitializationMode; \
    fmi3DoStepTYPE id##_fmi3DoStep; \
    fmi3GetFloat64TYPE id##_fmi3GetFloat64; \
    fmi3FreeInstanceTYPE id##_fmi3FreeInstance
#define ROW(id, token, outputs) \
    { token, \
      id##_fmi3InstantiateCoSimulation, \
      id##_fmi3EnterInitializationMode, \
      id##_fmi3ExitInitializationMode, \
      id##_fmi3DoStep, \
      id##_fmi3GetFloat64, \
      id##_fmi3FreeInstance, \
      (const void *)outputs }

FMU(Mcc);
FMU(Epcio);
#include "two_fmus.h" /* MCC_TOKEN, EPCIO_TOKEN, mcc_outputs, epcio_outputs: references and sizes */

static void say(fmi3InstanceEnvironment e, fmi3Status status, fmi3String category, fmi3String text)
{
    (void)e, (void)category;
    fprintf(stderr, "%d %s\n", (int)status, text);
}

int main(void)
{
    static const struct fmu fmus[] = { ROW(Mcc, MCC_TOKEN, mcc_outputs),
                                       ROW(Epcio, EPCIO_TOKEN, epcio_outputs) };
    enum { FMUS = sizeof fmus / sizeof fmus[0], STEPS = 10, WIDEST = 4096 };
    const double size = 1e-4;
    uint64_t hash[FMUS];
    void *instance[FMUS];
    int bad = 0;
    for (int i = 0; i < FMUS; i++) {
        const struct fmu *f = &fmus[i];
        hash[i] = 0xcbf29ce484222325u;
        instance[i] = f->instantiate("one", f->token, "", false, false, false, false, NULL, 0, NULL,
                                     say, NULL);
        if (!instance[i]) {
            return 1;
        }
        bad |= f->enter(instance[i], false, 0.0, 0.0, false, 0.0);
        bad |= f->leave(instance[i]);
    }
    for (int k = 0; k < STEPS; k++) {
        for (int i = 0; i < FMUS; i++) {
            static double x[WIDEST];
            bool event, end, early;
            double last;
            bad |= fmus[i].step(instance[i], k * size, size, true, &event, &end, &early, &last);
            for (int n = 0; fmus[i].outputs[n].count; n++) {
                const size_t count = fmus[i].outputs[n].count;
                bad |= fmus[i].get(instance[i], &fmus[i].outputs[n].ref, 1, x, count);
                for (size_t b = 0; b < count * sizeof x[0]; b++) {
                    hash[i] = (hash[i] ^ ((unsigned char *)x)[b]) * 0x100000001b3u;
                }
            }
        }
    }
    for (int i = 0; i < FMUS; i++) {
        fmus[i].release(instance[i]);
        printf("%016" PRIx64 "\n", hash[i]);
    }
    return bad;
}
