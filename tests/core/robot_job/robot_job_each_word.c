/* Every word: what it asks for, in order and with its line. */
#include "robot_job_given.h"

enum { CYCLE = 100000, SWITCH = 5 * CYCLE }; /* [ns]; when the inputs change */

static struct robot_job_run run;
static char trace[4000];

static void say(const struct robot_job_request *r, const struct robot_job_inputs *in)
{
    static const char *const UNIT[] = { "", "%", "mm/s", "deg/s" };
    const size_t at = strlen(trace), left = sizeof trace - at;
    char via[16] = "", corner[32] = "";
    switch (r->answer) {
    case ROBOT_JOB_MOVE:
        if (r->path == ROBOT_JOB_CIRCLE) {
            snprintf(via, sizeof via, "P%d ", (int)r->via);
        }
        if (r->corner > 0.0) {
            snprintf(corner, sizeof corner, " CR%g", r->corner);
        }
        snprintf(trace + at, left, "%d: %d %c %sP%d %g%s PL%d%s T%d U%d\n", (int)r->line,
                 (int)r->after, "JLC"[r->path], via, (int)r -> point, r -> speed, UNIT[r->tag],
                 (int)r -> level, corner, (int)r -> tool, (int)r -> user);
        break;
    case ROBOT_JOB_DOUT:
        snprintf(trace + at, left, "%d: after %d OT%d %d\n", (int)r->line, (int)r->after,
                 (int)r->index + 1, (int)r->on);
        break;
    case ROBOT_JOB_AOUT:
        snprintf(trace + at, left, "%d: after %d AO%d %g\n", (int)r->line, (int)r->after,
                 (int)r->index + 1, r->volt);
        break;
    case ROBOT_JOB_REACH:
        snprintf(trace + at, left, "%d: reach %d\n", (int)r->line, (int)r->after);
        break;
    case ROBOT_JOB_PAUSE: snprintf(trace + at, left, "%d: pause\n", (int)r->line); break;
    case ROBOT_JOB_END:
        snprintf(trace + at, left, "%d: end %d us\n", (int)r->line, (int)(in->now / 1000));
        break;
    case ROBOT_JOB_FAULT:
        snprintf(trace + at, left, "%d: %s\n", (int)r->line, robot_job_fault_text(r->fault));
        break;
    case ROBOT_JOB_WAIT:
    case ROBOT_JOB_BUSY: break;
    }
}

/* Run a program to its end. IN#(1) is on until SWITCH, IN#(2) from then on; AI#(1) 2.5 V, AI#(2)
 * -2.5 V. All moves are reached a cycle after someone asks. */
static const char *run_text(const char *text)
{
    struct robot_job_inputs in = { .ai = { 2.5, -2.5 } };
    trace[0] = '\0';
    if (read_program(text)) {
        return message;
    }
    robot_job_begin(&run, &program, &START);
    for (int n = 0; n < 100000; n++) {
        struct robot_job_request r;
        in.di = in.now < SWITCH ? 1 : 2;
        robot_job_next(&run, &program, &points, &in, 100, &r);
        say(&r, &in);
        if (r.answer == ROBOT_JOB_END || r.answer == ROBOT_JOB_FAULT) {
            const struct robot_job_request last = r;
            robot_job_next(&run, &program, &points, &in, 100, &r);
            CHECK(r.answer == last.answer && r.fault == last.fault && r.line == last.line);
            return trace;
        }
        if (r.answer >= ROBOT_JOB_REACH) {
            in.now += CYCLE;
            in.reached = r.answer == ROBOT_JOB_REACH ? r.after : in.reached;
        }
    }
    return "never ends";
}

