/* Outputs follow inputs, FMI 3.0: all types of the standard, from its headers alone. */
#include <string.h>

#include "fmi3_rest.h"

/* References end with 0 for a single input, 1 for its output, 2 and 3 for arrays, 4 and 5 for one
 * more of single values; the arrays' size is that of the structural parameter. What no one records
 * can be seen in a sum of all. */
enum { MANY = 3, ROOM = 256 };

struct feed {
#define VALUES(type) \
    struct { \
        fmi3##type one, many[MANY], other; \
    } type
    VALUES(Float32);
    VALUES(Float64);
    VALUES(Int8);
    VALUES(UInt8);
    VALUES(Int16);
    VALUES(UInt16);
    VALUES(Int32);
    VALUES(UInt32);
    VALUES(Int64);
    VALUES(UInt64);
    VALUES(Boolean);
    char text[ROOM];
    fmi3Byte bytes[ROOM];
    size_t size;
};

fmi3Instance fmi3InstantiateCoSimulation(fmi3String name, fmi3String token, fmi3String place,
                                         fmi3Boolean visible, fmi3Boolean logging,
                                         fmi3Boolean events, fmi3Boolean early,
                                         const fmi3ValueReference needed[], size_t n,
                                         fmi3InstanceEnvironment environment,
                                         fmi3LogMessageCallback log,
                                         fmi3IntermediateUpdateCallback update)
{
    (void)name, (void)token, (void)place, (void)visible, (void)logging, (void)events, (void)early;
    (void)needed, (void)n, (void)environment, (void)log, (void)update;
    return calloc(1, sizeof(struct feed));
}

fmi3Status fmi3EnterInitializationMode(fmi3Instance c, fmi3Boolean defined, fmi3Float64 tolerance,
                                       fmi3Float64 start, fmi3Boolean ends, fmi3Float64 stop)
{
    (void)defined, (void)tolerance, (void)start, (void)ends, (void)stop;
    return c ? fmi3OK : fmi3Error;
}

#define SLOT(of, ref) (ref % 10 < 2 ? &of.one : ref % 10 < 4 ? of.many : &of.other)
#define FEED(type) \
    fmi3Status fmi3Set##type(fmi3Instance c, const fmi3ValueReference r[], size_t n, \
                             const fmi3##type x[], size_t count) \
    { \
        struct feed *f = c; \
        const fmi3##type *end = x + count; \
        for (size_t i = 0; i < n; i++) { \
            const size_t size = r[i] % 10 / 2 == 1 ? MANY : 1; \
            if (r[i] % 2 || size > (size_t)(end - x)) \
                return fmi3Error; \
            memcpy(SLOT(f->type, r[i]), x, size * sizeof *x); \
            x += size; \
        } \
        return x == end ? fmi3OK : fmi3Error; \
    } \
    fmi3Status fmi3Get##type(fmi3Instance c, const fmi3ValueReference r[], size_t n, \
                             fmi3##type x[], size_t count) \
    { \
        const struct feed *f = c; \
        const fmi3##type *end = x + count; \
        for (size_t i = 0; i < n; i++) { \
            const size_t size = r[i] % 10 / 2 == 1 ? MANY : 1; \
            if (size > (size_t)(end - x)) \
                return fmi3Error; \
            memcpy(x, SLOT(f->type, r[i]), size * sizeof *x); \
            x += size; \
        } \
        return x == end ? fmi3OK : fmi3Error; \
    }

FEED(Float32)
FEED(Float64)
FEED(Int8)
FEED(UInt8)
FEED(Int16)
FEED(UInt16)
FEED(Int32)
FEED(UInt32)
FEED(Int64)
FEED(UInt64)
FEED(Boolean)

fmi3Status fmi3SetString(fmi3Instance c, const fmi3ValueReference r[], size_t n,
                         const fmi3String x[], size_t count)
{
    (void)r, (void)count;
    for (size_t i = 0; i < n; i++)
        strncpy(((struct feed *)c)->text, x[i], ROOM - 1);
    return fmi3OK;
}

fmi3Status fmi3GetString(fmi3Instance c, const fmi3ValueReference r[], size_t n, fmi3String x[],
                         size_t count)
{
    (void)r, (void)count;
    for (size_t i = 0; i < n; i++)
        x[i] = ((const struct feed *)c)->text;
    return fmi3OK;
}

fmi3Status fmi3SetBinary(fmi3Instance c, const fmi3ValueReference r[], size_t n,
                         const size_t sizes[], const fmi3Binary x[], size_t count)
{
    struct feed *f = c;
    (void)r;
    if (n != 1 || count != 1 || sizes[0] > ROOM)
        return fmi3Error;
    f->size = sizes[0];
    memcpy(f->bytes, x[0], sizes[0]);
    return fmi3OK;
}

fmi3Status fmi3GetBinary(fmi3Instance c, const fmi3ValueReference r[], size_t n, size_t sizes[],
                         fmi3Binary x[], size_t count)
{
    const struct feed *f = c;
    (void)r;
    if (n != 1 || count != 1)
        return fmi3Error;
    sizes[0] = f->size;
    x[0] = f->bytes;
    return fmi3OK;
}

fmi3Status fmi3DoStep(fmi3Instance c, fmi3Float64 now, fmi3Float64 step, fmi3Boolean no_set,
                      fmi3Boolean *event, fmi3Boolean *end, fmi3Boolean *early, fmi3Float64 *last)
{
    struct feed *f = c;
    (void)no_set;
    f->Float64.other =
        (double)f->Float32.one + 2 * f->Float64.one + 3 * f->Int8.one + 4 * f->UInt8.one
        + 5 * f->Int16.one + 6 * f->UInt16.one + 7.0 * f->Int32.one + 8.0 * f->UInt32.one
        + 9 * (double)f->Int64.one + 10 * (double)f->UInt64.one + 11 * f->Boolean.one
        + 12 * (double)strlen(f->text) + 13 * (double)f->Int64.other + 14 * f->Int16.many[2];
    *event = *end = *early = false;
    *last = now + step;
    return c ? fmi3OK : fmi3Error;
}
