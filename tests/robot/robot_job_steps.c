/* One program in the robot language, request by request, for test_robot_job.py. */
#include <string.h>

#include "robot_job_run.h"

static struct robot_job_points points;
static struct robot_job_program program;
static struct robot_job_run run;

/* Read both texts: 0, 1 points refused, 2 program refused, with the message. */
int robot_job_steps_load(const char *points_text, const char *text, char *message)
{
    struct robot_job_report r;
    if (robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, points_text, (int64_t)strlen(points_text),
                              &r)) {
        robot_job_message(&r, points_text, message);
        return 1;
    }
    if (robot_job_read(&program, &points, text, (int64_t)strlen(text), &r)) {
        robot_job_message(&r, text, message);
        return 2;
    }
    const struct robot_job_start start = { .vj = 10.0, .v = 100.0, .vr = 20.0 };
    robot_job_begin(&run, &program, &start);
    return 0;
}

/* The next request as numbers; the run goes through a copy of its bytes. */
void robot_job_steps_next(int64_t now, int64_t reached, uint32_t di, const double *ai, int32_t most,
                          double *request)
{
    struct robot_job_inputs in = { .now = now, .reached = reached, .di = di };
    struct robot_job_request r;
    struct robot_job_run copy;
    memcpy(in.ai, ai, sizeof in.ai);
    memcpy(&copy, &run, sizeof copy);
    memset(&run, 0xa5, sizeof run);
    robot_job_next(&copy, &program, &points, &in, most, &r);
    memcpy(&run, &copy, sizeof copy);
    const double as[] = { r.answer, r.line,  (double)r.after, r.path,  r.point,
                          r.via,    r.tag,   r.speed,         r.level, r.corner,
                          r.tool,   r.user,  r.index,         r.on,    r.volt,
                          r.fault,  r.shift, r.shift_user,    r.count, (double)r.time };
    memcpy(request, as, sizeof as);
}

/* All variables: B, I, D, R. */
void robot_job_steps_variables(double *value)
{
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < ROBOT_JOB_VARIABLES; i++) {
            *value++ = run.whole[k][i];
        }
    }
    memcpy(value, run.real, sizeof run.real);
}

const char *robot_job_steps_fault(int32_t fault)
{
    return robot_job_fault_text((enum robot_job_fault)fault);
}
