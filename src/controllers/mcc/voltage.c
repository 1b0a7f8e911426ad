#include "voltage.h"

#include <math.h>
#include <string.h>

/* Begin the commanded path where the machine is: at the start, and after an emergency stop. */
static void begin_trail(struct voltage *v, const struct mcc *m)
{
    static const double origin[3] = { 0.0 };

    commanded_path_start(&v->commanded_path, origin);
    memset(v->sum, 0, sizeof v->sum);
    memset(v->place, 0, sizeof v->place);
    memcpy(v->base, m->signals.pulses, sizeof v->base);
    memcpy(v->added, m->written.added, sizeof v->added);
    memcpy(v->added_base, v->added, sizeof v->added_base);
    v->frame = 0;
}

void voltage_start(struct voltage *v, const struct law_config *c, const struct machine *m)
{
    memset(v, 0, sizeof *v);
    v->config = *c;
    for (int i = 0; i < AXES; i++) {
        const struct law_axis *a = &c->axis[i];
        v->wanted[i] = a->on;
        v->special = v->special || (a->on && (a->feed_forward > 0.0 || a->lag > 0.0));
    }
    v->special = v->special || law_crosses(c);
    voltage_follow(v, m);
}

void voltage_follow(struct voltage *v, const struct machine *m)
{
    bool other = false;

    for (int i = 0; i < AXES; i++) {
        if (!v->wanted[i]) {
            continue;
        }
        const struct machine_axis *a = &m->axis[i];
        const double unit = machine_pulses_per_mm(a);
        other = other || v->config.axis[i].on != a->used || v->inverted[i] != a->inverted
                || (i < 3 && v->config.pulses_per_mm[i] != unit);
        v->config.axis[i].on = a->used;
        v->inverted[i] = a->inverted;
        if (i < 3) {
            v->config.pulses_per_mm[i] = unit;
        }
    }
    if (other) {
        memset(&v->law, 0, sizeof v->law);
    }
}

/* Append a frame that the card has taken (NULL: standstill) to the commanded path. Its end comes
 * from the sum of pulses, so that a new origin is no motion. */
static void take(struct voltage *v, const struct mcc *m, const struct point *point)
{
    const double dda_time = machine_dda_time(&m->machine);
    struct commanded_path_point p = { { 0.0 }, { 0.0 }, { 0 } };

    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &m->machine.axis[i];
        const int32_t correction = point ? point->added[i] - v->added[i] : 0;
        const double before = v->place[i];
        if (point && a->used) {
            v->sum[i] += (int64_t)point->frame[i] - correction;
            v->place[i] = (double)v->sum[i];
            if (!m->dry_run) {
                v->place[i] += point->place[i] * machine_pulses_per_mm(a) - point->pulses[i];
            }
            v->added[i] = point->added[i];
            p.speed[i] = (v->place[i] - before + correction) / dda_time;
        }
        if (i < 3) {
            p.place[i] = v->place[i] / machine_pulses_per_mm(a);
            p.added[i] = v->added[i] - v->added_base[i];
        }
    }
    commanded_path_push(&v->commanded_path, &p);
}

void voltage_taken(struct voltage *v, const struct mcc *m, const struct pcl_part *part,
                   int32_t taken)
{
    for (int32_t i = 0; i < taken && v->special; i++) {
        take(v, m, i < part->points ? queue_peek(&m->queue, i) : NULL);
    }
}

/* Point of the frame that is being put out; NULL once that is over and the FIFO is empty. */
static const struct commanded_path_point *now_out(struct voltage *v, const struct mcc *m,
                                                  int64_t now, int32_t stock)
{
    const int64_t frame = v->commanded_path.frames - stock;

    if (frame != v->frame) {
        v->frame = frame;
        v->since = now;
    }
    const bool over = now - v->since > machine_dda_clocks(&m->machine);
    return over || frame < v->commanded_path.first ? NULL
                                                   : commanded_path_at(&v->commanded_path, frame);
}

/* Point of the path nearest to the tool, whose place follows from pulses, errors and compensation
 * of the instant before, when `frame` was put out. */
static struct commanded_path_foot nearest(struct voltage *v, const struct mcc *m, int64_t frame)
{
    const struct commanded_path_point *at = commanded_path_at(&v->commanded_path, frame);
    double tool[3];

    for (int k = 0; k < 3; k++) {
        const int64_t counts = (int64_t)v->law.pulses[k] - m->signals.err[k];
        tool[k] = (double)(counts - v->base[k] - at->added[k]) / v->config.pulses_per_mm[k];
    }
    return commanded_path_nearest(&v->commanded_path, tool, v->frame);
}

void voltage_tick(struct voltage *v, const struct mcc *m, int64_t now, int32_t stock, double limit,
                  double volts[AXES])
{
    struct law_look look = { .foot = { { 0.0 }, { 0.0 } } };

    if (v->special && (!v->law.begun || m->signals.stop)) {
        begin_trail(v, m);
    }
    memcpy(look.pulses, m->signals.pulses, sizeof look.pulses);
    memcpy(look.error, m->signals.err, sizeof look.error);
    if (v->special) {
        const int64_t before = v->frame;
        const struct commanded_path_point *out = now_out(v, m, now, stock);
        if (out) {
            memcpy(look.speed, out->speed, sizeof look.speed);
        }
        if (law_crosses(&v->config) && v->law.begun) {
            look.foot = nearest(v, m, before);
        }
    }
    law_tick(&v->config, &v->law, &look, limit, volts);
}
