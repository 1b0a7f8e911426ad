/* Positions that change, elements by a variable, speeds by a variable, moves by an increment, moves
 * that an input ends: what is asked for, and why it is refused or stops. */
#include <math.h>

#include "robot_job_given.h"

static struct robot_job_run run;
static char trace[4000];

/* The arm as GETS finds it. */
static const struct robot_job_point HERE[2] = {
    { .value = { 1, 2, 3, 4, 5, 6 }, .kind = ROBOT_JOB_PULSES },
    { .value = { 700.5, -20.25, 300, 180, 0, -90 }, .kind = ROBOT_JOB_POSE, .tool = 1 },
};

/* How often somebody has asked. */
static int asked;

static void where(const void *arm, struct robot_job_point here[2])
{
    memcpy(here, arm, sizeof HERE);
    asked++;
}

/* A position seen with tools and in frames: their numbers behind its X. */
static void seen(const void *arm, const struct robot_job_point *from, struct robot_job_point *pose)
{
    (void)arm;
    memcpy(pose->value, from->value, sizeof pose->value);
    pose->value[1] = 10 * from->tool + from->user;
    pose->value[2] = 10 * pose->tool + pose->user;
    pose->elbow = from->kind == ROBOT_JOB_PULSES;
}

/* From one X to the other; frames and tools of both behind it, and turns about what rounds to
 * none. */
static void led(const void *arm, const struct robot_job_point *from,
                const struct robot_job_point *to, int32_t frame, double by[6])
{
    const double way[6] = { to->value[0] - from->value[0],
                            10 * from->tool + from->user,
                            10 * to->tool + to->user,
                            frame,
                            4.9e-5,
                            -5.1e-5 };
    (void)arm;
    memcpy(by, way, sizeof way);
}

/* The moves of a program: path, values of the position, tool, user frame, speed; UNTIL and frames
 * of increments; its outputs. A move is reached when somebody asks. */
static const char *run_text(const char *text)
{
    struct robot_job_inputs in = { .here = where, .convert = seen, .shift = led, .arm = HERE };
    struct robot_job_request r = { .answer = ROBOT_JOB_BUSY };
    trace[0] = '\0';
    if (read_program(text)) {
        return message;
    }
    robot_job_begin(&run, &program, &START);
    for (int n = 0; n < 400 && r.answer != ROBOT_JOB_END && r.answer != ROBOT_JOB_FAULT; n++) {
        const size_t at = strlen(trace), left = sizeof trace - at;
        robot_job_next(&run, &program, &points, &in, 1000, &r);
        if (r.answer == ROBOT_JOB_MOVE) {
            const struct robot_job_point *p = robot_job_place(&run, &program, &points, r.point);
            snprintf(trace + at, left, "%c%g,%g,%g,%g,%g,%g T%d U%d %g", "JLCS"[r.path],
                     p -> value[0], p -> value[1], p -> value[2], p -> value[3], p -> value[4],
                     p -> value[5], (int)r.tool, (int)r.user, r.speed);
            if (r.path == ROBOT_JOB_CIRCLE) {
                p = robot_job_place(&run, &program, &points, r.via);
                snprintf(trace + strlen(trace), 40, " via %g", p->value[0]);
            }
            if (r.path == ROBOT_JOB_SPLINE && r.next >= 0) {
                p = robot_job_place(&run, &program, &points, r.next);
                snprintf(trace + strlen(trace), 40, " next %g U%d", p->value[0], (int)r.next_user);
            }
            if (r.increment != ROBOT_JOB_NOT_BY) {
                snprintf(trace + strlen(trace), 40, " by %d", (int)r.increment);
            }
            if (r.shift >= 0) {
                snprintf(trace + strlen(trace), 60, " shift %g %g %g", r.shift_by[0], r.shift_by[1],
                         r.shift_by[2]);
            }
            if (r.until >= 0) {
                snprintf(trace + strlen(trace), 40, " until %d %d", (int)r.until, r.until_on);
            }
            if (r.acc[0] != 100.0 || r.acc[1] != 100.0) {
                snprintf(trace + strlen(trace), 40, " ramps %g %g", r.acc[0], r.acc[1]);
            }
            strcat(trace, ";");
        } else if (r.answer == ROBOT_JOB_DOUT) {
            snprintf(trace + at, left, "%d:%d=%d;", (int)r.after, (int)r.index + 1, (int)r.on);
        } else if (r.answer == ROBOT_JOB_REACH) {
            snprintf(trace + at, left, "reach %d;", (int)r.after);
            in.reached = r.after;
        } else if (r.answer == ROBOT_JOB_FAULT) {
            snprintf(trace + at, left, "%d %s", (int)r.line, robot_job_fault_text(r.fault));
        }
    }
    return trace;
}

