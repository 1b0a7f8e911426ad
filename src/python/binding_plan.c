/* binding_plan - planning a drawing into the job file of a network card, for Python. */
#include <string.h>

#include "binding.h"
#include "job_writer.h"
#include "net_plan.h"

/* A plan in progress and the pages of its job file. */
struct planner {
    struct net_plan_config config;
    struct job_header header;
    struct net_plan plan;
    struct job_writer writer;
};

#define SET(m, name, unit) ONE(planner, m, name, unit)
#define AXIS(m, unit) \
    { \
        #m,  unit, 'd', OFFSET(planner, config.axis[0].m), JOB_AXES, sizeof(struct net_plan_axis), \
        SAME \
    }
#define EVENT(m, kind) \
    { "event_" #m, "", \
      kind,        OFFSET(planner, header.event[0].m), \
      JOB_EVENTS,  sizeof(struct job_event), \
      SAME }
static const struct field planner_fields[] = {
    AXIS(pulses_per_mm, "pulses/mm"),
    AXIS(speed, "mm/s"),
    AXIS(acc, "mm/s^2"),
    AXIS(jerk, "mm/s^3"),
    SET(config.period_ns, "period_ns", "ns"),
    SET(config.tolerance, "tolerance", "mm"),
    SET(config.rapid, "rapid", "mm/s"),
    SET(config.reserve, "reserve", ""),
    { "pen", "", 'i', OFFSET(planner, config.pen), 1, sizeof(enum net_plan_pen), SAME },
    SET(config.pen_axis, "pen_axis", ""),
    SET(config.up, "up", "mm"),
    SET(config.down, "down", "mm"),
    SET(config.dwell, "dwell", "s"),
    SET(header.axes, "axes", "bits"),
    SET(header.events, "events", ""),
    SET(header.rest, "rest", ""),
    ROW(planner, header.pulses_per_m, "pulses_per_m", "pulses/m"),
    ROW(planner, header.speed_max, "speed_max", "pulses/s"),
    ROW(planner, header.acc_max, "acc_max", "pulses/s^2"),
    EVENT(width_us, 'u'),
    SET(plan.stops, "stops", ""),
    SET(writer.header.frames, "frames", ""),
};

#define VERTEX(m, name, unit) ONE(net_plan_vertex, m, name, unit)
static const struct field vertex_fields[] = {
    ROW(net_plan_vertex, point, "point", "mm"),
    VERTEX(feed, "feed", "mm/s"),
    { "kind", "", 'i', OFFSET(net_plan_vertex, kind), 1, sizeof(enum net_plan_kind), SAME },
};

static const struct field frame_fields[] = {
    ROW(net_plan_frame, job.command, "command", "pulses"),
    ONE(net_plan_frame, job.event, "event", ""),
    ROW(net_plan_frame, place, "place", "mm"),
    { "step", "", 'i', OFFSET(net_plan_frame, step), 1, sizeof(enum net_plan_step), SAME },
};
_Static_assert(sizeof(enum net_plan_kind) == sizeof(int32_t)
                   && sizeof(enum net_plan_step) == sizeof(int32_t)
                   && sizeof(enum net_plan_pen) == sizeof(int32_t),
               "an enum is read as an int32");

const struct table PLAN_TABLES[] = {
    { "planner", planner_fields, sizeof planner_fields, sizeof(struct planner) },
    { "plan_vertex", vertex_fields, sizeof vertex_fields, sizeof(struct net_plan_vertex) },
    { "plan_frame", frame_fields, sizeof frame_fields, sizeof(struct net_plan_frame) },
    { NULL, NULL, 0, 0 },
};

/* Begin with the settings that Python has filled in; arrays that are no fields are arguments. */
void binding_plan_start(struct planner *p, const uint8_t origin[JOB_ORIGIN_BYTES],
                        const uint64_t jerk_max[JOB_AXES], const uint16_t pins[JOB_EVENTS],
                        const uint8_t level[JOB_EVENTS])
{
    p->header.period_ns = (uint32_t)p->config.period_ns;
    memcpy(p->header.origin, origin, JOB_ORIGIN_BYTES);
    memcpy(p->header.jerk_max, jerk_max, sizeof p->header.jerk_max);
    for (int k = 0; k < JOB_EVENTS; k++) {
        p->header.event[k].pins = pins[k];
        p->header.event[k].level = level[k];
    }
    net_plan_start(&p->plan, &p->config);
    job_writer_start(&p->writer, &p->header);
}

/* Plan frames from vertices and write them into pages, until the vertices are taken or there is no
 * room; after the last vertex to the end of the job. Returns the number of frames; `done` is the
 * numbers of vertices taken and of pages. */
int64_t binding_plan_run(struct planner *p, const struct net_plan_vertex *v, const int64_t count[3],
                         struct net_plan_frame *f, uint8_t (*page)[JOB_PAGE_BYTES], int64_t done[2])
{
    const int64_t vertices = count[0], room = count[1];
    int64_t made = 0;

    done[0] = done[1] = 0;
    while (made < room) {
        while (done[0] < vertices && net_plan_take(&p->plan, &v[done[0]])) {
            done[0]++;
        }
        if (done[0] == vertices && !count[2]) {
            break;
        }
        if (done[0] == vertices) {
            net_plan_end(&p->plan);
        }
        if (net_plan_next(&p->plan, &f[made]) != NET_PLAN_FRAME) {
            break;
        }
        done[1] += job_writer_add(&p->writer, &f[made].job, page[done[1]]);
        made++;
    }
    return made;
}

/* Write the last page and the header. Returns what is wrong with the job, or "". */
const char *binding_plan_end(struct planner *p, uint8_t page[JOB_PAGE_BYTES],
                             uint8_t header[JOB_PAGE_BYTES])
{
    const enum job_fault fault = job_writer_end(&p->writer, page, header);
    return fault ? job_fault_text(fault) : "";
}
