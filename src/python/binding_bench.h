/* binding_bench - FMUs that are stepped with signals added to values of their wires, for
 * motionfmu.analysis.freq.bench. The instances are of FMI 3.0, and initialized. */
#ifndef BINDING_BENCH_H
#define BINDING_BENCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* fmi3Get.. or fmi3Set.. of one variable, whatever the type of its values. */
struct bench_access {
    int (*call)(void *instance, const uint32_t *reference, size_t references, void *values,
                size_t count);
    void *instance;
    void *values;
    size_t count;
    uint32_t reference;
};

/* An output and what its wire brings to an input, in the same memory. */
struct bench_wire {
    struct bench_access get, put;
    const double *offset; /* added to each of its values, which are Float64; NULL: nothing */
};

/* One element of an output. */
struct bench_output {
    struct bench_access get;
    int32_t kind; /* d double, i int32, ? bool */
    int32_t place;
};

/* One element of an input, with a signal added to what its wire brings. */
struct bench_tap {
    struct bench_access put;
    const struct bench_output *source; /* NULL: the input keeps `base` */
    double base, gain;                 /* the wire's value is multiplied by gain */
    double *late;                      /* the values on their way, the oldest at `oldest` */
    int32_t delay, oldest;             /* [steps]; 0: nothing is late */
    int32_t kind, place;               /* of the input: d or i */
    size_t bytes;                      /* of all its values */
};

struct bench_slave {
    int (*step)(void *instance, double time, double size, bool keeps, bool *event, bool *ended,
                bool *early, double *last);
    void *instance;
};

struct bench_loop {
    struct bench_wire *wire;
    struct bench_output *output;
    struct bench_tap *tap;
    struct bench_slave *slave;
    int32_t wires, outputs, taps, slaves;
    int64_t step_ns;
    int64_t rows; /* begun steps, of which all outputs were read */
    /* The call that an FMU refused, NULL if it was its step, and the instance of that FMU. */
    const struct bench_access *refused;
    const void *by;
};

/* Go on to before step `to`. Row k of `shown` are the outputs at the begin of step k, of `added`
 * what is added at the taps in it, of `used` what that was after rounding. False: an FMU refused,
 * and nothing can go on. */
bool binding_bench(struct bench_loop *b, int64_t to, const double *added, double *shown,
                   double *used);

#endif
