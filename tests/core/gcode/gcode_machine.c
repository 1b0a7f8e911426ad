/* Words for the machine beside its axes: tools, overrides, analog outputs, inputs, a probe. */
#include "gcode_reader.h"
#include "tools.h"
#include "waiting.h"

/* A tool table of lines of text; the first one that is wrong, or NULL. */
static const char *table_of(struct tool_table *t, const char *text, struct tool_text *at)
{
    memset(t, 0, sizeof *t);
    while (*text) {
        const char *end = text + strcspn(text, "\n");
        const char *why = tool_table_line(t, text, (int32_t)(end - text), false, at);
        if (why) {
            return why;
        }
        text = end + (*end != '\0');
    }
    return NULL;
}

static const char TABLE[] = "; number, pocket, length, diameter\n"
                            "T1 P1 D6.0 Z+50.2 ;end mill\n"
                            "T2 P2 X1.5 Y-2 Z20 D-0 I90 J80 Q3\n"
                            "\n"
                            "T10 P7 D3 Z30 A0\n";

static void begin_with_tools(struct reader *x, const char *text)
{
    struct tool_text at;
    begin(x, text);
    CHECK(!table_of(&x->in.tools.table, TABLE, &at));
}

static void tables(void)
{
    static const struct {
        const char *text, *why, *at;
    } bad[] = {
        { "T1 P1\nT1 P2\n", "a tool that is in the table already", "T1 P2" },
        { "P1 D2\n", "no tool number T", "P1 D2" },
        { "T1 D-6\n", "a diameter below 0", "D-6" },
        { "T1.5 P1\n", "not a whole number", "T1.5" },
        { "T0 P1\n", "not a whole number", "T0" },
        { "T1 P1 A5\n", "no column of a tool table", "A5" },
        { "T1 P1 F5\n", "no column of a tool table", "F5" },
        { "T1 P1 Z1 Z2\n", "given twice", "Z2" },
        { "T1 P1 $\n", "not a word of a letter and a number", "$" },
    };
    static struct tool_table t;
    struct tool_text at;
    struct tool tool;

    CHECK(tool_table_find(&t, 77, &tool) && tool.diameter == 0.0); /* no file: any tool */
    CHECK(!table_of(&t, TABLE, &at));
    CHECK_EQ(t.count, 3);
    CHECK(tool_table_find(&t, 1, &tool) && tool.offset[2] == 50.2 && tool.diameter == 6.0);
    CHECK(tool_table_find(&t, 2, &tool) && tool.offset[0] == 1.5 && tool.offset[1] == -2.0);
    CHECK(tool_table_find(&t, 10, &tool) && tool.pocket == 7);
    CHECK(!tool_table_find(&t, 3, &tool) && tool_table_find(&t, 0, &tool));
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const char *why = table_of(&t, bad[i].text, &at);
        CHECK(why && !strcmp(why, bad[i].why));
        CHECK_EQ(at.length, strlen(bad[i].at));
        CHECK(strstr(bad[i].text, bad[i].at));
    }
    memset(&t, 0, sizeof t);
    for (int i = 1; i <= TOOL_TABLE_MAX + 1; i++) {
        char line[32];
        snprintf(line, sizeof line, "T%d P%d", i, i);
        CHECK((tool_table_line(&t, line, (int32_t)strlen(line), false, &at) != NULL)
              == (i > TOOL_TABLE_MAX));
    }
}

/* M6 stops for the operator, with a turning spindle off before; or it is immediate. */
static void changes(void)
{
    struct reader x;

    begin_with_tools(&x, "T2\nM3 S500\nM6 T1\nT10 M6\nM61 Q2\n");
    x.program.change_stops = true;
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK(x.c.spindle == 500.0 && x.c.tool == 0);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK(x.c.spindle == 0.0 && x.c.tool == 0);
    CHECK_EQ(next(&x), COMMAND_STOP);
    CHECK(x.c.changes && x.c.tool == 1);
    CHECK_EQ(next(&x), COMMAND_STOP); /* the spindle stands already */
    CHECK(x.c.changes && x.c.tool == 10);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(x.c.tool, 2);
    CHECK_EQ(next(&x), -1);

    begin_with_tools(&x, "T2\nM6\nM6\n");
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(x.c.tool, 2);
    CHECK_EQ(next(&x), -2);
    CHECK(x.r.fault == FAULT_NO_TOOL && x.r.line == 3);

    begin_with_tools(&x, "T3 M6\n");
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_TOOL);
}

