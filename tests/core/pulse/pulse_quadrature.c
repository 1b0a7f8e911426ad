/* Edges of lines in quadrature against looking at every clock. */
#include "check.h"
#include "quadrature.h"

#include <math.h>

enum { UNIT = 64 }; /* phases are whole 64ths of a line period, so that all sums are exact */

/* floor(4 x / (UNIT den)) */
static int64_t quarter_of(int64_t x, int64_t den)
{
    const int64_t n = 4 * x, d = UNIT * den;
    return n >= 0 ? n / d : -((d - 1 - n) / d);
}

/* A straight piece after another: each edge at the first clock at which it has passed, one by one
 * and counted up to any clock; the lines step as a Gray code. */
static void path(uint64_t seed)
{
    struct quadrature q = { 0 };
    int64_t from = check_random(&seed, -2000, 2000), clock = 0;
    const int64_t start = quarter_of(from, 1);
    CHECK_EQ(quadrature_check(&q, (double)from / UNIT, 0), QUADRATURE_OK);
    quadrature_sample(&q, (double)from / UNIT, 0);
    for (int piece = 0; piece < 40; piece++) {
        const int64_t span = check_random(&seed, 1, 3000);
        const int64_t most = span * UNIT / 8, way = check_random(&seed, -most, most);
        const int64_t to = piece % 5 ? from + way : (from + way) / (UNIT / 4) * (UNIT / 4);
        CHECK_EQ(quadrature_check(&q, (double)to / UNIT, clock + span), QUADRATURE_OK);
        quadrature_sample(&q, (double)to / UNIT, clock + span);
        const struct quadrature all = q;
        for (int64_t n = 1; n <= span; n++) {
            const int64_t quarter = quarter_of(from * span + (to - from) * n, span);
            CHECK_EQ(quadrature_until(&all, to > from ? 1 : -1, clock + n),
                     (to > from ? 1 : -1) * (quarter - all.quarter));
            while (quadrature_next(&q) == clock + n) {
                const struct lines before = quadrature_lines(&q);
                quadrature_pass(&q);
                const struct lines now = quadrature_lines(&q);
                CHECK((before.a != now.a) + (before.b != now.b) == 1);
            }
            CHECK_EQ(q.quarter, quarter);
        }
        CHECK_EQ(quadrature_next(&q), INT64_MAX);
        CHECK_EQ(quadrature_edges(&q), q.quarter - start);
        from = to;
        clock += span;
    }
}

/* A leads going up. */
static void levels(void)
{
    const char a[] = "1100", b[] = "0110";
    for (int64_t q = -8; q < 8; q++) {
        const struct lines l = lines_of_quarter(q);
        const struct lines w = lines_wired(l, LINES_A_INVERSE | LINES_SWAP);
        CHECK_EQ(l.a, a[(q + 8) % 4] - '0');
        CHECK_EQ(l.b, b[(q + 8) % 4] - '0');
        CHECK(w.a == l.b && w.b == !l.a);
    }
}

/* What is wrong with a sample is said before it is taken. */
static void refused(void)
{
    struct quadrature q = { 0 };
    CHECK_EQ(quadrature_check(&q, NAN, 0), QUADRATURE_BAD_PHASE);
    CHECK_EQ(quadrature_check(&q, 2e15, 0), QUADRATURE_BAD_PHASE);
    CHECK_EQ(quadrature_check(&q, 3.0, 0), QUADRATURE_OK);
    quadrature_sample(&q, 3.0, 0);
    CHECK_EQ(quadrature_check(&q, 3.0 + 25.25, 100), QUADRATURE_TOO_FAST);
    CHECK_EQ(quadrature_check(&q, 3.0 + 25.0, 100), QUADRATURE_OK);
    CHECK_EQ(quadrature_check(&q, -INFINITY, 100), QUADRATURE_BAD_PHASE);
    quadrature_sample(&q, 3.0 + 25.0, 100);
    for (int edges = 1; edges <= 100; edges++) { /* one a clock */
        CHECK_EQ(quadrature_next(&q), edges);
        CHECK_EQ(quadrature_pass(&q), 1);
    }
    CHECK_EQ(quadrature_next(&q), INT64_MAX);
}

int main(void)
{
    for (uint64_t seed = 1; seed <= 40; seed++)
        path(seed * 7919);
    levels();
    refused();
    return check_result();
}