static const struct {
    const char *text, *trace;
} GOOD[] = {
    /* moves: words in force, tags, numbers of the point */
    { "MOVJ P000 VJ=50.00 PL=1\nMOVL P001 V=10.0\nMOVL P002 VR=30 CR=5.5\nmovj P0",
      "1: 1 J P0 50% PL1 T0 U0\n2: 2 L P1 10mm/s PL0 T1 U0\n"
      "3: 3 L P2 30deg/s PL0 CR5.5 T0 U0\n4: 4 J P0 10% PL0 T0 U0\n"
      "4: reach 4\n4: end 100 us\n" },
    { "SPEED VJ=20 V=276 VR=15\nMOVJ P0\nMOVL P2\nSPEED VR=7\nMOVL P2\nSPEED VJ=3\nMOVL P2\n"
      "SPEED V=9\nMOVL P2\n",
      "2: 1 J P0 20% PL0 T0 U0\n3: 2 L P2 15deg/s PL0 T0 U0\n5: 3 L P2 7deg/s PL0 T0 U0\n"
      "7: 4 L P2 7deg/s PL0 T0 U0\n9: 5 L P2 9mm/s PL0 T0 U0\n9: reach 5\n9: end 100 us\n" },
    { "PL 3\nMOVL P2\nMOVL P2 PL=0\nPL=8\nMOVL P2 V=5",
      "2: 1 L P2 100mm/s PL3 T0 U0\n3: 2 L P2 100mm/s PL0 T0 U0\n5: 3 L P2 5mm/s PL8 T0 U0\n"
      "5: reach 3\n5: end 100 us\n" },
    { "TOOL 1\nUSER UF#(2)\nMOVL P2\nMOVL P1\nTOOL TL#(0)\nMOVL P4\nUSER 0\nMOVL P2",
      "3: 1 L P2 100mm/s PL0 T1 U2\n4: 2 L P1 100mm/s PL0 T1 U2\n6: 3 L P4 100mm/s PL0 T0 U2\n"
      "8: 4 L P2 100mm/s PL0 T0 U0\n8: reach 4\n8: end 100 us\n" },
    { "MOVC P002 P003 V=20 PL=2", "1: 1 C P2 P3 20mm/s PL2 T0 U0\n1: reach 1\n1: end 100 us\n" },
    { "MOVC P001 V=10\nMOVC P002 V=20\n ' the end\nMOVC P003 V=20 PL=1\nNOP\nMOVC P3\nMOVC P2\n"
      "MOVC P3\n",
      "1: 1 L P1 10mm/s PL0 T1 U0\n4: 2 C P2 P3 20mm/s PL1 T0 U0\n6: 3 L P3 100mm/s PL0 T0 U0\n"
      "8: 4 C P2 P3 100mm/s PL0 T0 U0\n8: reach 4\n8: end 100 us\n" },
    /* outputs keep their place among the moves, and nobody waits */
    { "DOUT OT#(1) ON\nMOVL P1\nDOUT OT#(32) ON\nDOUT OT#(1) OFF\nMOVL P2\nAOUT AO#(2) -3.5\n"
      "SET R001 0.25\nAOUT AO#(8) R001\nEND",
      "1: after 0 OT1 1\n2: 1 L P1 100mm/s PL0 T1 U0\n3: after 1 OT32 1\n4: after 1 OT1 0\n"
      "5: 2 L P2 100mm/s PL0 T0 U0\n6: after 2 AO2 -3.5\n8: after 2 AO8 0.25\n9: reach 2\n"
      "9: end 100 us\n" },
    { "DOUT OT#(2) ON\nDOUT OT#(1) ON\nDOUT OT#(1) OFF\nIF OT#(1)=OFF\nIF OT#(2)=ON\n"
      "DOUT OT#(3) ON\nENDIF\nENDIF",
      "1: after 0 OT2 1\n2: after 0 OT1 1\n3: after 0 OT1 0\n6: after 0 OT3 1\n8: end 0 us\n" },
    { "SET R000 10.01\nAOUT AO#(1) R000", "2: result out of range\n" },
    /* inputs: DIN and AIN wait until the move before is reached */
    { "MOVL P2\nDIN B001 IN#(1)\nDIN B002 IN#(2)\nDOUT OT#(3) ON\nDIN B003 OT#(3)\nAIN R5 AI#(2)\n"
      "IF B001=1\nIF B002=0\nIF B003=1\nIF R5=-2.5\nDOUT OT#(9) ON\nENDIF\nENDIF\nENDIF\nENDIF",
      "1: 1 L P2 100mm/s PL0 T0 U0\n2: reach 1\n4: after 1 OT3 1\n11: after 1 OT9 1\n"
      "15: end 100 us\n" },
    { "IF AI#(1)>2\nDOUT OT#(1) ON\nENDIF\nIF AI#(1)<=R000\nDOUT OT#(2) ON\nENDIF",
      "2: after 0 OT1 1\n6: end 0 us\n" },
    /* waiting: until it holds, or the time is up */
    { "WAIT IN#(2)=ON\nEND", "2: end 500 us\n" },
    { "WAIT IN#(1)<>ON", "1: end 500 us\n" },
    { "WAIT IN#(2)=ON T=0.00025\nEND", "2: end 300 us\n" },
    { "WAIT IN#(2)=ON T=2.00\nEND", "2: end 500 us\n" },
    { "WAIT B000=0\nWAIT B000=1 T=0.001", "2: end 1000 us\n" },
    { "MOVL P2\nTIMER T=0.50\nTIMER T=0.5",
      "1: 1 L P2 100mm/s PL0 T0 U0\n2: reach 1\n3: end 1000100 us\n" },
    { "MOVL P2\nPAUSE\nPAUSE IF IN#(2)=ON\nPAUSE IF B000=0\nEND",
      "1: 1 L P2 100mm/s PL0 T0 U0\n2: reach 1\n2: pause\n4: pause\n5: end 300 us\n" },
    /* jumps, in both spellings */
    { "*A\nINC B000\nJUMP *A IF B000<3\nDOUT OT#(3) ON\nJUMP OUT\nDOUT OT#(4) ON\nLABEL OUT",
      "4: after 0 OT3 1\n7: end 0 us\n" },
    { "*WAITING\nJUMP *WAITING IF IN#(1)=ON", "2: end 500 us\n" },
    { "JUMP JOB:B\nJOB A\nDOUT OT#(1) ON\nJOB B\nDOUT OT#(2) ON", "5: after 0 OT2 1\n"
                                                                  "5: end 0 us\n" },
    /* jobs */
    { "//NAME MAIN\nCALL JOB:SUB\nCALL JOB:SUB IF B000=9\nCALL JOB:Sub IF B000=1\nEND\n"
      "//NAME SUB ' twice the name\nINC B000\nRET IF B000=1\nDOUT OT#(1) ON\n"
      "JOB Sub\nDOUT OT#(2) ON\nRET\nDOUT OT#(3) ON\nEND",
      "11: after 0 OT2 1\n5: end 0 us\n" },
    { "INC B000\nCALL JOB:MAIN", "2: CALL inside too many others\n" },
    { "INC B000\nCALL JOB:MAIN IF B000<13\nDEC B000\nIF B000=0\nDOUT OT#(1) ON\nENDIF",
      "5: after 0 OT1 1\n6: end 0 us\n" },
    /* blocks */
    { "LOOP 3\nINC B000\nLOOP 2\nINC B001\nENDLOOP\nENDLOOP\nIF B000=3\nIF B001=6\n"
      "DOUT OT#(1) ON\nENDIF\nENDIF",
      "9: after 0 OT1 1\n11: end 0 us\n" },
    { "LOOP 0\nDOUT OT#(1) ON\nENDLOOP\nLOOP B000\nDOUT OT#(2) ON\nENDLOOP\nSET I001 2\nLOOP I001\n"
      "DOUT OT#(3) ON\nENDLOOP\nSET D002 -2\nLOOP D002\nDOUT OT#(4) ON\nENDLOOP",
      "9: after 0 OT3 1\n9: after 0 OT3 1\n14: end 0 us\n" },
    { "LOOP\nINC B000\nJUMP *OUT IF B000=200\nENDLOOP\n*OUT\nDOUT OT#(1) ON",
      "6: after 0 OT1 1\n6: end 600 us\n" },
    { "WHILE B000<2\nINC B000\nDOUT OT#(1) ON\nENDWHILE\nWHILEEXP (B000=1)\nDOUT OT#(2) ON\n"
      "ENDWHILE",
      "3: after 0 OT1 1\n3: after 0 OT1 1\n7: end 0 us\n" },
    { "LOOP 4\nIFTHEN B000=0\nDOUT OT#(1) ON\nELSEIF B000=1\nDOUT OT#(2) ON\nELSEIFEXP (B000=2)\n"
      "DOUT OT#(3) ON\nELSE\nDOUT OT#(4) ON\nENDIF\nINC B000\nENDLOOP",
      "3: after 0 OT1 1\n5: after 0 OT2 1\n7: after 0 OT3 1\n9: after 0 OT4 1\n12: end 0 us\n" },
    { "IFTHENEXP OT#(1)=OFF\nDOUT OT#(1) ON\nENDIF\nIF OT#(1)=ON\nDOUT OT#(2) ON\nELSE\n"
      "DOUT OT#(3) ON\nENDIF",
      "2: after 0 OT1 1\n5: after 0 OT2 1\n8: end 0 us\n" },
    /* arithmetic: whole variables take the whole part */
    { "SET D000 7\nDIV D000 2\nSET D001 -7\nDIV D001 2\nSET R000 7\nDIV R000 2\nMUL D000 D000\n"
      "SUB D000 10\nSET B000 R000\nADD R000 0.25\nDEC I000\n"
      "IF D000=-1\nIF D001=-3\nIF R000=3.75\nIF B000=3\nIF I000=-1\nDOUT OT#(1) ON\nENDIF\nENDIF\n"
      "ENDIF\nENDIF\nENDIF",
      "17: after 0 OT1 1\n22: end 0 us\n" },
    { "SET B000 200\nADD B000 -100\nIF B000=100\nDOUT OT#(1) ON\nENDIF",
      "4: after 0 OT1 1\n5: end 0 us\n" },
    { "NOP\nDIV B000 B001", "2: division by zero\n" },
    { "DEC B000", "1: result out of range\n" },
    { "SET B000 255\nINC B000", "2: result out of range\n" },
    { "SET I000 32767\nADD I000 1", "2: result out of range\n" },
    { "SET D000 2147483647\nINC D000", "2: result out of range\n" },
    { "SET R000 1000000000000\n*A\nMUL R000 R000\nJUMP *A", "3: result out of range\n" },
    { "*A\nNOP\nJUMP *A", "3: endless without motion, input, output or wait\n" },
    { "MOVL P2\n*A\nINC D000\nJUMP *A IF D000<300000\nDOUT OT#(1) ON",
      "1: 1 L P2 100mm/s PL0 T0 U0\n5: after 1 OT1 1\n5: reach 1\n5: end 600100 us\n" },
    /* relations */
    { "SET R0 2\nIF R0=2\nDOUT OT#(1) ON\nENDIF\nIF R0<>2\nDOUT OT#(2) ON\nENDIF\nIF R0<2.5\n"
      "DOUT OT#(3) ON\nENDIF\nIF R0 > 2\nDOUT OT#(4) ON\nENDIF\nIF R0<=2\nDOUT OT#(5) ON\nENDIF\n"
      "IF R0>=2\nDOUT OT#(6) ON\nENDIF",
      "3: after 0 OT1 1\n9: after 0 OT3 1\n15: after 0 OT5 1\n18: after 0 OT6 1\n19: end 0 us\n" },
};

