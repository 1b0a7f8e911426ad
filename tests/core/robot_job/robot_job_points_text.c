/* The points file: what is read, what is refused with its message, and what is written. */
#include "robot_job_given.h"

static const char *read_points(const char *text)
{
    const int status =
        robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, text, (int64_t)strlen(text), &report);
    CHECK_EQ(status, report.fault == ROBOT_JOB_OK ? 0 : -1);
    message[0] = '\0';
    if (status) {
        robot_job_message(&report, text, message);
    }
    return message;
}

static void read_all(void)
{
    CHECK_TEXT(read_points("' a cell\n"
                           "TOOL 1 X=0 Y=-1.5 Z=150 A=0 B=90 C=0 // pen\n"
                           "user 63 c=90 x=900 y=-300 z=200 a=1 b=2\r\n\n"
                           "  P7 J1=0 J2=-20.5 J3=10 J4=400 J5=+90 J6=-.25 USER=63\n"
                           "P999 X=100 Y=50 Z=.5 A=180 B=0 C=-0.000001 BACK DOWN FLIP TURN1=0 "
                           "TURN4=-1 TURN6=100 TOOL=1 USER=0"),
               "");
    const struct robot_job_point *p = &points.point[7];
    static const double JOINT[6] = { 0, -20.5, 10, 400, 90, -0.25 };
    static const double PLACE[6] = { 100, 50, 0.5, 180, 0, -0.000001 };
    static const double FRAME[6] = { 900, -300, 200, 1, 2, 90 };
    CHECK(p->kind == ROBOT_JOB_JOINTS && !memcmp(p->value, JOINT, sizeof JOINT) && p->line == 5);
    CHECK(p->tool == ROBOT_JOB_ANY && p->user == 63 && p->shoulder == ROBOT_JOB_ANY
          && p->turn[1] == ROBOT_JOB_ANY_TURN);
    p = &points.point[999];
    CHECK(p->kind == ROBOT_JOB_POSE && !memcmp(p->value, PLACE, sizeof PLACE) && p->line == 6);
    CHECK(p->shoulder == 1 && p->elbow == 1 && p->wrist == 1 && p->tool == 1 && p->user == 0);
    CHECK(p->turn[0] == 0 && p->turn[1] == -1 && p->turn[2] == 100);
    CHECK(points.user[63].defined && !memcmp(points.user[63].value, FRAME, sizeof FRAME));
    CHECK(points.tool[0].defined && points.user[0].defined && !points.tool[2].defined);
    CHECK_EQ(points.point[8].kind, ROBOT_JOB_NO_POINT);
    CHECK_TEXT(read_points("P0 X=1 Y=2 Z=3 A=0 B=0 C=0 FRONT UP NOFLIP"), "");
    p = &points.point[0];
    CHECK(p->shoulder == 0 && p->elbow == 0 && p->wrist == 0);
    CHECK_EQ(points.point[7].kind, ROBOT_JOB_NO_POINT); /* nothing is left of the file before */
    CHECK_TEXT(read_points("P0 X=12345.1234567891 Y=2 Z=3 A=0 B=0 C=0"), "");
    CHECK(points.point[0].value[0] == 12345.1234567891);
    CHECK_TEXT(read_points(""), "");
}

#define POSE   "X=1 Y=2 Z=3 A=0 B=0 C=0"
#define JOINTS "J1=0 J2=0 J3=0 J4=0 J5=0 J6=0"