/* Machine coordinate = program coordinate + offset of the tool, from the next motion on. */
static void lengths(void)
{
    static const struct {
        const char *text;
        double end[3];
    } rows[] = {
        { "T1 M6 G43\nG0 Z10\n", { 0, 0, 60.2 } },
        { "G43 H2\nG0 X1 Y1 Z1\n", { 2.5, -1, 21 } },
        { "G43 H2\nG0 Z1\n", { 0, 0, 21 } },           /* only what is named moves */
        { "G43 H2 G0 Z1\n", { 0, 0, 21 } },            /* before the motion of its line */
        { "T1 M6\nG43 H0\nG0 Z10\n", { 0, 0, 60.2 } }, /* 0: the one in the spindle */
        { "G43 H1\nG0 Z10\nG49\nZ11\n", { 0, 0, 11 } },
        { "G43 H1\nG43.1 Z5\nG0 X3 Z1\n", { 3, 0, 6 } },
        { "G43 H2\nG43.2 H10\nG0 X0 Z0\n", { 1.5, 0, 50 } },
        { "G43 H1\nG43.2 Z0.1\nG0 Z0\n", { 0, 0, 50.3 } },
        { "G20 G43.1 Z1\nG0 Z1\n", { 0, 0, 50.8 } },
        { "G43 H1\nG53 G0 Z10\n", { 0, 0, 10 } },
        { "G43 H1\nG55 G0 X1 Z10\n", { 101, 0, 61.2 } },
        { "G0 Z80\nG43 H1\nG92 Z0\nG0 Z5\n", { 0, 0, 85 } },
        { "G43 H1\nG91 G0 Z10\n", { 0, 0, 10 } },
        { "G10 L1 P1 Z7 R2\nG43 H1 G0 Z1\n", { 0, 0, 8 } },
        { "G0 Z30\nG10 L10 P1 Z1.5\nG43 H1\nG0 Z2\n", { 0, 0, 30.5 } },
        { "G43 H2\nG0 Z30\nG10 L10 P1 Z1.5\nG43 H1\nG0 Z2\n", { 0, 0, 50.5 } },
        { "G55 G0 Z30\nG92 Z0\nG10 L11 P1 Z4\nG92.1\nG54 G43 H1\nG0 Z4\n", { 0, 0, 31 } },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct reader x;
        int type;
        begin_with_tools(&x, rows[i].text);
        while ((type = next(&x)) >= 0) {
        }
        CHECK_EQ(type, -1);
        if (type == -2) {
            printf("    '%s' line %d: %s\n", rows[i].text, (int)x.r.line, fault_text(x.r.fault));
        }
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(x.in.point[k], rows[i].end[k], 1e-12);
        }
    }
    struct reader x;
    double d;
    begin_with_tools(&x, "T1 M6\nG10 L1 P10 R4\nG43 H3\n");
    while (next(&x) >= 0) {
    }
    CHECK(x.r.fault == FAULT_TOOL && x.r.line == 3);
    CHECK(tools_diameter(&x.in, 10, &d) && d == 8.0);
    CHECK(tools_diameter(&x.in, 0, &d) && d == 6.0);
    CHECK(!tools_diameter(&x.in, 3, &d));
    static const struct {
        int number;
        double value;
    } numbers[] = {
        { 5400, 2 }, { 5401, 1.5 }, { 5402, -2 }, { 5403, 20 },   { 5404, 0 }, { 5407, 0 },
        { 5410, 0 }, { 5413, 0 },   { 5081, 0 },  { 5083, 50.2 }, { 5089, 0 },
    };
    begin_with_tools(&x, "T2 M6\nG43 H1\n");
    while (next(&x) >= 0) {
    }
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        CHECK(tools_parameter(&x.in, false, numbers[i].number, &d) && d == numbers[i].value);
    }
    CHECK(!tools_parameter(&x.in, false, 5399, &d) && !tools_parameter(&x.in, false, 5414, &d));
}

