/* All faults of a program at once: which lines are told, and none that follows from another. */
#include "gcode_reader.h"

static struct fault_list list;

/* The faults of a text, a line each; 0 ends the lines. */
static void lines_are(const char *text, const int *lines)
{
    struct reader x;
    int n = 0;

    begin(&x, text);
    const struct interpreter before = x.in;
    interpreter_check_all(&x.in, &x.program, &list);
    CHECK(!memcmp(&before, &x.in, sizeof before));
    while (lines[n]) {
        CHECK(n < list.count && list.of[n].line == lines[n]);
        n++;
    }
    CHECK_EQ(list.count, n);
    for (int i = 0; i < list.count && list.count != n; i++) {
        printf("    line %d: %s\n", (int)list.of[i].line, fault_text(list.of[i].fault));
    }
    struct fault_report first;
    interpreter_check(&x.in, &x.program, &first);
    CHECK(first.fault == (n ? list.of[0].fault : FAULT_NONE) && first.line == lines[0]);
}

#define LINES(text, ...) lines_are(text, (int[]){ __VA_ARGS__, 0 })

static void no_cascades(void)
{
    lines_are("G1 X1\nM2\n", (int[]){ 0 });
    LINES("G1 X5 Q3 F600\nY2\nX1 $ Y3\nG91 X1 Z\nX2 K1\nM2\nX5 nonsense\n", 1, 3, 4, 5);
    LINES("X5\nX6\nY7\n", 1); /* as if G1 were in force */
    LINES("G1 X[1/0] Y5\nG91 Y1\nG90 Y[#<a>]\n#<b>=[1/0]\nX3\n", 1, 3, 4);
    LINES("G20 $\nG1 X1 F600000\nX2\nG21 X900000\nX900001\nX0\nX1\nX900000\n", 1, 2, 4, 8);
    LINES("G1 Z701\nX2 Z702\nZ703\nZ0\nX5\nZ701\n", 1, 6); /* still outside is told once */
    LINES("o1 whil [1]\nG1 X1\no1 endwhile\nX2 Q5\n", 1, 4);
    LINES("o1 repeat [50]\nG1 X1 Q5\no1 endrepeat\nX2 R\n", 2, 4); /* a line once */
    /* Points whose spans are not made, more than a curve keeps. */
    LINES("F9 G5.2 X1 Y1\no1 repeat [50]\nX2 Y3 M98 P5\no1 endrepeat\nG5.3\nX7 Q5\nM2\n", 3, 6);
    LINES("F9 G5.2 X1 Y1\nX2 Y3\nX3 Y1 M98 P5\nX3 Y4\nX4 Y1\nG5.3\nX7 Q5\nM2\n", 3, 7);
    LINES("o5 call\nG1 X1\nM98 P7\nX2\nM99.5\nM30\n", 1, 3, 5);
    LINES("G2 X10 Y0 I6\nG1 X20\nG2 X30 R5\n", 1); /* the arc's end is where its words lead */
}

static void places(void)
{
    static const int32_t at[] = { 6, 0, 5 }, length[] = { 2, 2, 4 };

    LINES("G1 X5 Q3\nN5\nQ4 X1\nX1 Y[1/0]\n", 1, 3, 4);
    for (int i = 0; i < 2; i++) {
        CHECK_EQ(list.of[i].at, at[i]);
        CHECK_EQ(list.of[i].length, length[i]);
    }
    CHECK_EQ(list.of[2].offset, 18);
    CHECK_EQ(list.of[2].at, 5);
    CHECK_EQ(list.of[2].length, 3);
}

/* Twenty are told, and that there are more. */
static void many(void)
{
    char text[600] = "";
    struct reader x;

    for (int n = 19; n <= 21; n++) {
        text[0] = '\0';
        for (int i = 0; i < n; i++) {
            strcat(text, "G1 X1 Q1\n");
        }
        begin(&x, text);
        interpreter_check_all(&x.in, &x.program, &list);
        CHECK_EQ(list.count, n < 20 ? n : 20);
        CHECK_EQ(list.more, n > 20);
    }
}

static void notes(void)
{
    struct reader x;

    begin(&x, "(a comment)\nG1 X1 (print, #1)\n(DEBUG, x)\n(LOGCLOSE)\nG1 X2 (MSG, print)\n");
    interpreter_check_all(&x.in, &x.program, &list);
    CHECK_EQ(list.count, 0);
    CHECK_EQ(list.notes, 1);
    CHECK(list.note[0].fault == FAULT_NOTE_COMMENT && list.note[0].line >= 2);
}