static const struct {
    const char *text, *message;
} BAD[] = {
    { "Q001 " POSE, "line 1: unknown word \"Q001\"" },
    { "P " POSE, "line 1: unknown word \"P\"" },
    { "P00X " POSE, "line 1: unknown word \"P00X\"" },
    { "P001 " POSE " UPSIDE", "line 1: unknown word \"UPSIDE\"" },
    { "P001 J7=0", "line 1: unknown word \"J7\"" },
    { "P001 J0=0", "line 1: unknown word \"J0\"" },
    { "P001 " POSE " TURN2=0", "line 1: unknown word \"TURN2\"" },
    { "TOOL 1 J1=0", "line 1: unknown word \"J1\"" },
    { "P001 X", "line 1: incomplete \"P001 X\"" },
    { "P001 X=", "line 1: incomplete \"P001 X=\"" },
    { "TOOL", "line 1: incomplete \"TOOL\"" },
    { "P001 X=a", "line 1: unexpected \"a\"" },
    { "P001 X 1", "line 1: unexpected \"1\"" },
    { "P001 " POSE " UP DOWN", "line 1: given twice \"DOWN\"" },
    { "P001 " POSE " ,", "line 1: unexpected \",\"" },
    { "TOOL 1 " POSE " ;", "line 1: unexpected \";\"" },
    { "TOOL X=1", "line 1: unexpected \"X=1\"" },
    { "*A", "line 1: unexpected \"*A\"" },
    { "//NAME A", "line 1: unexpected \"//NAME\"" },
    { "P001 X=1 X=2", "line 1: given twice \"X\"" },
    { "P001 J1=1 J1=2", "line 1: given twice \"J1\"" },
    { "P001 " POSE " TURN1=1 TURN1=1", "line 1: given twice \"TURN1\"" },
    { "TOOL 1 " POSE "\nP001 " POSE " TOOL=1 TOOL=1", "line 2: given twice \"TOOL\"" },
    { "P001 X=1234567890.123456", "line 1: number with more than 15 digits "
                                  "\"1234567890.123456\"" },
    { "P001 " POSE " TURN4=0.5", "line 1: no whole number \"0.5\"" },
    { "P1000 " POSE, "line 1: value out of range \"P1000\" (0 to 999)" },
    { "P001 X=100000.1", "line 1: value out of range \"100000.1\" (-100000 to 100000)" },
    { "P001 A=361", "line 1: value out of range \"361\" (-360 to 360)" },
    { "P001 J1=-3601", "line 1: value out of range \"-3601\" (-3600 to 3600)" },
    { "P001 " POSE " TURN6=101", "line 1: value out of range \"101\" (-100 to 100)" },
    { "P001 " POSE " TOOL=64", "line 1: value out of range \"64\" (0 to 63)" },
    { "TOOL 0 " POSE, "line 1: value out of range \"0\" (1 to 63)" },
    { "P001 " POSE "\n\nP1 " JOINTS, "line 3: defined twice \"P1\" (line 1)" },
    { "USER 5 " POSE "\nUSER 5 " POSE, "line 2: defined twice \"USER 5 " POSE "\" (line 1)" },
    { "P001 X=1 Y=2 Z=3 A=0 B=0", "line 1: needs X Y Z A B C or J1 to J6 \"P001 X=1 Y=2 Z=3 A=0 "
                                  "B=0\"" },
    { "P001", "line 1: needs X Y Z A B C or J1 to J6 \"P001\"" },
    { "P001 J1=0 J2=0 J3=0 J4=0 J6=0 TOOL=0", "line 1: needs X Y Z A B C or J1 to J6 "
                                              "\"P001 J1=0 J2=0 J3=0 J4=0 J6=0 TOOL=0\"" },
    { "TOOL 1 X=0", "line 1: needs X Y Z A B C or J1 to J6 \"TOOL 1 X=0\"" },
    { "P001 " JOINTS " X=1", "line 1: joints beside coordinates or configuration \"X\"" },
    { "P001 X=1 J1=0", "line 1: joints beside coordinates or configuration \"J1\"" },
    { "P001 " JOINTS " UP", "line 1: joints beside coordinates or configuration \"UP\"" },
    { "P001 TURN1=0 " JOINTS, "line 1: joints beside coordinates or configuration \"J1\"" },
    { "P001 " POSE " TOOL=1\nTOOL 1 " POSE, "line 1: tool or user frame not defined above "
                                            "\"TOOL=1\"" },
    { "P001 " JOINTS " USER=2", "line 1: tool or user frame not defined above \"USER=2\"" },
};

static void refused(void)
{
    bool seen[ROBOT_JOB_FAULT_COUNT] = { false };
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        CHECK_TEXT(read_points(BAD[i].text), BAD[i].message);
        seen[report.fault] = true;
    }
    for (int f = ROBOT_JOB_BAD_WORD; f <= ROBOT_JOB_BAD_POINT_FRAME; f++) {
        CHECK(seen[f]);
    }
}

