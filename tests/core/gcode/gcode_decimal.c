/* Decimal numbers against strtod, which rounds to the nearest double: short ones, doubles printed
 * in full, halves between two doubles and one digit beside them. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "el_decimal.h"
#include "reading.h"

static void is(const char *text)
{
    struct fault_report r = { .notes = 0 };
    struct reading s = { .text = text, .end = (int32_t)strlen(text), .r = &r };
    double value;
    bool whole;

    CHECK_EQ(reading_number(&s, 0, &value, &whole), FAULT_NONE);
    CHECK(value == strtod(text, NULL));
    CHECK_EQ(whole, strchr(text, '.') == NULL);
    if (value != strtod(text, NULL)) {
        printf("%s: %.17g\n", text, value);
    }
}

static uint64_t state = 2607;

/* Bits of the mantissa of a double. */
static uint64_t mantissa(void)
{
    return (uint64_t)check_random(&state, 0, ((int64_t)1 << 52) - 1);
}

static void doubles(void)
{
    char text[200];

    for (int i = 0; i < 20000; i++) {
        const double share = (double)mantissa() * 0x1p-52;
        const double x = ldexp(1.0 + share, (int)check_random(&state, -60, 60));
        snprintf(text, sizeof text, "%.60f", x);
        is(text);
        snprintf(text, sizeof text, "%.*f", (int)check_random(&state, 0, 30), x);
        is(text);
    }
}

/* From 2^53 on every second whole number lies between two doubles, from 2^54 on every fourth. */
static void halves(void)
{
    char text[200];

    for (int i = 0; i < 20000; i++) {
        const int more = i % 9;
        const unsigned long long half = (((uint64_t)1 << 53) + 2 * mantissa() + 1) << more;
        snprintf(text, sizeof text, "%llu", half);
        is(text);
        snprintf(text, sizeof text, "%llu.00000000000000000000001", half);
        is(text);
        snprintf(text, sizeof text, "%llu.99999999999999999999999", half - 1);
        is(text);
    }
}

int main(void)
{
    static const char *const texts[] = {
        "0",
        "0.0",
        "-0",
        "+1",
        "-.5",
        "7.",
        "0.30000000000000004",
        "9007199254740993",
        "9007199254740992.99999999999999999",
        "9007199254740993.0000000000000000001",
        "123456789012345678901234567890",
        "0.000000000000000000000000000000000000001",
        "00000000000000000000000000000000012.5",
        "0.1000000000000000055511151231257827",
        "100000000000000000000000000000000000000000000000000000000000000000000000000000",
    };
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        is(texts[i]);
    }
    doubles();
    halves();
    return check_result();
}
