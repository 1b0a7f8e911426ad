#include "mcc.h"

#include <math.h>
#include <string.h>

int MCC_init_motion(struct mcc *m, const struct machine *machine)
{
    if (!machine_valid(machine) || machine->queue_depth > QUEUE_SIZE) {
        return MCC_PARAMETER;
    }
    memset(m, 0, sizeof *m);
    m->machine = *machine;
    for (int i = 0; i < AXES; i++) {
        if (m->machine.axis[i].max_dda == 0) {
            m->machine.axis[i].max_dda = machine_dda_limit(machine);
        }
    }
    m->feed = machine->feed;
    ipo_start(&m->ipo);
    m->open = true;
    return MCC_NO_ERR;
}

int MCC_close_motion(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!MCC_check_stop(m)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    m->open = false;
    return MCC_NO_ERR;
}

int MCC_clear_error(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    m->error = 0;
    return MCC_NO_ERR;
}

int MCC_get_errcode(const struct mcc *m)
{
    return m->error;
}

/* Whether a motion call can be taken now. */
static int acceptable(const struct mcc *m)
{
    return !m->open ? MCC_INITIAL_MOTION :
           m->error ? MCC_RUN_TIME :
           m->ipo.abort ? MCC_ABORT_NOT_FINISH :
           m->running ? MCC_COMMAND_NOTACCEPTED :
           ring_full(&m->ring) ? MCC_COMMAND_BUFFER_FULL : MCC_NO_ERR;
}

/* A target of the user in machine coordinates; false if it is no number. */
static bool absolute(const struct mcc *m, const double target[AXES], double end[AXES])
{
    for (int i = 0; i < AXES; i++) {
        end[i] = m->incremental ? m->end[i] + target[i] : target[i];
        if (!isfinite(end[i]) || (!m->machine.axis[i].used && end[i] != m->end[i])) {
            return false;
        }
    }
    return true;
}

static int accept(struct mcc *m, struct command *c, enum fault f)
{
    if (f != FAULT_NONE) {
        return fault_code(f);
    }
    c->index = ++m->commands;
    memcpy(m->end, c->path.end, sizeof m->end);
    if (c->path.length > 0.0 || c->type == COMMAND_DELAY) {
        ring_push(&m->ring, c);
    }
    return c->index;
}

static int straight(struct mcc *m, const double target[AXES], enum command_type type)
{
    struct fault_report r;
    struct command c = { .blend = m->blend };
    double end[AXES];
    const int code = acceptable(m);

    if (code) {
        return code;
    }
    if (!absolute(m, target, end)) {
        return MCC_PARAMETER;
    }
    path_line(&c.path, m->end, end);
    if (c.path.length == 0.0) {
        return accept(m, &c, FAULT_NONE);
    }
    return accept(m, &c, type == COMMAND_PTP ? command_ptp(&c, &m->machine)
                                             : command_move(&c, &m->machine, type, m->feed, &r));
}

int MCC_line(struct mcc *m, const double target[AXES])
{
    return straight(m, target, COMMAND_LINE);
}

int MCC_ptp(struct mcc *m, const double target[AXES])
{
    return straight(m, target, COMMAND_PTP);
}

/* Only one axis goes somewhere. */
static int line_one(struct mcc *m, int axis, double value)
{
    double target[AXES] = { 0.0 };
    if (!m->incremental) {
        memcpy(target, m->end, sizeof target);
    }
    target[axis] = value;
    return MCC_line(m, target);
}

int MCC_line_x(struct mcc *m, double x)
{
    return line_one(m, 0, x);
}

int MCC_line_y(struct mcc *m, double y)
{
    return line_one(m, 1, y);
}

int MCC_line_z(struct mcc *m, double z)
{
    return line_one(m, 2, z);
}

/* A point of a plane in machine coordinates. */
static void in_plane(const struct mcc *m, enum path_plane plane, double a, double b,
                     double point[2])
{
    point[0] = a + (m->incremental ? m->end[path_first(plane)] : 0.0);
    point[1] = b + (m->incremental ? m->end[path_second(plane)] : 0.0);
}

/* Arc through a point, or with via NULL the full circle about centre. */
static int turn(struct mcc *m, enum path_plane plane, const double *via, const double end2[2],
                double centre[2], bool ccw)
{
    struct fault_report r;
    struct command c = { .blend = m->blend };
    double end[AXES];
    const int code = acceptable(m), a = path_first(plane), b = path_second(plane);
    enum fault f = FAULT_NONE;

    if (code) {
        return code;
    }
    memcpy(end, m->end, sizeof end);
    end[a] = end2[0];
    end[b] = end2[1];
    if (!isfinite(end[a]) || !isfinite(end[b]) || !m->machine.axis[a].used ||
        !m->machine.axis[b].used) {
        return MCC_PARAMETER;
    }
    if (via) {
        f = path_centre_by_point(plane, m->end, via, end, centre, &ccw);
    }
    if (f == FAULT_NONE && (!isfinite(centre[0]) || !isfinite(centre[1]))) {
        return MCC_PARAMETER;
    }
    if (f == FAULT_NONE) {
        f = path_arc(&c.path, plane, m->end, end, centre, ccw, 1, &r.value);
    }
    if (f == FAULT_NONE) {
        f = command_move(&c, &m->machine, command_arc_type(&c.path), m->feed, &r);
    }
    return accept(m, &c, f);
}

static int arc(struct mcc *m, enum path_plane plane, const double via[2], const double end[2])
{
    double v[2], e[2], centre[2];
    in_plane(m, plane, via[0], via[1], v);
    in_plane(m, plane, end[0], end[1], e);
    return turn(m, plane, v, e, centre, false);
}

int MCC_arc_xy(struct mcc *m, double via_x, double via_y, double x, double y)
{
    return arc(m, PATH_XY, (double[]){ via_x, via_y }, (double[]){ x, y });
}

int MCC_arc_yz(struct mcc *m, double via_y, double via_z, double y, double z)
{
    return arc(m, PATH_YZ, (double[]){ via_y, via_z }, (double[]){ y, z });
}

int MCC_arc_zx(struct mcc *m, double via_z, double via_x, double z, double x)
{
    return arc(m, PATH_ZX, (double[]){ via_z, via_x }, (double[]){ z, x });
}

static int circle(struct mcc *m, enum path_plane plane, double a, double b, int direction)
{
    const double end[2] = { m->end[path_first(plane)], m->end[path_second(plane)] };
    double centre[2];
    if (direction != 0 && direction != 1) {
        return MCC_PARAMETER;
    }
    in_plane(m, plane, a, b, centre);
    return turn(m, plane, NULL, end, centre, direction == 1);
}

int MCC_circle_xy(struct mcc *m, double centre_x, double centre_y, int direction)
{
    return circle(m, PATH_XY, centre_x, centre_y, direction);
}

int MCC_circle_yz(struct mcc *m, double centre_y, double centre_z, int direction)
{
    return circle(m, PATH_YZ, centre_y, centre_z, direction);
}

int MCC_circle_zx(struct mcc *m, double centre_z, double centre_x, int direction)
{
    return circle(m, PATH_ZX, centre_z, centre_x, direction);
}

int MCC_motion_delay(struct mcc *m, double ms)
{
    struct command c = { .blend = false };
    const int code = acceptable(m);
    if (code) {
        return code;
    }
    if (!isfinite(ms) || ms < 0.0) {
        return MCC_PARAMETER;
    }
    command_delay(&c, m->end, ms / 1000.0);
    return accept(m, &c, FAULT_NONE);
}