static void overrides(void)
{
    static const struct {
        const char *text;
        uint32_t now;
    } rows[] = {
        { "M49\n", OUTPUTS_FEED_FIXED | OUTPUTS_SPEED_FIXED },
        { "M48\n", 0 },
        { "M50 P0\n", OUTPUTS_FEED_FIXED },
        { "M50\n", 0 },
        { "M51 P0\n", OUTPUTS_SPEED_FIXED },
        { "M51 P1\n", 0 },
        { "M52\n", OUTPUTS_ADAPTIVE },
        { "M52 P0\n", 0 },
        { "M53 P0\n", OUTPUTS_HOLD_OFF },
        { "M53\n", 0 },
        { "M49\nM50 P1\n", OUTPUTS_SPEED_FIXED },
        { "M52\nM49\nM2\n", 0 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        struct reader x;
        begin(&x, rows[i].text);
        while (next(&x) >= 0) {
            CHECK_EQ(x.c.type, COMMAND_OUTPUTS);
        }
        CHECK_EQ(x.r.fault, FAULT_NONE);
        CHECK_EQ(x.c.overrides, rows[i].now);
        CHECK_EQ(x.in.switches.overrides, rows[i].now);
    }
}

/* M67 goes with the next motion, M68 behind the motion before; M60 stops, M19 stops the spindle. */
static void others(void)
{
    struct reader x;

    begin(&x, "M67 E1 Q2.5\nM67 E1 Q3\nM68 E0 Q-1\nG1 X1\nX2\nM60\nM3 S10\nM19 R90 P1\nG97 S5\n");
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK(x.c.analog.set == 1 && x.c.analog.value[0] == -1.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(x.c.analog.set == 2 && x.c.analog.value[1] == 3.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(x.c.analog.set, 0);
    CHECK_EQ(next(&x), COMMAND_STOP);
    CHECK(!x.c.changes);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK(x.c.spindle == 0.0 && x.r.note[0].what == FAULT_NOTE_ORIENT && x.r.note[0].line == 8);
    CHECK_EQ(next(&x), -1);
}

/* G96: S is a speed along the work, D the most, and the radius counts from the program's X0. */
static void surface(void)
{
    static const struct {
        double speed, centre, x, most, is;
    } at[] = {
        { 0.0, 0.0, 1.0, 500.0, 500.0 },              /* not in force */
        { 1000.0, 0.0, 10.0, 5000.0, 954.929658551 }, /* 60 m/min at 20 mm of diameter */
        { 1000.0, 4.0, -6.0, 5000.0, 954.929658551 },
        { 1000.0, 0.0, 10.0, -5000.0, -954.929658551 },
        { 1000.0, 3.0, 3.0, 5000.0, 5000.0 }, /* at the axis */
        { 1000.0, 0.0, 10.0, 900.0, 900.0 },
        { 1000.0, 0.0, 10.0, 0.0, 0.0 }, /* it stands */
    };
    struct reader x;

    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        const struct outputs_surface s = { at[i].speed, at[i].centre };
        CHECK_NEAR(outputs_spindle(&s, at[i].most, at[i].x), at[i].is, 1e-8);
    }
    begin(&x, "S300 M4\nG96 S60 D4000\nG55\nG20 S10\nG97\nM2\n");
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.spindle == -300.0 && x.c.surface.speed == 0.0);
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.spindle == -4000.0 && x.c.surface.speed == 1000.0
          && x.c.surface.centre == 0.0);
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.surface.centre == 100.0); /* X0 of G55 */
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.surface.speed == 10.0 * 304.8 / 60.0);
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.spindle == -300.0 && x.c.surface.speed == 0.0);
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.spindle == 0.0);
    CHECK_EQ(next(&x), -1);
    begin(&x, "M3 G96 S60 D4000\nM5\nG92 X7\nM3\nG96 S0 D9\n");
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.spindle == 4000.0);
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.spindle == 0.0 && x.c.surface.speed == 0.0);
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.surface.centre == -7.0);
    CHECK(next(&x) == COMMAND_OUTPUTS && x.c.spindle == 0.0);
    CHECK_EQ(next(&x), -1);
}

