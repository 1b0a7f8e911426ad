/* Jobs as pendants and offline systems write them: what they ask for, and why one is refused. */
#include "robot_job_given.h"

static struct robot_job_run run;
static char trace[4000];

static const char HEAD[] = "/JOB\r\n"
                           "//NAME WELD-1\r\n"
                           "//POS\r\n"
                           "///NPOS 5,0,0,2,0,0\r\n"
                           "///TOOL 1\r\n"
                           "///POSTYPE PULSE\r\n"
                           "///PULSE\r\n"
                           "C00000=0,-1000, 2500,0,250000,-7\r\n"
                           "BC00000=0\r\n"
                           "///USER 2\r\n"
                           "///POSTYPE USER\r\n"
                           "///RECTAN\r\n"
                           "///RCONF 1,0,1,0,-1,0,0,0,0,0\r\n"
                           "C00001=10.500,-20.000,30.000,180.0000,0.0000,-90.0000\r\n"
                           "///RCONF 0,1,0,1,0,0\r\n"
                           "C00002=1,2,3,4,5,6\r\n"
                           "///POSTYPE BASE\r\n"
                           "///TOOL 0\r\n"
                           "C00003=900,0,350,180,0,0\r\n"
                           "P00100=0,0,50,0,0,0\r\n"
                           "///POSTYPE PULSE\r\n"
                           "P01005=1,2,3,4,5,6\r\n"
                           "//INST\r\n"
                           "///DATE 2026/01/01 12:00\r\n"
                           "///COMM MADE BY HAND\r\n"
                           "///ATTR SC,RW,RJ\r\n"
                           "////FRAME USER 2\r\n"
                           "///GROUP1 RB1\r\n"
                           "///LVARS 3,0,0,0,0,0,0,0\r\n"
                           "NOP\r\n";

/* What a program asks for; IN#(1) is on, IG#(2) is 5. A move is reached when somebody asks. */
static const char *run_text(const char *text)
{
    struct robot_job_inputs in = { .di = 1u | 5u << 8 };
    struct robot_job_request r = { .answer = ROBOT_JOB_BUSY };
    trace[0] = '\0';
    if (read_program(text)) {
        return message;
    }
    robot_job_begin(&run, &program, &START);
    for (int n = 0; n < 200 && r.answer != ROBOT_JOB_END && r.answer != ROBOT_JOB_FAULT; n++) {
        const size_t at = strlen(trace), left = sizeof trace - at;
        robot_job_next(&run, &program, &points, &in, 1000, &r);
        if (r.answer == ROBOT_JOB_MOVE) {
            const struct robot_job_point *p = robot_job_point(&program, &points, r.point);
            snprintf(trace + at, left, "%c%g T%d U%d", "JLC"[r.path], p -> value[0], (int)r.tool,
                     (int)r.user);
            snprintf(trace + strlen(trace), left - 20, r.shift < 0 ? ";" : " S%d in %d;",
                     (int)(r.shift < 0 ? 0 : robot_job_point(&program, &points, r.shift)->value[2]),
                     (int)r.shift_user);
        } else if (r.answer == ROBOT_JOB_DOUT) {
            snprintf(trace + at, left, "%d:%d+%d=%d;", (int)r.after, (int)r.index + 1, (int)r.count,
                     (int)r.on);
        } else if (r.answer == ROBOT_JOB_REACH) {
            snprintf(trace + at, left, "reach %d;", (int)r.after);
            in.reached = r.after;
        } else if (r.answer == ROBOT_JOB_FAULT) {
            snprintf(trace + at, left, "%d: %s", (int)r.line, robot_job_fault_text(r.fault));
        }
    }
    return trace;
}

static const char *with_head(const char *text)
{
    static char all[8000];
    snprintf(all, sizeof all, "%s%s", HEAD, text);
    return all;
}

