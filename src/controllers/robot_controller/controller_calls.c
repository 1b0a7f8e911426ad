#include "controller_calls.h"

#include "controller_parts.h"

static bool taken(const struct controller *s)
{
    return controller_running(s) || s->stopped || s->replaying >= 0;
}

/* A call that starts a motion clears what ended an earlier program. */
static enum robot_status begin(struct controller *s, enum robot_status status)
{
    if (status == ROBOT_OK) {
        s->trouble = (struct controller_trouble){ 0 };
    }
    return status;
}

enum robot_status controller_move(struct controller *s, const struct controller_config *c,
                                  const struct robot_move *move, const struct pose *tool,
                                  struct robot_refusal *why)
{
    struct robot_move m = *move;

    if (taken(s) || s->jogs || !controller_program_ready(s, c, tool)) {
        return ROBOT_BUSY;
    }
    return begin(s, controller_program_give(s, c, &m, 0, why));
}

enum robot_status controller_jog(struct controller *s, const struct controller_config *c,
                                 struct controller_panel *panel, struct robot_refusal *why)
{
    return taken(s) ? ROBOT_BUSY : begin(s, controller_panel_jog(s, c, panel, why));
}

enum robot_status controller_output(struct controller *s, struct order *order)
{
    order->after = s->given - s->first;
    return !taken(s) && controller_program_put(s, order) ? ROBOT_OK : ROBOT_BUSY;
}

int controller_taught(const struct controller *s, const struct controller_config *c, int32_t n,
                      char line[ROBOT_JOB_POINT_TEXT])
{
    struct robot_job_point p = { .kind = ROBOT_JOB_JOINTS,
                                 .shoulder = ROBOT_JOB_ANY,
                                 .elbow = ROBOT_JOB_ANY,
                                 .wrist = ROBOT_JOB_ANY,
                                 .turn = { ROBOT_JOB_ANY_TURN, ROBOT_JOB_ANY_TURN,
                                           ROBOT_JOB_ANY_TURN },
                                 .tool = ROBOT_JOB_ANY,
                                 .user = ROBOT_JOB_ANY };

    for (int i = 0; i < OPW_JOINTS; i++) {
        p.value[i] = s->taught[n].joint[i] / manipulator_unit(&c->robot.arm, i);
    }
    if (s->taught[n].beside != EXTERNAL_NONE) {
        p.beside = true;
        p.external = s->taught[n].external / external_unit(&c->robot.external);
    }
    return robot_job_point_write(n, &p, line);
}
