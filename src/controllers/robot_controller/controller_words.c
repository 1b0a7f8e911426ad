#include "controller_words.h"

#include <math.h>

#include "elementary.h"
#include "robot_job_decimal.h"

static const double DEGREE = 0.017453292519943295, MM = 1e-3;

/* CCN 16: a case for each status. */
static const char *name_of(enum robot_status status)
{
    switch (status) {
    case ROBOT_OK:           return "done";
    case ROBOT_BUSY:         return "not now";
    case ROBOT_PARAMETER:    return "a number is out of range";
    case ROBOT_FAR:          return "out of reach";
    case ROBOT_OUTSIDE:      return "a joint leaves its limits";
    case ROBOT_SINGULAR:     return "too near a singular place";
    case ROBOT_OTHER_BRANCH: return "the path does not lead to the configuration of the target";
    case ROBOT_OTHER_TURN:   return "the path does not lead to the turn of the target";
    case ROBOT_NO_CIRCLE:    return "three points on one line";
    case ROBOT_OFF_PLANE:    return "the start is not in the plane of the arc's centre";
    case ROBOT_NO_UNIT:      return "the normal of the arc is no unit vector";
    case ROBOT_NO_SPLINE:    return "two points of a spline in a row are the same";
    case ROBOT_TILTED:       return "the arm has no joint that turns the tool so";
    case ROBOT_NO_JOINT:     return "no such joint";
    case ROBOT_BESIDE:       return "a track moves with joints and lines alone";
    }
    return "";
}

/* Append words and a number with six digits. */
static void add(struct robot_job_text *t, const char *words, double value)
{
    const double decades = value != 0.0 ? floor(el_log(fabs(value)) / el_log(10.0)) : 5.0;
    const double scale = el_pow(10.0, 5.0 - decades);

    robot_job_text_add(t, words);
    robot_job_text_number(t, round(value * scale) / scale);
}

/* Append which joint it is, or that it is the external axis. */
static void add_axis(struct robot_job_text *t, const struct robot_refusal *r)
{
    if (r->which < OPW_JOINTS) {
        add(t, ": joint ", r->which + 1);
    } else {
        robot_job_text_add(t, ": external axis");
    }
}

static void add_place(struct robot_job_text *t, const struct robot_refusal *r)
{
    add(t, " at ", 100.0 * r->part);
    add(t, " % of its path, X ", r->place[0]);
    add(t, " Y ", r->place[1]);
    add(t, " Z ", r->place[2]);
    robot_job_text_add(t, " mm");
}

/* CCN 18: a case for each refusal that has numbers, in the unit of its joint. */
void controller_refusal_words(enum robot_status status, const struct robot_refusal *r,
                              char text[CONTROLLER_WORDS])
{
    struct robot_job_text t = { text, CONTROLLER_WORDS, 0 };
    const int flag = r->which;

    robot_job_text_add(&t, name_of(status));
    switch (status) {
    case ROBOT_FAR: add_place(&t, r); break;
    case ROBOT_OUTSIDE:
        add_axis(&t, r);
        add(&t, " to ", r->value / (r->slides ? MM : DEGREE));
        add(&t, r->slides ? " mm, limit " : " deg, limit ", r->limit / (r->slides ? MM : DEGREE));
        add(&t, r->slides ? " mm, at " : " deg, at ", 100.0 * r->part);
        robot_job_text_add(&t, " % of its path");
        break;
    case ROBOT_SINGULAR:
        robot_job_text_add(&t, r->which == 0   ? ": shoulder"
                               : r->which == 1 ? ": elbow"
                                               : ": wrist");
        add(&t, " factor ", r->value);
        add_place(&t, r);
        break;
    case ROBOT_OTHER_BRANCH:
        robot_job_text_add(&t, flag == OPW_FLIP    ? ": wrist"
                               : flag == OPW_ELBOW ? ": elbow"
                                                   : ": shoulder");
        break;
    case ROBOT_OTHER_TURN:
        add(&t, ": joint ", r->which + 1);
        add(&t, " ends at ", r->value / DEGREE);
        add(&t, " deg, not within 180 deg of ", r->limit / DEGREE);
        robot_job_text_add(&t, " deg");
        break;
    case ROBOT_OFF_PLANE:
        add(&t, ": ", r->value);
        add(&t, " mm off it, limit ", r->limit);
        robot_job_text_add(&t, " mm");
        break;
    case ROBOT_TILTED:
        add(&t, ": ", r->value / DEGREE);
        robot_job_text_add(&t, " deg from the tilt that its tool keeps");
        break;
    case ROBOT_NO_JOINT:
        add_axis(&t, r);
        add(&t, ", the arm has ", r->limit);
        break;
    case ROBOT_NO_UNIT: add(&t, ": its length is ", r->value); break;
    default:            break;
    }
}

void controller_words(const struct controller_trouble *t, char text[CONTROLLER_WORDS])
{
    struct robot_job_text words = { text, CONTROLLER_WORDS, 0 };

    if (t->error == CONTROLLER_MOVE) {
        controller_refusal_words(t->status, &t->refusal, text);
    } else {
        robot_job_text_add(&words, t->error == CONTROLLER_PROGRAM ? robot_job_fault_text(t->fault)
                                   : t->error == CONTROLLER_LOST  ? "out of reach on the path"
                                                                  : "");
    }
}
