#include "values.h"

#include <math.h>
#include <string.h>

#include "scratch.h"

uint32_t take(struct bytes *b, int n)
{
    uint32_t x = 0;
    for (int i = 0; i < n; i++) {
        x = x << 8 | (b->at < b->end ? *b->at++ : 0);
    }
    return x;
}

static double number(struct bytes *b, const struct inside_variable *v, double start)
{
    static const double odd[] = { 0.0,   -0.0,   1.0,    -1.0, 1e-9,     25e-9,     1e-3, 1e3,
                                  1e308, -1e308, 5e-324, NAN,  INFINITY, -INFINITY, 0.1,  1e18 };
    const uint32_t kind = take(b, 1);
    const double share = (double)take(b, 2) / 65535.0;
    const double low = fmax(v->min, -1e3), high = fmin(v->max, 1e3);
    switch (kind % 8) {
    case 0:  return v->min;
    case 1:  return v->max;
    case 2:  return odd[kind / 8 % 16];
    case 3:  return nextafter(kind & 8 ? v->min : v->max, kind & 8 ? -INFINITY : INFINITY);
    case 4:  return start;
    case 5:  return fmin(fmax(start * (0.25 + 3.75 * share), v->min), v->max);
    default: return low + (high - low) * share;
    }
}

union side_value value(struct bytes *b, const struct inside_variable *v, union side_value start)
{
    static char large[4096];
    union side_value x = { .real = 0.0 };
    double n;
    switch (v->type) {
    case SIDE_REAL: x.real = number(b, v, start.real); break;
    case SIDE_INTEGER:
        n = number(b, v, start.integer);
        x.integer = n >= INT32_MIN && n <= INT32_MAX ? (int32_t)n : (int32_t)take(b, 4);
        break;
    case SIDE_BOOLEAN: x.boolean = take(b, 1) & 1; break;
    default:
        memset(large, 'a', (size_t)inside_string_max());
        n = take(b, 1);
        large[inside_string_max() - (n == 254)] = '\0'; /* just short enough, just too long */
        x.string = n >= 254   ? large
                   : n >= 192 ? scratch_texts[(int)n % SCRATCH_TEXTS]
                              : scratch_names[(int)n % SCRATCH_NAMES];
    }
    return x;
}

bool legal(const struct inside_variable *v, union side_value x)
{
    switch (v->type) {
    case SIDE_REAL:    return x.real >= v->min && x.real <= v->max;
    case SIDE_INTEGER: return x.integer >= v->min && x.integer <= v->max;
    case SIDE_BOOLEAN: return true;
    default:           return strlen(x.string) < (size_t)inside_string_max();
    }
}

bool equal(int type, union side_value a, union side_value b)
{
    return type == SIDE_REAL      ? memcmp(&a.real, &b.real, sizeof a.real) == 0
           : type == SIDE_STRING  ? strcmp(a.string, b.string) == 0
           : type == SIDE_BOOLEAN ? a.boolean == b.boolean && a.boolean >> 1 == 0
                                  : a.integer == b.integer;
}