/* What a name says behind a program; those of other controllers are refused, and never exist. */
static void names(void)
{
    static const struct {
        const char *before, *name;
        double value;
    } rows[] = {
        { "", "_task", 1 },
        { "G1", "_motion_mode", 10 },
        { "", "_motion_mode", 800 },
        { "G18", "_plane", 180 },
        { "G19", "_plane", 190 },
        { "G41.1 D2", "_ccomp", 410 },
        { "G42.1 D2", "_ccomp", 420 },
        { "G41 D0\nG40", "_ccomp", 400 },
        { "G20", "_metric", 0 },
        { "G20", "_imperial", 1 },
        { "G91", "_absolute", 0 },
        { "G91", "_incremental", 1 },
        { "G93", "_inverse_time", 1 },
        { "G93", "_units_per_minute", 0 },
        { "G95", "_units_per_rev", 1 },
        { "G59", "_coord_system", 590 },
        { "G59.3", "_coord_system", 593 },
        { "G54", "_coord_system", 540 },
        { "G43 H1", "_tool_offset", 1 },
        { "G43 H1\nG49", "_tool_offset", 0 },
        { "G99", "_retract_r_plane", 1 },
        { "G99", "_retract_old_z", 0 },
        { "", "_spindle_rpm_mode", 1 },
        { "G96 S1 D2", "_spindle_css_mode", 1 },
        { "G96 S1 D2\nG97", "_spindle_css_mode", 0 },
        { "G90.1", "_ijk_absolute_mode", 1 },
        { "M4", "_spindle_on", 1 },
        { "M4", "_spindle_cw", 0 },
        { "M3", "_spindle_cw", 1 },
        { "M7\nM8", "_mist", 1 },
        { "M7", "_flood", 0 },
        { "M49", "_speed_override", 0 },
        { "M50 P0", "_feed_override", 0 },
        { "M50 P0", "_speed_override", 1 },
        { "M52", "_adaptive_feed", 1 },
        { "M53 P0", "_feed_hold", 0 },
        { "", "_feed_hold", 1 },
        { "F90", "_feed", 90 },
        { "F254 G20", "_feed", 254 },
        { "G95 F.5", "_feed", 0.5 },
        { "F254\nG20", "_feed", 10 },
        { "G93 F9", "_feed", 0 },
        { "S77", "_rpm", 77 },
        { "T10 M6", "_current_tool", 10 },
        { "T10 M6", "_current_pocket", 7 },
        { "T10", "_selected_tool", 10 },
        { "T10", "_selected_pocket", 7 },
        { "T10 M6", "_selected_tool", -1 },
        { "", "_current_pocket", 0 },
        { "G0 X5\nG92 X1", "_x", 1 },
        { "G0 X5\nG92 X1", "_abs_x", 5 },
        { "G20", "_abs_a", 0 },
        { "G20 G0 X1", "_abs_x", 1 },
        { "", "_line", 2 },
        { "", "_call_level", 0 },
    };
    struct reader x;

    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[120];
        snprintf(text, sizeof text, "%s\n#1=#<%s>\n", rows[i].before, rows[i].name);
        begin_with_tools(&x, text);
        while (next(&x) >= 0) {
        }
        CHECK_EQ(x.r.fault, FAULT_NONE);
        CHECK_NEAR(x.in.parameters.value[0], rows[i].value, 1e-12);
    }
    begin(&x, "#1=[EXISTS[#<_vminor>] + 2 * EXISTS[#<_task>] + 4 * EXISTS[#<_hal[a]>]]\n");
    CHECK_EQ(next(&x), -1);
    CHECK_NEAR(x.in.parameters.value[0], 3.0, 0.0);
}

