/* A state from outside with one number wrong is refused: what it would lead to is no place. */
#include "gcode_reader.h"

static const char text[] =
    "F600\nG91 M70\no1 sub\nM73\nG55 G18 G1 X1\nG91 G81 X2 Y-1 R1 L2\no1 endsub\no1 call\nM72\n";

static struct reader x;
static struct interpreter good;

/* With the statement done to it, the state is refused; what it was before is none the worse. */
#define REFUSED(...) \
    do { \
        __VA_ARGS__; \
        CHECK(interpreter_damaged(&x.in)); \
        memcpy(&x.in, &good, sizeof good); \
        CHECK(!interpreter_damaged(&x.in)); \
    } while (0)

int main(void)
{
    begin(&x, text);
    for (int i = 0; i < 3; i++) {
        CHECK(next(&x) >= 0);
    }
    memcpy(&good, &x.in, sizeof good);
    CHECK_EQ(x.in.flow.level, 1);
    REFUSED(x.in.saved[0].plane = PATH_TILTED);
    REFUSED(x.in.saved[0].system = INTERPRETER_ALL);
    REFUSED(x.in.saved[1].system = -1);
    REFUSED(x.in.saved[1].kept = false; x.in.saved[1].plane = PATH_TILTED);
    REFUSED(x.in.cutter.plane = PATH_TILTED);
    REFUSED(x.in.nurbs.plane = PATH_TILTED);
    REFUSED(x.in.cycle.line.file = 1);
    REFUSED(x.in.flow.files = 1; strcpy(x.in.flow.file[0], "../a"));
    REFUSED(x.in.flow.files = 1; strcpy(x.in.flow.file[0], ""));
    REFUSED(x.in.cycle.way.polar = CYCLE_POLAR + 1);
    x.in.saved[2].system = -1;      /* of no call: nobody looks at it */
    x.in.saved[2].kept = true;
    CHECK(!interpreter_damaged(&x.in));
    while (next(&x) >= 0) {
    }
    CHECK_EQ(x.r.fault, FAULT_NONE);
    CHECK_EQ(x.in.system, 0);
    CHECK_EQ(x.in.plane, PATH_XY);
    return check_result();
}
