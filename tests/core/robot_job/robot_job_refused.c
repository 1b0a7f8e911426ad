/* Every way in which a program can be wrong, with the whole message. */
#include "robot_job_given.h"

static const struct {
    const char *text, *message;
} BAD[] = {
    { "MOVX P000", "line 1: unknown word \"MOVX\"" },
    { "NOP\n\n ' a comment\nMOVJ P000 VJ=50 FAST", "line 4: unknown word \"FAST\"" },
    { "SET B000 X12", "line 1: unknown word \"X12\"" },
    { "SET B B001", "line 1: unknown word \"B\"" },
    { "INC B00X", "line 1: unknown word \"B00X\"" },
    { "NOP\r\nMOVJ", "line 2: incomplete \"MOVJ\"" },
    { "MOVJ P000 VJ", "line 1: incomplete \"MOVJ P000 VJ\"" },
    { "MOVJ P000 VJ=", "line 1: incomplete \"MOVJ P000 VJ=\"" },
    { "WAIT IN#(1)", "line 1: incomplete \"WAIT IN#(1)\"" },
    { "WAIT IN#(1)=", "line 1: incomplete \"WAIT IN#(1)=\"" },
    { "WAIT IN#(1)=ON T", "line 1: incomplete \"WAIT IN#(1)=ON T\"" },
    { "DOUT OT#(1)", "line 1: incomplete \"DOUT OT#(1)\"" },
    { "DOUT OT#(1", "line 1: incomplete \"DOUT OT#(1\"" },
    { "DIN B000", "line 1: incomplete \"DIN B000\"" },
    { "JUMP", "line 1: incomplete \"JUMP\"" },
    { "CALL JOB:", "line 1: incomplete \"CALL JOB:\"" },
    { "JOB", "line 1: incomplete \"JOB\"" },
    { "//NAME", "line 1: incomplete \"//NAME\"" },
    { "TIMER", "line 1: incomplete \"TIMER\"" },
    { "SPEED", "line 1: incomplete \"SPEED\"" },
    { "TOOL", "line 1: incomplete \"TOOL\"" },
    { "*", "line 1: incomplete \"*\"" },
    { "IF", "line 1: incomplete \"IF\"" },
    { "IF B000 JUMP *A", "line 1: unexpected \"JUMP\"" },
    { "SET B000", "line 1: incomplete \"SET B000\"" },
    { "AOUT AO#(1)", "line 1: incomplete \"AOUT AO#(1)\"" },
    { "MOVJ VJ=50.00", "line 1: unexpected \"VJ=50.00\"" },
    { "MOVJ C00000 VJ=50.00", "line 1: position not in this job \"C00000\"" },
    { "MOVJ P000 + VJ=50.00", "line 1: unexpected \"+\"" },
    { "MOVJ P000 P001", "line 1: unknown word \"P001\"" },
    { "MOVL P000 V=fast", "line 1: unknown word \"fast\"" },
    { "MOVL P000 V=1e2", "line 1: unknown word \"e2\"" },
    { "NOP NOP", "line 1: unexpected \"NOP\"" },
    { "END END", "line 1: unexpected \"END\"" },
    { "ELSE B000=1", "line 1: does not end what is open \"ELSE B000=1\"" },
    { "LABEL A B", "line 1: unexpected \"B\"" },
    { "JOB A B", "line 1: unexpected \"B\"" },
    { "JUMP *A UNLESS B000=1\n*A", "line 1: unexpected \"UNLESS\"" },
    { "CALL SUB", "line 1: unexpected \"SUB\"" },
    { "DOUT IN#(1) ON", "line 1: unexpected \"IN#(1)\"" },
    { "DOUT OT#(1) 1", "line 1: unexpected \"1\"" },
    { "DOUT OT#(1) OPEN", "line 1: unexpected \"OPEN\"" },
    { "DOUT OT(1) ON", "line 1: unexpected \"(1)\"" },
    { "AOUT OT#(1) 1", "line 1: unexpected \"OT#(1)\"" },
    { "TIMER 0.5", "line 1: unexpected \"0.5\"" },
    { "WAIT IN#(1)=ON 2.0", "line 1: unexpected \"2.0\"" },
    { "WAIT (IN#(1)=ON T=1", "line 1: unexpected \"T=1\"" },
    { "TOOL UF#(1)", "line 1: unexpected \"UF#(1)\"" },
    { "TOOL TL#(1", "line 1: incomplete \"TOOL TL#(1\"" },
    { "SPEED PL=1", "line 1: unexpected \"PL=1\"" },
    { "PL", "line 1: incomplete \"PL\"" },
    { "(NOP)", "line 1: unexpected \"(NOP)\"" },
    { "/MOVJ", "line 1: unexpected \"/MOVJ\"" },
    { "123 NOP", "line 1: unexpected \"123\"" },
    { "MOVL P001 V=10 V=20", "line 1: given twice \"V\"" },
    { "MOVL P001 V=10 VR=20", "line 1: given twice \"VR\"" },
    { "MOVL P001 PL=1 PL=2", "line 1: given twice \"PL\"" },
    { "MOVL P001 PL=1 CR=5", "line 1: given twice \"CR\"" },
    { "SPEED V=10 V=20", "line 1: given twice \"V\"" },
    { "MOVL P001 V=1234567.1234567890", "line 1: number with more than 15 digits "
                                        "\"1234567.1234567890\"" },
    { "MOVJ P000 PL=1.5", "line 1: no whole number \"1.5\"" },
    { "LOOP 2.5", "line 1: no whole number \"2.5\"" },
    { "SET B000 1.5", "line 1: no whole number \"1.5\"" },
    { "ADD D000 0.5", "line 1: no whole number \"0.5\"" },
    { "DOUT OT#(1.5) ON", "line 1: no whole number \"1.5\"" },
    { "NOP\nMOVJ P000 VJ=100.01", "line 2: value out of range \"100.01\" (0.01 to 100)" },
    { "MOVJ P000 VJ=0", "line 1: value out of range \"0\" (0.01 to 100)" },
    { "MOVL P001 V=0.05", "line 1: value out of range \"0.05\" (0.1 to 10000)" },
    { "MOVL P001 V=-10", "line 1: value out of range \"-10\" (0.1 to 10000)" },
    { "MOVL P001 VR=1001", "line 1: value out of range \"1001\" (0.1 to 1000)" },
    { "MOVL P001 PL=9", "line 1: value out of range \"9\" (0 to 8)" },
    { "PL 9", "line 1: value out of range \"9\" (0 to 8)" },
    { "MOVL P001 CR=6553.6", "line 1: value out of range \"6553.6\" (0.1 to 6553.5)" },
    { "SPEED VJ=101", "line 1: value out of range \"101\" (0.01 to 100)" },
    { "DOUT OT#(33) ON", "line 1: value out of range \"33\" (1 to 32)" },
    { "WAIT IN#(0)=ON", "line 1: value out of range \"0\" (1 to 32)" },
    { "AOUT AO#(9) 1", "line 1: value out of range \"9\" (1 to 8)" },
    { "AOUT AO#(1) 10.5", "line 1: value out of range \"10.5\" (-10 to 10)" },
    { "AIN R000 AI#(9)", "line 1: value out of range \"9\" (1 to 8)" },
    { "SET B100 1", "line 1: value out of range \"B100\" (0 to 99)" },
    { "SET B000 256", "line 1: value out of range \"256\" (0 to 255)" },
    { "SET I000 -32769", "line 1: value out of range \"-32769\" (-32768 to 32767)" },
    { "SET D000 2147483648", "line 1: value out of range \"2147483648\" (-2147483648 to "
                             "2147483647)" },
    { "TIMER T=655.36", "line 1: value out of range \"655.36\" (0 to 655.35)" },
    { "WAIT IN#(1)=ON T=-1", "line 1: value out of range \"-1\" (0 to 655.35)" },
    { "LOOP -1", "line 1: value out of range \"-1\" (0 to 2147483647)" },
    { "TOOL 64", "line 1: value out of range \"64\" (0 to 63)" },
    { "MOVJ P099", "line 1: point not in the points file \"P099\"" },
    { "MOVJ P1000", "line 1: point not in the points file \"P1000\"" },
    { "MOVC P001 P005", "line 1: point not in the points file \"P005\"" },
    { "TOOL 3", "line 1: tool or user frame not in the points file \"3\"" },
    { "USER UF#(1)", "line 1: tool or user frame not in the points file \"UF#(1)\"" },
    { "NOP\nCALL JOB:SUB\nEND\nJOB SUP", "line 2: no such job \"SUB\"" },
    { "JUMP JOB:A", "line 1: no such job \"A\"" },
    { "NOP\nJUMP *OUT IF B000=1\n*OUT1", "line 2: no such label in this job \"OUT\"" },
    { "JUMP *A\nJOB B\n*A", "line 1: no such label in this job \"A\"" },
    { "JOB A\nNOP\nJOB A", "line 3: second job of this name \"A\" (line 1)" },
    { "NOP\nJOB MAIN", "line 2: second job of this name \"MAIN\" (line 1)" },
    { "*A\nNOP\nLABEL A", "line 3: second label of this name in the job \"A\" (line 1)" },
    { "JUMP *A\nLOOP 3\n*A\nENDLOOP", "line 1: jump into a LOOP \"A\" (line 2)" },
    { "LOOP 2\nJUMP A\nENDLOOP\nLOOP 3\nLABEL *A\nENDLOOP", "line 2: jump into a LOOP \"A\" "
                                                            "(line 4)" },
    { "ENDIF", "line 1: does not end what is open \"ENDIF\"" },
    { "ELSE", "line 1: does not end what is open \"ELSE\"" },
    { "LOOP\nELSEIF B000=1\nENDLOOP", "line 2: does not end what is open \"ELSEIF B000=1\" "
                                      "(line 1)" },
    { "IF B000=1\nENDLOOP", "line 2: does not end what is open \"ENDLOOP\" (line 1)" },
    { "LOOP 2\nENDWHILE", "line 2: does not end what is open \"ENDWHILE\" (line 1)" },
    { "NOP\nIF B000=1\nNOP\n", "line 2: has no end \"IF B000=1\" (line 3)" },
    { "LOOP 4 ' four\nEND", "line 1: has no end \"LOOP 4\" (line 2)" },
    { "JOB A\nWHILE B000=1\nJOB B\nENDWHILE", "line 2: has no end \"WHILE B000=1\" (line 2)" },
    { "IF B000=1\nELSE\nELSE\nENDIF", "line 3: behind ELSE \"ELSE\" (line 2)" },
    { "IF B000=1\nELSE\nELSEIF B000=2\nENDIF", "line 3: behind ELSE \"ELSEIF B000=2\" (line 2)" },
    { "END\nNOP", "line 2: behind END \"NOP\" (line 1)" },
    { "END\n*A", "line 2: behind END \"*A\" (line 1)" },
    { "JUMP *ABCDEFGHIJABCDEFGHIJABCDEFGHIJABC",
      "line 1: name too long "
      "\"ABCDEFGHIJABCDEFGHIJABCDEFGHIJABC\" (at most 32)" },
    { "MOVC P001\nMOVC P002\nNOP", "line 2: MOVC of one point: three in a row, start, via, end "
                                   "\"MOVC P002\"" },
    { "MOVC P001", "line 1: MOVC of one point: three in a row, start, via, end \"MOVC P001\"" },
    { "MOVC P001\nMOVC P002\n*A\nMOVC P003", "line 2: MOVC of one point: three in a row, start, "
                                             "via, end \"MOVC P002\"" },
    { "MOVC P001\nJOB B", "line 1: MOVC of one point: three in a row, start, via, end "
                          "\"MOVC P001\"" },
    { "MOVC P001\nMOVC P002\nMOVC P003\nMOVC P002", "line 4: MOVC of one point: three in a row, "
                                                    "start, via, end \"MOVC P002\"" },
    { "MOVC P001\nMOVC P002 P003", "line 1: MOVC of one point: three in a row, start, via, end "
                                   "\"MOVC P001\"" },
    { "MOVC P001\nMOVC P002 V=10\nMOVC P003 V=11", "line 3: via and end with different speeds "
                                                   "\"MOVC P003 V=11\" (line 2)" },
    { "MOVC P001 P002", "line 1: via and end with different tools or user frames "
                        "\"MOVC P001 P002\"" },
    { "MOVC P001\nMOVC P002\nMOVC P004", "line 3: via and end with different tools or user "
                                         "frames \"MOVC P004\"" },
    { "MOVJ P000 V=10", "line 1: operand of the wrong kind \"V=10\"" },
    { "MOVL P001 VJ=10.00", "line 1: operand of the wrong kind \"VJ=10.00\"" },
    { "SET IN#(1) 1", "line 1: operand of the wrong kind \"IN#(1)\"" },
    { "SET B000 IN#(1)", "line 1: operand of the wrong kind \"IN#(1)\"" },
    { "SET 5 B000", "line 1: operand of the wrong kind \"5\"" },
    { "DIN B000 1", "line 1: operand of the wrong kind \"1\"" },
    { "DIN R000 IN#(1)", "line 1: operand of the wrong kind \"R000\"" },
    { "AIN B000 AI#(1)", "line 1: operand of the wrong kind \"B000\"" },
    { "INC R000", "line 1: operand of the wrong kind \"R000\"" },
    { "LOOP R000", "line 1: operand of the wrong kind \"R000\"" },
    { "WAIT 1=1", "line 1: operand of the wrong kind \"1\"" },
    { "WAIT B000=IN#(1)", "line 1: operand of the wrong kind \"IN#(1)\"" },
    { "WAIT IN#(1)>OFF", "line 1: IN# and OT# compare by = or <> with ON or OFF "
                         "\"WAIT IN#(1)>OFF\"" },
    { "RET IF OT#(1)=1", "line 1: IN# and OT# compare by = or <> with ON or OFF "
                         "\"RET IF OT#(1)=1\"" },
    { "", "no instruction" },
    { "\n ' nothing\n", "line 2: no instruction" },
    { "// only\n", "line 1: no instruction" },
};

