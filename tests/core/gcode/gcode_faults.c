/* Every way in which a part program can be wrong: which fault, in which line, at which text. */
#include "gcode_reader.h"

static void faults(void)
{
    static const struct { const char *text; int line; const char *at; enum fault fault; } bad[] = {
        { "G1 X1\nY2 Q3", 2, "Q3", FAULT_WORD },
        { "G1 X1 A5", 1, "A5", FAULT_WORD },
        { "G5 X1", 1, "G5", FAULT_WORD },
        { "G1.5 X1", 1, "G1.5", FAULT_WORD },
        { "G-1 X1", 1, "G-1", FAULT_WORD },
        { "G9999999 X1", 1, "G9999999", FAULT_WORD },
        { "G61.1", 1, "G61.1", FAULT_WORD },
        { "M6", 1, "M6", FAULT_WORD },
        { "\n\nG1 X1 $", 3, "$", FAULT_CHARACTER },
        { "G1 X1 / Y2", 1, "/", FAULT_CHARACTER },
        { "%%", 1, "%", FAULT_CHARACTER },
        { "G1 X", 1, "X", FAULT_NUMBER },
        { "G1 X. Y1", 1, "X.", FAULT_NUMBER },
        { "G1 X-Y1", 1, "X-", FAULT_NUMBER },
        { "G1 X1.2.3", 1, ".", FAULT_CHARACTER },
        { "G1 X1e3", 1, "e3", FAULT_WORD },
        { "G1 X12345678901234567", 1, "X12345678901234567", FAULT_DIGITS },
        { "G1 X1 (open", 1, "(open", FAULT_COMMENT },
        { "G1 X1 x 2", 1, "x 2", FAULT_TWICE },
        { "N1 N2", 1, "N2", FAULT_TWICE },
        { "N-1", 1, "N-1", FAULT_VALUE },
        { "G0 G1 X1", 1, "G1", FAULT_GROUP },
        { "G17 G18", 1, "G18", FAULT_GROUP },
        { "G4 P1 G53", 1, "G53", FAULT_GROUP },
        { "M2 M30", 1, "M30", FAULT_GROUP },
        { "M0 M1", 1, "M1", FAULT_GROUP },
        { "M3 S100\nM3 M4", 2, "M4", FAULT_GROUP },
        { "M7 M8", 1, "M8", FAULT_GROUP },
        { "M62 P1 M65", 1, "M65", FAULT_GROUP },
        { "G92 X0 G92.1", 1, "G92.1", FAULT_GROUP },
        { "M3 M8 M64 M0 M9 P1", 1, "M9", FAULT_M_COUNT },
        { "M3.1", 1, "M3.1", FAULT_WORD },
        { "T1", 1, "T1", FAULT_WORD },
        { "S-1", 1, "S-1", FAULT_VALUE },
        { "M62", 1, "M62", FAULT_NO_OUTPUT },
        { "G1 X1 M64", 1, "M64", FAULT_NO_OUTPUT },
        { "M65 P32", 1, "P32", FAULT_VALUE },
        { "M65 P-1", 1, "P-1", FAULT_VALUE },
        { "M63 P0.5", 1, "P0.5", FAULT_VALUE },
        { "M64 P1 G4", 1, "M64", FAULT_SHARED },
        { "G10 L2 P1 X0 M62", 1, "M62", FAULT_SHARED },
        { "G2 I5 P2 M62", 1, "P2", FAULT_SHARED },
        { "G64 P0.1 M62", 1, "G64", FAULT_SHARED },
        { "G4 G64 P0.1", 1, "G64", FAULT_SHARED },
        { "G64 G2 I5 P2", 1, "G64", FAULT_SHARED },
        { "G64 P-1", 1, "P-1", FAULT_VALUE },
        { "G61 P1", 1, "P1", FAULT_UNUSED },
        { "G1 G92 X0", 1, "G1", FAULT_SHARED },
        { "G28 G0 X0", 1, "G0", FAULT_SHARED },
        { "G52 X0 G3", 1, "G3", FAULT_SHARED },
        { "G10 P1 X0", 1, "G10 P1 X0", FAULT_NO_SYSTEM },
        { "G10 L2 X0", 1, "G10 L2 X0", FAULT_NO_SYSTEM },
        { "G10 L20 P1 X0", 1, "L20", FAULT_VALUE },
        { "G10 L2 P7 X0", 1, "P7", FAULT_VALUE },
        { "G10 L2 P1.5 X0", 1, "P1.5", FAULT_VALUE },
        { "G10 L2 P1 X0 R5", 1, "R5", FAULT_UNUSED },
        { "G10 L2 P1", 1, "G10 L2 P1", FAULT_NO_AXES },
        { "G92", 1, "G92", FAULT_NO_AXES },
        { "G92 V1", 1, "V1", FAULT_AXIS },
        { "G52 X1 P1", 1, "P1", FAULT_UNUSED },
        { "G28 W0", 1, "W0", FAULT_AXIS },
        { "G28 X0 I1", 1, "I1", FAULT_UNUSED },
        { "G1 X1 L2", 1, "L2", FAULT_UNUSED },
        { "G92.1 X1", 1, "X1", FAULT_NO_MOTION },
        { "G92 X-900000\nG1 X0 Y0", 2, "G1 X0 Y0", FAULT_RANGE },
        { "M3\n\n%\nG1 X1\nG0 X5 G1", 5, "G1", FAULT_GROUP },
        { "//G1 X1", 1, "/", FAULT_CHARACTER },
        { "X1", 1, "X1", FAULT_NO_MOTION },
        { "G1 X1\nG80 Y1", 2, "Y1", FAULT_NO_MOTION },
        { "G1 X1 I1", 1, "I1", FAULT_UNUSED },
        { "G1 X1 P1", 1, "P1", FAULT_UNUSED },
        { "R1", 1, "R1", FAULT_UNUSED },
        { "G1 X1 F0", 1, "F0", FAULT_VALUE },
        { "G1 X1 F0.00000005", 1, "F0.00000005", FAULT_VALUE },
        { "G1 X1 F-5", 1, "F-5", FAULT_VALUE },
        { "F60000.1", 1, "F60000.1", FAULT_FEED },
        { "G20 F2363", 1, "F2363", FAULT_FEED },
        { "G4", 1, "G4", FAULT_NO_DWELL },
        { "G4 P-1", 1, "P-1", FAULT_VALUE },
        { "G1 X1\nG4 P1 X2", 2, "X2", FAULT_UNUSED },
        { "G53", 1, "G53", FAULT_NO_AXES },
        { "G53 X1", 1, "G53 X1", FAULT_G53 },
        { "G1 U1", 1, "U1", FAULT_AXIS },
        { "G1 X1 Y0 F30001", 1, "G1 X1 Y0 F30001", FAULT_SPEED },
        { "G1 X900000", 1, "G1 X900000", FAULT_RANGE },
        { "G1 Z700\nG91 G1 Z0.1", 2, "G91 G1 Z0.1", FAULT_TRAVEL },
        { "G0 Z700.1", 1, "G0 Z700.1", FAULT_TRAVEL },
        { "G18 G1 Z650.1\nG3 Z650.1 X100 R50", 2, "G3 Z650.1 X100 R50", FAULT_TRAVEL },
        { "G28 Z-701", 1, "G28 Z-701", FAULT_TRAVEL },
        { "G1 X99 (to the start)\nG2 X1 Y1", 2, "G2 X1 Y1", FAULT_NO_CENTRE },
        { "G2", 1, "G2", FAULT_NO_CENTRE },
        { "G90.1 G2 X1 I1", 1, "G90.1 G2 X1 I1", FAULT_NO_CENTRE },
        { "G2 X1 I1 R1", 1, "G2 X1 I1 R1", FAULT_CENTRE_AND_R },
        { "G2 X1 K1", 1, "K1", FAULT_UNUSED },
        { "G18 G2 X1 J1", 1, "J1", FAULT_UNUSED },
        { "G2 X1 I0 J0", 1, "G2 X1 I0 J0", FAULT_ARC_RADIUS },
        { "G2 X10 Y0 I6", 1, "G2 X10 Y0 I6", FAULT_ARC_END },
        { "G2 X10 R4.9", 1, "G2 X10 R4.9", FAULT_ARC_CHORD },
        { "G2 R5", 1, "G2 R5", FAULT_ARC_CLOSED },
        { "G2 X10 R0", 1, "G2 X10 R0", FAULT_ARC_RADIUS },
        { "G3 I5 P1.5", 1, "P1.5", FAULT_VALUE },
        { "G3 I5 P0", 1, "P0", FAULT_VALUE },
    };
    /* Two have tests of their own below, and gcode_stream.c has those of a source. */
    bool seen[FAULT_COUNT] = { [FAULT_NONE] = true, [FAULT_LINE_LENGTH] = true,
                               [FAULT_WORD_COUNT] = true, [FAULT_READ] = true,
                                [FAULT_ZERO] = true };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        fault_is(bad[i].text, bad[i].line, bad[i].at, bad[i].fault);
        seen[bad[i].fault] = true;
    }
    for (int i = 0; i < FAULT_COUNT; i++) {
        CHECK(seen[i] && fault_text((enum fault)i)[0]);
    }
}