/* Reading stops behind what is before the wait in the order of the words, until it is answered. */
static void waits(void)
{
    struct reader x;
    struct fault_report r;

    begin(&x, "G1 X1\nG1 X2 M66 P3 L1 Q5\nM66 E2\nX3\n");
    x.program.has_inputs = true;
    interpreter_check(&x.in, &x.program, &r);
    CHECK_EQ(r.fault, FAULT_NONE);
    CHECK_EQ(next(&x), COMMAND_LINE);
    for (int i = 0; i < 3; i++) {
        CHECK_EQ(interpreter_next(&x.in, &x.program, &x.c, &x.r), INTERPRETER_WAIT);
    }
    CHECK(x.in.wait.kind == WAIT_DIGITAL && x.in.wait.index == 3 && x.in.wait.mode == WAIT_RISE
          && x.in.wait.limit == 5.0);
    waiting_answer(&x.in, 1.0);
    CHECK(next(&x) == COMMAND_LINE && x.c.path.end[0] == 2.0 && x.in.input == 1.0);
    CHECK_EQ(interpreter_next(&x.in, &x.program, &x.c, &x.r), INTERPRETER_WAIT);
    CHECK(x.in.wait.kind == WAIT_ANALOG && x.in.wait.index == 2);
    waiting_answer(&x.in, 0.25);
    CHECK(next(&x) == COMMAND_LINE && x.in.input == 0.25);
    CHECK_EQ(next(&x), -1);

    static const struct {
        const char *text, *at;
        enum fault fault;
    } bad[] = {
        { "M66", "M66", FAULT_MISSING },       { "M66 P32", "P32", FAULT_VALUE },
        { "M66 E4", "E4", FAULT_VALUE },       { "M66 E1 L1 Q1", "L1", FAULT_VALUE },
        { "M66 P1 E1", "P1", FAULT_SHARED },   { "M66 P1 L3", "M66", FAULT_MISSING },
        { "M66 P1 L3 Q0", "Q0", FAULT_VALUE }, { "M66 P1 L5 Q1", "L5", FAULT_VALUE },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        begin(&x, bad[i].text);
        x.program.has_inputs = true;
        CHECK_EQ(next(&x), -2);
        CHECK_EQ(x.r.fault, bad[i].fault);
        CHECK(!memcmp(bad[i].text + x.r.at, bad[i].at, strlen(bad[i].at)));
    }
    static const double rises[] = { 0, 0, 1 }, falls[] = { 1, 1, 0 };
    for (int mode = WAIT_NOW; mode <= WAIT_LOW; mode++) {
        const struct waiting w = { .mode = (enum wait_mode)mode };
        for (int i = 1; i < 3; i++) {
            CHECK_EQ(waiting_done(&w, rises[i], rises[i - 1]), mode == WAIT_NOW || mode == WAIT_LOW
                                                                   ? mode == WAIT_NOW || i == 1
                                                               : mode == WAIT_FALL ? false
                                                                                   : i == 2);
            CHECK_EQ(waiting_done(&w, falls[i], falls[i - 1]), mode == WAIT_NOW || mode == WAIT_HIGH
                                                                   ? mode == WAIT_NOW || i == 1
                                                               : mode == WAIT_RISE ? false
                                                                                   : i == 2);
        }
    }
}

/* A line that may be cut short, behind a wait whether it may begin; then it goes on from rest. */
static void probing(void)
{
    const double rest[AXES] = { 3.5 }, contact[AXES] = { 3.0, 0.0, 1.0 };
    struct reader x;
    struct fault_report r;

    begin(&x, "G64 G1 X1 F100\nG55 G38.2 X-90 Y-10 M64 P1\nG1 X-95\n");
    x.program.has_probe = true;
    interpreter_check(&x.in, &x.program, &r);
    CHECK_EQ(r.fault, FAULT_NONE);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(interpreter_next(&x.in, &x.program, &x.c, &x.r), INTERPRETER_WAIT);
    CHECK(x.in.wait.kind == WAIT_FREE && x.in.wait.mode == WAIT_HIGH && x.in.wait.must);
    waiting_free(&x.in);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(x.c.probes && !x.c.blend && x.c.path.end[0] == 10.0);
    CHECK_EQ(interpreter_next(&x.in, &x.program, &x.c, &x.r), INTERPRETER_WAIT);
    waiting_probed(&x.in, contact, rest, true);
    CHECK(x.in.touched && x.in.contact[0] == -97.0 && x.in.contact[1] == -10.0
          && x.in.contact[2] == 0.0);
    double value;
    CHECK(waiting_parameter(&x.in, false, 5061, &value) && value == -97.0);
    CHECK(waiting_parameter(&x.in, false, 5069, &value) && value == 0.0);
    CHECK(waiting_parameter(&x.in, false, 5070, &value) && value == 1.0);
    CHECK(!waiting_parameter(&x.in, false, 5060, &value));
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(x.c.blend && x.c.path.start[0] == 3.5 && x.c.path.end[0] == 5.0);
    CHECK_EQ(next(&x), -1);

    static const struct {
        const char *text;
        enum fault fault;
    } bad[] = {
        { "G38.2 X0\n", FAULT_PROBE_POINT },        { "G38.3\n", FAULT_NO_AXES },
        { "G38.5 X1 F100\nX2\n", FAULT_NO_MOTION }, { "G38.2 X1 M66 P1\n", FAULT_SHARED },
        { "G1 X5 G38.2\n", FAULT_GROUP },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        begin(&x, bad[i].text);
        x.program.has_probe = x.program.has_inputs = true;
        interpreter_check(&x.in, &x.program, &r);
        CHECK_EQ(r.fault, bad[i].fault);
    }
}

int main(void)
{
    tables();
    changes();
    lengths();
    overrides();
    others();
    surface();
    names();
    waits();
    probing();
    return check_result();
}