static const struct {
    const char *text, *trace;
} GOOD[] = {
    /* SET ADD SUB: all that belongs to a position goes with it; ADD keeps frame and tool */
    { "SET P010 P001\nADD P010 P002\nMOVL P010 V=9\nMOVL P001 V=9\nSUB P010 P010\nMOVL P010 V=9",
      "L1900,100,700,360,0,0 T1 U0 9;L900,0,350,180,0,0 T1 U0 9;L0,0,0,0,0,0 T1 U0 9;reach 3;" },
    { "SUB P020 P020\nSETE P020 (3) -1500\nSETE P20 (6) 900000\nADD P020 P004\nMOVL P020 V=9",
      "L0,0,-1.5,180,0,90 T0 U0 9;reach 1;" },
    { "ADD P020 P004\nMOVL P020 V=9\nSUB P021 P000\nMOVJ P21 VJ=1",
      "L0,0,0,180,0,0 T0 U2 9;J0,20,-10,0,-90,0 T0 U0 1;reach 2;" },
    /* a move keeps the value that its position had when it was asked for */
    { "SET P001 P002\nMOVL P001 V=9\nSETE P001 (1) D000\nMOVL P001 V=9",
      "L1000,100,350,180,0,0 T0 U0 9;L0,100,350,180,0,0 T0 U0 9;reach 2;" },
    /* GETE and SETE: micrometres, ten thousandths of a degree, pulses */
    { "GETE D000 P002 (2)\nGETE LD001 P001 (4)\nADD D000 LD001\nSETE P001 (1) D000\nMOVL P1 V=9",
      "L1900,0,350,180,0,0 T1 U0 9;reach 1;" },
    { "//NAME A\n//POS\n///POSTYPE PULSE\nC1=10,20,30,40,50,60\nP00300=1,2,3,4,5,6\n//INST\n"
      "SET P5 C1\nGETE D000 P300 (6)\nSETE P5 (2) D000\nMOVJ P5 VJ=2\nADD P00300 P5\n"
      "MOVJ P300 VJ=3\nSET B009 44\nSET P[B009] P300\nSET I001 300\nMOVJ P[I001] VJ=3\n"
      "MOVJ P44 VJ=4",
      "J10,6,30,40,50,60 T0 U0 2;J11,8,33,44,55,66 T0 U0 3;J11,8,33,44,55,66 T0 U0 3;"
      "J11,8,33,44,55,66 T0 U0 4;reach 4;" },
    { "//NAME A\n//POS\n///TOOL 1\n///RCONF 1,0,0,0,0,0\n///POSTYPE JOINT\nC0=-3600,2.5,0,0,0,1\n"
      "//INST\nMOVJ C0 VJ=1",
      "J-3600,2.5,0,0,0,1 T1 U0 1;reach 1;" },
    { "//NAME A\n//POS\n///POSTYPE JOINT\nC0=0,2.5,0,3601,0,1", "line 4: value out of range "
                                                                "\"3601\" (-3600 to 3600)" },
    /* GETS waits until the arm rests */
    { "MOVL P2 V=9\nGETS PX012 $PX001\nMOVL P012 V=9\nGETS PX3 $PX000\nGETE D000 PX003 (6)\n"
      "SET B000 D000\nDOUT OG#(1) B000",
      "L1000,100,350,180,0,0 T0 U0 9;reach 1;L700.5,-20.25,300,180,0,-90 T1 U0 9;reach 2;2:1=6;" },
    /* CNVRT and MSHIFT: tools and frames are those of the positions, or in force */
    { "TOOL 1\nUSER 2\nCNVRT PX010 P001 BF\nCNVRT PX[11] P[2] UF#(2)\nCNVRT P012 PX004 RF TL#(0)\n"
      "CNVRT P002 P002 BF TL#(1)\nMOVL P010 V=9\nMOVL P011 V=9\nMOVL P012 V=9\nMOVL P002 V=9",
      "L900,12,10,180,0,0 T1 U0 9;L1000,12,12,180,0,0 T1 U2 9;L0,12,0,180,0,0 T0 U0 9;"
      "L1000,12,10,180,0,0 T1 U0 9;reach 4;" },
    { "SET B001 2\nMSHIFT PX010 TF P001 P[B001]\nMSHIFT P011 UF#(2) P004 P001\nMOVL P010 V=9\n"
      "TOOL 1\nMSHIFT P002 BF P002 P002\nSETE P002 (6) 0\nMOVL P011 V=9\nMOVL P002 V=9\nSFTON P002",
      "L100,10,0,-1,0,-5.1e-05 T0 U0 9;L900,2,10,2,0,-5.1e-05 T1 U0 9;"
      "L0,10,10,0,0,0 T1 U0 9;reach 3;" },
    { "MSHIFT P010 BF P001 P020\nSET P020 P1", "1 a position that has no value yet" },
    { "MSHIFT P010 BF P020 P001\nSET P020 P1", "1 a position that has no value yet" },
    { "SET I000 1000\nMSHIFT P010 BF P001 P[I000]", "2 no such variable" },
    { "CNVRT P010 P020 BF\nSET P020 P1", "1 a position that has no value yet" },
    { "CNVRT P010 P001", "line 1: incomplete \"CNVRT P010 P001\"" },
    { "CNVRT P010 P001 PULSE", "line 1: unexpected \"PULSE\"" },
    { "CNVRT P010 P001 TF", "line 1: INFORM that this controller lacks \"TF\"" },
    { "CNVRT P010 P001 MTF", "line 1: INFORM that this controller lacks \"MTF\"" },
    { "CNVRT P010 P001 UF#(3)", "line 1: tool or user frame not in the points file \"UF#(3)\"" },
    { "CNVRT P010 P001 BF TL#(2)", "line 1: tool or user frame not in the points file \"TL#(2)\"" },
    { "CNVRT P010 P001 BF TL#(64)", "line 1: value out of range \"64\" (0 to 63)" },
    { "CNVRT P010 P001 BF TL(1)", "line 1: unexpected \"(1)\"" },
    { "CNVRT P010 P001 BF TL#(1", "line 1: incomplete \"CNVRT P010 P001 BF TL#(1\"" },
    { "CNVRT P010 P001 BF UF#(2)", "line 1: unexpected \"UF#(2)\"" },
    { "CNVRT P010 P001 BF TL#(1) 1", "line 1: unexpected \"1\"" },
    { "CNVRT P010 5 BF", "line 1: unexpected \"5\"" },
    { "CNVRT B010 P001 BF", "line 1: unexpected \"B010\"" },
    { "CNVRT LPX000 LPX001 BF", "line 1: unexpected \"LPX000\"" },
    { "MSHIFT P010 P001 P002", "line 1: unexpected \"P001\"" },
    { "MSHIFT P010 MTF P001 P002", "line 1: INFORM that this controller lacks \"MTF\"" },
    { "MSHIFT P010 BF P001", "line 1: incomplete \"MSHIFT P010 BF P001\"" },
    { "MSHIFT P010 BF P005 P001", "line 1: point not in the points file \"P005\"" },
    { "MSHIFT P010 BF P001 P002 P003", "line 1: unexpected \"P003\"" },
    /* elements of variables, those of a call, by a number, by one of them */
    { "SET B[3] 7\nSET I005 3\nSET D[I005] B[I005]\nADD D003 B003\nSET LR[9] 2.5\nMUL D003 LR009\n"
      "SET B000 D[3]\nDOUT OG#(1) B[0]\nINC B[LI000]\nSET B[B[0]] 1",
      "0:1=35;" },
    { "SET B[3] 7\nSET I005 3\nSET D[I005] B[I005]\nADD D003 B003\nSET LR[9] 2.5\nMUL D003 LR009\n"
      "SET B000 D[3]\nDOUT OG#(1) B[0]\nINC B[LI000]\nDOUT OG#(2) B000\nIF D[3]=35 AND B[I005]=7\n"
      "DOUT OT#(1) ON\nENDIF",
      "0:1=35;0:9=36;0:1=1;" },
    { "FOR B000=1 TO 3\nMOVL P[B000] V=9\nNEXT B000",
      "L900,0,350,180,0,0 T1 U0 9;L1000,100,350,180,0,0 T0 U0 9;L1100,0,350,180,0,0 T0 U0 9;"
      "reach 3;" },
    { "SET B001 2\nMOVC P[3] P[B001] V=9\nMOVC P3 V=7\nMOVC P[B001] V=7\nMOVC P[B001] V=7",
      "C1000,100,350,180,0,0 T0 U0 9 via 1100;L1100,0,350,180,0,0 T0 U0 7;"
      "C1000,100,350,180,0,0 T0 U0 7 via 1000;reach 3;" },
    /* speeds by a variable: 0.01 %, 0.1 mm/s, 0.1 deg/s */
    { "SET I000 1250\nMOVJ P000 VJ=I000\nSET I000 5\nMOVL P2 V=I000\nMOVL P2 VR=I000\n"
      "SPEED V=I000\nSET I000 9\nMOVL P2",
      "J0,-20,10,0,90,0 T0 U0 12.5;L1000,100,350,180,0,0 T0 U0 0.5;"
      "L1000,100,350,180,0,0 T0 U0 0.5;L1000,100,350,180,0,0 T0 U0 0.5;reach 4;" },
    /* IMOV: with the tool of the move before, and no shift on top */
    { "SETE P9 (1) 10000\nSFTON P9\nMOVL P1 V=9\nIMOV P9 V=8 TF\nIMOV P9 V=8\nIMOV P9 V=8 UF#(2)\n"
      "TOOL 0\nIMOV P9 V=8 BF UNTIL IN#(2)=OFF\nSETE P9 (2) 1\nMOVL P1 V=9\nSFTON P9\nMOVL P1 V=9",
      "L900,0,350,180,0,0 T1 U0 9 shift 10 0 0;L10,0,0,0,0,0 T1 U0 8 by -1;"
      "L10,0,0,0,0,0 T1 U0 8 by 0;L10,0,0,0,0,0 T1 U0 8 by 2;"
      "L10,0,0,0,0,0 T0 U0 8 by 0 until 1 0;reach 5;L900,0,350,180,0,0 T1 U0 9 shift 10 0 0;"
      "L900,0,350,180,0,0 T1 U0 9 shift 10 0.001 0;reach 7;" },
    /* UNTIL: what follows waits for its end; what NWAIT lets come with it does not */
    { "MOVL P1 V=9 UNTIL IN#(3)=ON\nDOUT OT#(1) ON\nMOVL P2 V=9",
      "L900,0,350,180,0,0 T1 U0 9 until 2 1;reach 1;1:1=1;L1000,100,350,180,0,0 T0 U0 9;reach 2;" },
    { "SET I000 100\nMOVL P1 V=9 NWAIT UNTIL IN#(3)=ON ACC=50 DEC=I000\nDOUT OT#(1) ON\nINC B000\n"
      "MOVL P2 V=9",
      "L900,0,350,180,0,0 T1 U0 9 until 2 1 ramps 50 100;0:1=1;reach 1;L1000,100,350,180,0,0 T0 U0 "
      "9;reach 2;" },
    /* shares of the accelerations, of the third line of an arc */
    { "SET B004 20\nMOVJ P0 VJ=5 DEC=B[4]\nMOVL P1 V=9\nMOVC P1 V=9 ACC=99\nMOVC P2 V=9 ACC=I7 "
      "DEC=30.5\nMOVC P3 V=9 DEC=30.5 ACC=I7",
      "J0,-20,10,0,90,0 T0 U0 5 ramps 100 20;L900,0,350,180,0,0 T1 U0 9;"
      "L900,0,350,180,0,0 T1 U0 9 ramps 99 100;6 result out of range" },
    { "SET I007 100\nMOVL P1 V=9 ACC=I7\nINC I7\nMOVL P1 V=9 DEC=I007",
      "L900,0,350,180,0,0 T1 U0 9;4 result out of range" },
    { "MOVC P1 V=9\nMOVC P2 V=9 ACC=50\nMOVC P3 V=9 ACC=51",
      "line 3: via and end with different speeds \"MOVC P3 V=9 ACC=51\" (line 2)" },
    { "MOVL P1 ACC=50 ACC=50", "line 1: given twice \"ACC\"" },
    { "MOVL P1 ACC=50 DEC=100.5", "line 1: value out of range \"100.5\" (20 to 100)" },
    /* one or two MOVS are lines; more are a curve from the first on, whatever moves the points */
    { "MOVS P2 V=9\nMOVL P4 V=9\nMOVS P2 V=8\nMOVS P4 V=7",
      "L1000,100,350,180,0,0 T0 U0 9;L0,0,0,180,0,0 T0 U2 9;L1000,100,350,180,0,0 T0 U0 8;"
      "L0,0,0,180,0,0 T0 U2 7;reach 4;" },
    { "MOVS P2 V=9\nMOVS P4 V=8\nMOVS P2 V=7",
      "L1000,100,350,180,0,0 T0 U0 9;S0,0,0,180,0,0 T0 U2 8 next 1000 U0;"
      "S1000,100,350,180,0,0 T0 U0 7;reach 3;" },
    { "SET B001 4\nMOVS P2 V=9\nMOVS P3 V=8 PL=3\nMOVS P[B001] VR=7 ACC=50\nMOVS P2 V=6\n"
      "NOP\nMOVS P3 V=5",
      "L1000,100,350,180,0,0 T0 U0 9;S1100,0,350,180,0,0 T0 U0 8 next 0 U2;"
      "S0,0,0,180,0,0 T0 U2 7 next 1000 U0 ramps 50 100;S1000,100,350,180,0,0 T0 U0 6;"
      "L1100,0,350,180,0,0 T0 U0 5;reach 5;" },
    /* a point with another tool begins a curve anew; a point without a value shows where it is */
    { "MOVS P2 V=9\nMOVS P3 V=8\nMOVS P1 V=7\nMOVS P1 V=6",
      "L1000,100,350,180,0,0 T0 U0 9;S1100,0,350,180,0,0 T0 U0 8;"
      "S900,0,350,180,0,0 T1 U0 7 next 900 U0;S900,0,350,180,0,0 T1 U0 6;reach 4;" },
    { "SET B001 100\nMOVS P2 V=9\nMOVS P3 V=8\nMOVS P[D000] V=7\nMOVS B[B001] V=7",
      "line 5: unexpected \"B[B001]\"" },
    { "SET I001 -1\nMOVS P2 V=9\nMOVS P3 V=8\nMOVS P[I001] V=7",
      "L1000,100,350,180,0,0 T0 U0 9;S1100,0,350,180,0,0 T0 U0 8;4 no such variable" },
    { "MOVS P1 VJ=9", "line 1: operand of the wrong kind \"VJ=9\"" },
    { "MOVS P1 P2 V=9", "line 1: unknown word \"P2\"" },
    /* stopped by numbers */
    { "MOVL P5 V=9\nSETE P[B000] (1) 1", "1 a position that has no value yet" },
    { "MOVL P2 V=9\nSET B000 7\nMOVL P[B000] V=9",
      "L1000,100,350,180,0,0 T0 U0 9;3 a position that has no value yet" },
    { "SET P7 P5\nSET P5 P1", "1 a position that has no value yet" },
    { "SET B000 100\nSET B[B000] 1", "2 no such variable" },
    { "SET B000 100\nSET B001 I[B000]", "2 no such variable" },
    { "SET I000 -1\nMOVL P[I000] V=9", "2 no such variable" },
    { "SET LI0 10\nIF LB[LI0]=0\nENDIF", "2 no such variable" },
    { "ADD P1 P0", "1 positions of two kinds" },
    { "IMOV P0 V=9 TF", "1 a shift or increment of the wrong kind" },
    { "SETE P3 (4) 1\nSFTON P3", "2 a shift or increment of the wrong kind" },
    { "MOVL P2 V=B000", "1 result out of range" },
    { "SPEED VJ=B000", "1 result out of range" },
    { "SETE P2 (1) 2147483647\nADD P2 P2", "2 result out of range" },
    { "FOR I000=0 TO 200\nSET P[I000] P1\nNEXT I000", "2 more than 128 positions are changed" },
    /* refused */
    { "MOVL P5 V=9\nSET P6 P2", "line 1: point not in the points file \"P5\"" },
    { "SET P1000 P1", "line 1: value out of range \"P1000\" (0 to 999)" },
    { "SET P1 5", "line 1: unexpected \"5\"" },
    { "SET P1 B000", "line 1: unexpected \"B000\"" },
    { "MUL P1 P2", "line 1: operand of the wrong kind \"P1\"" },
    { "SET P[1000] P1", "line 1: value out of range \"1000\" (0 to 999)" },
    { "SET P[R000] P1", "line 1: operand of the wrong kind \"R000\"" },
    { "SET B[100] 1", "line 1: value out of range \"100\" (0 to 99)" },
    { "SET LB[10] 1", "line 1: value out of range \"10\" (0 to 9)" },
    { "SET B[1 1", "line 1: unexpected \"1\"" },
    { "SET B[B[I000]] 1", "line 1: unexpected \"]\"" },
    { "SETE P1 (7) 1", "line 1: value out of range \"7\" (1 to 6)" },
    { "SETE P1 3 1", "line 1: unexpected \"3\"" },
    { "SETE P1 (3) 0.5", "line 1: no whole number \"0.5\"" },
    { "SETE P1 (3) B000", "line 1: operand of the wrong kind \"B000\"" },
    { "GETE B000 P1 (3)", "line 1: operand of the wrong kind \"B000\"" },
    { "GETE D000 P1", "line 1: incomplete \"GETE D000 P1\"" },
    { "GETS B000 $B002", "line 1: INFORM that this controller lacks \"GETS B000 $B002\"" },
    { "GETS PX001 $PX002", "line 1: INFORM that this controller lacks \"PX002\"" },
    { "IMOV P1 V=9 TF VJ=5", "line 1: given twice \"VJ\"" },
    { "IMOV C5 V=9", "line 1: position not in this job \"C5\"" },
    { "MOVL P1 V=9 TF", "line 1: unknown word \"TF\"" },
    { "MOVJ LP000 VJ=9", "line 1: INFORM that this controller lacks \"LP000\"" },
    { "MOVL P1 UNTIL B000=1", "line 1: operand of the wrong kind \"B000\"" },
    { "MOVL P1 UNTIL IN#(1)<>ON", "line 1: unexpected \"<>ON\"" },
    { "MOVL P1 UNTIL IN#(1)=ON UNTIL IN#(1)=ON", "line 1: given twice \"UNTIL\"" },
    { "MOVC P1\nMOVC P2 UNTIL IN#(1)=ON\nMOVC P3", "line 3: via and end with different UNTIL "
                                                   "\"MOVC P3\" (line 2)" },
    { "MOVL P1 ACC=19", "line 1: value out of range \"19\" (20 to 100)" },
    { "MOVL P1 V=R000", "line 1: operand of the wrong kind \"R000\"" },
};

