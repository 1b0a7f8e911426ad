/* orders_gcode - a part program as orders, and its inquiry, which reads it without motion. */
#include "orders_parts.h"

#include "waiting.h"

static const double DEGREE = 0.017453292519943295;
static const double FREE_SPEED = 1e9; /* [mm/s] the arm decides how fast, not the reader */

/* What a part program is read against: six coordinates without joints, inputs, no probe. */
static struct program program_of(const struct orders_config *c, const struct orders_text *t)
{
    struct program p = { .source = t->gcode,
                         .angles = true,
                         .plain = true,
                         .bare = true,
                         .block_delete = c->block_delete,
                         .optional_stop = c->optional_stop,
                         .change_stops = c->tool_stop,
                         .has_inputs = true,
                         .limits = { .feed = c->feed_most,
                                     .rapid = 1.0,
                                     .up = { .acc = 1.0 },
                                     .down = { .acc = 1.0 } } };
    for (int i = 0; i < AXES; i++) {
        p.machine.axis[i] = true;
        p.machine.joint[i] = (struct joint){ .used = true, .scale = 1.0, .speed = FREE_SPEED };
    }
    return p;
}

void orders_gcode_start(struct interpreter *in, const struct orders_config *c,
                        const struct pose *at)
{
    double point[AXES], angle[3];

    quaternion_angles(at->turn, angle);
    for (int i = 0; i < 3; i++) {
        point[i] = at->at[i];
        point[3 + i] = angle[i];
    }
    interpreter_start(in, point, c->feed, c->origin);
}

void orders_check(const struct orders_config *c, const struct orders_text *t, const struct pose *at,
                  struct fault_list *all)
{
    const struct program p = program_of(c, t);
    struct interpreter in;

    orders_gcode_start(&in, c, at);
    interpreter_check_all(&in, &p, all);
}

/* Motion of a part program as one of the arm: G0 by its joints, the others on their path. F counts
 * degrees where the tool only turns, so its scale [mm] is taken back. */
static void arm_move(struct robot_move *m, const struct orders_config *c, const struct command *k,
                     double scale)
{
    const struct path *p = &k->path;

    *m = (struct robot_move){ .line = k->line,
                              .share = c->rapid,
                              .singular = c->singular,
                              .target = { .branch = ROBOT_ANY_BRANCH } };
    m->target.pose = pose_of(p->end, p->end + 3);
    m->kind = k->type == COMMAND_PTP ? ROBOT_JOINTS : p->arc ? ROBOT_ARC : ROBOT_LINE;
    if (p->arc) {
        const int a = path_first(p->plane), b = path_second(p->plane);
        m->centre[a] = p->centre[0];
        m->centre[b] = p->centre[1];
        m->centre[p->plane] = p->start[p->plane];
        m->normal[p->plane] = 1.0;
        m->rise = p->end[p->plane] - p->start[p->plane];
        m->sweep = p->sweep;
    }
    const bool turns =
        p->start[0] == p->end[0] && p->start[1] == p->end[1] && p->start[2] == p->end[2] && !p->arc;
    m->feed = turns ? 0.0 : k->feed;
    m->spin = turns ? k->feed / scale * DEGREE : 0.0;
    m->zone = !k->blend ? 0.0 : k->tolerance > 0.0 ? k->tolerance : c->zone[ROBOT_JOB_LEVELS];
}

static bool command_switches(const struct command *k)
{
    return k->set || k->clear;
}

static void switch_outputs(struct orders *o, struct order *order, const struct command *k)
{
    order->kind = ORDER_OUT;
    order->after = o->moves;
    order->mask = k->set | k->clear;
    order->value = k->set;
}

/* Answer the wait of M66, once motion has ended. False: it is not answered yet. */
static bool answered(struct orders *o, const struct robot_job_inputs *in)
{
    const struct waiting *w = &o->gcode.wait;

    if (o->passes) {
        waiting_pass(&o->gcode);
        return true;
    }
    if (in->reached < o->moves) {
        return false;
    }
    const double is = w->kind == WAIT_ANALOG ? in->ai[w->index] : in->di >> w->index & 1;
    const double was = o->waits ? o->was : is;
    o->since = o->waits ? o->since : in->now;
    o->was = is;
    o->waits = !waiting_done(w, is, was);
    if (o->waits && (double)(in->now - o->since) >= w->limit * 1e9) {
        o->waits = false;
        waiting_answer(&o->gcode, -1.0);
    } else if (!o->waits) {
        waiting_answer(&o->gcode, is);
    }
    return !o->waits;
}

/* Read the next command into o->kept. False: there is none, and *order says why. */
static bool next_command(struct orders *o, const struct program *p,
                         const struct robot_job_inputs *in, struct order *order)
{
    struct fault_report fault;

    for (;;) {
        switch (interpreter_next(&o->gcode, p, &o->kept, &fault)) {
        case INTERPRETER_COMMAND: return true;
        case INTERPRETER_END:     order->kind = ORDER_END; return false;
        case INTERPRETER_FAULT:   order->kind = ORDER_FAULT; return false;
        default:
            if (!answered(o, in)) {
                return false;
            }
        }
    }
}

/* Order what a command switches before it begins, one output a call. False: nothing is left. */
static bool switch_before(struct orders *o, struct order *order)
{
    struct command *k = &o->kept;

    if (k->type != COMMAND_OUTPUTS && command_switches(k)) { /* M62 */
        switch_outputs(o, order, k);
        k->set = k->clear = 0;
        return true;
    }
    for (int i = 0; i < OUTPUTS_ANALOG; i++) {
        if (k->analog.set >> i & 1) {
            k->analog.set &= ~((uint32_t)1 << i);
            order->kind = ORDER_ANALOG;
            order->index = i;
            order->amount = k->analog.value[i];
            order->after = o->moves;
            return true;
        }
    }
    return false;
}

void orders_gcode_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                       const struct robot_job_inputs *in, struct order *order)
{
    const struct program p = program_of(c, t);

    o->keeps = o->keeps || next_command(o, &p, in, order);
    if (!o->keeps) {
        return;
    }
    order->line = o->kept.line;
    if (switch_before(o, order)) {
        return;
    }
    const struct command k = o->kept;
    o->keeps = false;
    switch (k.type) {
    case COMMAND_DELAY:
        order->kind = ORDER_DELAY;
        order->amount = k.dwell;
        break;
    case COMMAND_OUTPUTS: switch_outputs(o, order, &k); break;
    case COMMAND_STOP:    order->kind = ORDER_PAUSE; break;
    default:
        order->kind = ORDER_MOVE;
        order->plain = true;
        arm_move(&order->move, c, &k, o->gcode.inch ? 25.4 : 1.0);
        order->after = ++o->moves;
    }
}
