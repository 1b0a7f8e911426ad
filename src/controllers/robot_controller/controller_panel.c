#include "controller_parts.h"

static const double DEGREE = 0.017453292519943295;

static bool jog_wanted(const struct controller_panel *panel)
{
    bool any = false;

    for (int i = 0; i < 6; i++) {
        any = any || panel->jog[i] != 0.0;
    }
    return any;
}

enum robot_status controller_panel_jog(struct controller *s, const struct controller_config *c,
                                       const struct controller_panel *panel,
                                       struct robot_refusal *why)
{
    const double *d = panel->jog;
    const bool turns =
        panel->frame == ROBOT_IN_JOINTS || (d[0] == 0.0 && d[1] == 0.0 && d[2] == 0.0);
    double way = panel->jog_way * (turns ? DEGREE : 1.0);

    if (panel->frame == ROBOT_IN_EXTERNAL) {
        way = panel->jog_way * external_unit(&c->robot.external);
    }
    for (int i = 0; i < OPW_JOINTS && panel->frame == ROBOT_IN_JOINTS; i++) {
        way = d[i] != 0.0 ? panel->jog_way * manipulator_unit(&c->robot.arm, i) : way;
    }
    const enum robot_status status =
        robot_jog(&s->robot, &c->robot, panel->frame, d, panel->jog_speed, way, why);

    if (status == ROBOT_BUSY && s->jogs) { /* another direction: the one before ends first */
        robot_release(&s->robot);
    }
    s->jogs = s->jogs || status == ROBOT_OK;
    return status;
}

static void jog(struct controller *s, const struct controller_config *c,
                const struct controller_panel *panel)
{
    struct robot_refusal why;

    if (!jog_wanted(panel) || controller_running(s) || s->replaying >= 0 || s->stopped) {
        if (s->jogs) {
            robot_release(&s->robot);
        }
        s->jogs = false;
        return;
    }
    controller_panel_jog(s, c, panel, &why);
}

static void teach(struct controller *s, const struct controller_config *c)
{
    if (s->taught_count < CONTROLLER_TAUGHT) {
        robot_teach(&s->robot, &c->robot, &s->taught[s->taught_count++]);
    }
}

/* Replay: give the arm the taught points one after another, as moves of the joints. */
static void replay(struct controller *s, const struct controller_config *c,
                   const struct controller_panel *panel)
{
    if (s->replaying < 0 || s->stopped) {
        return;
    }
    if (s->replaying == s->taught_count) {
        s->replaying = robot_idle(&s->robot) ? -1 : s->replaying;
        return;
    }
    struct order order = { .kind = ORDER_MOVE, .tool = s->robot.tool };
    order.move.kind = ROBOT_JOINTS;
    order.move.target = s->taught[s->replaying];
    order.move.target.by_joints = true;
    order.move.share = panel->jog_speed;
    if (controller_program_move(s, c, &order)) {
        s->replaying = s->trouble.error == CONTROLLER_OK ? s->replaying + 1 : -1;
    }
}

/* Whether nothing moves the arm and nothing is about to. */
static bool free_to_start(const struct controller *s)
{
    return !controller_running(s) && !s->stopped && s->replaying < 0;
}

/* The start key begins the program, or lets the next of single steps go. */
static void start(struct controller *s, const struct controller_config *c,
                  const struct orders_text *t, const struct controller_panel *panel, int64_t clock)
{
    const bool program = t->gcode || t->job, due = s->program == PROGRAM_NEW && clock >= c->start;

    if (program && free_to_start(s) && robot_idle(&s->robot)
        && (controller_key_take(&s->start) || due)) {
        controller_program_start(s, c, t);
        s->leave = true;
    }
    if (controller_running(s) && panel->single && s->program != PROGRAM_PAUSED
        && controller_key_take(&s->start)) {
        s->leave = true;
    }
}

void controller_panel_run(struct controller *s, const struct controller_config *c,
                          const struct orders_text *t, const struct controller_panel *panel,
                          int64_t clock)
{
    robot_hold(&s->robot, panel->hold);
    robot_override(&s->robot, panel->override);
    if (controller_key_take(&s->abort)) {
        controller_program_drop(s);
        s->replaying = -1;
        robot_abort(&s->robot);
    }
    if (controller_key_take(&s->teach)) {
        teach(s, c);
    }
    if (controller_key_take(&s->replay) && free_to_start(s)) {
        s->trouble = (struct controller_trouble){ 0 };
        s->replaying = 0;
    }
    start(s, c, t, panel, clock);
    jog(s, c, panel);
    replay(s, c, panel);
}
