/* robot_job_given - the points that the tests of the robot language use, and the reading of a
 * program with them. */
#ifndef ROBOT_JOB_GIVEN_H
#define ROBOT_JOB_GIVEN_H

#include <string.h>

#include "check.h"
#include "robot_job_run.h"

static const char POINTS[] = "TOOL 1 X=0 Y=0 Z=150 A=0 B=0 C=0\n"
                             "USER 2 X=900 Y=-300 Z=200 A=0 B=0 C=90\n"
                             "P000 J1=0 J2=-20 J3=10 J4=0 J5=90 J6=0\n"
                             "P001 X=900 Y=0 Z=350 A=180 B=0 C=0 FRONT UP NOFLIP TOOL=1\n"
                             "P002 X=1000 Y=100 Z=350 A=180 B=0 C=0\n"
                             "P003 X=1100 Y=0 Z=350 A=180 B=0 C=0\n"
                             "P004 X=0 Y=0 Z=0 A=180 B=0 C=0 USER=2\n";

static struct robot_job_points points;
static struct robot_job_program program;
static struct robot_job_report report;
static char message[ROBOT_JOB_MESSAGE_MAX];

/* Read a program. `message` is what is wrong with it, or empty. */
static inline int read_program(const char *text)
{
    message[0] = '\0';
    CHECK_EQ(robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, POINTS, (int64_t)strlen(POINTS),
                                   &report),
             0);
    const int status = robot_job_read(&program, &points, text, (int64_t)strlen(text), &report);
    CHECK_EQ(status, report.fault == ROBOT_JOB_OK ? 0 : -1);
    if (status) {
        robot_job_message(&report, text, message);
    }
    return status;
}

static const struct robot_job_start START = {
    .vj = 10.0, .v = 100.0, .vr = 20.0, .level = 0, .tool = 0, .user = 0
};

#define CHECK_TEXT(got, want) \
    do { \
        if (strcmp(got, want)) { \
            check_failures++; \
            printf("%s:%d: \"%s\", want \"%s\"\n", __FILE__, __LINE__, got, want); \
        } \
    } while (0)

#endif