static void each_word(void)
{
    for (size_t i = 0; i < sizeof GOOD / sizeof *GOOD; i++) {
        CHECK_TEXT(run_text(GOOD[i].text), GOOD[i].trace);
    }
}

/* A call does no more than it may, and says so. */
static void bounded(void)
{
    const struct robot_job_inputs in = { 0 };
    struct robot_job_request r;
    CHECK_EQ(read_program("LOOP 10\nINC D000\nENDLOOP\nDOUT OT#(1) ON"), 0);
    robot_job_begin(&run, &program, &START);
    for (int n = 1; n <= 3; n++) {
        robot_job_next(&run, &program, &points, &in, 7, &r);
        CHECK_EQ(r.answer, ROBOT_JOB_BUSY);
        CHECK_EQ(run.idle, 7 * n);
    }
    robot_job_next(&run, &program, &points, &in, 0, &r);
    CHECK_EQ(r.answer, ROBOT_JOB_BUSY);
    CHECK_EQ(run.idle, 21);
    robot_job_next(&run, &program, &points, &in, 1, &r);
    CHECK_EQ(r.answer, ROBOT_JOB_DOUT);
    CHECK_EQ(run.idle, 0);
    CHECK_EQ(run.whole[2][0], 10);
    int32_t line;
    CHECK_EQ(robot_job_running(&run, &program, &line), 0);
    CHECK_EQ(line, 4);
}