static void refused(void)
{
    bool seen[ROBOT_JOB_FAULT_COUNT] = { false };
    for (size_t i = 0; i < sizeof BAD / sizeof *BAD; i++) {
        CHECK_EQ(read_program(BAD[i].text), -1);
        CHECK_TEXT(message, BAD[i].message);
        seen[report.fault] = true;
    }
    for (int f = ROBOT_JOB_BAD_WORD; f < ROBOT_JOB_BAD_EMPTY; f++) {
        if (!seen[f] && (f < ROBOT_JOB_BAD_POINT_TWICE || f > ROBOT_JOB_BAD_POINT_FRAME)) {
            printf("fault %d is in no test\n", f);
            CHECK(false);
        }
    }
    for (int f = 0; f < ROBOT_JOB_FAULT_COUNT; f++) {
        CHECK(robot_job_fault_text((enum robot_job_fault)f)[0]);
    }
}

/* Where in the text: the column, and the bytes. */
static void places(void)
{
    static const char text[] = "NOP\n\tMOVJ P000 VJ=50 PL=77\n";
    CHECK_EQ(read_program(text), -1);
    CHECK_EQ(report.line, 2);
    CHECK_EQ(report.column, 21);
    CHECK(report.length == 2 && !memcmp(text + report.offset, "77", 2));
    CHECK_EQ(read_program("X"), -1);
    CHECK_EQ(report.column, 1);
    CHECK_EQ(read_program(" X"), -1);
    CHECK_EQ(report.column, 2);
    CHECK_EQ(read_program("\nX"), -1);
    CHECK_EQ(report.column, 1);
    CHECK_EQ(read_program("NOP\n \tCALL JOB:SUB"), -1); /* found when all has been read */
    CHECK(report.line == 2 && report.column == 12 && report.offset == 15);
}