/* Positions are what their words say. */
static void positions(void)
{
    CHECK_TEXT(run_text(with_head("MOVJ C00000 VJ=50.00\r\nEND\r\n")), "J0 T1 U0;reach 1;");
    CHECK_EQ(program.positions, 6);
    const struct robot_job_point *p = robot_job_point(&program, &points, ROBOT_JOB_POINTS);
    CHECK(p->kind == ROBOT_JOB_PULSES && p->tool == 1 && p->user == ROBOT_JOB_ANY);
    CHECK(p->value[1] == -1000 && p->value[2] == 2500 && p->value[4] == 250000
          && p->value[5] == -7);
    CHECK(p->wrist == ROBOT_JOB_ANY && p->turn[0] == ROBOT_JOB_ANY_TURN);
    p = robot_job_point(&program, &points, ROBOT_JOB_POINTS + 1);
    CHECK(p->kind == ROBOT_JOB_POSE && p->tool == 1 && p->user == 2 && p->value[0] == 10.5);
    CHECK(p->value[3] == 180 && p->value[5] == -90);
    CHECK(p->wrist == ROBOT_JOB_WRIST_FAR && p->elbow == 0 && p->shoulder == 1);
    CHECK(p->turn[0] == 0 && p->turn[1] == 0 && p->turn[2] == ROBOT_JOB_ANY_TURN);
    p = robot_job_point(&program, &points, ROBOT_JOB_POINTS + 2);
    CHECK(p->wrist == ROBOT_JOB_WRIST_NEAR && p->elbow == 1 && p->shoulder == 0);
    CHECK(p->turn[0] == 0 && p->turn[1] == ROBOT_JOB_ANY_TURN && p->turn[2] == 0);
    p = robot_job_point(&program, &points, ROBOT_JOB_POINTS + 3);
    CHECK(p->user == 0 && p->tool == 0 && p->value[2] == 350);
    CHECK_TEXT(run_text(with_head("MOVL C00001 V=50.0 PL=0\r\nMOVL P100 V=5\r\nMOVJ P1005 VJ=5\r\n"
                                  "MOVC C00001 V=9\r\nMOVC C00001 V=9\r\nMOVC C00002 V=9\r\nEND")),
               "L10.5 T1 U2;L0 T0 U0;J1 T0 U2;L10.5 T1 U2;C1 T1 U2;reach 5;");
}