/* Two words that do not agree are both told. */
static void both_words(void)
{
    static const struct { const char *text, *other; enum fault fault; } bad[] = {
        { "G1 X1 G2", "G1", FAULT_GROUP },
        { "M9 G1 M8", "M9", FAULT_GROUP },
        { "G92 X1 G1", "G92", FAULT_SHARED },
        { "G4 P1 M64", "G4", FAULT_SHARED },
        { "G3 M65 P2 I1", "M65", FAULT_SHARED },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct reader x;
        begin(&x, bad[i].text);
        CHECK_EQ(next(&x), -2);
        CHECK_EQ(x.r.fault, bad[i].fault);
        CHECK_EQ(x.r.other_length, (int)strlen(bad[i].other));
        CHECK(!memcmp(bad[i].text + x.r.other_at, bad[i].other, strlen(bad[i].other)));
    }
    struct reader x;
    begin(&x, "G1 X1 I1");
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.other_length, 0);
}

static void long_lines(void)
{
    char text[400];
    struct reader x;
    memset(text, ' ', sizeof text);
    memcpy(text, "G1", 2);
    strcpy(text + 255, "X");
    begin(&x, text);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_NUMBER);      /* 256 characters are read */
    text[255] = ' ';
    strcpy(text + 256, "X");
    begin(&x, text);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_LINE_LENGTH);
    text[0] = '\0';
    for (int i = 0; i < 41; i++) {
        strcat(text, "G1 ");
    }
    begin(&x, text);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_WORD_COUNT);
}

int main(void)
{
    faults();
    both_words();
    long_lines();
    return check_result();
}
