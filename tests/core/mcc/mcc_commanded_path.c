/* The nearest point on the commanded path against closed formulas and dense sampling. */
#include "mcc_check.h"
#include "commanded_path.h"

static struct commanded_path t;

static void push(double x, double y, double z)
{
    commanded_path_push(&t, &(struct commanded_path_point){ .place = { x, y, z } });
}

/* A circle at a speed that changes all the time: the error is R - r, at any lag. The estimate by
 * the tangent at the commanded point would be R sin^2(lag)-like, twice too much. */
static void circle_is_exact(uint64_t seed)
{
    for (int trial = 0; trial < 40; trial++) {
        const double radius = exp(check_real(&seed, log(0.5), log(2000.0)));
        const double step = exp(check_real(&seed, log(1e-5), log(0.3))); /* [rad] */
        const double lag = check_real(&seed, 2.0, 8.0);                  /* frames */
        const double tilt = trial % 2 ? 0.7 : 0.0, c = cos(tilt), s = sin(tilt);
        double angle = 0.0, before[10] = { 0.0 };
        commanded_path_start(&t, (double[3]){ radius, 0.0, 0.0 });
        for (int n = 1; n <= 400; n++) {
            memmove(before + 1, before, 9 * sizeof *before);
            before[0] = angle;
            angle += step * check_real(&seed, 0.7, 1.3);
            push(radius * cos(angle), radius * sin(angle) * c, radius * sin(angle) * s);
            if (n < 12) {
                continue;
            }
            const double at = before[(int)lag] + (lag - (int)lag) * 0.5 * step;
            const double off = radius * check_real(&seed, -0.02, 0.02), r = radius + off;
            const double tool[3] = { r * cos(at), r * sin(at) * c, r * sin(at) * s };
            const struct commanded_path_foot f = commanded_path_nearest(&t, tool, n);
            const double want[3] = { -off * cos(at), -off * sin(at) * c, -off * sin(at) * s };
            for (int k = 0; k < 3; k++) {
                /* Three points tell a bend to rounding over step^2. */
                CHECK_NEAR(f.error[k], want[k], radius * (1e-12 + 1e-15 / step));
            }
            CHECK_NEAR(f.tangent[0], -sin(at), 1e-6);
            CHECK_NEAR(f.tangent[1], cos(at) * c, 1e-6);
        }
    }
}

static void line_is_exact(uint64_t seed)
{
    for (int trial = 0; trial < 200; trial++) {
        const double a = check_real(&seed, -3.0, 3.0), b = check_real(&seed, -1.5, 1.5);
        const double way[3] = { cos(a) * cos(b), sin(a) * cos(b), sin(b) };
        const double side[3] = { -sin(a), cos(a), 0.0 };
        const double off = check_real(&seed, -1.0, 1.0);
        double s = 0.0, tool[3];
        commanded_path_start(&t, (double[3]){ 0.0 });
        for (int n = 0; n < 60; n++) {
            s += check_real(&seed, 1e-4, 0.2);
            push(s * way[0], s * way[1], s * way[2]);
        }
        for (int k = 0; k < 3; k++) {
            tool[k] = 0.6 * s * way[k] + off * side[k];
        }
        const struct commanded_path_foot f = commanded_path_nearest(&t, tool, 60);
        for (int k = 0; k < 3; k++) {
            CHECK_NEAR(f.error[k], -off * side[k], 1e-11);
            CHECK_NEAR(f.tangent[k], way[k], 1e-9);
        }
    }
}

/* A square corner that the tool cuts: the nearer of the two sides, the second as soon as it is
 * nearer though the way over the corner is longer; never back. */
static void corner_and_rest(void)
{
    commanded_path_start(&t, (double[3]){ 0.0 });
    for (int n = 1; n <= 20; n++) {
        push(0.5 * n, 0.0, 0.0);
    }
    for (int n = 0; n < 300; n++) {
        push(10.0, 0.0, 0.0); /* exact stop */
    }
    for (int n = 1; n <= 20; n++) {
        push(10.0, 0.5 * n, 0.0);
    }
    struct commanded_path_foot f = commanded_path_nearest(&t, (double[3]){ 9.0, 0.3, 0.0 }, 338);
    CHECK_NEAR(f.error[0], 0.0, 1e-12);
    CHECK_NEAR(f.error[1], -0.3, 1e-12);
    f = commanded_path_nearest(&t, (double[3]){ 9.7, 1.0, 0.0 }, 338);
    CHECK_NEAR(f.error[0], 0.3, 1e-12);
    CHECK_NEAR(f.error[1], 0.0, 1e-12);
    CHECK_NEAR(f.tangent[1], 1.0, 1e-12);
    f = commanded_path_nearest(&t, (double[3]){ 9.0, 0.4, 0.0 }, 338);
    CHECK_NEAR(f.error[0], 1.0, 1e-12);
    /* Beyond what is put out the path is not known to the tool. */
    f = commanded_path_nearest(&t, (double[3]){ 10.2, 9.9, 0.0 }, 330);
    CHECK_NEAR(f.error[0], -0.2, 1e-12);
}

/* The oldest points go; a place alone has no direction. */
static void forgets(void)
{
    commanded_path_start(&t, (double[3]){ 1.0, 2.0, 3.0 });
    struct commanded_path_foot f = commanded_path_nearest(&t, (double[3]){ 0.0 }, 0);
    CHECK_NEAR(f.tangent[0], 0.0, 0.0);
    CHECK_NEAR(f.error[2], 0.0, 0.0);
    for (int n = 1; n <= 3 * COMMANDED_PATH_SIZE; n++) {
        push(1.0 + n, 2.0, 3.0);
    }
    CHECK_EQ(t.frames - t.first, COMMANDED_PATH_SIZE - 1);
    CHECK_NEAR(commanded_path_at(&t, 0)->place[0], 1.0 + (double)t.first, 0.0);
    f = commanded_path_nearest(&t, (double[3]){ (double)t.frames - 3.0, 2.5, 3.0 }, t.frames);
    CHECK_NEAR(f.error[1], -0.5, 1e-12);
}

int main(void)
{
    circle_is_exact(3);
    line_is_exact(5);
    corner_and_rest();
    forgets();
    return check_result();
}
