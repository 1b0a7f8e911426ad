/* FMU of the logic analyser (core analyser): it reads its inputs at the instants of a grid and
 * shows the outcome at the next. Events are kept in memory and written to a file if the run ends
 * well. */
#include <inttypes.h>

#include "analyser.h"
#include "vars.h"

struct model {
    struct analyser analyser;
    int64_t instant;  /* [clock] next instant of the grid */
    bool unpublished; /* the outputs of the latest instant are not shown yet */
    int64_t held;     /* number of events so far */
};

#define MODEL_BLOB
#include "fmi_model.h"
#include "fmu_output.h"
#include "fmu_period.h"

enum { CLOCK_HZ = 40000000, CLOCK_NS = 1000000000 / CLOCK_HZ, GROUPS = 6 };

/* Recorded events. A restored FMU state may be from before or after the last of them. */
struct events {
    struct analyser_event *of;
    int64_t room, held;
};

static int cannot_write(struct fmu *f, const char *why)
{
    return fmu_fail(f, "record_file: cannot write %s: %s", f->s.v.record_file, why);
}

/* Check before the run, not after it, that the file can be written. */
static int model_open(struct fmu *f)
{
    const char *name = f->s.v.record_file;
    const struct fmu_path path = fmu_path(f, name, FMU_WRITTEN);
    const char *why = !path.good ? path.text : name[0] ? output_try(path.text, NULL, 0) : NULL;
    if (why)
        return cannot_write(f, why);
    f->blob = calloc(1, sizeof(struct events));
    return f->blob ? 0 : fmu_fail(f, "no memory for the events");
}

static void model_close(struct fmu *f)
{
    struct events *e = f->blob;
    if (e)
        free(e->of);
    free(e);
}

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const double period = v->bus_period * CLOCK_HZ;
    struct analyser_config c = { .enabled = (uint32_t)v->enabled, .seed = v->seed };
    if (!fmu_is_period(period))
        return fmu_fail(f, "bus_period = %.17g s: not a whole number of 25 ns clocks",
                        v->bus_period);
    c.period = llround(period);
    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        if (v->mean_pause[i] < v->least_pause[i])
            return fmu_fail(f, "mean_pause[%d] = %g s: less than least_pause = %g s", i + 1,
                            v->mean_pause[i], v->least_pause[i]);
        c.least[i] = llround(v->least_pause[i] * CLOCK_HZ);
        c.most[i] = 2 * llround(v->mean_pause[i] * CLOCK_HZ) - c.least[i];
        c.timeout[i] = llround(v->timeout[i] * CLOCK_HZ);
    }
    analyser_reset(&f->s.m.analyser, &c);
    return 0;
}

/* Record an event. Events from before a state of another instance are not known and stay marked
 * so. */
static int record(struct fmu *f, const struct analyser_event *event)
{
    enum { FIRST = 1024 }; /* events of the first buffer; it doubles when full */
    const struct analyser_event unknown = { .channel = -1 };
    struct events *e = f->blob;
    struct model *m = &f->s.m;
    if (m->held >= e->room) {
        int64_t room = e->room ? e->room : FIRST;
        while (room <= m->held)
            room *= 2;
        struct analyser_event *of = realloc(e->of, (size_t)room * sizeof *of);
        if (!of)
            return fmu_fail(f, "no memory for event %" PRId64 " of %s", m->held,
                            f->s.v.record_file);
        e->of = of;
        e->room = room;
    }
    for (; e->held < m->held; e->held++)
        e->of[e->held] = unknown;
    e->of[m->held++] = *event;
    e->held = m->held;
    return 0;
}

/* Set the outputs of a group from the statistics of its channels together. */
static void publish_group(struct vars *v, const struct analyser *a, int group)
{
    struct analyser_channel all = { .least = INT64_MAX };
    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        const struct analyser_channel *c = &a->channel[i];
        if (v->group[i] != group + 1)
            continue;
        all.timeouts += c->timeouts + c->strays;
        if (c->responses == 0)
            continue;
        all.responses += c->responses;
        all.sum += c->sum;
        all.least = c->least < all.least ? c->least : all.least;
        all.most = c->most > all.most ? c->most : all.most;
    }
    v->group_failures[group] = all.timeouts;
    if (v->group_responses[group] == all.responses)
        return;
    v->group_responses[group] = all.responses;
    v->group_least[group] = (double)all.least / CLOCK_HZ;
    v->group_mean[group] = (double)all.sum / CLOCK_HZ / all.responses;
    v->group_most[group] = (double)all.most / CLOCK_HZ;
}

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    const struct analyser *a = &f->s.m.analyser;
    v->di = (int32_t)a->levels;
    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        const struct analyser_channel *c = &a->channel[i];
        if (!(a->config.enabled >> i & 1))
            continue;
        v->di_clock[i] = (double)c->shown;
        v->edges[i] = c->edges;
        v->timeouts[i] = c->timeouts;
        v->strays[i] = c->strays;
        if (v->responses[i] == c->responses)
            continue;
        v->responses[i] = c->responses;
        v->latest[i] = (double)c->latest / CLOCK_HZ;
        v->least[i] = (double)c->least / CLOCK_HZ;
        v->mean[i] = (double)c->sum / CLOCK_HZ / c->responses;
        v->most[i] = (double)c->most / CLOCK_HZ;
    }
    for (int g = 0; g < GROUPS; g++)
        publish_group(v, a, g);
}

static int read_wires(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    struct analyser_event event[ANALYSER_CHANNELS];
    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        if (!(fabs(v->response_clock[i]) < FMU_TICKS_MAX))
            return fmu_fail(f, "response_clock[%d] = %g: not a clock", i + 1, v->response_clock[i]);
    }
    const int32_t n =
        analyser_instant(&m->analyser, m->instant, (uint32_t)v->response, v->response_clock, event);
    for (int32_t k = 0; k < n && v->record_file[0]; k++) {
        if (record(f, &event[k]))
            return -1;
    }
    return 0;
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    (void)t0;
    for (;;) {
        if (m->unpublished && m->instant * CLOCK_NS <= t1) {
            publish(f);
            m->unpublished = false;
        }
        if (m->instant * CLOCK_NS >= t1)
            return 0;
        if (read_wires(f))
            return -1;
        m->instant += m->analyser.config.period;
        m->unpublished = true;
    }
}

static const char *put_events(const void *model, FILE *file)
{
    const struct fmu *f = model;
    const struct events *e = f->blob;
    const int64_t events = f->s.m.held;

    fputs("channel,edge_clock,response_clock\n", file);
    for (int64_t k = 0; k < events && k < e->held; k++) {
        const struct analyser_event *of = &e->of[k];
        if (of->channel < 0)
            continue;
        fprintf(file, "%d,%" PRId64 ",", (int)of->channel, of->edge);
        if (of->response >= 0)
            fprintf(file, "%" PRId64, of->response);
        fputc('\n', file);
    }
    return NULL;
}

static int model_end(struct fmu *f)
{
    const struct fmu_path path = fmu_path(f, f->s.v.record_file, FMU_WRITTEN);
    const char *why = path.text[0] ? output_write(path.text, NULL, 0, put_events, f) : NULL;
    return why ? cannot_write(f, why) : 0;
}