static const struct {
    const char *text, *trace;
} GOOD[] = {
    /* conditions of several comparisons */
    { "IFTHENEXP IN#(1)=ON AND B000=0 AND (IG#(2)=5)\nDOUT OT#(1) ON\nENDIF", "0:1+1=1;" },
    { "IF IN#(1)=OFF OR B000=1 OR B001=0\nDOUT OT#(1) ON\nENDIF", "0:1+1=1;" },
    { "IF (IN#(1)=OFF AND B000=0)\nDOUT OT#(1) ON\nELSE\nDOUT OT#(2)=ON\nENDIF", "0:2+1=1;" },
    { "IF (IN#(1)=OFF) OR (B000=1)\nDOUT OT#(1) ON\nENDIF", "" },
    { "MOVL P2\nJUMP *A IF B000=0 AND IN#(1)=ON\nDOUT OT#(1) ON\n*A", "L1000 T0 U0;reach 1;" },
    { "MOVL P2\nIF B000=0 AND IN#(1)=ON\nDOUT OT#(1) ON\nENDIF\nMOVL P2",
      "L1000 T0 U0;reach 1;1:1+1=1;L1000 T0 U0;reach 2;" },
    /* groups */
    { "DOUT OG#(2) 255\nSET B001 7\nDOUT OG#(1) B001\nDIN B002 IG#(2)\nDIN I000 OG#(1)\n"
      "IF B002=5 AND I000=7 AND OT#(3)=ON\nDOUT OT#(9) OFF\nENDIF",
      "0:9+8=255;0:1+8=7;0:9+1=0;" },
    { "SET I000 256\nDOUT OG#(1) I000", "2: result out of range" },
    /* counted blocks and choices */
    { "FOR B000=1 TO 3\nDOUT OG#(1) B000\nNEXT B000", "0:1+8=1;0:1+8=2;0:1+8=3;" },
    { "FOR I000 = 4 TO -2 STEP -3\nADD I001 10\nNEXT I000\nDOUT OG#(1) I001", "0:1+8=30;" },
    { "SET B005 2\nFOR LB001 = 5 TO B005\nDOUT OT#(1) ON\nNEXT LB001", "" },
    { "FOR B000=0 TO 1\nFOR B001=0 TO 1\nINC B002\nNEXT B001\nNEXT B000\nDOUT OG#(1) B002",
      "0:1+8=4;" },
    { "FOR B000=1 TO 5\nSWITCH B000\nCASE 1\nDOUT OT#(1) ON\nCASE 2,3\nDOUT OT#(2) ON\nDEFAULT\n"
      "DOUT OT#(3) ON\nENDSWITCH\nNEXT B000",
      "0:1+1=1;0:2+1=1;0:2+1=1;0:3+1=1;0:3+1=1;" },
    { "SWITCH IG#(2)\nCASE B000\nDOUT OT#(1) ON\nCASE 5\nENDSWITCH", "" },
    { "SWITCH B000\nENDSWITCH\nSWITCH B000\nDEFAULT\nDOUT OT#(1) ON\nENDSWITCH", "0:1+1=1;" },
    /* jobs with arguments and variables of their own */
    { "SET LB000 9\nCALL JOB:SUB ARGF5 ARGFLB000\nDOUT OG#(1) LB000\nEND\nJOB SUB\n"
      "GETARG LB001 IARG#(2)\nGETARG LD000 IARG#(1)\nADD LD000 LB001\nADD LD000 LB000\n"
      "DOUT OG#(2) LD000\nSET LB000 77\nSET LR003 0.5",
      "0:9+8=14;0:1+8=9;" },
    { "CALL JOB:SUB (ARGF-5) IF B000=0\nJOB SUB\nGETARG LI000 IARG#(1)\nIF LI000=-5\n"
      "DOUT OT#(1) ON\nENDIF\nGETARG LI000 IARG#(2)",
      "0:1+1=1;7: an argument it was not called with" },
    { "CALL JOB:SUB ARGF300\nJOB SUB\nGETARG B000 IARG#(1)", "3: result out of range" },
    /* what is shifted, what does not wait, what does */
    { "MOVL P2\nSFTON P002\nMOVL P3\nSFTOF\nMOVL P3", "line 2: a shift is a pose without a turn "
                                                      "\"P002\"" },
    { "MOVL P2 NWAIT\nDOUT OT#(1) ON\nCWAIT\nDOUT OT#(2) ON\nMOVL P2\nDOUT OT#(3) ON",
      "L1000 T0 U0;0:1+1=1;reach 1;1:2+1=1;L1000 T0 U0;2:3+1=1;reach 2;" },
    { "PULSE OT#(3) T=0.50\nPULSE OT#(4)\nIF OT#(3)=OFF\nDOUT OT#(1) ON\nENDIF",
      "0:3+1=1;0:4+1=1;0:1+1=1;" },
    { "MSG \"it's // on\"\nDOUT OT#(1) ON", "0:1+1=1;" },
};

