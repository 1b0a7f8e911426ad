/* Where a program goes on: O words, M98, M99, G65, computed by hand. */
#include "gcode_reader.h"

/* The X of all commands up to the end, or up to `count` of them. */
static void path_is(const char *text, bool fanuc, const double *x_end, int count, bool ends)
{
    struct reader x;
    int got = 0;

    begin(&x, text);
    x.program.fanuc = fanuc;
    while (got < count && next(&x) >= 0) {
        CHECK(fabs(x.c.path.end[0] - x_end[got]) < 1e-12);
        if (fabs(x.c.path.end[0] - x_end[got]) >= 1e-12) {
            printf("    '%s': command %d leads to X%g\n", text, got, x.c.path.end[0]);
        }
        got++;
    }
    CHECK_EQ(got, count);
    CHECK(!ends || next(&x) == -1);
    if (got != count) {
        printf("    '%s': %d commands, %s\n", text, got, fault_text(x.r.fault));
    }
}

#define PATH(text, ...) \
    path_is(text, false, (double[]){ __VA_ARGS__ }, \
            (int)(sizeof(double[]){ __VA_ARGS__ } / sizeof(double)), true)
#define FANUC(text, ...) \
    path_is(text, true, (double[]){ __VA_ARGS__ }, \
            (int)(sizeof(double[]){ __VA_ARGS__ } / sizeof(double)), true)

static void conditions(void)
{
    PATH("G1\no1 if [1 GT 2]\nX1\no1 elseif [2 GT 2]\nX2\no1 else\nX3\no1 endif\nX4\n", 3, 4);
    PATH("G1\no1 if [3 GT 2]\nX1\no1 elseif [1]\nX2\no1 else\nX3\no1 endif\nX4\n", 1, 4);
    PATH("G1\no1 if [0]\nX1\no1 elseif [1]\nX2\n"
         "o1 elseif [1/0]\nX5\no1 else\nX3\no1 endif\nX4",
         2, 4);
    PATH("G1\nO<a b> IF [0]\nX1\n(o<ab> endif)\n;o<ab> endif\no<A b> endif (yes)\nX4\n", 4);
    PATH("G1\no1 if [1]\no2 if [0]\nX1\no2 else\nX2\no2 endif\no1 else\nX3\no1 endif\nX4\n", 2, 4);
    PATH("G1\no1 if [0]\no2 if [1]\nX1\no2 endif\no1 endif\no1 if [1]\nX5\no1 endif\n", 5);
    PATH("G1\n/o1 if [0]\nX1\n/o1 endif\nX2\n", 2);
}

static void loops(void)
{
    PATH("G1\n#1=0\no1 while [#1 LT 3]\n#1=[#1+1]\nX#1\no1 endwhile\nX9\n", 1, 2, 3, 9);
    PATH("G1\no1 while [0]\nX1\no1 endwhile\nX9\n", 9);
    PATH("G1\n#1=0\no1 do\n#1=[#1+1]\nX#1\no1 while [#1 LT 3]\nX9\n", 1, 2, 3, 9);
    PATH("G91 G1\no1 repeat [3]\nX1\no1 endrepeat\nG90 X9\n", 1, 2, 3, 9);
    PATH("G1\no1 repeat [0]\nX1\no1 endrepeat\no2 repeat [-5]\nX1\no2 endrepeat\nX9\n", 9);
    PATH("G91 G1\no1 repeat [2]\no2 repeat [2]\nX1\no2 endrepeat\nX10\no1 endrepeat\n", 1, 2, 12,
         13, 14, 24);
    PATH("G1\n#1=0\no1 while [1]\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 elseif [#1 EQ 4]\n"
         "o1 break\no2 endif\nX#1\no1 endwhile\nX9\n",
         1, 3, 9);
    PATH("G1\n#1=0\no1 do\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\no3 if [#1 EQ 5]\n"
         "o1 break\no3 endif\nX#1\no1 while [#1 LT 7]\nX9\n",
         1, 3, 4, 9);
    PATH("G91 G1\n#1=0\no1 repeat [4]\n#1=[#1+1]\no2 if [#1 EQ 2]\no1 continue\no2 endif\nX1\n"
         "o3 if [#1 EQ 3]\no1 break\no3 endif\no1 endrepeat\nX100\n",
         1, 2, 102);
}

