/* Every function and operator of an expression against values from tables of mathematics. */
#include "gcode_reader.h"

static double value_of(const char *expression)
{
    char text[200];
    struct reader x;

    snprintf(text, sizeof text, "G1 F600 X9999\nX[%s]\n", expression);
    begin(&x, text);
    CHECK_EQ(next(&x), COMMAND_LINE);
    const int type = next(&x);
    if (type != COMMAND_LINE) {
        printf("%s: %d %s\n", expression, type, fault_text(x.r.fault));
    }
    CHECK_EQ(type, COMMAND_LINE);
    return x.c.path.end[0];
}

static const struct {
    const char *expression;
    double value;
} all[] = {
    { "ABS[-2.5]", 2.5 },
    { "ABS[2.5]", 2.5 },
    { "ACOS[0.5]", 60.0 },
    { "ACOS[-1]", 180.0 },
    { "ASIN[0.5]", 30.0 },
    { "ASIN[-1]", -90.0 },
    { "ATAN[1]/[1]", 45.0 },
    { "ATAN[1]/[-1]", 135.0 },
    { "ATAN[-1]/[-1]", -135.0 },
    { "ATAN[3]/[0]", 90.0 },
    { "COS[60]", 0.5 },
    { "COS[180]", -1.0 },
    { "EXP[0]", 1.0 },
    { "EXP[1]", 2.718281828459045 },
    { "EXP[-2]", 0.1353352832366127 },
    { "FIX[2.8]", 2.0 },
    { "FIX[-2.2]", -3.0 },
    { "FUP[2.2]", 3.0 },
    { "FUP[-2.8]", -2.0 },
    { "LN[1]", 0.0 },
    { "LN[10]", 2.302585092994046 },
    { "ROUND[2.4]", 2.0 },
    { "ROUND[2.6]", 3.0 },
    { "ROUND[-2.6]", -3.0 },
    { "SIN[30]", 0.5 },
    { "SIN[-90]", -1.0 },
    { "SQRT[2]", 1.4142135623730951 },
    { "SQRT[16]", 4.0 },
    { "TAN[45]", 1.0 },
    { "TAN[-60]", -1.7320508075688772 },
    { "EXISTS[#<nobody>]", 0.0 },
    { "EXISTS[#<_vmajor>]", 1.0 },
    { "#<_vmajor>", 2.9 },
    { "#<_vminor> + 7", 7.0 },
    { "#<_lathe_diameter_mode> + 7", 7.0 },
    { "#<_lathe_radius_mode> + 7", 7.0 },
    { "#<_remap_level> + 7", 7.0 },
    { "7 + 3", 10.0 },
    { "7 - 3", 4.0 },
    { "7 * 3", 21.0 },
    { "7 / 4", 1.75 },
    { "7 MOD 4", 3.0 },
    { "-7 MOD 4", 1.0 },
    { "2 ** 10", 1024.0 },
    { "4 ** 0.5", 2.0 },
    { "2 + 3 * 4 ** 2", 50.0 },
    { "[2 + 3] * 4", 20.0 },
    { "2 - 3 - 4", -5.0 },
    { "1 AND 0", 0.0 },
    { "1 AND 2", 1.0 },
    { "0 AND 0", 0.0 },
    { "1 OR 0", 1.0 },
    { "0 OR 0", 0.0 },
    { "2 OR 3", 1.0 },
    { "1 XOR 0", 1.0 },
    { "1 XOR 2", 0.0 },
    { "0 XOR 0", 0.0 },
    { "1 EQ 1", 1.0 },
    { "1 EQ 2", 0.0 },
    { "1 NE 1", 0.0 },
    { "1 NE 2", 1.0 },
    { "1 LT 1", 0.0 },
    { "1 LT 2", 1.0 },
    { "2 LT 1", 0.0 },
    { "1 LE 1", 1.0 },
    { "1 LE 2", 1.0 },
    { "2 LE 1", 0.0 },
    { "1 GT 1", 0.0 },
    { "1 GT 2", 0.0 },
    { "2 GT 1", 1.0 },
    { "1 GE 1", 1.0 },
    { "1 GE 2", 0.0 },
    { "2 GE 1", 1.0 },
    { "1 + 1 EQ 2", 1.0 },
    { "0 EQ 1 AND 0", 0.0 },
    { "0 AND 0 OR 1", 1.0 },
};

int main(void)
{
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        const int before = check_failures;
        CHECK_NEAR(value_of(all[i].expression), all[i].value, 1e-14 * fabs(all[i].value) + 1e-15);
        if (check_failures > before) {
            printf("    %s\n", all[i].expression);
        }
    }
    return check_result();
}
