/* What of a ring needs no copy: all elements but the used ones, by counting each byte. */
#include <string.h>

#include "check.h"
#include "spans.h"

enum { PLACES = 7, SIZE = 3 };

static void check_ring(int32_t first, int32_t used)
{
    static char array[PLACES * SIZE];
    struct spans s = { 0 };
    int named[sizeof array] = { 0 };

    spans_ring(&s, array, SIZE, PLACES, first, used);
    for (int32_t k = 0; k < s.count; k++) {
        CHECK(!s.span[k].zero);
        for (uintptr_t at = s.span[k].from; at < s.span[k].to; at++) {
            const uintptr_t place = at - (uintptr_t)array;
            CHECK(place < sizeof array);
            named[place < sizeof array ? place : 0]++;
        }
    }
    for (int32_t n = 0; n < PLACES; n++) {
        bool is_used = false;
        for (int32_t k = 0; k < used; k++) {
            is_used |= (first + k) % PLACES == n;
        }
        for (int32_t byte = 0; byte < SIZE; byte++) {
            CHECK_EQ(named[SIZE * n + byte], !is_used);
        }
    }
}

/* Each is kept as it was given, up to the last place; nothing of no length is. */
static void check_list(void)
{
    static struct spans s;
    char bytes[4];

    spans_leave(&s, bytes + 1, bytes + 1);
    spans_zero(&s, bytes + 2, bytes + 1);
    CHECK_EQ(s.count, 0);
    for (int32_t k = 0; k <= SPANS_MAX; k++) {
        if (k % 2) {
            spans_zero(&s, bytes + 1, bytes + 2);
        } else {
            spans_leave(&s, bytes, bytes + 4);
        }
        CHECK_EQ(s.count, k < SPANS_MAX ? k + 1 : SPANS_MAX);
    }
    for (int32_t k = 0; k < SPANS_MAX; k++) {
        CHECK_EQ(s.span[k].zero, k % 2);
        CHECK(s.span[k].from == (uintptr_t)(k % 2 ? bytes + 1 : bytes));
        CHECK(s.span[k].to == (uintptr_t)(k % 2 ? bytes + 2 : bytes + 4));
    }
}

int main(void)
{
    for (int32_t first = 0; first < PLACES; first++) {
        for (int32_t used = 0; used <= PLACES; used++) {
            check_ring(first, used);
        }
    }
    check_list();
    return check_result();
}
