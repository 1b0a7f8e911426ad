/* Canned cycles against lists written by hand: all of them, in three planes, with G98 and G99, G90
 * and G91, and what is refused. */
#include <stdlib.h>

#include "gcode_reader.h"
#include "queue.h"

/* From 1, 2 at a height of 10 over the hole at 5, 7: R is 2, the bottom -10. What comes behind the
 * rapids over the hole and to R, as letter and height, C the way to the next hole: f feed, r rapid;
 * w dwell of half a second; s spindle off, + clockwise, - the other way round, each with overrides
 * on; and = the same with overrides off; ! stop. */
static const struct {
    int code;
    const char *spindle, *words, *list;
} cycles[] = {
    { 81, "", "", "f-10 rC" },
    { 82, "", "P.5", "f-10 w rC" },
    { 73, "", "Q5", "f-3 r-2.746 f-8 r-7.746 f-10 rC" },
    { 83, "", "Q5", "f-3 r2 r-2.746 f-8 r2 r-7.746 f-10 rC" },
    { 83, "", "Q12", "f-10 rC" },
    { 83, "", "Q.1 Z1.9", "f1.9 rC" },
    { 83, "", "Q.1 Z1.8", "f1.9 r2 f1.8 rC" },
    { 84, "M3", "", "=+ f-10 =- fC +" },
    { 84, "M3", "P.5", "=+ f-10 =- w fC +" },
    { 74, "M4", "", "=- f-10 =+ fC -" },
    { 85, "", "", "f-10 f2 rC" },
    { 86, "M4", "P.5", "f-10 w s rC -" },
    { 88, "M3", "P.5", "f-10 w s ! rC +" },
    { 89, "", "P.5", "f-10 w fC" },
};

/* Coordinates of the plane and of its normal. */
static const struct {
    const char *word;
    char letter[3];
    int axis[3];
} planes[] = {
    { "G17", { 'X', 'Y', 'Z' }, { 0, 1, 2 } },
    { "G18", { 'Z', 'X', 'Y' }, { 2, 0, 1 } },
    { "G19", { 'Y', 'Z', 'X' }, { 1, 2, 0 } },
};

static void expect_place(const struct reader *x, int plane, double a, double b, double height)
{
    const int *axis = planes[plane].axis;
    CHECK_NEAR(x->c.path.end[axis[0]], a, 1e-12);
    CHECK_NEAR(x->c.path.end[axis[1]], b, 1e-12);
    CHECK_NEAR(x->c.path.end[axis[2]], height, 1e-12);
}

static void expect_spindle(const struct reader *x, char way, bool fixed)
{
    CHECK_EQ(x->c.type, COMMAND_OUTPUTS);
    CHECK_NEAR(x->c.spindle, way == '+' ? 100.0 : way == '-' ? -100.0 : 0.0, 0.0);
    CHECK_EQ(x->c.overrides, fixed ? OUTPUTS_FEED_FIXED | OUTPUTS_SPEED_FIXED : 0);
}

static void expect_list(struct reader *x, int plane, const char *list, double a, double b,
                        double clear)
{
    bool fixed = false;
    double at = NAN; /* no motion leads to where the tool is */
    while (*list) {
        const char c = *list++;
        if (c == ' ') {
            continue;
        }
        if (c == '=') {
            fixed = true;
            continue;
        }
        if (c == 'f' || c == 'r') {
            char *end;
            const double height = *list == 'C' ? clear : strtod(list, &end);
            list = *list == 'C' ? list + 1 : end;
            if (height == at) {
                continue;
            }
            at = height;
            next(x);
            CHECK_EQ(x->c.type, c == 'f' ? COMMAND_LINE : COMMAND_PTP);
            CHECK(!x->c.blend);
            expect_place(x, plane, a, b, height);
            continue;
        }
        next(x);
        if (c == 'w') {
            CHECK_EQ(x->c.type, COMMAND_DELAY);
            CHECK_NEAR(x->c.dwell, 0.5, 0.0);
        } else if (c == '!') {
            CHECK_EQ(x->c.type, COMMAND_STOP);
        } else {
            expect_spindle(x, c, fixed);
        }
        fixed = false;
    }
}