/* Bytes and lengths that are no text. */
static void shapes(void)
{
    static char text[ROBOT_JOB_TEXT_MAX + 1];
    struct robot_job_report r;
    memset(text, ' ', sizeof text);
    CHECK_EQ(robot_job_read(&program, &points, "NOP\nN\0P", 7, &r), -1);
    robot_job_message(&r, "NOP\nN\0P", message);
    CHECK_TEXT(message, "line 2: byte 0, which no text has, behind \"N\"");
    memcpy(text, "NOP", 3);
    memcpy(text + 256, "\r\nNOP", 5);
    CHECK_EQ(robot_job_read(&program, &points, text, 300, &r), 0);
    memcpy(text + 256, " \n", 2);
    CHECK_EQ(robot_job_read(&program, &points, text, 300, &r), -1);
    CHECK_EQ(r.fault, ROBOT_JOB_BAD_LINE_LENGTH);
    CHECK_EQ(r.line, 1);
    robot_job_message(&r, text, message);
    CHECK(strstr(message, "line too long \"NOP   ") && strstr(message, "\" (at most 256)"));
    CHECK_EQ(robot_job_read(&program, &points, text, ROBOT_JOB_TEXT_MAX + 1, &r), -1);
    robot_job_message(&r, text, message);
    CHECK_TEXT(message, "text too long (at most 4194304)");
}

