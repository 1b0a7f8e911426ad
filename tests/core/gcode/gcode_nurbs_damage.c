/* A NURBS on its way whose numbers were written to from outside: told, or it goes on to an end
 * within its window. */
#include <stddef.h>

#include "gcode_reader.h"
#include "nurbs.h"

enum { TRIALS = 4000, COMMANDS = 3000 };

static const char text[] =
    "F600\nG5.2 P2 L4\nX5 Y1\nX9 Y-3 P0.7\nX14 Y4\nX19 Y-2 P3\nX24 Y3\nX29 Y0\nX34 Y5\nX40 Y1\n"
    "G5.3\nG1 X50\n";

static uint64_t dice = 31;

static uint32_t roll(uint32_t n)
{
    dice = dice * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(dice >> 33) % n;
}

/* The reader behind so many commands. */
static void behind(struct reader *x, int commands)
{
    begin(x, text);
    for (int i = 0; i < commands; i++) {
        CHECK(next(x) >= 0);
        CHECK(!nurbs_damaged(&x->in.nurbs));
    }
}

static bool told(const struct reader *x, size_t at, int32_t value)
{
    struct nurbs hurt = x->in.nurbs;

    memcpy((char *)&hurt + at, &value, sizeof value);
    return nurbs_damaged(&hurt);
}

/* Each count by itself, on both sides of what it can be. */
static void counts(void)
{
    static const size_t at[] = {
        offsetof(struct nurbs, count), offsetof(struct nurbs, order),
        offsetof(struct nurbs, first), offsetof(struct nurbs, span), offsetof(struct nurbs, upto)
    };
    struct reader x;

    behind(&x, 3);
    const struct nurbs *n = &x.in.nurbs;
    CHECK(n->running && n->count > 0 && n->from < 1.0);
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        CHECK(told(&x, at[i], INT32_MIN));
        CHECK(told(&x, at[i], -1));
        CHECK(told(&x, at[i], 1 << 30));
    }
    CHECK(told(&x, at[0], 0));
    CHECK(told(&x, at[0], n->first));
    CHECK(told(&x, at[0], n->first + NURBS_WINDOW));
    CHECK(told(&x, at[1], 2));
    CHECK(told(&x, at[1], NURBS_ORDER + 1));
    CHECK(told(&x, at[2], n->span + 1));
    CHECK(told(&x, at[4], n->span));
    CHECK(told(&x, at[4], n->count - n->order + 2));
    struct nurbs waits = *n;
    waits.running = false;
    waits.span = waits.first = n->count - n->order + 1;
    CHECK(!nurbs_damaged(&waits));
    waits.span = waits.first = n->count - n->order + 2;     /* the next point has no place then */
    CHECK(nurbs_damaged(&waits));
    static const double places[] = { -1e-9, 1.0, NAN, INFINITY };
    for (int i = 0; i < 4; i++) {
        struct nurbs hurt = *n;
        hurt.from = places[i];
        CHECK(nurbs_damaged(&hurt));
    }
}

/* Some counts at once, small ones: what is not told reads nothing outside of its points, which the
 * sanitizers of the second build see, and comes to an end. */
static void anything(void)
{
    int32_t harmless = 0;

    for (int i = 0; i < TRIALS; i++) {
        struct reader x;
        behind(&x, (int)roll(12));
        struct nurbs *n = &x.in.nurbs;
        int32_t *const count[] = { &n->count, &n->order, &n->first, &n->span, &n->upto };
        for (uint32_t k = 1 + roll(3); k > 0; k--) {
            int32_t *const one = count[roll(5)];
            *one += (int32_t)roll(9) - 4;
        }
        if (roll(4) == 0) {
            n->ended = !n->ended;
        }
        if (nurbs_damaged(n)) {
            continue;
        }
        harmless++;
        int made = 0;
        while (made < COMMANDS && next(&x) >= 0) {
            CHECK(!nurbs_damaged(n));
            made++;
        }
        CHECK(made < COMMANDS);
    }
    printf("%d harmless of %d\n", (int)harmless, TRIALS);
    CHECK(harmless > TRIALS / 10);
}

int main(void)
{
    counts();
    anything();
    return check_result();
}
