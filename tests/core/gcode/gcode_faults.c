/* Every way in which a part program can be wrong: which fault, in which line, at which text. */
#include "gcode_reader.h"

#define WAITS "G4 P1\nG4 P1\nG4 P1\nG4 P1\nG4 P1\n"

#define FORTY "0000000000000000000000000000000000000000"

static void faults(void)
{
    static const struct {
        const char *text;
        int line;
        const char *at;
        enum fault fault;
    } bad[] = {
        { "G1 X1\nY2 E3", 2, "E3", FAULT_UNUSED },
        { "G1 X1\nY2 Q3", 2, "Q3", FAULT_UNUSED },
        { "G1 X1 @3", 1, "@3", FAULT_SHARED },
        { "G28 @3", 1, "@3", FAULT_UNUSED },
        { "@3", 1, "@3", FAULT_UNUSED },
        { "G1 @3", 1, "@3", FAULT_POLE },
        { "G91 G1 ^3", 1, "^3", FAULT_POLE },
        { "G33 Z1 K1", 1, "G33", FAULT_TURNING },
        { "G7", 1, "G7", FAULT_TURNING },
        { "F9 G5.2 X1", 1, "F9 G5.2 X1", FAULT_NURBS_POINT },
        { "F9 G5.2\nX1 Y1\nG1 X1", 3, "G1 X1", FAULT_NURBS },
        { "F60 G81 X1 Z-1 R1\nX2 R900", 2, "X2 R900", FAULT_TRAVEL },
        { "G5.3", 1, "G5.3", FAULT_NURBS_NONE },
        { "F9 G5.2\nX1 Y1\nM2", 3, "M2", FAULT_NURBS },
        { "F9 G5.2\nX1 Y1\nX2 Y3 M30", 3, "M30", FAULT_NURBS },
        { "F9 G5.2\nX1 Y1\nM99", 3, "M99", FAULT_NURBS },
        { "F9 G5.2\nX1 Y1\nG28 Z1", 3, "G28", FAULT_NURBS },
        { "F9 G5.2\nX1 Y1\nG18\nX2 Z1", 4, "X2 Z1", FAULT_NURBS },
        { "%\nF9 G5.2\nX1 Y1\n\n%", 3, "X1 Y1", FAULT_NURBS_END },
        { "F9 G5.2\nX1 Y1\n", 2, "X1 Y1", FAULT_NURBS_END },
        { "F9 G5.2\nX1 Y1\nG5.3", 3, "G5.3", FAULT_NURBS_FEW },
        { "G93 G5.2 F9", 1, "G93 G5.2 F9", FAULT_NURBS_FEED },
        { "G1 X1 A5", 1, "A5", FAULT_ANGLE },
        { "G1.5 X1", 1, "G1.5", FAULT_WORD },
        { "G-1 X1", 1, "G-1", FAULT_WORD },
        { "G9999999 X1", 1, "G9999999", FAULT_WORD },
        { "M6", 1, "M6", FAULT_NO_TOOL },
        { "\n\nG1 X1 $", 3, "$", FAULT_CHARACTER },
        { "G1 X1 / Y2", 1, "/", FAULT_CHARACTER },
        { "%%", 1, "%", FAULT_CHARACTER },
        { "G1 X", 1, "X", FAULT_NUMBER },
        { "G1 X. Y1", 1, "X.", FAULT_NUMBER },
        { "G1 X-Y1", 1, "X-", FAULT_NUMBER },
        { "G1 X1.2.3", 1, ".", FAULT_CHARACTER },
        { "G1 X1e3", 1, "e3", FAULT_UNUSED },
        { "G1 X12345678901234567", 1, "G1 X12345678901234567", FAULT_RANGE },
        { "G1 X." FORTY FORTY FORTY "1", 1, "X." FORTY FORTY FORTY "1", FAULT_DIGITS },
        { "G1 X1 (open", 1, "(open", FAULT_COMMENT },
        { "G1 X1 x 2", 1, "x 2", FAULT_TWICE },
        { "N1 N2", 1, "N2", FAULT_TWICE },
        { "N-1", 1, "N-1", FAULT_VALUE },
        { "G1 X[1+2", 1, "[1+2", FAULT_BRACKET },
        { "G1 X SIN 30", 1, "3", FAULT_BRACKET },
        { "G1 X[1 2]\nG1 X[1 $ 2]", 2, "$", FAULT_OPERATOR },
        { "G1 X[ ]", 1, "[", FAULT_NUMBER },
        { "G1 X#<long", 1, "#<long", FAULT_NAME },
        { "#<> = 5", 1, "#<>", FAULT_NAME },
        { "#<a234567890123456789012345678901>=1\n#<b2345678901234567890123456789012>=1", 2,
          "#<b234567890123456789012345678901", FAULT_NAME },
        { "G1 X[ATAN[1] + 2]", 1, "ATAN[1]", FAULT_ATAN },
        { "#1=[EXISTS[#2]]", 1, "EXISTS[#2", FAULT_EXISTS },
        { "#1=EXISTS[5]", 1, "EXISTS[", FAULT_EXISTS },
        { "G1 X1 #2 5", 1, "#2 5", FAULT_ASSIGNMENT },
        { "#2", 1, "#2", FAULT_ASSIGNMENT },
        { "G1 X[1/[2-2]]", 1, "1/[2-2]", FAULT_DIVISION },
        { "G1 X[1 MOD 0]", 1, "1 MOD 0", FAULT_DIVISION },
        { "G1 X[3 + SQRT[-4]]", 1, "SQRT[-4]", FAULT_ARGUMENT },
        { "G1 XASIN[1.01]", 1, "ASIN[1.01]", FAULT_ARGUMENT },
        { "G1 XACOS[-2]", 1, "ACOS[-2]", FAULT_ARGUMENT },
        { "G1 XLN[0]", 1, "LN[0]", FAULT_ARGUMENT },
        { "G1 X[[-8] ** 0.5]", 1, "[-8] ** 0.5", FAULT_ARGUMENT },
        { "G1 X EXP[1000]", 1, "EXP[1000]", FAULT_LARGE },
        { "G1 X[0 ** -1]", 1, "0 ** -1", FAULT_LARGE },
        { "G1 X#0", 1, "#0", FAULT_PARAMETER },
        { "G1 X#5003", 1, "#5003", FAULT_PARAMETER },
        { "#1=1.5 #2=1\nG1 X##1", 2, "##1", FAULT_PARAMETER },
        { "G1 X#[1/3]", 1, "#[1/3]", FAULT_PARAMETER },
        { "#5003 = 1", 1, "#5003 = 1", FAULT_PARAMETER },
        { "#<a>=1\nG1 X[#<a> + #<b>]", 2, "#<b>", FAULT_UNSET },
        { "#5420 = 1", 1, "#5420 = 1", FAULT_FIXED },
        { "#<_value>=1", 1, "#<_value>=1", FAULT_FIXED },
        { "o100 els", 1, "o100 e", FAULT_O_WORD },
        { "o100 calling", 1, "ing", FAULT_O_BEHIND },
        { "G1 O100", 1, "O100", FAULT_WORD },
        { "#1=1\no#1 sub", 2, "o#1 sub", FAULT_O_LABEL },
        { "o[-1] call", 1, "o[-1]", FAULT_VALUE },
        { "o1 endif", 1, "o1 endif", FAULT_O_PLACE },
        { "o1 break", 1, "o1 break", FAULT_O_PLACE },
        { "o1 endsub", 1, "o1 endsub", FAULT_O_PLACE },
        { "o1 if [1]\no1 while [1]", 2, "o1 while [1]", FAULT_O_OPEN },
        { "o1 if [1]\no2 do\no1 endif", 3, "o1 endif", FAULT_O_PLACE },
        { "G1 X1\no1 do\nX2\n", 2, "o1 do", FAULT_O_END },
        { "o1 while [0]\nX2\n", 1, "o1 while [0]", FAULT_O_END },
        { "o1 call\nM2\no1 sub\nG1 X1\n", 1, "o1 call", FAULT_O_END },
        { "o1 call\nM2\no1 sub\no2 do\no1 endsub", 5, "o1 endsub", FAULT_O_END },
        { "o1 repeat [1.5]\no1 endrepeat", 1, "[1.5]", FAULT_VALUE },
        { "O1 (the program)\nG1 X1\nO2\nX2\nM30", 3, "O2", FAULT_O_NUMBER },
        { "o1 call", 1, "o1 call", FAULT_NO_SUB },
        { "G1 X1 M98 P5", 1, "P5", FAULT_NO_SUB },
        { "M98 P5\nM30\nO5\nM98 P5\nM99", 4, "P5", FAULT_CALLS },
        { "M98", 1, "M98", FAULT_NO_SUB },
        { "o1 call\nM2\no1 sub\nM99\no1 endsub", 4, "M99", FAULT_M99 },
        { "o1 while [1]\no1 endwhile\nG1 X1", 2, "o1 endwhile", FAULT_ENDLESS },
        { "M99", 1, "M99", FAULT_ENDLESS },
        { "M64 P1\nM65 P1\nM99", 3, "M99", FAULT_ENDLESS },
        { "o1 do\nG4 P0\nM68 E1 Q1\no1 while [1]", 4, "o1 while [1]", FAULT_ENDLESS },
        { "G0 G1 X1", 1, "G1", FAULT_GROUP },
        { "G0 G80 G1 X1", 1, "G1", FAULT_GROUP },
        { "G80 X1 G80", 1, "G80", FAULT_GROUP },
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
        { "T1.5", 1, "T1.5", FAULT_VALUE },
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
        { "G64 G2 I5 P2", 1, "P2", FAULT_SHARED },
        { "G64 P-1", 1, "P-1", FAULT_VALUE },
        { "G61 P1", 1, "P1", FAULT_UNUSED },
        { "G1 G92 X0", 1, "G1", FAULT_SHARED },
        { "G28 G2 X0", 1, "G2", FAULT_SHARED },
        { "G10 L2 P1 G0 X0", 1, "G0", FAULT_SHARED },
        { "G52 X0 G3", 1, "G3", FAULT_SHARED },
        { "G10 P1 X0", 1, "G10 P1 X0", FAULT_NO_SYSTEM },
        { "G10 L2 X0", 1, "G10 L2 X0", FAULT_NO_SYSTEM },
        { "G10 L3 P1 X0", 1, "L3", FAULT_VALUE },
        { "G10 L2 P10 X0", 1, "P10", FAULT_VALUE },
        { "G10 L2 P1.5 X0", 1, "P1.5", FAULT_VALUE },
        { "G10 L20 P1 X0 R5", 1, "R5", FAULT_UNUSED },
        { "G10 L2 P1 X0 I5", 1, "I5", FAULT_UNUSED },
        { "G10 L20 P1", 1, "G10 L20 P1", FAULT_NO_AXES },
        { "G51 X0", 1, "G51 X0", FAULT_NO_FACTOR },
        { "G51 P2 I3", 1, "P2", FAULT_SHARED },
        { "G51 P0", 1, "P0", FAULT_VALUE },
        { "G51 I1 J1000", 1, "J1000", FAULT_VALUE },
        { "G51 P2 U1", 1, "U1", FAULT_UNUSED },
        { "G51 P2 R1", 1, "R1", FAULT_UNUSED },
        { "G51 P2 M62", 1, "M62", FAULT_SHARED },
        { "G51 P2 G1 X3", 1, "G1", FAULT_SHARED },
        { "G51 P2 G68 R3", 1, "G68", FAULT_SHARED },
        { "G51 P2 G92 X3", 1, "G51", FAULT_SHARED },
        { "G51 P2\nG55", 2, "G55", FAULT_FRAME },
        { "G51 P2\nG92 X3", 2, "G92", FAULT_FRAME },
        { "G68 R2\nG52 X3", 2, "G52", FAULT_FRAME },
        { "G68 R2\nG10 L2 P1 X3", 2, "G10", FAULT_FRAME },
        { "G68 R2\nG18", 2, "G18", FAULT_FRAME },
        { "G68 R2\nG51 P2", 2, "G51", FAULT_FRAME },
        { "G68 R2\nG50", 2, "G50", FAULT_FRAME },
        { "G68 X1", 1, "G68 X1", FAULT_NO_ANGLE },
        { "G68 Z1 R3", 1, "Z1", FAULT_UNUSED },
        { "G51 I2 J3\nG2 X1 Y1 I1 J0", 2, "G2 X1 Y1 I1 J0", FAULT_OVAL },
        { "G10 L2 P1 R30\nG18 G2 X1 Z1 I1", 2, "G18 G2 X1 Z1 I1", FAULT_OVAL },
        { "G5 X1 Y1 I1 P1 Q1", 1, "G5 X1 Y1 I1 P1 Q1", FAULT_SPLINE },
        { "G5 X1 Y1 P1 Q1", 1, "G5 X1 Y1 P1 Q1", FAULT_SPLINE },
        { "G5 X1 Y1 I1 J1 P1", 1, "G5 X1 Y1 I1 J1 P1", FAULT_SPLINE },
        { "G5 X9 I1 J1 P1 Q1\nG1 X8\nG5 X1 Y1 P1 Q1", 3, "G5 X1 Y1 P1 Q1", FAULT_SPLINE },
        { "G5.1 X1", 1, "G5.1 X1", FAULT_SPLINE },
        { "G5.1 X1 I1 P1", 1, "P1", FAULT_UNUSED },
        { "G5 X1 Y1 I1 J1 P1 Q1 R1", 1, "R1", FAULT_UNUSED },
        { "G5 X1 Z1 I1 J1 P1 Q1", 1, "Z1", FAULT_UNUSED },
        { "G18 G5.1 X1 I1", 1, "G18 G5.1 X1 I1", FAULT_SPLINE_PLANE },
        { "G5 X9 Y0 I9 J6 P-9 Q6", 1, "G5 X9 Y0 I9 J6 P-9 Q6", FAULT_CUSP },
        { "G5 X9 I1 J1 P1 Q1 M62", 1, "P1", FAULT_SHARED },
        { "G53 G5 X9 I1 J1 P1 Q1", 1, "G53 G5 X9 I1 J1 P1 Q1", FAULT_G53 },
        { "G93 G1 X1", 1, "G93 G1 X1", FAULT_NO_FEED },
        { "G93 G1 X1 F5\nX2", 2, "X2", FAULT_NO_FEED },
        { "G93 G1 X1 F5\nG94 X2", 2, "G94 X2", FAULT_NO_FEED },
        { "G93 G1 X100 F2000", 1, "F2000", FAULT_FEED },
        { "G93 F0", 1, "F0", FAULT_VALUE },
        { "G95 S100 M3 G1 X1", 1, "G95 S100 M3 G1 X1", FAULT_NO_FEED },
        { "G95 S100 F1 G1 X1", 1, "G95 S100 F1 G1 X1", FAULT_REST },
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
        { "G4 P1 R5", 1, "R5", FAULT_UNUSED },
        { "G4 P1 G2 X1 R5", 1, "P1", FAULT_SHARED },
        { "G4 P-1", 1, "P-1", FAULT_VALUE },
        { "G17 G2 X2 I1 K1", 1, "K1", FAULT_UNUSED },
        { "o1 sub\no2 endsub\no1 endsub\no1 call", 2, "o2 endsub", FAULT_O_PLACE },
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
        { "M61", 1, "M61", FAULT_MISSING },
        { "M68 E1", 1, "M68", FAULT_MISSING },
        { "M67 E4 Q1", 1, "E4", FAULT_VALUE },
        { "G10 L1 Z5", 1, "G10", FAULT_MISSING },
        { "G43.1", 1, "G43.1", FAULT_MISSING },
        { "G43.2 H1 X1", 1, "H1", FAULT_SHARED },
        { "G1 G43.1 Z5", 1, "G1", FAULT_SHARED },
        { "G92 G43.1 X1", 1, "G43.1", FAULT_SHARED },
        { "M66 P0", 1, "M66", FAULT_NO_INPUTS },
        { "G1 X1 H1", 1, "H1", FAULT_UNUSED },
        { "M50 P2", 1, "P2", FAULT_VALUE },
        { "M19 R361", 1, "R361", FAULT_VALUE },
        { "M50 P1 M62", 1, "M50", FAULT_SHARED },
        { "G10 L1 P0 Z1", 1, "P0", FAULT_TOOL },
        { "G1 X1\nG38.2 X5", 2, "G38.2", FAULT_NO_PROBE },
        { "G87 X1", 1, "G87 X1", FAULT_CYCLE_SPINDLE },
        { "G96 S100", 1, "G96", FAULT_MISSING },
        { "G96 D100", 1, "G96", FAULT_MISSING },
        { "G96 S100 D0", 1, "D0", FAULT_VALUE },
        { "G96 S-1 D9", 1, "S-1", FAULT_VALUE },
        { "G97 S1 D9", 1, "D9", FAULT_UNUSED },
        { "G96 G97 S1 D9", 1, "G97", FAULT_GROUP },
        { "G96 S1 D9 G41", 1, "G41", FAULT_SHARED },
        { "G96 S1 D9 M3\nG95 G1 F1 X1", 2, "G95 G1 F1 X1", FAULT_SURFACE },
        { "G1 X#<_hal[x]>", 1, "#<_hal[x]>", FAULT_FOREIGN },
        { "M70\nM71\nM72", 3, "M72", FAULT_NO_MODES },
        { "M70\nG41.1 D1\n M72 ", 3, "M72", FAULT_RESTORE },
        { "G1 X1 M101 P1", 1, "M101", FAULT_USER },
        { "M100 M199", 1, "M199", FAULT_GROUP },
        { "G4 P1 M101\no<m101> sub\no<m101> endsub", 1, "M101", FAULT_SHARED },
        { "M100.5", 1, "M100.5", FAULT_WORD },
        { "M200", 1, "M200", FAULT_WORD },
        { "M3 S1\nG33.1 Z1", 2, "G33.1 Z1", FAULT_TAP_K },
        { "#<_ini[emc]machine>=1", 1, "#<_ini[emc]machine>=1", FAULT_FOREIGN },
        { "#<_hal[spindle]> = 1", 1, "#<_hal[spindle]> = 1", FAULT_FOREIGN },
        { "#<_rpm>=1", 1, "#<_rpm>=1", FAULT_FIXED },
        { "G18.1", 1, "G18.1", FAULT_PLANE },
        { "G87 X1 Z-1 R1 S1 M3", 1, "G87", FAULT_CYCLE_ASIDE },
        { "G81 X1 Z-1", 1, "G81", FAULT_CYCLE_R },
        { "G81 X1 R1", 1, "G81", FAULT_CYCLE_DEPTH },
        { "G73 X1 Z-1 R1", 1, "G73", FAULT_CYCLE_Q },
        { "G88 X1 Z-1 R1 M3 S1", 1, "G88", FAULT_CYCLE_P },
        { "G81 X1 R1 Z2", 1, "G81 X1 R1 Z2", FAULT_CYCLE_LOW },
        { "G73 X1 Z-20.1 R0 Q.002", 1, "G73 X1 Z-20.1 R0 Q.002", FAULT_CYCLE_PECKS },
        { "G93 G81 X1 Z-1 R0 F1", 1, "G93 G81 X1 Z-1 R0 F1", FAULT_CYCLE_FEED },
        { "G74 X1 Z-1 R0", 1, "G74 X1 Z-1 R0", FAULT_CYCLE_SPINDLE },
        { "G41.1 D1\nG42.1 D1", 2, "G42.1", FAULT_CUTTER_ON },
        { "G41.1", 1, "G41.1", FAULT_MISSING },
        { "G42 D-1", 1, "D-1", FAULT_VALUE },
        { "G1 X1 D1", 1, "D1", FAULT_UNUSED },
        { "G19 G41.1 D1", 1, "G41.1", FAULT_CUTTER_PLANE },
        { "G41.1 D1\nG18", 2, "G18", FAULT_CUTTER_PLANE },
        { "G41.1 D1 G28", 1, "G28", FAULT_CUTTER_WORD },
        { "G42.1 D10 G1 X5", 1, "G42.1 D10 G1 X5", FAULT_CUTTER_ENTRY },
        { "G42.1 D1 G1 X5\nX9\nG40 G2 X9 Y5 R5", 3, "G40 G2 X9 Y5 R5", FAULT_CUTTER_EXIT },
        { "G41.1 D4 G1 X9\nG3 Y2 J1", 2, "G3 Y2 J1", FAULT_CUTTER_ARC },
        { "G41.1 D2 G1 X9\nG3 X6.8 I-1.1", 2, "G3 X6.8 I-1.1", FAULT_CUTTER_CORNER },
        { "G41.1 D2 G1 X9\n  Y.5\nM8\n X0", 2, "Y.5", FAULT_CUTTER_SHORT },
        { "G41.1 D2 G1 X9\nX0", 2, "X0", FAULT_CUTTER_BACK },
        { "G41.1 D2 G1 X9\n" WAITS WAITS WAITS WAITS "G4 P1\nG4 P2\n", 23, "G4 P2",
          FAULT_CUTTER_FULL },
    };
    /* Three have tests of their own below; gcode_stream.c has those of a source, gcode_machine.c
     * one of a machine with a probe, tests/gcode/test_files.py one of files,
     * tests/gcode/test_fanuc*.py those of Fanuc's controls, gcode_angles.c one of U V W,
     * tests/core/mcc/mcc_mdi.c those of lines by hand and of run from line. */
    bool seen[FAULT_COUNT] = {
        [FAULT_NONE] = true,        [FAULT_LINE_LENGTH] = true, [FAULT_WORD_COUNT] = true,
        [FAULT_READ] = true,        [FAULT_ZERO] = true,        [FAULT_PLAIN] = true,
        [FAULT_PROBE_POINT] = true, [FAULT_DEEP] = true,        [FAULT_NAMES] = true,
        [FAULT_O_DEEP] = true,      [FAULT_FILES] = true,       [FAULT_SEQUENCE] = true,
        [FAULT_LOOP_END] = true,    [FAULT_THEN] = true,        [FAULT_SIDE] = true,
        [FAULT_ALARM] = true,       [FAULT_MODAL] = true,       [FAULT_ROUND_NEXT] = true,
        [FAULT_ROUND_SHORT] = true, [FAULT_ALONE] = true,       [FAULT_WHILE_PROGRAM] = true,
        [FAULT_WHILE_HAND] = true,  [FAULT_WHILE_ERROR] = true, [FAULT_FROM_LINE] = true,
        [FAULT_FROM_HELD] = true
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        fault_is(bad[i].text, bad[i].line, bad[i].at, bad[i].fault);
        seen[bad[i].fault] = true;
    }
    for (int i = 0; i < FAULT_COUNT; i++) {
        CHECK((seen[i] || i >= FAULT_NOTE_COMMENT) && fault_text((enum fault)i)[0]);
    }
}

/* Two words that do not agree are both told. */
static void both_words(void)
{
    static const struct {
        const char *text, *other;
        enum fault fault;
    } bad[] = {
        { "G1 X1 G2", "G1", FAULT_GROUP },       { "M9 G1 M8", "M9", FAULT_GROUP },
        { "G92 X1 G1", "G92", FAULT_SHARED },    { "G4 P1 M64", "G4", FAULT_SHARED },
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

/* A machine that knows no splines refuses them. */
static void plain(void)
{
    struct reader x;
    begin(&x, "G1 X1\nG5.1 X2 I1 J1\n");
    x.program.plain = true;
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_PLAIN);
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
    CHECK_EQ(x.r.fault, FAULT_NUMBER); /* 256 characters are read */
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
    plain();
    long_lines();
    return check_result();
}