/* Texts of n lines and of one line more. */
static void limits(void)
{
    static const struct {
        const char *head, *line; /* a # in the line is its number */
        int most;
        const char *tail, *message;
    } LIMIT[] = {
        { "", "NOP", ROBOT_JOB_INSTRUCTIONS - 1, "",
          "line 16384: too many \"NOP\" (at most 16384)" },
        { "", "JOB A#", ROBOT_JOB_JOBS, "", "line 65: too many \"JOB A65\" (at most 64)" },
        { "", "*A#", ROBOT_JOB_LABELS, "", "line 1025: too many \"*A1025\" (at most 1024)" },
        { "", "IF B000=1", ROBOT_JOB_BLOCKS, "ENDIF\n",
          "line 17: too many \"IF B000=1\" (at most 16)" },
        { "", "LOOP", ROBOT_JOB_LOOPS, "ENDLOOP\n", "line 9: too many \"LOOP\" (at most 8)" },
    };
    static char text[1 << 17];
    for (size_t k = 0; k < sizeof LIMIT / sizeof *LIMIT; k++) {
        for (int more = 0; more < 2; more++) {
            const int n = LIMIT[k].most + more;
            int at = snprintf(text, sizeof text, "%s", LIMIT[k].head);
            for (int i = 1; i <= n; i++) {
                const char *mark = strchr(LIMIT[k].line, '#');
                at += mark ? snprintf(text + at, sizeof text - (size_t)at, "%.*s%d\n",
                                      (int)(mark - LIMIT[k].line), LIMIT[k].line, i)
                           : snprintf(text + at, sizeof text - (size_t)at, "%s\n", LIMIT[k].line);
            }
            for (int i = 1; i <= n; i++) {
                at += snprintf(text + at, sizeof text - (size_t)at, "%s", LIMIT[k].tail);
            }
            CHECK_EQ(read_program(text), more ? -1 : 0);
            if (more) {
                CHECK_TEXT(message, LIMIT[k].message);
            }
        }
    }
}

/* The end of a job needs an instruction, too: where there is none left is told by the last line. */
static void full_at_the_end(void)
{
    static char text[1 << 17];
    int at = 0;
    for (int i = 0; i < ROBOT_JOB_INSTRUCTIONS; i++) {
        at += snprintf(text + at, sizeof text - (size_t)at, "NOP\n");
    }
    snprintf(text + at, sizeof text - (size_t)at, "\n  JOB B\n");
    CHECK_EQ(read_program(text), -1);
    CHECK_TEXT(message, "line 16384: too many \"NOP\" (at most 16384)");
    CHECK(report.column == 1 && report.offset == at - 4);
}

int main(void)
{
    refused();
    full_at_the_end();
    places();
    shapes();
    limits();
    return check_result();
}