/* Over a hole from where the tool is, and down to R. */
static void expect_approach(struct reader *x, int plane, double a, double b, double from)
{
    CHECK_EQ(next(x), COMMAND_PTP);
    expect_place(x, plane, a, b, from);
    if (from != 2.0) {
        CHECK_EQ(next(x), COMMAND_PTP);
        expect_place(x, plane, a, b, 2.0);
    }
}

static void one(int cycle, int plane, bool to_r, bool incremental)
{
    char text[256], depth[8];
    const char *l = planes[plane].letter, *z = strchr(cycles[cycle].words, 'Z');
    const double bottom = z ? strtod(z + 1, NULL) : -10.0;
    char words[32] = "";
    struct reader x;

    strncat(words, cycles[cycle].words, z ? (size_t)(z - cycles[cycle].words) : 31);
    snprintf(depth, sizeof depth, "%c%.1f", l[2], bottom - (incremental ? 2.0 : 0.0));
    snprintf(text, sizeof text,
             "%s S100 %s G0 %c1 %c2 %c10\n%s %s F60 G64\n"
             "G%d %c%g %c%g R%g %s %s M0\n%c%g %c%g\n",
             planes[plane].word, cycles[cycle].spindle, l[0], l[1], l[2],
             incremental ? "G91" : "G90", to_r ? "G99" : "G98", cycles[cycle].code, l[0],
             incremental ? 4.0 : 5.0, l[1], incremental ? 5.0 : 7.0, incremental ? -8.0 : 2.0,
             depth, words, l[0], incremental ? 4.0 : 9.0, l[1], incremental ? 5.0 : 7.0);
    begin(&x, text);
    if (*cycles[cycle].spindle) {
        CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    }
    CHECK_EQ(next(&x), COMMAND_PTP);
    const double clear = to_r ? 2.0 : 10.0;
    expect_approach(&x, plane, 5.0, 7.0, 10.0);
    expect_list(&x, plane, cycles[cycle].list, 5.0, 7.0, clear);
    CHECK_EQ(x.c.line, 3);
    CHECK_EQ(next(&x), COMMAND_STOP); /* behind the whole cycle */
    /* words are kept, and a kept R with G91 counts from where the series began */
    expect_approach(&x, plane, 9.0, incremental ? 12.0 : 7.0, clear);
    expect_list(&x, plane, cycles[cycle].list, 9.0, incremental ? 12.0 : 7.0, clear);
    CHECK_EQ(next(&x), -1);
}

static void all(void)
{
    for (int cycle = 0; cycle < (int)(sizeof cycles / sizeof *cycles); cycle++) {
        for (int plane = 0; plane < 3; plane++) {
            for (int modes = 0; modes < 4; modes++) {
                one(cycle, plane, modes & 1, modes & 2);
            }
        }
    }
}

/* G87: aside by 3 and 4 with the spindle off, down, over the hole, bore from -10 up to -6. */
static void back_boring(int plane, bool incremental, bool to_r)
{
    static const struct {
        char kind;
        double a, b, height;
    } steps[] = {
        { 'r', 8.0, 11.0, 2.0 },  { 's', 0, 0, 0 },       { 'r', 8.0, 11.0, -10.0 },
        { 'r', 5.0, 7.0, -10.0 }, { '+', 0, 0, 0 },       { 'f', 5.0, 7.0, -6.0 },
        { 'f', 5.0, 7.0, -10.0 }, { 's', 0, 0, 0 },       { 'r', 8.0, 11.0, -10.0 },
        { 'r', 8.0, 11.0, NAN },  { 'r', 5.0, 7.0, NAN }, { '+', 0, 0, 0 },
    };
    const char *l = planes[plane].letter;
    const double clear = to_r ? 2.0 : 10.0;
    char text[256];
    struct fault_list all;
    struct reader x;

    snprintf(text, sizeof text,
             "%s S100 M3 G0 %c1 %c2 %c10\n%s %s F60\n"
             "G87 %c%g %c%g R%g %c%g %c3 %c4 %c%g M0\n",
             planes[plane].word, l[0], l[1], l[2], incremental ? "G91" : "G90",
             to_r ? "G99" : "G98", l[0], incremental ? 4.0 : 5.0, l[1], incremental ? 5.0 : 7.0,
             incremental ? -8.0 : 2.0, l[2], incremental ? -12.0 : -10.0, l[0] - 'X' + 'I',
             l[1] - 'X' + 'I', l[2] - 'X' + 'I', incremental ? 4.0 : -6.0);
    begin(&x, text);
    interpreter_check_all(&x.in, &x.program, &all);
    CHECK(all.count == 0 && all.notes == 1 && all.note[0].fault == FAULT_NOTE_ORIENT);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_approach(&x, plane, 5.0, 7.0, 10.0);
    for (int i = 0; i < (int)(sizeof steps / sizeof *steps); i++) {
        const char kind = steps[i].kind;
        next(&x);
        if (kind == 's' || kind == '+') {
            expect_spindle(&x, kind, false);
            continue;
        }
        CHECK_EQ(x.c.type, kind == 'f' ? COMMAND_LINE : COMMAND_PTP);
        expect_place(&x, plane, steps[i].a, steps[i].b,
                     isnan(steps[i].height) ? clear : steps[i].height);
    }
    CHECK_EQ(next(&x), COMMAND_STOP);
    CHECK_EQ(next(&x), -1);
}

