/* Arcs as posts round them: none is refused, the radius changes evenly; the bounds of what is. */
#include "gcode_reader.h"

enum { ARCS = 400 };

static double rounded(double x, double unit)
{
    return round(x / unit) * unit;
}

/* An arc whose start, end and centre or radius are each rounded at so many decimals. Radii from 0.2
 * to 200 mm. */
static void posted(bool inch, bool by_radius, double *largest)
{
    const int decimals = inch ? 3 : 2;
    const double unit = inch ? 0.001 : 0.01, size = inch ? 25.4 : 1.0;
    uint64_t seed = by_radius ? 3 : 4;

    for (int i = 0; i < ARCS; i++) {
        const double r = exp(check_real(&seed, log(0.2), log(200.0))) / size;
        const double a = check_real(&seed, 0.0, 6.28), turn = check_real(&seed, 0.3, 3.14159);
        const double b = i % 4 ? a + turn : a + acos(-1.0); /* and many half circles */
        const double x0 = rounded(r * cos(a), unit), y0 = rounded(r * sin(a), unit);
        const double x1 = rounded(r * cos(b), unit), y1 = rounded(r * sin(b), unit);
        char text[200];
        struct reader x;
        if (x0 == x1 && y0 == y1) {
            continue;
        }
        if (by_radius) {
            snprintf(text, sizeof text, "G%d G1 X%.*f Y%.*f F600\nG3 X%.*f Y%.*f R%.*f\n",
                     inch ? 20 : 21, decimals, x0, decimals, y0, decimals, x1, decimals, y1,
                     decimals, r);
        } else {
            snprintf(text, sizeof text, "G%d G1 X%.*f Y%.*f F600\nG3 X%.*f Y%.*f I%.*f J%.*f\n",
                     inch ? 20 : 21, decimals, x0, decimals, y0, decimals, x1, decimals, y1,
                     decimals, -r * cos(a), decimals, -r * sin(a));
        }
        begin(&x, text);
        x.program.limits.feed = 1000.0;
        const bool moves = x0 != 0.0 || y0 != 0.0;
        CHECK(!moves || next(&x) == COMMAND_LINE);
        const int got = next(&x);
        CHECK_EQ(got, COMMAND_CCW_ARC);
        if (got != COMMAND_CCW_ARC) {
            printf("    '%s'\n", text);
            continue;
        }
        const struct path *p = &x.c.path;
        double at[AXES], slope[AXES];
        *largest = fmax(*largest, fabs(p->growth));
        CHECK(p->sweep > 0.0 && p->sweep < 2.0 * acos(-1.0) + 1e-6);
        path_at(p, 0.5 * p->length, at, slope); /* half of the change in the middle */
        CHECK_NEAR(hypot(at[0] - p->centre[0], at[1] - p->centre[1]), p->radius + 0.5 * p->growth,
                   1e-9);
        path_at(p, p->length, at, slope);
        CHECK_NEAR(at[0], x1 * size, 1e-9);
        CHECK_NEAR(at[1], y1 * size, 1e-9);
    }
}

/* The end of an arc of a radius that misses by so much. */
static bool accepted(const char *unit, double radius, double miss, struct path_tolerance t)
{
    char text[200];
    struct reader x;

    snprintf(text, sizeof text, "%s G3 X%.6f Y%.6f I0 J%.6f\n", unit, radius + miss, radius,
             radius);
    begin(&x, text);
    x.program.arc = t;
    return next(&x) >= 0;
}

static void bounds(void)
{
    const struct path_tolerance usual = { 0.0, 0.0 }, own = { 0.1, 0.01 };

    CHECK(accepted("G21", 5.0, 0.0282, usual));
    CHECK(!accepted("G21", 5.0, 0.0284, usual));
    CHECK(accepted("G21", 500.0, 0.4995, usual)); /* a thousandth */
    CHECK(!accepted("G21", 500.0, 0.502, usual));
    CHECK(accepted("G21", 680.0, -0.67, usual));
    CHECK(accepted("G20", 0.2, 0.00282, usual));
    CHECK(!accepted("G20", 0.2, 0.00284, usual));
    CHECK(accepted("G21", 5.0, 0.099, own));
    CHECK(!accepted("G21", 5.0, 0.101, own));
    CHECK(accepted("G21", 50.0, 0.499, own));
    CHECK(!accepted("G21", 50.0, 0.51, own));
}

/* Half a chord longer than the radius by rounding: half a circle about its middle. */
static void half_circle(void)
{
    struct reader x;
    begin(&x, "G2 X10.05 Y0 R5\n");
    CHECK_EQ(next(&x), COMMAND_CW_ARC);
    CHECK_NEAR(x.c.path.radius, 5.025, 1e-12);
    CHECK_NEAR(x.c.path.sweep, -acos(-1.0), 1e-12);
    begin(&x, "G2 X10.06 Y0 R5\n");
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_ARC_CHORD);
    CHECK_NEAR(x.r.value, 5.0, 1e-12);
    CHECK_NEAR(x.r.limit, 5.03, 1e-12);
}

int main(void)
{
    double largest = 0.0;
    for (int k = 0; k < 4; k++) {
        posted(k & 1, k & 2, &largest);
    }
    CHECK(largest > 0.02 && largest < 0.0719);
    printf("4 x %d arcs; the radius changes by up to %.4f mm\n", ARCS, largest);
    bounds();
    half_circle();
    return check_result();
}