static void calls(void)
{
    PATH("\xEF\xBB\xBFo1 sub\nG1 X#1\no1 endsub\no1 call [5]\n", 5);
    PATH("o1 sub\nG1 X#1\nX[#2 + 1]\no1 endsub\no1 call [5] [7]\nM2\n", 5, 8);
    PATH("o<b> call [3]\nM2\no<b> sub\nG1 X#1\no<b> endsub\n", 3);
    PATH("#1=4 #2=6 #31=1\no1 call [3]\nG1 X[#1+#31]\nM2\n"
         "o1 sub\nX#1 G1\nX#2\n#1=99 #31=2\no1 endsub\n",
         3, 0, 6); /* #2 is not given; #1 is 4 again, #31 2 */
    PATH("o1 call [3]\nG1 X[#<_value> + #<_value_returned>]\n"
         "o1 call [0]\nX[20+#<_value_returned>]\nM2\n"
         "o1 sub\no2 if [#1]\no1 return [#1*2]\no2 endif\no1 endsub\n",
         7, 20);
    PATH("o1 call [4]\nG1 X#<_value>\nM2\no1 sub\no2 if [#1 LE 1]\no1 return [1]\no2 endif\n"
         "o1 call [#1 - 1]\no1 endsub [#1 * #<_value>]\n",
         24);
    PATH("#<a>=1\no1 call\nG1 X#<a>\nM2\no1 sub\n#<a>=2 #<_g>=7\nG1 X[#<_g>]\no1 endsub\n", 7, 1);
    PATH("o1 call\no2 if [EXISTS[#<l>]]\nG1 X1\no2 else\nG1 X2\n"
         "o2 endif\nM2\no1 sub\n#<l>=1\no1 endsub",
         2);
    PATH("#3=99\no[#3+1] call [8]\nM2\no0100 sub\nG1 X#1\no100 endsub\n", 8);
    PATH("G1\no1 while [1]\no2 repeat [5]\no3 call\no1 break\no2 endrepeat\no1 endwhile\nX9\nM2\n"
         "o3 sub\no4 while [1]\nX1\no3 return\no4 endwhile\no3 endsub\n",
         1, 9);
    PATH("#1=0\no1 call [10]\nG1 X[#5000]\nM2\no1 sub\no2 if [#1 GT 1]\no1 call [#1-1]\no2 endif\n"
         "#5000=[#5000+1]\no1 endsub\n",
         10);
}

/* A computed number is a code as that of any other word is: 1.1 * 100 is 110 but for rounding. */
static void users(void)
{
    PATH("o<m110> sub\nG1 X1\no<m110> endsub\nM[1.1*100] G1 X2\n", 1, 2);
    PATH("o<m110> sub\nG1 X1\no<m110> endsub\nG1\nM109.99995 X2\n", 1, 2);
}