static const struct {
    const char *text, *message;
} BAD[] = {
    { "IF B000=1 AND B001=2 OR B002=3", "line 1: AND beside OR in one condition \"OR\"" },
    { "IF B000=1 AND", "line 1: incomplete \"IF B000=1 AND\"" },
    { "IF (B000=1 AND B001=1", "line 1: incomplete \"IF (B000=1 AND B001=1\"" },
    { "FOR B000=0 TO 300", "line 1: value out of range \"300\" (0 to 255)" },
    { "FOR R000=0 TO 3", "line 1: operand of the wrong kind \"R000\"" },
    { "FOR B000=0 UNTIL 3", "line 1: unexpected \"UNTIL\"" },
    { "FOR B000=0 TO 3\nNEXT B001", "line 2: NEXT of another variable \"B001\" (line 1)" },
    { "FOR B000=0 TO 3\nENDIF", "line 2: does not end what is open \"ENDIF\" (line 1)" },
    { "FOR B000=0 TO 3", "line 1: has no end \"FOR B000=0 TO 3\" (line 1)" },
    { "NEXT B000", "line 1: does not end what is open \"NEXT B000\"" },
    { "SWITCH B000\nNOP\nCASE 1\nENDSWITCH", "line 2: before the first CASE \"NOP\"" },
    { "SWITCH B000\nDEFAULT\nCASE 1\nENDSWITCH", "line 3: behind DEFAULT \"CASE 1\" (line 2)" },
    { "CASE 1", "line 1: does not end what is open \"CASE 1\"" },
    { "SWITCH B000\nCASE 1.5\nENDSWITCH", "line 2: no whole number \"1.5\"" },
    { "ARCON ASF#(1)", "line 1: INFORM that this controller lacks \"ARCON\"" },
    { "MFRAME UF#(1) PX001 PX002 PX003", "line 1: INFORM that this controller lacks \"MFRAME\"" },
    { "SET S[0] 1", "line 1: INFORM that this controller lacks \"S\"" },
    { "SET D000 P001", "line 1: INFORM that this controller lacks \"P001\"" },
    { "SET LP000 P001", "line 1: INFORM that this controller lacks \"LP000\"" },
    { "MOVJ P000 VJ=5 +MOVJ P000", "line 1: a move of another robot, and there is one \"MOVJ P000 "
                                   "VJ=5 +MOVJ P000\"" },
    { "SET LB010 1", "line 1: value out of range \"LB010\" (0 to 9)" },
    { "DOUT OG#(5) 1", "line 1: value out of range \"5\" (1 to 4)" },
    { "DOUT OG#(1) 256", "line 1: value out of range \"256\" (0 to 255)" },
    { "GETARG B000 IARG#(9)", "line 1: value out of range \"9\" (1 to 8)" },
    { "SFTON P001", "line 1: a shift is a pose without a turn \"P001\"" },
    { "MOVJ P000 BP000 VJ=5", "line 1: base or station axes, which the arm has not \"BP000\"" },
    { "MOVL BC00000 V=5", "line 1: base or station axes, which the arm has not \"BC00000\"" },
    { "PULSE OT#(33)", "line 1: value out of range \"33\" (1 to 32)" },
    { "PULSE OG#(1)", "line 1: unexpected \"OG#(1)\"" },
    { "PULSE OT#(1) T=0.005", "line 1: value out of range \"T=0.005\" (0.01 to 655.35)" },
    { "MSG hello", "line 1: unexpected \"hello\"" },
    { "CALL JOB:NOBODY", "line 1: no such job \"NOBODY\"" },
    { "//NAME A\n//POS\n///TOOL 7\n//INST", "line 3: tool or user frame not in the points file "
                                            "\"7\"" },
    { "//NAME A\n//POS\n///POSTYPE MASTER", "line 3: INFORM that this controller lacks "
                                            "\"MASTER\"" },
    { "//NAME A\n//POS\n///RCONF 0,0", "line 3: ///RCONF wants six numbers or more "
                                       "\"///RCONF 0,0\"" },
    { "//NAME A\n//POS\n///RCONF 2,0,0,0,0,0", "line 3: value out of range \"2\" (0 to 1)" },
    { "//NAME A\n//POS\nC00000=1,2,3,4,5", "line 3: six values wanted, as many as the arm has axes "
                                           "\"C00000=1,2,3,4,5\"" },
    { "//NAME A\n//POS\nC00000=1,2,3,4,5,6,7", "line 3: six values wanted, as many as the arm has "
                                               "axes \"C00000=1,2,3,4,5,6,7\"" },
    { "//NAME A\n//POS\nC0=1,2,3,4,5,6\nC0=1,2,3,4,5,6", "line 4: defined twice \"C0\"" },
    { "//NAME A\n//POS\nP003=1,2,3,4,5,6", "line 3: defined twice \"P003\"" },
    { "//NAME A\n//POS\nC0=1,2,3,4,5,6\n//INST\nNOP\n//NAME B\nMOVJ C0 VJ=5",
      "line 7: position not in this job \"C0\"" },
    { "//NAME A\n//POS\nC0=1,2,3,x,5,6", "line 3: unexpected \"x,5,6\"" },
};

