/* inform_points - the points, tools and user frames of a program, from text and back to text.
 *
 *     TOOL 1 X=0 Y=0 Z=150 A=0 B=0 C=0
 *     USER 1 X=900 Y=-300 Z=200 A=0 B=0 C=90
 *     P000 J1=0 J2=-20 J3=10 J4=0 J5=90 J6=0 TOOL=1
 *     P001 X=100 Y=50 Z=0 A=180 B=0 C=0 FRONT UP NOFLIP TURN4=0 TURN6=-1 TOOL=1 USER=1
 *
 * Orientation: R = Rz(C) Ry(B) Rx(A). A pose is that of the tool in the user frame. Joints are
 * those of the maker.
 */
#ifndef INFORM_POINTS_H
#define INFORM_POINTS_H

#include <stdbool.h>

#include "inform_fault.h"

enum {
    INFORM_TEXT_MAX = 1 << 22, /* [byte] */
    INFORM_LINE_MAX = 256,     /* [characters] of a line without CR LF */
    INFORM_POINTS = 1000,      /* P000 .. P999 */
    INFORM_FRAMES = 64         /* tools 0 (flange) .. 63, user frames 0 (base) .. 63 */
};

enum inform_point_kind { INFORM_NO_POINT, INFORM_JOINTS, INFORM_POSE };

/* What a configuration leaves open is what is nearest to where the arm stands. */
enum { INFORM_ANY = -1, INFORM_ANY_TURN = -128, INFORM_TURN_MAX = 100 };

struct inform_point {
    double value[6]; /* joints [deg], or X Y Z [mm] A B C [deg] */
    enum inform_point_kind kind;
    int32_t shoulder;   /* 0 FRONT, 1 BACK, INFORM_ANY */
    int32_t elbow;      /* 0 UP, 1 DOWN, INFORM_ANY */
    int32_t wrist;      /* 0 NOFLIP, 1 FLIP, INFORM_ANY */
    int32_t turn[3];    /* of joints 1 4 6: n for 360 n - 180 < joint <= 360 n + 180 [deg],
                         * -100 .. 100, or INFORM_ANY_TURN */
    int32_t tool, user; /* INFORM_ANY: what is in force where the program goes there */
    int32_t line;       /* where it is defined, 0: taught */
};

struct inform_frame {
    bool defined;    /* 0 always is: no shift, no turn */
    double value[6]; /* X Y Z [mm] A B C [deg]; in the flange, in the base */
    int32_t line;
};

struct inform_points {
    struct inform_point point[INFORM_POINTS];
    struct inform_frame tool[INFORM_FRAMES], user[INFORM_FRAMES];
};

/* No points; tool 0 and user frame 0. */
void inform_points_clear(struct inform_points *p);

/* Read a points file; -1: refused, the report says why, *p is undefined. Ranges: joints +-3600 deg,
 * X Y Z +-100000 mm, A B C +-360 deg. */
int inform_points_read(struct inform_points *p, const char *text, int64_t length,
                       struct inform_report *r);

enum { INFORM_POINT_TEXT = 256 };

/* The line of one point without its end, as the reader takes it: to 1e-6 mm and deg, so what was
 * read from at most six decimals comes back as the same bits. -1: a value or number is out of the
 * reader's range or not finite, nothing is written. */
int inform_point_write(int32_t number, const struct inform_point *p, char text[INFORM_POINT_TEXT]);

#endif
