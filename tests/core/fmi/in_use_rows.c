/* Rows of arrays: what is listed as not in use is what a loop over all elements finds, for every
 * fill; nothing of another member is listed. */
#include "check.h"

#include <stdbool.h>
#include <string.h>

#include "fmu_in_use.h"

enum { SIZE = 12, EACH = 4, FLAGS = 5, WORDS = 17 };

struct element {
    int64_t word[WORDS];
}; /* worth its place in the list, alone */

struct model {
    int64_t before;
    struct element list[SIZE];
    int32_t used;
    struct element ring[SIZE];
    int32_t first, count;
    struct element kept[SIZE];
    int32_t head, ahead;
    struct element between[SIZE];
    int64_t from, to;
    struct element tail[SIZE];
    int32_t begin;
    struct element flagged[FLAGS * EACH - 1];
    uint8_t flag[FLAGS];
    struct {
        int64_t own;
        struct element inner[SIZE];
        int32_t inside;
    } part;
    int32_t state;
    struct element behind[SIZE];
    int32_t last;
};

struct state {
    int64_t other;
    struct model m;
};

#define MODEL_IN_USE \
    FMU_LIST(list, used) \
    FMU_RING(ring, first, count, 0) \
    FMU_RING(kept, head, ahead, 3) \
    FMU_BETWEEN(between, from, to, 1) \
    FMU_TO_END(tail, begin) \
    FMU_FLAGS(flagged, EACH, flag) \
    FMU_WHEN(part, state, 2, 3) \
    FMU_LIST(part.inner, part.inside) \
    FMU_LIST(behind, last)

static const struct fmu_row rows[] = { MODEL_IN_USE };
static struct state s;
static bool left[sizeof(struct state)], want[sizeof(struct state)];

static void leave(const struct element *array, int i)
{
    memset(want + ((const char *)(array + i) - (const char *)&s), true, sizeof *array);
}

/* Element i of a ring of SIZE, of which `used` are from `first` on. */
static bool lies(int64_t i, int64_t first, int64_t used)
{
    return (i - first % SIZE + SIZE) % SIZE < used;
}

/* Element by element. */
static void expect(void)
{
    const struct model *m = &s.m;
    const bool whole = m->state >= 2 && m->state <= 3;
    memset(want, 0, sizeof want);
    for (int i = 0; i < SIZE; i++) {
        if (i >= m->used)
            leave(m->list, i);
        if (!lies(i, m->first, m->count))
            leave(m->ring, i);
        if (!lies(i, m->head + SIZE - 3, m->ahead + 3))
            leave(m->kept, i);
        if (!lies(i, m->from, m->to - m->from + 1))
            leave(m->between, i);
        if (i < m->begin)
            leave(m->tail, i);
        if (whole && i >= m->part.inside)
            leave(m->part.inner, i);
        if (i >= m->last)
            leave(m->behind, i);
    }
    for (int i = 0; i < FLAGS * EACH - 1; i++)
        if (!m->flag[i / EACH])
            leave(m->flagged, i);
    if (!whole)
        memset(want + offsetof(struct state, m.part), true, sizeof m->part);
}

static void compare(void)
{
    enum { BASE = 4096 }; /* as if it lay there in the state of a system */
    struct fmu_span span[FMU_SPANS];
    const size_t n = fmu_spans(&s, BASE, rows, sizeof rows / sizeof *rows, span, 0);
    memset(left, 0, sizeof left);
    for (size_t i = 0; i < n; i++) {
        CHECK(span[i].from < span[i].to && (i == 0 || span[i - 1].to <= span[i].from));
        CHECK(span[i].from >= BASE && span[i].to <= BASE + sizeof s);
        memset(left + span[i].from - BASE, true, span[i].to - span[i].from);
    }
    expect();
    CHECK(memcmp(left, want, sizeof left) == 0);
}

int main(void)
{
    uint64_t seed = 1;
    for (int32_t n = 0; n <= SIZE; n++) {
        for (int32_t first = 0; first < SIZE; first++) {
            struct model *m = &s.m;
            m->used = m->count = n;
            m->first = m->head = first;
            m->ahead = n <= SIZE - 3 ? n : SIZE - 3;
            m->from = 1000 * SIZE + first;
            m->to = m->from + n - 1;
            m->begin = n;
            m->state = (int32_t)check_random(&seed, 0, 5);
            m->part.inside = (int32_t)check_random(&seed, 0, SIZE);
            m->last = (int32_t)check_random(&seed, 0, SIZE + 5);
            for (int i = 0; i < FLAGS; i++)
                m->flag[i] = (uint8_t)(check_random(&seed, 0, 2) * 100);
            compare();
        }
    }
    return check_result();
}
