/* Curves of micrometres a metre away from the origin are as smooth as at it. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "shape.h"

enum { LINES = 2000 };

static struct shape shape;
static struct segment before;
static double jump[3]; /* most of place [mm], r' and r'' [1/mm] where segments meet */

static void drain(void)
{
    for (int32_t k = 0; k < shape_count(&shape); k++) {
        const struct segment *p = shape_segment(&shape, k);
        struct segment_state a, b;
        segment_at(&before, before.length, &a);
        segment_at(p, 0.0, &b);
        for (int i = 0; i < AXES && before.length > 0.0 && !before.rest; i++) {
            jump[0] = fmax(jump[0], fabs(a.point[i] - b.point[i]));
            jump[1] = fmax(jump[1], fabs(a.slope[i] - b.slope[i]));
            jump[2] = fmax(jump[2], fabs(a.bend[i] - b.bend[i]));
        }
        before = *p;
    }
    shape_drop(&shape, shape_count(&shape));
    shape_drop_marks(&shape, shape_marks(&shape));
}

/* A walk of steps that turn by up to half a radian. Returns the number of segments. */
static int64_t walk(double start, double step, double tolerance, double merge)
{
    double from[AXES] = { start, start }, angle = 0.0;
    uint64_t dice = 15;

    memset(jump, 0, sizeof jump);
    memset(&before, 0, sizeof before);
    shape_start(&shape, merge);
    for (int32_t k = 1; k <= LINES; k++) {
        struct command c = { .type = COMMAND_LINE,
                             .tolerance = tolerance,
                             .feed = 50.0,
                             .cap = 100.0,
                             .ramp = { 1000.0, 1000.0, 0.0, 0.0 },
                             .index = k };
        double to[AXES];
        angle += check_real(&dice, -0.5, 0.5);
        memcpy(to, from, sizeof to);
        to[0] += step * cos(angle);
        to[1] += step * sin(angle);
        path_line(&c.path, from, to);
        while (shape_take(&shape, &c) == SHAPE_FULL) {
            drain();
        }
        memcpy(from, to, sizeof from);
        drain();
    }
    shape_end(&shape);
    while (shape_count(&shape) > 0) {
        drain();
    }
    return shape.made;
}

int main(void)
{
    static const double rows[][3] = {
        /* step, tolerance, merge [mm] */
        { 0.1, 0.01, 0.0 },
        { 0.001, 1e-3, 0.0 }, /* a corner at each vertex */
        { 0.001, 1e-4, 1.0 },
        { 0.01, 1e-4, 1.0 },
        { 0.001, 0.02, 1.0 } /* splines */
    };

    for (int k = 0; k < 5; k++) {
        const int64_t near = walk(0.0, rows[k][0], rows[k][1], rows[k][2]);
        const int64_t far = walk(1000.0, rows[k][0], rows[k][1], rows[k][2]);
        printf("%g mm, %g mm: %d segments, %d at 1 m, jumps of r %.0e, r' %.0e, r'' %.0e /mm\n",
               rows[k][0], rows[k][1], (int)near, (int)far, jump[0], jump[1], jump[2]);
        CHECK(jump[0] <= 1e-12); /* two roundings of 1 m */
        CHECK(jump[1] <= 1e-13);
        CHECK(jump[2] <= 2e-9); /* 1e-16 of some r' over 0.1 um */
        CHECK(near > 20 && labs((long)(far - near)) <= near / 10);
    }
    return check_result();
}
