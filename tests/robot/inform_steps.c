/* One program in the robot language, request by request, for test_inform.py. */
#include <string.h>

#include "inform_run.h"

static struct inform_points points;
static struct inform_program program;
static struct inform_run run;

/* Read both texts: 0, 1 points refused, 2 program refused, with the message. */
int inform_steps_load(const char *points_text, const char *text, char *message)
{
    struct inform_report r;
    if (inform_points_read(&points, points_text, (int64_t)strlen(points_text), &r)) {
        inform_message(&r, points_text, message);
        return 1;
    }
    if (inform_read(&program, &points, text, (int64_t)strlen(text), &r)) {
        inform_message(&r, text, message);
        return 2;
    }
    const struct inform_start start = { .vj = 10.0, .v = 100.0, .vr = 20.0 };
    inform_begin(&run, &program, &start);
    return 0;
}

/* The next request as numbers; the run goes through a copy of its bytes. */
void inform_steps_next(int64_t now, int64_t reached, uint32_t di, const double *ai, int32_t most,
                       double *request)
{
    struct inform_inputs in = { .now = now, .reached = reached, .di = di };
    struct inform_request r;
    struct inform_run copy;
    memcpy(in.ai, ai, sizeof in.ai);
    memcpy(&copy, &run, sizeof copy);
    memset(&run, 0xa5, sizeof run);
    inform_next(&copy, &program, &points, &in, most, &r);
    memcpy(&run, &copy, sizeof copy);
    const double as[] = { r.answer, r.line,  (double)r.after, r.path,   r.point, r.via,
                          r.tag,    r.speed, r.level,         r.corner, r.tool,  r.user,
                          r.index,  r.on,    r.volt,          r.fault };
    memcpy(request, as, sizeof as);
}

/* All variables: B, I, D, R. */
void inform_steps_variables(double *value)
{
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < INFORM_VARIABLES; i++) {
            *value++ = run.whole[k][i];
        }
    }
    memcpy(value, run.real, sizeof run.real);
}

const char *inform_steps_fault(int32_t fault)
{
    return inform_fault_text((enum inform_fault)fault);
}