/* A shift in the base and in a user frame, of points and of pulses. */
static void shifts(void)
{
    CHECK_TEXT(run_text(
                   with_head("SFTON P100\nMOVJ C00000 VJ=5\nSFTON P100 UF#(2)\nMOVL C00001 V=5\n"
                             "SFTOF\nMOVL C00001 V=5\nSFTON P100 BF\nMOVL P002 V=9\n")),
               "J0 T1 U0 S50 in 0;L10.5 T1 U2 S50 in 2;L10.5 T1 U2;L1000 T0 U0 S50 in 0;reach 4;");
    CHECK_TEXT(run_text(with_head("SFTON P100 TF\n")),
               "line 31: INFORM that this controller lacks \"TF\"");
    CHECK_TEXT(run_text(with_head("SFTON P100 UF#(3)\n")),
               "line 31: tool or user frame not in the points file \"UF#(3)\"");
}

/* A job in a text of its own; a position of all jobs may be in both, as the same. */
static void several_texts(void)
{
    static const char *const TEXTS[] = {
        "//NAME A\n//POS\nP500=1,2,3,4,5,6\nC0=9,0,0,0,0,0\n//INST\n"
        "MOVJ C0 VJ=5\nCALL JOB:B\nEND\n",
        "//NAME B\n//POS\nP500=1,2,3,4,5,6\nC0=8,0,0,0,0,0\n//INST\n"
        "MOVJ C0 VJ=5\n*L\nMOVJ P500 VJ=5\nCALL JOB:C\nEND\n",
        "//NAME C\n//POS\nP500=1,2,3,4,5,7\n//INST\nEND\n"
    };
    struct robot_job_inputs in = { 0 };
    struct robot_job_request r;
    robot_job_begin_reading(&program);
    CHECK_EQ(robot_job_read_text(&program, &points, TEXTS[0], (int64_t)strlen(TEXTS[0]), &report),
             0);
    CHECK(program.callees == 1 && robot_job_wanted(&program, 0));
    CHECK_TEXT(program.callee[0].name, "B");
    CHECK_EQ(robot_job_read_text(&program, &points, TEXTS[1], (int64_t)strlen(TEXTS[1]), &report),
             0);
    CHECK(!robot_job_wanted(&program, 0) && robot_job_wanted(&program, 1));
    CHECK_EQ(robot_job_end_reading(&program, &report), -1);
    CHECK(report.text == 1 && report.line == 9 && report.column == 10);
    robot_job_message(&report, TEXTS[1], message);
    CHECK_TEXT(message, "line 9: no such job \"C\"");
    CHECK_EQ(robot_job_read_text(&program, &points, TEXTS[2], (int64_t)strlen(TEXTS[2]), &report),
             -1);
    CHECK(report.text == 2 && report.line == 3 && report.fault == ROBOT_JOB_BAD_POINT_TWICE);
    CHECK_EQ(robot_job_read_text(&program, &points, TEXTS[2], ROBOT_JOB_TEXT_MAX + 1, &report), -1);
    CHECK(report.text == 2 && report.fault == ROBOT_JOB_BAD_TEXT_LENGTH);
    program.callees = 1; /* as if nobody called C */
    program.instruction[program.job[1].start + 2].op = ROBOT_JOB_OP_NOP;
    program.jobs = 2;
    CHECK_EQ(robot_job_end_reading(&program, &report), 0);
    robot_job_begin(&run, &program, &START);
    const double first[] = { 9, 8, 1 };
    for (int i = 0; i < 3; i++) {
        robot_job_next(&run, &program, &points, &in, 100, &r);
        CHECK_EQ(r.answer, ROBOT_JOB_MOVE);
        CHECK(robot_job_point(&program, &points, r.point)->value[0] == first[i]);
        CHECK_EQ(program.job[r.job].text, i > 0);
    }
}

int main(void)
{
    positions();
    for (size_t i = 0; i < sizeof GOOD / sizeof *GOOD; i++) {
        CHECK_TEXT(run_text(GOOD[i].text), GOOD[i].trace);
    }
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        CHECK_EQ(read_program(BAD[i].text), -1);
        CHECK_TEXT(message, BAD[i].message);
    }
    shifts();
    several_texts();
    return check_result();
}