/* Where there are but axes and outputs: what a program asks for in vain, each once. */
static void bare(void)
{
    static const struct {
        enum fault what;
        int line, at;
    } rows[] = {
        { FAULT_NOTE_MERGE, 1, 9 },   { FAULT_NOTE_SPINDLE, 3, 0 },  { FAULT_NOTE_COOLANT, 3, 7 },
        { FAULT_NOTE_COMMENT, 4, 0 }, { FAULT_NOTE_OVERRIDE, 5, 0 },
    };
    struct reader x;

    begin(&x, "G64 P0.1 Q0.2\nG1 X1\nM3 S10 M8\n(PRINT, a)\nM50 P0 M9\nS3 G97\nM64 P1\nX2\n");
    x.program.bare = true;
    interpreter_check_all(&x.in, &x.program, &list);
    CHECK_EQ(list.count, 0);
    CHECK_EQ(list.notes, sizeof rows / sizeof *rows);
    for (int i = 0; i < list.notes; i++) {
        CHECK(list.note[i].fault == rows[i].what && list.note[i].line == rows[i].line);
        CHECK_EQ(list.note[i].at, rows[i].at);
    }
    x.program.bare = false;
    interpreter_check_all(&x.in, &x.program, &list);
    CHECK_EQ(list.notes, 1);
    begin(&x, "(PRINT, 1)\n(PRINT, 2)\n(PRINT, 3)\n(PRINT, 4)\n(PRINT, 5)\n(PRINT, 6)\n"
              "(PRINT, 7)\n(PRINT, 8)\n(PRINT, 9)\n(PRINT, 10)\n"); /* read at once */
    interpreter_check_all(&x.in, &x.program, &list);
    CHECK(list.notes == 1 && list.note[0].line == 1);
}

/* Where a tap has an F above the highest feed there is one fault and no note that it is cut down,
 * which a tap never is. The note is for an F by which something else may move. */
static void taps(void)
{
    static const struct {
        const char *text;
        int fault, at, note;
    } rows[] = {
        { "S9000 M3 G0 Z5\nG84 X2 Z-1 R2 F90000\n", 2, 14, 0 },
        { "S9000 M4 G0 Z5\nG74 X2 Z-1 R2 F90000\n", 2, 14, 0 },
        { "S9000 M4 G0 Z5\nG84 X2 Z-1 R2 F90000\n", 2, 14, 0 }, /* turns the wrong way */
        { "S9000 M3 G0 Z5 F600\nG84 X2 Z-1 R2\nX3 F90000\n", 3, 3, 0 },
        { "G95 F10 S9000 M3 G0 Z5\nG84 X2 Z-1 R2\n", 2, 0, 0 },
        { "S9000 M3 G0 Z5 F90000\nG84 X2 Z-1 R2\n", 2, 0, 1 },
        { "S9000 M3 G0 Z5 F600\nG84 X2 Z-1 R2\nF90000\nG80 G1 X1\n", 0, 0, 3 },
    };
    struct reader x;

    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        begin(&x, rows[i].text);
        x.program.strict_feed = false;
        interpreter_check_all(&x.in, &x.program, &list);
        CHECK_EQ(list.count, rows[i].fault > 0);
        CHECK_EQ(list.notes, rows[i].note > 0);
        if (list.count > 0) {
            CHECK(list.of[0].fault == FAULT_FEED && list.of[0].line == rows[i].fault);
            CHECK_EQ(list.of[0].at, rows[i].at);
            CHECK_NEAR(list.of[0].value, 90000.0, 1e-9);
        }
        if (list.notes > 0) {
            CHECK(list.note[0].fault == FAULT_NOTE_FEED && list.note[0].line == rows[i].note);
        }
    }
    LINES("S9000 M3 G0 Z5\nG84 X2 Z-1 R2 F90000\nX3\nG80 G1 X4\n", 2);
}

/* A program that runs for ever is checked so far and no further. */
static void endless(void)
{
    struct reader x;

    begin(&x, "G91 G1 X1\nX-1\nM99\n");
    x.program.check_again = 100;
    interpreter_check_all(&x.in, &x.program, &list);
    CHECK_EQ(list.count, 0);
    CHECK_EQ(list.notes, 1);
    CHECK_EQ(list.note[0].fault, FAULT_NOTE_CHECKED);
    for (int i = 0; i < 1000; i++) {
        CHECK_EQ(next(&x), COMMAND_LINE);
    }
}

/* The state of one size: brackets, names, blocks within one another, and no further. */
static void bounds(void)
{
    char text[8000] = "";
    struct reader x;

    for (int n = 100; n <= 101; n++) {
        text[0] = '\0';
        for (int i = 0; i < n; i++) {
            sprintf(text + strlen(text), "#<a%d>=1\n", i);
        }
        LINES(text, n == 101 ? 101 : 0);
    }
    CHECK_EQ(list.of[0].fault, FAULT_NAMES);
    for (int n = 64; n <= 65; n++) {
        text[0] = '\0';
        for (int i = 0; i < n; i++) {
            sprintf(text + strlen(text), "o%d do\n", i);
        }
        for (int i = n - 1; i >= 0; i--) {
            sprintf(text + strlen(text), "o%d while [0]\n", i);
        }
        begin(&x, text);
        interpreter_check_all(&x.in, &x.program, &list);
        CHECK_EQ(list.count > 0, n == 65);
    }
    CHECK_EQ(list.of[0].fault, FAULT_O_DEEP);
    for (int n = 30; n <= 31; n++) {
        strcpy(text, "G1 X");
        memset(text + 4, '[', (size_t)n);
        text[4 + n] = '7';
        memset(text + 5 + n, ']', (size_t)n);
        text[5 + 2 * n] = '\0';
        LINES(text, n == 31 ? 1 : 0);
    }
    CHECK_EQ(list.of[0].fault, FAULT_DEEP);
}

int main(void)
{
    no_cascades();
    places();
    many();
    notes();
    taps();
    bare();
    endless();
    bounds();
    return check_result();
}
