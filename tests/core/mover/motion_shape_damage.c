/* Chains whose bytes were written to from outside: told, or harmless. */
#include <stddef.h>
#include <string.h>

#include "check.h"
#include "shape.h"

enum { TRIALS = 1500, LINES = 150 };

static struct shape shape, hurt;
static uint64_t dice = 15;

static uint32_t roll(uint32_t n)
{
    dice = dice * 6364136223846793005u + 1442695040888963407u;
    return (uint32_t)(dice >> 33) % n;
}

/* Lines of 0.1 mm on a curve, every 40th one long, every 90th with a corner before it. */
static void take(struct shape *s, int32_t k)
{
    const double way = k % 40 == 0 ? 5.0 : 0.1, angle = 0.02 * k + (k % 90 == 0 ? 1.5 : 0.0);
    struct command c = { .type = COMMAND_LINE, .tolerance = 0.02, .feed = 100.0, .cap = 200.0,
                         .ramp = { 1000.0, 1000.0, 0.0, 0.0 }, .index = k };
    double end[AXES];

    memcpy(end, s->end, sizeof end);
    end[0] += way * cos(angle);
    end[1] += way * sin(angle);
    path_line(&c.path, s->end, end);
    shape_take(s, &c);
    if (shape_count(s) > 700 || k % 3 == 0) {
        shape_drop(s, shape_count(s));
        shape_drop_marks(s, shape_marks(s));
    }
}

static const size_t counts[] = {
    offsetof(struct shape, looked), offsetof(struct shape, grabbed),
    offsetof(struct shape, closing),
    offsetof(struct shape, tail_points), offsetof(struct shape, marks_loose),
    offsetof(struct shape, made) + 4, offsetof(struct shape, gone) + 4,
    offsetof(struct shape, stretch) + 4, offsetof(struct shape, corner_made) + 4,
    offsetof(struct shape, corner_stretch) + 4, offsetof(struct shape, marks) + 4,
    offsetof(struct shape, marks_set) + 4, offsetof(struct shape, marks_gone) + 4,
    offsetof(struct shape, run.vertices), offsetof(struct shape, run.placed),
    offsetof(struct shape, run.spans), offsetof(struct shape, run.vertex[0].marks),
};

static bool told(size_t at, int32_t value)
{
    hurt = shape;
    memcpy((char *)&hurt + at, &value, sizeof value);
    return shape_damaged(&hurt);
}

int main(void)
{
    int32_t k = 0, harmless = 0;

    shape_start(&shape, 1e9);
    while (k < 1000 || !shape.running || shape.marks_loose > 0 || !shape.corner) {
        take(&shape, ++k);
        CHECK(!shape_damaged(&shape));
        if (k > 3000) {
            break;
        }
    }
    CHECK(shape.running && shape.run.vertices > 1);
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        CHECK(told(counts[i], 1 << 30));
        CHECK(told(counts[i], INT32_MIN));
    }
    const size_t newest = offsetof(struct shape, piece)
        + (size_t)((shape.made - 1) % SHAPE_PIECES) * sizeof(struct piece);
    CHECK(told(newest + offsetof(struct piece, kind), 4));
    CHECK(told(newest + offsetof(struct piece, length) + 4, 0x7ff80000));     /* no number */
    CHECK(told(newest + offsetof(struct piece, length) + 4, (int32_t)0xbff00000));    /* -1 */

    /* anything in a number: what is not told goes on to its end within its arrays */
    for (int n = 0; n < TRIALS; n++) {
        take(&shape, ++k);
        hurt = shape;
        for (int i = 0; i < 3; i++) {
            const size_t from[4] = {
                offsetof(struct shape, run.knot), offsetof(struct shape, whole),
                offsetof(struct shape, run.vertex), offsetof(struct shape, end)
            };
            const size_t words[4] = { 300, sizeof(struct piece) / 8, 3000, AXES };
            const int which = (int)roll(4);
            const double values[6] = { 0.0, -1.0, 1e300, NAN, INFINITY, 1e-300 };
            char *to = (char *)&hurt + from[which] + 8 * roll((uint32_t)words[which]);
            memcpy(to, &values[roll(6)], 8);
        }
        if (shape_damaged(&hurt)) {
            continue;
        }
        harmless++;
        for (int32_t j = 0; j < LINES; j++) {
            take(&hurt, k + j);
        }
        shape_end(&hurt);
        for (int j = 0; j < 100; j++) {
            CHECK(shape_count(&hurt) >= 0 && shape_marks(&hurt) >= 0);
            shape_drop(&hurt, shape_count(&hurt));
        }
        shape_start(&hurt, 1e9);
        CHECK(!shape_damaged(&hurt));
    }
    CHECK(harmless > TRIALS / 10);
    printf("%d harmless of %d\n", (int)harmless, TRIALS);
    return check_result();
}