static void fanuc(void)
{
    PATH("%\nO1000 (PLATE)\nG91 G1 X1\nM98 P2000 L3\nM98 P2000 L0\n"
         "G90 X50\nM30\nO2000\nX10\nM99\n%\n",
         1, 11, 21, 31, 50);
    PATH("O1\n#1=0\nM98 P0100 L5\nG1 X#1\nM30\n"
         "O100\n#1=[#1+1]\nM98 P200 L5\nM99\nO200\n#1=[#1+0.125]\nM99\n",
         8.125);
    FANUC("M98 P32000\nM30\nO2000\nG91 G1 X1\nM99\n", 1, 2, 3);
    FANUC("M98 P2000\nM30\nO2000\nG91 G1 X1\nM99\n", 1);
    FANUC("#1=5\nG65 P7 A1. B2. C3. I4. J5. K6. D7. E8. F9. L2 Z26.\nG1 X#1\nM30\nO7\n"
          "G1 X[#1+#2*2+#3*4+#4*8+#5*16+#6*32+#7*64+#8*128+#9*256+#26*512+#10]\n#1=100\nX0\nM99\n",
          1 + 4 + 12 + 32 + 80 + 192 + 448 + 1024 + 2304 + 26 * 512, 0,
          1 + 4 + 12 + 32 + 80 + 192 + 448 + 1024 + 2304 + 26 * 512, 0, 5);
    FANUC("G1\n#1=0\nN10 #1=#1+1\nX#1\nIF[#1LT3]GOTO10\nX9\nM30\n", 1, 2, 3, 9);
    FANUC("G1 X1\nGOTO 20\nX2\nN20 X3\nGOTO[10+20]\nX4\n/N30 X5\nN030\nX6\nM30\n", 1, 3, 5, 6);
    FANUC("G1\n#1=1\nWHILE [#1 LE 3] DO1\n#2=1\nWHILE[#2LT#1]DO 2\nX[10*#1+#2]\n#2=#2+1\nEND 2\n"
          "#1=#1+1\nEND1\nWHILE[0]DO1\nX1\nEND1\nX9\nM30\n",
          21, 31, 32, 9);
    FANUC("G1\n#1=0\nDO1\n#1=#1+1\nX#1\nIF[#1EQ2]GOTO5\nEND1\nX8\nN5 X9\nDO1\nX10\nGOTO 7\n"
          "END1\nN7M30\n",
          1, 2, 9, 10);
    FANUC("G1\nIF [1 EQ 1] THEN #1=5 #2=6\nIF [1 NE 1] THEN #1=7\nX[#1+#2]\nM30\n", 11);
    FANUC("O1\nG1\nM98 P2\nN1 X5\nM30\nO2\nN1 X[#1+1]\n#1=#1+1\nIF[#1 LT 3]GOTO 1\nM99\nO3\nN1X7\n",
          1, 2, 3, 5);
    path_is("G91 G1 X1\nM99\n", false, (double[]){ 1, 2, 3, 4, 5 }, 5, false);
    PATH("G90 G1 X1\n/M30\nM99\n", 1);
}

static void forms(void)
{
    struct reader x;

    begin(&x, "\xEF\xBB\xBFG1 X1\r\nN10.5\tX2 N3\r\n/3 X3\n"
              "(MSG, hello)\n(PRINT, #1)(DEBUG,#2)X4\nX5\n");
    x.program.block_delete = true;
    for (int i = 0; i < 4; i++) {
        if (i == 1) {
            CHECK_EQ(next(&x), -2);
            CHECK_EQ(x.r.fault, FAULT_TWICE);
            break;
        }
        CHECK_EQ(next(&x), COMMAND_LINE);
    }
    begin(&x, "\xEF\xBB\xBFG1 X1 Q2\n");
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.at, 6); /* the mark is in no column */
    begin(&x, "G4 P500\nG4 P0.5\nG4 X1.5\nG4 U2\nG1 X100 Y1. F6\n");
    x.program.fanuc = true;
    x.program.least_increment = 0.001;
    const double seconds[] = { 0.5, 0.5, 1.5, 0.002 };
    for (int i = 0; i < 4; i++) {
        CHECK_EQ(next(&x), COMMAND_DELAY);
        CHECK_NEAR(x.c.dwell, seconds[i], 1e-15);
    }
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 0.1, 1.0, 0.0);
    CHECK_NEAR(x.c.feed, 0.1, 1e-15);
}

int main(void)
{
    conditions();
    loops();
    calls();
    users();
    fanuc();
    forms();
    return check_result();
}
