/* Positions of an axis outside the arm: read with those of the arm, of this job and of all jobs,
 * named by moves; refused where there is no such axis, or another one. */
#include "robot_job_given.h"

static const char HEAD[] = "/JOB\n//NAME A\n//POS\n///NPOS 2,2,1,1,1,1\n///TOOL 0\n"
                           "///POSTYPE PULSE\n///PULSE\n"
                           "C00000=0,0,0,0,0,0\nBC00000=-1500\nEC00000=450,0\n"
                           "C00001=1,2,3,4,5,6\nBC00001=2500.5\n"
                           "///POSTYPE BASE\n///RECTAN\n///RCONF 0,0,0,0,0,0\n"
                           "P00100=900.000,0.000,350.000,180.0000,0.0000,0.0000\n"
                           "BP00100=-750.250\n"
                           "///POSTYPE ANGLE\n///ANGLE\nEX00100=20.7801,5.3331\n"
                           "//INST\nNOP\n";

/* Read a job behind HEAD for an arm with this axis. */
static void read(enum robot_job_outside outside, const char *instructions)
{
    static char text[2000];

    snprintf(text, sizeof text, "%s%s", HEAD, instructions);
    message[0] = '\0';
    robot_job_points_clear(&points, outside);
    if (robot_job_read(&program, &points, text, (int64_t)strlen(text), &report)) {
        robot_job_message(&report, text, message);
    }
}

/* The place that the n-th move asks of the axis; NAN: none. */
static double place(int n, enum robot_job_point_kind *kind)
{
    struct robot_job_run run;
    struct robot_job_request r = { .answer = ROBOT_JOB_MOVE };
    const struct robot_job_inputs in = { .reached = 1000 };

    robot_job_begin(&run, &program, &START);
    for (int i = 0; i <= n; i++) {
        robot_job_next(&run, &program, &points, &in, 1000, &r);
        CHECK_EQ(r.answer, ROBOT_JOB_MOVE);
    }
    if (r.beside < 0) {
        return NAN;
    }
    const struct robot_job_point *p = robot_job_place(&run, &program, &points, r.beside);
    CHECK(p->beside);
    *kind = p->kind;
    return p->external;
}

static void named(void)
{
    enum robot_job_point_kind kind;

    read(ROBOT_JOB_BASE_AXIS, "MOVJ C00000 BC00000 VJ=5\nMOVL P100 BP100 V=10.0\n"
                              "MOVL C00001 V=5\nMOVC C00000 BC00001 V=9\nMOVC C00000 BC00001 V=9\n"
                              "MOVC C00001 BC00001 V=9\nEND\n");
    CHECK_TEXT(message, "");
    CHECK(place(0, &kind) == -1500.0 && kind == ROBOT_JOB_PULSES);
    CHECK(place(1, &kind) == -750.25 && kind == ROBOT_JOB_POSE);
    CHECK(isnan(place(2, &kind)));
    CHECK(place(4, &kind) == 2500.5);
    read(ROBOT_JOB_STATION_AXIS, "MOVJ C00000 VJ=5 EC00000 PL=0\nEND\n");
    CHECK_TEXT(message, "");
    CHECK(place(0, &kind) == 450.0 && kind == ROBOT_JOB_PULSES);
}

static const struct {
    enum robot_job_outside outside;
    const char *text, *message;
} BAD[] = {
    { ROBOT_JOB_NO_AXIS, "MOVJ C00000 BC00000 VJ=5",
      "line 23: base or station axes, which the arm has not \"BC00000\"" },
    { ROBOT_JOB_BASE_AXIS, "MOVJ C00000 EC00000 VJ=5",
      "line 23: base or station axes, which the arm has not \"EC00000\"" },
    { ROBOT_JOB_BASE_AXIS, "MOVJ C00000 BC00000 EC00000 VJ=5",
      "line 23: base or station axes, which the arm has not \"EC00000\"" },
    { ROBOT_JOB_STATION_AXIS, "MOVJ P100 EX100 VJ=5",
      "line 23: base or station axes, which the arm has not \"EX100\"" }, /* it has two */
    { ROBOT_JOB_BASE_AXIS, "MOVL BC00000 V=5",
      "line 23: base or station axes, which the arm has not \"BC00000\"" },
    { ROBOT_JOB_BASE_AXIS, "IMOV P100 BP100 V=5",
      "line 23: base or station axes, which the arm has not \"BP100\"" },
    { ROBOT_JOB_BASE_AXIS, "MOVJ C00000 BC00002 VJ=5",
      "line 23: position not in this job \"BC00002\"" },
    { ROBOT_JOB_BASE_AXIS, "MOVJ C00000 BC00000 BC00001 VJ=5", "line 23: given twice \"BC00001\"" },
    { ROBOT_JOB_BASE_AXIS,
      "MOVC C00000 BC00000 V=9\nMOVC P100 BC00000 V=9\nMOVC C00001 BC00001 V=9",
      "line 25: via and end with different base or station axes \"MOVC C00001 BC00001 V=9\"" },
    { ROBOT_JOB_BASE_AXIS, "SMOVL C00000 BC00000 V=5",
      "line 23: INFORM that this controller lacks \"SMOVL\"" },
    { ROBOT_JOB_BASE_AXIS, "MOVJ C00000 VJ=5\n//POS\n///PULSE\nBC7=1,x",
      "line 26: unexpected \"x\"" },
};

/* E of a points file. */
static void points_file(void)
{
    static const char TEXT[] = "P001 J1=0 J2=0 J3=0 J4=0 J5=90 J6=0 E=-250.5 TOOL=0\n";
    static const char TWICE[] = "P001 X=0 Y=0 Z=0 A=0 B=0 C=0 E=1 E=2\n";
    char line[ROBOT_JOB_POINT_TEXT];

    CHECK_EQ(robot_job_points_read(&points, ROBOT_JOB_BASE_AXIS, TEXT, (int64_t)strlen(TEXT),
                                   &report),
             0);
    CHECK(points.point[1].beside && points.point[1].external == -250.5);
    CHECK_EQ(robot_job_point_write(1, &points.point[1], line), 0);
    CHECK(strstr(line, " E=-250.5 "));
    CHECK_EQ(robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, TEXT, (int64_t)strlen(TEXT),
                                   &report),
             -1);
    robot_job_message(&report, TEXT, message);
    CHECK_TEXT(message, "line 1: base or station axes, which the arm has not \"E\"");
    CHECK_EQ(robot_job_points_read(&points, ROBOT_JOB_BASE_AXIS, TWICE, (int64_t)strlen(TWICE),
                                   &report),
             -1);
    CHECK_EQ(report.fault, ROBOT_JOB_BAD_TWICE);
}

int main(void)
{
    named();
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        read(BAD[i].outside, BAD[i].text);
        CHECK_TEXT(message, BAD[i].message);
    }
    points_file();
    return check_result();
}