/* Every repeat goes on by the way of the line; without G91 it is made in the same place. */
static void repeats(void)
{
    struct reader x;
    begin(&x, "G0 Z3\nG91 G81 X4 Y5 Z-.6 R1.8 L3\nG80 G90 G0 X0 Y0\nG99 G81 X1 Z-1 R2 L2\n");
    CHECK_EQ(next(&x), COMMAND_PTP);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_place(&x, 0, 0.0, 0.0, 4.8); /* the tool is below R: first of all up there */
    for (int i = 1; i <= 3; i++) {
        CHECK_EQ(next(&x), COMMAND_PTP);
        expect_place(&x, 0, 4.0 * i, 5.0 * i, 4.8);
        expect_list(&x, 0, "f4.2 r4.8", 4.0 * i, 5.0 * i, 0.0);
    }
    CHECK_EQ(next(&x), COMMAND_PTP);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_place(&x, 0, 1.0, 0.0, 4.8);
    expect_list(&x, 0, "r2 f-1 r2 f-1 r2", 1.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* The first height of a series counts, until another motion; R may change; inch and offsets. */
static void heights(void)
{
    struct reader x;
    begin(&x, "G0 Z9\nG99 G81 X1 Z-1 R2\nG98 X2 R3\nG83 X3 Q9\nG0 X0 Z4\nG81 X1 Z-1 R2\n");
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_list(&x, 0, "r9 r2 f-1 r2", 1.0, 0.0, 0.0);
    x.c.line = 0;
    CHECK_EQ(next(&x), COMMAND_PTP); /* below the new R: up, then over the hole */
    expect_place(&x, 0, 1.0, 0.0, 3.0);
    expect_list(&x, 0, "r3 f-1 r9", 2.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -2); /* another cycle needs its words */
    CHECK_EQ(x.r.fault, FAULT_CYCLE_R);
    begin(&x, "G55 G20 G0 X0 Y0 Z1\nG81 X1 Y1 R.5 Z-1 F10\nG80\n"
              "G21 G92 X0 Y0 Z30\nG82 X1 Z1 R2 P1\n");
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_list(&x, 0, "r26.4 r13.7 f-24.4 r26.4", 125.4, 35.4, 0.0);
    CHECK_NEAR(x.c.path.end[2], 26.4, 1e-12);
    expect_list(&x, 0, "r26.4 r-1.6 f-2.6", 126.4, 35.4, 0.0);
    CHECK_NEAR(x.c.feed, 254.0 / 60.0, 1e-12);
}

/* P is kept by the cycle that had it, in its series; another one without P does not wait. */
static void dwells(void)
{
    struct reader x;
    begin(&x, "S100 M3 G0 Z5\nG82 X1 Z-1 R2 P.5\nX2\nG84 X3 Z-1 R2\nG84 X4 P.5\nX5\n"
              "G81 X6 Z-1 R2\nG84 X7 Z-1 R2\n");
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_list(&x, 0, "r5 r2 f-1 w r5", 1.0, 0.0, 0.0);
    expect_list(&x, 0, "r5 r2 f-1 w r5", 2.0, 0.0, 0.0);
    expect_list(&x, 0, "r5 r2 =+ f-1 =- f5 +", 3.0, 0.0, 0.0);
    expect_list(&x, 0, "r5 r2 =+ f-1 =- w f5 +", 4.0, 0.0, 0.0);
    expect_list(&x, 0, "r5 r2 =+ f-1 =- w f5 +", 5.0, 0.0, 0.0);
    expect_list(&x, 0, "r5 r2 f-1 r5", 6.0, 0.0, 0.0);
    expect_list(&x, 0, "r5 r2 =+ f-1 =- f5 +", 7.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* An axis that no word names does not move, whatever the rounding of offsets. */
static void rests(void)
{
    char text[128];
    struct reader x;
    for (int i = 1; i < 100; i++) {
        snprintf(text, sizeof text, "G0 X%.1f Z9\nG92 X%.2f\nG81 Y1 Z-1 R2\n", i * 0.7, i * 33.37);
        begin(&x, text);
        for (int k = 0; k < 5; k++) {
            CHECK_EQ(next(&x), k == 3 ? COMMAND_LINE : COMMAND_PTP);
            CHECK(x.c.path.end[0] == x.c.path.start[0] || k == 0);
        }
        CHECK_EQ(next(&x), -1);
    }
}

/* As many pecks as a hole may have, in a state of one size; a state goes on where it was. */
static void streams(void)
{
    struct reader x;
    int made = 0;
    begin(&x, "G0 Z1\nG91 G73 X.01 R0 Z-100 Q.02 L20\nM2\n");
    while (next(&x) >= 0) {
        const struct interpreter kept = x.in;
        x.in = kept;
        made++;
    }
    CHECK_EQ(x.r.fault, FAULT_NONE);
    CHECK_EQ(made, 1 + 20 * (1 + 5000 + 4999 + 1));
    CHECK_NEAR(x.in.point[0], 0.2, 1e-12);
    CHECK_NEAR(x.in.point[2], 1.0, 1e-12);
}

/* A check ends in what a line repeats, too: these are 200 million commands. */
static void checked(void)
{
    struct fault_list all;
    struct reader x;
    begin(&x, "G0 Z1\nG91 G73 X.0001 R0 Z-100 Q.01 L9999\nG90 G99\nG81 X1 Q5\n");
    interpreter_check_all(&x.in, &x.program, &all);
    CHECK_EQ(all.count, 0);
    CHECK(all.notes == 1 && all.note[0].fault == FAULT_NOTE_CHECKED);
}

static void refused(void)
{
    fault_is("G81 X1 Z-1\n", 1, "G81", FAULT_CYCLE_R);
    fault_is("G81 X1 R1\n", 1, "G81", FAULT_CYCLE_DEPTH);
    fault_is("G18 G81 X1 Z1 R1\n", 1, "G81", FAULT_CYCLE_DEPTH);
    fault_is("G81 X1 Z1 R0\n", 1, "G81 X1 Z1 R0", FAULT_CYCLE_LOW);
    fault_is("G83 X1 Z-1 R0\n", 1, "G83", FAULT_CYCLE_Q);
    fault_is("G73 X1 Z-1 R0 Q0\n", 1, "Q0", FAULT_VALUE);
    fault_is("G83 X1 Z-1 R0 Q-1\n", 1, "Q-1", FAULT_VALUE);
    fault_is("G83 X1 Z-100 R0 Q.001\n", 1, "G83 X1 Z-100 R0 Q.001", FAULT_CYCLE_PECKS);
    fault_is("G82 X1 Z-1 R0\n", 1, "G82", FAULT_CYCLE_P);
    fault_is("G89 X1 Z-1 R0 P-1\n", 1, "P-1", FAULT_VALUE);
    fault_is("G81 X1 Z-1 R0 L0\n", 1, "L0", FAULT_VALUE);
    fault_is("G81 X1 Z-1 R0 L1.5\n", 1, "L1.5", FAULT_VALUE);
    fault_is("G81 X1 Z-1 R0 Q1\n", 1, "Q1", FAULT_UNUSED);
    fault_is("G81 X1 Z-1 R0 P1\n", 1, "P1", FAULT_UNUSED);
    fault_is("G81 X1 Z-1 R0 I1\n", 1, "I1", FAULT_UNUSED);
    fault_is("G81 X1 Z-1 R0 U1\n", 1, "U1", FAULT_UNUSED);
    fault_is("G81 X1 Z-1 R0\nL2\n", 2, "L2", FAULT_UNUSED);
    fault_is("G81 R0\n", 1, "G81", FAULT_NO_AXES);
    fault_is("G82 X1 Z-1 R0 P1 M62\n", 1, "P1", FAULT_SHARED);
    fault_is("G84 X1 Z-1 R0\n", 1, "G84 X1 Z-1 R0", FAULT_CYCLE_SPINDLE);
    fault_is("S9 M4\nG84 X1 Z-1 R0\n", 2, "G84 X1 Z-1 R0", FAULT_CYCLE_SPINDLE);
    fault_is("M3\nG86 X1 Z-1 R0 P0\n", 2, "G86 X1 Z-1 R0 P0", FAULT_CYCLE_SPINDLE);
    fault_is("S9 M3\nG87 X1 Z-1 R0 I1 J1\n", 2, "G87", FAULT_CYCLE_ASIDE);
    fault_is("S9 M3\nG87 X1 Z-1 R0 J1 K1\n", 2, "G87", FAULT_CYCLE_ASIDE);
    fault_is("S9 M3\nG87 X1 Z-1 R0 I1 J1 K-2\n", 2, "G87 X1 Z-1 R0 I1 J1 K-2", FAULT_CYCLE_LOW);
    fault_is("S9 M3\nG87 X1 Z-1 R0 I1 J1 K0 Q1\n", 2, "Q1", FAULT_UNUSED);
    fault_is("S9\nG87 X1 Z-1 R0 I1 J1 K0\n", 2, "G87 X1 Z-1 R0 I1 J1 K0", FAULT_CYCLE_SPINDLE);
    fault_is("G17.1\n", 1, "G17.1", FAULT_PLANE);
    fault_is("G53 G81 X1 Z-1 R0\n", 1, "G53 G81 X1 Z-1 R0", FAULT_G53);
    fault_is("G81 X1 Z-1 R0\nG80\nX2\n", 3, "X2", FAULT_NO_MOTION);
    fault_is("G81 X1 Z-1 R0\nG0 X2\nG81 X3\n", 3, "G81", FAULT_CYCLE_R);
    fault_is("G81 X1 R1 Z-1 M62 P1\n( )\n G81 X1 Z-900 R0  ; far\n", 3, "G81 X1 Z-900 R0  ; far",
             FAULT_TRAVEL);
    fault_is("G41.1 D1 G0 X5\nG81 X1 Z-1 R0\n", 2, "G81", FAULT_CUTTER_WORD);
}

/* The spindle's turns ask for the feed of a tap: one that would be cut down is refused. */
static void taps_above_the_highest_feed(void)
{
    static const struct {
        const char *text;
        double feed;
    } taps[] = { { "S1000 M3\nG33.1 Z-5 K5\n", 5000.0 },
                 { "S1000 M3\nG33.1 Z-5 K2 I2\n", 4000.0 },
                 { "S1000 M3\nG33.1 Z-5 K3\n", 0.0 },
                 { "S1000 M3\nG33.1 Z-5 K1.5 I2\n", 0.0 } };
    for (size_t i = 0; i < sizeof taps / sizeof *taps; i++) {
        struct reader x;
        int got;
        begin(&x, taps[i].text);
        x.program.limits.feed = 50.0;
        while ((got = next(&x)) >= 0) {
        }
        CHECK_EQ(got, taps[i].feed > 0.0 ? -2 : -1);
        CHECK_EQ(x.r.fault, taps[i].feed > 0.0 ? FAULT_FEED : FAULT_NONE);
        if (x.r.fault != FAULT_NONE) {
            CHECK_NEAR(x.r.value, taps[i].feed, 1e-9);
            CHECK_NEAR(x.r.limit, 3000.0, 1e-9);
        }
    }
}

int main(void)
{
    all();
    for (int plane = 0; plane < 3; plane++) {
        for (int modes = 0; modes < 4; modes++) {
            back_boring(plane, modes & 1, modes & 2);
        }
    }
    repeats();
    heights();
    dwells();
    rests();
    streams();
    checked();
    refused();
    taps_above_the_highest_feed();
    return check_result();
}
