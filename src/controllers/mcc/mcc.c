#include "mcc.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Make all 0 but what is written before it is read: entries behind the counts of ring and queue,
 * the mean, and shape and speed profile of a chain, which curve_start makes. They are nine tenths
 * of the memory. */
static void clear(struct mcc *m)
{
    memset(m, 0, offsetof(struct mcc, ring));
    ring_clear(&m->ring);
    memset(&m->trajectory, 0, sizeof m->trajectory);
    memset(&m->curve_plan, 0, offsetof(struct curve_plan, shape));
    queue_clear(&m->queue);
    memset(&m->written, 0, sizeof *m - offsetof(struct mcc, written));
}

int MCC_init_motion(struct mcc *m, const struct machine *machine)
{
    if (!machine_valid(machine) || machine->queue_depth > QUEUE_SIZE) {
        return MCC_PARAMETER;
    }
    clear(m);
    m->machine = *machine;
    m->curve_plan.limits = machine_speed_limits(machine);
    for (int i = 0; i < AXES; i++) {
        if (m->machine.axis[i].max_dda == 0) {
            m->machine.axis[i].max_dda = machine_dda_limit(machine);
        }
        if (m->machine.axis[i].max_dda_acc == 0) {
            m->machine.axis[i].max_dda_acc = 2 * machine_dda_limit(machine);
        }
        m->epcio_axis_param[i] = mcc_param_of(&machine->axis[i]);
    }
    m->machine.acc_type = machine->acc_type ? machine->acc_type : 'T';
    m->machine.dec_type = machine->dec_type ? machine->dec_type : 'T';
    machine_complete_asyn(&m->machine);
    m->cart_max_speed = machine->max_feed;
    m->feed = machine->feed;
    interpreter_start(&m->program, m->end, m->feed, (const double(*)[AXES])m->offset);
    readout_start(m);
    trajectory_start(&m->trajectory);
    m->trajectory.confirm = guard_watched(&m->machine) != 0;
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

int MCC_get_errcode(const struct mcc *m)
{
    return m->error;
}

/* MCC_NO_ERR if a motion call can be taken now, else the code that refuses it. */
static int acceptable(const struct mcc *m)
{
    return !m->open                                           ? MCC_INITIAL_MOTION
           : m->error                                         ? MCC_RUN_TIME
           : m->trajectory.abort                              ? MCC_ABORT_NOT_FINISH
           : m->running || trajectory_ordered(&m->trajectory) ? MCC_COMMAND_NOTACCEPTED
           : ring_full(&m->ring)                              ? MCC_COMMAND_BUFFER_FULL
                                                              : MCC_NO_ERR;
}

/* A target as the user gives it, in machine coordinates; false if it is no number. */
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

static int accept(struct mcc *m, struct command *c, enum command_status s)
{
    if (s != COMMAND_OK) {
        return s == COMMAND_FAST ? MCC_FEED_RATE : MCC_PARAMETER;
    }
    c->index = ++m->commands;
    m->moved = true;
    memcpy(m->end, c->path.end, sizeof m->end);
    if (c->type == COMMAND_PTP_ASYN) {
        struct axes_limits l[AXES];
        for (int i = 0; i < AXES; i++) {
            l[i] = machine_axis_limits(&m->machine, i, machine_ptp_speed(&m->machine, i));
        }
        ring_push_asyn(&m->ring, c, l);
    } else if (c->path.length > 0.0 || c->type == COMMAND_DELAY) {
        ring_push(&m->ring, c);
    }
    m->curve_plan.last = false;
    return c->index;
}

/* Plan a command whose path is set, and put it into the ring. Returns its index, or a code. */
static int plan(struct mcc *m, struct command *c, enum command_type type)
{
    const struct mechanism machine = machine_mechanism(&m->machine);
    const struct motion_limits l = machine_limits(&m->machine);
    struct command_refusal r;

    return accept(m, c,
                  type == COMMAND_PTP        ? command_ptp(c, &machine, &l, &r)
                  : type == COMMAND_PTP_ASYN ? command_ptp_asyn(c, &machine, &r)
                                             : command_move(c, &machine, &l, type, m->feed, &r));
}

/* A command with the settings of path mixing and look-ahead. */
static struct command smoothed(const struct mcc *m)
{
    return (struct command){
        .blend = m->blend, .tolerance = m->tolerance, .curve = m->curve, .merge = m->merge
    };
}

static int straight(struct mcc *m, const double target[AXES], enum command_type type)
{
    struct command c = smoothed(m);
    double end[AXES];
    const int code = acceptable(m);

    if (code) {
        return code;
    }
    if (!absolute(m, target, end)) {
        return MCC_PARAMETER;
    }
    path_line(&c.path, m->end, end);
    return c.path.length == 0.0 ? accept(m, &c, COMMAND_OK) : plan(m, &c, type);
}

int MCC_line(struct mcc *m, const double target[AXES])
{
    return straight(m, target, COMMAND_LINE);
}

int MCC_ptp(struct mcc *m, const double target[AXES])
{
    return straight(m, target, COMMAND_PTP);
}

int MCC_ptp_asyn(struct mcc *m, const double target[AXES])
{
    return straight(m, target, COMMAND_PTP_ASYN);
}

/* A motion of some axes only, `count` of them from `first` on. */
static int some(struct mcc *m, int first, int count, const double value[], enum command_type type)
{
    double target[AXES] = { 0.0 };
    if (!m->incremental) {
        memcpy(target, m->end, sizeof target);
    }
    memcpy(target + first, value, (size_t)count * sizeof *value);
    return straight(m, target, type);
}

int MCC_line_x(struct mcc *m, double x)
{
    return some(m, 0, 1, &x, COMMAND_LINE);
}

int MCC_line_y(struct mcc *m, double y)
{
    return some(m, 1, 1, &y, COMMAND_LINE);
}

int MCC_line_z(struct mcc *m, double z)
{
    return some(m, 2, 1, &z, COMMAND_LINE);
}

int MCC_ptp_x(struct mcc *m, double x)
{
    return some(m, 0, 1, &x, COMMAND_PTP);
}

int MCC_ptp_y(struct mcc *m, double y)
{
    return some(m, 1, 1, &y, COMMAND_PTP);
}

int MCC_ptp_z(struct mcc *m, double z)
{
    return some(m, 2, 1, &z, COMMAND_PTP);
}

int MCC_ptp_uvw(struct mcc *m, double u, double v, double w)
{
    return some(m, 3, 3, (double[]){ u, v, w }, COMMAND_PTP);
}

/* A point of a plane in machine coordinates. */
static void in_plane(const struct mcc *m, enum path_plane plane, double a, double b,
                     double point[2])
{
    point[0] = a + (m->incremental ? m->end[path_first(plane)] : 0.0);
    point[1] = b + (m->incremental ? m->end[path_second(plane)] : 0.0);
}

/* An arc as it is asked for, in machine coordinates of its plane. */
struct turn {
    enum path_plane plane;
    bool circle; /* full circle about centre, else an arc through via */
    bool ccw;
    double via[2], end[2], centre[2];
    const double *follow; /* U V W of the user that follow, or NULL */
};

/* End of an arc in all axes; false if an axis is not used or a number is none. */
static bool turn_end(const struct mcc *m, const struct turn *t, double end[AXES])
{
    const int a = path_first(t->plane), b = path_second(t->plane);

    memcpy(end, m->end, AXES * sizeof *end);
    end[a] = t->end[0];
    end[b] = t->end[1];
    for (int i = 3; i < AXES && t->follow; i++) {
        end[i] = t->follow[i - 3] + (m->incremental ? m->end[i] : 0.0);
    }
    for (int i = 0; i < AXES; i++) {
        const bool moves = i == a || i == b || end[i] != m->end[i];
        if (!isfinite(end[i]) || (moves && !m->machine.axis[i].used)) {
            return false;
        }
    }
    return true;
}

static int turn(struct mcc *m, struct turn *t)
{
    struct command c = smoothed(m);
    double end[AXES], miss;
    const int code = acceptable(m);

    if (code) {
        return code;
    }
    if (!turn_end(m, t, end)) {
        return MCC_PARAMETER;
    }
    if ((!t->circle
         && path_centre_by_point(t->plane, m->end, t->via, end, t->centre, &t->ccw) != PATH_OK)
        || !isfinite(t->centre[0]) || !isfinite(t->centre[1])
        || path_arc(&c.path, t->plane, m->end, end, t->centre, t->ccw, 1, &miss) != PATH_OK) {
        return MCC_PARAMETER;
    }
    return plan(m, &c, command_arc_type(&c.path));
}

static int arc(struct mcc *m, enum path_plane plane, const double p[4], const double *follow)
{
    struct turn t = { .plane = plane, .follow = follow };
    in_plane(m, plane, p[0], p[1], t.via);
    in_plane(m, plane, p[2], p[3], t.end);
    return turn(m, &t);
}

int MCC_arc_xy(struct mcc *m, double via_x, double via_y, double x, double y)
{
    return arc(m, PATH_XY, (double[]){ via_x, via_y, x, y }, NULL);
}

int MCC_arc_yz(struct mcc *m, double via_y, double via_z, double y, double z)
{
    return arc(m, PATH_YZ, (double[]){ via_y, via_z, y, z }, NULL);
}

int MCC_arc_zx(struct mcc *m, double via_z, double via_x, double z, double x)
{
    return arc(m, PATH_ZX, (double[]){ via_z, via_x, z, x }, NULL);
}

int MCC_arc_xyuvw(struct mcc *m, const double plane[4], const double uvw[3])
{
    return arc(m, PATH_XY, plane, uvw);
}

int MCC_arc_yzuvw(struct mcc *m, const double plane[4], const double uvw[3])
{
    return arc(m, PATH_YZ, plane, uvw);
}

int MCC_arc_zxuvw(struct mcc *m, const double plane[4], const double uvw[3])
{
    return arc(m, PATH_ZX, plane, uvw);
}

static int circle(struct mcc *m, enum path_plane plane, const double centre[2], int direction,
                  const double *follow)
{
    struct turn t = { .plane = plane, .circle = true, .ccw = direction == 1, .follow = follow };
    if (direction != 0 && direction != 1) {
        return MCC_PARAMETER;
    }
    t.end[0] = m->end[path_first(plane)];
    t.end[1] = m->end[path_second(plane)];
    in_plane(m, plane, centre[0], centre[1], t.centre);
    return turn(m, &t);
}

int MCC_circle_xy(struct mcc *m, double centre_x, double centre_y, int direction)
{
    return circle(m, PATH_XY, (double[]){ centre_x, centre_y }, direction, NULL);
}

int MCC_circle_yz(struct mcc *m, double centre_y, double centre_z, int direction)
{
    return circle(m, PATH_YZ, (double[]){ centre_y, centre_z }, direction, NULL);
}

int MCC_circle_zx(struct mcc *m, double centre_z, double centre_x, int direction)
{
    return circle(m, PATH_ZX, (double[]){ centre_z, centre_x }, direction, NULL);
}

int MCC_circle_xyuvw(struct mcc *m, const double centre[2], int direction, const double uvw[3])
{
    return circle(m, PATH_XY, centre, direction, uvw);
}

int MCC_circle_yzuvw(struct mcc *m, const double centre[2], int direction, const double uvw[3])
{
    return circle(m, PATH_YZ, centre, direction, uvw);
}

int MCC_circle_zxuvw(struct mcc *m, const double centre[2], int direction, const double uvw[3])
{
    return circle(m, PATH_ZX, centre, direction, uvw);
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
    return accept(m, &c, COMMAND_OK);
}