/* Which job runs; a program may begin with any. */
static void jobs(void)
{
    const struct robot_job_inputs in = { 0 };
    struct robot_job_start start = START;
    struct robot_job_request r;
    int32_t line;
    CHECK_EQ(read_program("TIMER T=0.000100001"), 0);
    CHECK_EQ(program.instruction[0].time, 100001);
    CHECK_EQ(read_program("JOB ONE\nCALL JOB:TWO\nJOB TWO\nDOUT OT#(1) ON\nDOUT OT#(2) ON"), 0);
    CHECK_EQ(robot_job_find(&program, "ONE"), 0);
    CHECK_EQ(robot_job_find(&program, "TWO"), 1);
    CHECK_EQ(robot_job_find(&program, "TW"), -1);
    CHECK_EQ(robot_job_find(&program, "TWOO"), -1);
    CHECK_EQ(robot_job_find(&program, ""), -1);
    robot_job_begin(&run, &program, &START);
    CHECK_EQ(robot_job_running(&run, &program, &line), 0);
    robot_job_next(&run, &program, &points, &in, 9, &r);
    CHECK_EQ(robot_job_running(&run, &program, &line), 1);
    CHECK_EQ(line, 5);
    start.job = 1;
    start.out = 1u << 4;
    robot_job_begin(&run, &program, &start);
    robot_job_next(&run, &program, &points, &in, 9, &r);
    CHECK_EQ(r.line, 4);
    CHECK_EQ(run.out, 1u << 4 | 1u);
}

int main(void)
{
    each_word();
    bounded();
    jobs();
    return check_result();
}