/* What is written is read as the same point, and a second time as the same bits. */
static void round_trip(void)
{
    uint64_t seed = 7;
    for (int n = 0; n < 20000; n++) {
        char text[ROBOT_JOB_POINT_TEXT], again[ROBOT_JOB_POINT_TEXT];
        const int32_t number = (int32_t)check_random(&seed, 0, ROBOT_JOB_POINTS - 1);
        struct robot_job_point p = { .kind = n % 2 ? ROBOT_JOB_POSE : ROBOT_JOB_JOINTS };
        for (int i = 0; i < 6; i++) {
            const double most = n % 2 == 0 ? 3600.0 : i < 3 ? 100000.0 : 360.0;
            p.value[i] =
                n % 5 ? check_real(&seed, -most, most) : (double)check_random(&seed, -1, 1) * most;
        }
        p.shoulder = n % 2 ? (int32_t)check_random(&seed, -1, 1) : ROBOT_JOB_ANY;
        p.elbow = n % 2 ? (int32_t)check_random(&seed, -1, 1) : ROBOT_JOB_ANY;
        p.wrist = n % 2 ? (int32_t)check_random(&seed, -1, 1) : ROBOT_JOB_ANY;
        for (int i = 0; i < 3; i++) {
            const int32_t turn = (int32_t)check_random(&seed, -101, 100);
            p.turn[i] = n % 2 && turn >= -100 ? turn : ROBOT_JOB_ANY_TURN;
        }
        p.tool = p.user = (int32_t)check_random(&seed, -1, 0);
        CHECK_EQ(robot_job_point_write(number, &p, text), 0);
        CHECK_TEXT(read_points(text), "");
        const struct robot_job_point first = points.point[number];
        for (int i = 0; i < 6; i++) {
            CHECK(fabs(first.value[i] - p.value[i]) <= 0.5e-6 + 1e-10);
            p.value[i] = first.value[i];
        }
        p.line = 1;
        CHECK(!memcmp(&first, &p, sizeof p));
        CHECK_EQ(robot_job_point_write(number, &first, again), 0);
        CHECK_TEXT(again, text);
        CHECK_TEXT(read_points(again), "");
        CHECK(!memcmp(&points.point[number], &first, sizeof first));
    }
}

static void written(void)
{
    char text[ROBOT_JOB_POINT_TEXT];
    struct robot_job_point p = { .kind = ROBOT_JOB_POSE,
                                 .value = { 900, -0.0000004, -0.5, 180, 1e-6, -359.999999 },
                                 .shoulder = 0,
                                 .elbow = 1,
                                 .wrist = 0,
                                 .turn = { ROBOT_JOB_ANY_TURN, -1, 2 },
                                 .tool = 3,
                                 .user = ROBOT_JOB_ANY };
    CHECK_EQ(robot_job_point_write(12, &p, text), 0);
    CHECK_TEXT(text, "P012 X=900 Y=0 Z=-0.5 A=180 B=0.000001 C=-359.999999 FRONT DOWN NOFLIP "
                     "TURN4=-1 TURN6=2 TOOL=3");
    strcpy(text, "as before");
    static const double WRONG[] = { NAN, INFINITY, 360.1 };
    for (int i = 0; i < 3; i++) {
        p.value[4] = WRONG[i];
        CHECK_EQ(robot_job_point_write(12, &p, text), -1);
    }
    p.value[4] = 0.0;
    CHECK_EQ(robot_job_point_write(1000, &p, text), -1);
    CHECK_EQ(robot_job_point_write(-1, &p, text), -1);
    p.tool = 64;
    CHECK_EQ(robot_job_point_write(12, &p, text), -1);
    p.tool = 0;
    p.turn[0] = 101;
    CHECK_EQ(robot_job_point_write(12, &p, text), -1);
    p.turn[0] = -101;
    CHECK_EQ(robot_job_point_write(12, &p, text), -1);
    p.turn[0] = 0;
    p.elbow = 2;
    CHECK_EQ(robot_job_point_write(12, &p, text), -1);
    p.elbow = 0;
    p.kind = ROBOT_JOB_NO_POINT;
    CHECK_EQ(robot_job_point_write(12, &p, text), -1);
    CHECK_TEXT(text, "as before");
}

int main(void)
{
    read_all();
    refused();
    round_trip();
    written();
    return check_result();
}
