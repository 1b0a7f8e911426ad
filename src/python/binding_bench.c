#include "binding_bench.h"

#include <math.h>
#include <string.h>

enum { WARNING = 1 }; /* of fmi3Status: what is above it is a refusal */

static bool reach(struct bench_loop *b, const struct bench_access *a)
{
    if (a->call(a->instance, &a->reference, 1, a->values, a->count) <= WARNING) {
        return true;
    }
    b->refused = a;
    b->by = a->instance;
    return false;
}

static double element(const void *values, int32_t kind, int32_t place)
{
    if (kind == 'd') {
        return ((const double *)values)[place];
    }
    return kind == 'i' ? ((const int32_t *)values)[place] : ((const bool *)values)[place];
}

static void set_element(void *values, int32_t kind, int32_t place, double value)
{
    if (kind == 'd') {
        ((double *)values)[place] = value;
    } else {
        ((int32_t *)values)[place] = (int32_t)value;
    }
}

static bool wire_put(struct bench_loop *b, const struct bench_wire *w)
{
    double *value = w->put.values;

    for (size_t i = 0; w->offset && i < w->put.count; i++) {
        value[i] += w->offset[i];
    }
    return reach(b, &w->put);
}

/* What the wire of a tap brings now; the other elements of the input come as they are. */
static double brought(struct bench_tap *t)
{
    if (!t->source) {
        return t->base;
    }
    memcpy(t->put.values, t->source->get.values, t->bytes);
    const double now = t->gain * element(t->put.values, t->kind, t->place);
    if (t->delay == 0) {
        return now;
    }
    const double value = t->late[t->oldest];
    t->late[t->oldest] = now;
    t->oldest = (t->oldest + 1) % t->delay;
    return value;
}

static bool tap_put(struct bench_loop *b, struct bench_tap *t, double added, double *used)
{
    const double value = brought(t);
    const double sum = t->kind == 'i' ? rint(value + added) : value + added;

    set_element(t->put.values, t->kind, t->place, sum);
    *used = sum - value;
    return reach(b, &t->put);
}

/* Read all outputs, then what the wires bring. */
static bool get(struct bench_loop *b, double *shown)
{
    for (int32_t i = 0; i < b->outputs; i++) {
        const struct bench_output *o = &b->output[i];
        if (!reach(b, &o->get)) {
            return false;
        }
        shown[i] = element(o->get.values, o->kind, o->place);
    }
    b->rows++;
    for (int32_t i = 0; i < b->wires; i++) {
        if (!reach(b, &b->wire[i].get)) {
            return false;
        }
    }
    for (int32_t i = 0; i < b->taps; i++) {
        if (b->tap[i].source && !reach(b, &b->tap[i].source->get)) {
            return false;
        }
    }
    return true;
}

static bool put(struct bench_loop *b, const double *added, double *used)
{
    for (int32_t i = 0; i < b->wires; i++) {
        if (!wire_put(b, &b->wire[i])) {
            return false;
        }
    }
    for (int32_t i = 0; i < b->taps; i++) {
        if (!tap_put(b, &b->tap[i], added[i], &used[i])) {
            return false;
        }
    }
    return true;
}

static bool step(struct bench_loop *b, double time, double size)
{
    for (int32_t i = 0; i < b->slaves; i++) {
        const struct bench_slave *s = &b->slave[i];
        bool event, ended, early;
        double last;

        if (s->step(s->instance, time, size, true, &event, &ended, &early, &last) > WARNING) {
            b->refused = NULL;
            b->by = s->instance;
            return false;
        }
    }
    return true;
}

bool binding_bench(struct bench_loop *b, int64_t to, const double *added, double *shown,
                   double *used)
{
    for (int64_t k = b->rows; k < to; k++) {
        const double time = (double)(k * b->step_ns) * 1e-9, size = (double)b->step_ns * 1e-9;
        if (!get(b, &shown[k * b->outputs]) || !put(b, &added[k * b->taps], &used[k * b->taps])
            || !step(b, time, size)) {
            return false;
        }
    }
    return true;
}
