/* What a saved state of the interpreter leaves out: nonsense there changes no command. */
#include "gcode_reader.h"

#include "library_in_use.h"

struct model {
    struct interpreter in;
};

struct state {
    struct model m;
};

static const struct fmu_row rows[] = { INTERPRETER_IN_USE(in) };

static const char text[] =
    "O100 SUB\n#<deep>=[#1+1]\nG1 X[#<deep>] Y#64 F600\nO101 IF [#1 GT 1]\nO100 CALL [#1-1]\n"
    "O101 ENDIF\nO100 ENDSUB\n"
    "#64=2 #65=3\n#128=4\n#129=5 #4161=6\n#5000=7 #<_far>=8\n"
    "O100 CALL [3]\n#<near>=9\nG1 X#64 Y#65\nX#128 Y#129\nX#4161 Y#5000\nZ#<_far> Y#<near>\n"
    "G41.1 D4 X20 Y0\nX40\nY20\nX20\nG40 X0 Y0\nG81 X1 Y1 Z-1 R1\nX2\nG80\n"
    "O102 REPEAT [2]\nG91 G1 X1\nO102 ENDREPEAT\nG90 X0\n";

/* The same interpreter with nonsense where no copy is needed. */
static struct interpreter without(const struct interpreter *in)
{
    static struct state other;
    struct fmu_span span[FMU_SPANS];
    other.m.in = *in;
    const size_t n = fmu_spans(&other, 0, rows, sizeof rows / sizeof *rows, span, 0);
    size_t left = 0;
    for (size_t i = 0; i < n; i++) {
        left += span[i].to - span[i].from;
        memset((char *)&other + span[i].from, 0xa5, span[i].to - span[i].from);
    }
    CHECK(n < FMU_SPANS && left > sizeof other / 2);
    return other.m.in;
}

/* One number that is set is kept, in whichever page it lies, at either end of that. */
static void each_page(void)
{
    for (int32_t n = PARAMETERS_PAGE; n < PARAMETERS_NUMBERED; n += n % 2 ? 1 : 63) {
        char one[64];
        struct reader x;
        snprintf(one, sizeof one, "#%d=%d\nG1 F600 X#%d\nX0\n", (int)n, (int)n, (int)n);
        begin(&x, one);
        CHECK_EQ(next(&x), COMMAND_LINE);
        x.in = without(&x.in);
        CHECK_NEAR(x.c.path.end[0], n, 0.0);
        CHECK_EQ(next(&x), COMMAND_LINE);
    }
}

int main(void)
{
    struct reader whole, part;
    int32_t commands = 0;

    each_page();
    begin(&whole, text);
    begin(&part, text);
    for (;;) {
        part.in = without(&part.in);
        const int type = next(&whole);
        CHECK_EQ(next(&part), type);
        if (type < 0) {
            CHECK_EQ(type, -1);
            break;
        }
        commands++;
        for (int32_t a = 0; a < AXES; a++) {
            CHECK_NEAR(part.c.path.end[a], whole.c.path.end[a], 0.0);
        }
        CHECK_EQ(part.c.line, whole.c.line);
    }
    CHECK_EQ(commands, 23);
    return check_result();
}