/* Where the arm is, is asked for by GETS, once for each, and by nothing that waits. */
static void asked_by_gets(void)
{
    asked = 0;
    run_text("MOVL P2 V=9\nWAIT IN#(1)=OFF\nGETS PX1 $PX000\nLOOP 3\n"
             "GETS PX2 $PX001\nENDLOOP\nSET P3 P2\nTIMER T=1");
    CHECK_EQ(asked, 4);
}

/* A position may come with a job that is read later. */
static void later_text(void)
{
    static const char first[] = "//NAME A\n MOVJ P500 VJ=5\nCALL JOB:B\n",
                      second[] = "//NAME B\n//POS\nP500=1,2,3,4,5,6\n//INST\nEND\n";
    struct robot_job_inputs in = { 0 };
    struct robot_job_request r;
    CHECK_EQ(robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, POINTS, (int64_t)strlen(POINTS),
                                   &report),
             0);
    robot_job_begin_reading(&program);
    CHECK_EQ(robot_job_read_text(&program, &points, first, (int64_t)strlen(first), &report), 0);
    program.callees = 0;
    CHECK_EQ(robot_job_end_reading(&program, &report), -1);
    CHECK(report.fault == ROBOT_JOB_BAD_POINT && report.line == 2 && report.column == 7);
    program.callees = 1;
    CHECK_EQ(robot_job_read_text(&program, &points, second, (int64_t)strlen(second), &report), 0);
    CHECK_EQ(robot_job_end_reading(&program, &report), 0);
    robot_job_begin(&run, &program, &START);
    robot_job_next(&run, &program, &points, &in, 100, &r);
    CHECK(r.answer == ROBOT_JOB_MOVE
          && robot_job_place(&run, &program, &points, r.point)->value[5] == 6.0);
}

int main(void)
{
    for (size_t i = 0; i < sizeof GOOD / sizeof *GOOD; i++) {
        CHECK_TEXT(run_text(GOOD[i].text), GOOD[i].trace);
    }
    asked_by_gets();
    later_text();
    return check_result();
}
