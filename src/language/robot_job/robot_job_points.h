/* robot_job_points - the points, tools and user frames of a program, from text and back to text.
 *
 *     TOOL 1 X=0 Y=0 Z=150 A=0 B=0 C=0
 *     USER 1 X=900 Y=-300 Z=200 A=0 B=0 C=90
 *     P000 J1=0 J2=-20 J3=10 J4=0 J5=90 J6=0 TOOL=1
 *     P002 J1=0 J2=-20 J3=10 J4=0 J5=90 J6=0 E=250
 *     P001 X=100 Y=50 Z=0 A=180 B=0 C=0 FRONT UP NOFLIP TURN4=0 TURN6=-1 TOOL=1 USER=1
 *
 * Orientation: R = Rz(C) Ry(B) Rx(A). A pose is that of the tool in the user frame. Joints are
 * those of the maker. E is a place of the axis outside the arm.
 */
#ifndef ROBOT_JOB_POINTS_H
#define ROBOT_JOB_POINTS_H

#include <stdbool.h>

#include "robot_job_fault.h"

enum {
    ROBOT_JOB_TEXT_MAX = 1 << 22, /* [byte] */
    ROBOT_JOB_LINE_MAX = 256,     /* [characters] of a line without CR LF */
    ROBOT_JOB_POINTS = 1000,      /* P000 .. P999 */
    ROBOT_JOB_FRAMES = 64         /* tools 0 (flange) .. 63, user frames 0 (base) .. 63 */
};

enum robot_job_point_kind {
    ROBOT_JOB_NO_POINT,
    ROBOT_JOB_JOINTS,
    ROBOT_JOB_POSE,
    ROBOT_JOB_PULSES
};

/* A configuration may leave these open. The arm then takes what is nearest to where it stands. */
enum { ROBOT_JOB_ANY = -1, ROBOT_JOB_ANY_TURN = -128, ROBOT_JOB_TURN_MAX = 100 };

/* A wrist told as Yaskawa's pendants do, by joint 4: within 90 deg of its zero, whole turns aside
 * (their "flip"), or beyond ("no flip"). */
enum { ROBOT_JOB_WRIST_NEAR = 2, ROBOT_JOB_WRIST_FAR = 3 };

/* An axis outside the arm: one that carries its base (BC, BP), one of a station with work (EC,
 * EX). */
enum robot_job_outside { ROBOT_JOB_NO_AXIS, ROBOT_JOB_BASE_AXIS, ROBOT_JOB_STATION_AXIS };

struct robot_job_point {
    double value[6]; /* joints [deg] or [pulses], or X Y Z [mm] A B C [deg] */
    enum robot_job_point_kind kind;
    int32_t shoulder;   /* 0 FRONT, 1 BACK, ROBOT_JOB_ANY */
    int32_t elbow;      /* 0 UP, 1 DOWN, ROBOT_JOB_ANY */
    int32_t wrist;      /* 0 NOFLIP, 1 FLIP, ROBOT_JOB_WRIST_NEAR, _FAR, ROBOT_JOB_ANY */
    int32_t turn[3];    /* of joints 1 4 6: n for 360 n - 180 < joint <= 360 n + 180 [deg],
                         * -100 .. 100, or ROBOT_JOB_ANY_TURN */
    int32_t tool, user; /* ROBOT_JOB_ANY: those in force when the program goes to the point */
    int32_t line;       /* of its file; 0: the point was taught */
    bool beside;        /* the axis outside the arm has a place, too, in external */
    double external;    /* [mm], of a station [deg]; [pulses] if the point is in pulses */
};

struct robot_job_frame {
    bool defined;    /* frame 0 always is: no shift, no turn */
    double value[6]; /* X Y Z [mm] A B C [deg]: a tool in the flange, a user frame in the base */
    int32_t line;
};

struct robot_job_points {
    struct robot_job_point point[ROBOT_JOB_POINTS];
    struct robot_job_frame tool[ROBOT_JOB_FRAMES], user[ROBOT_JOB_FRAMES];
    enum robot_job_outside outside; /* the axis outside the arm that there is */
};

/* A point of which nothing is said. */
struct robot_job_point robot_job_point_open(void);

/* Leave no points, and of the frames tool 0 and user frame 0 alone. */
void robot_job_points_clear(struct robot_job_points *p, enum robot_job_outside outside);

/* Read a points file. -1: it is refused, the report says why, and *p is undefined. Ranges: joints
 * +-3600 deg, X Y Z E +-100000 mm, A B C +-360 deg. */
int robot_job_points_read(struct robot_job_points *p, enum robot_job_outside outside,
                          const char *text, int64_t length, struct robot_job_report *r);

enum { ROBOT_JOB_POINT_TEXT = 256 };

/* Write the line of one point, without a line end, to 1e-6 mm and deg. A point that was read from
 * at most six decimals is read again as the same bits. -1, and nothing written: a value or the
 * number is out of the reader's range or not finite. */
int robot_job_point_write(int32_t number, const struct robot_job_point *p,
                          char text[ROBOT_JOB_POINT_TEXT]);

#endif
