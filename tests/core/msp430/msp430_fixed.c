/* Words, saturation, products and shifts of the 16-bit part. */
#include "check.h"
#include "fixed.h"

#include <math.h>

static void words(void)
{
    CHECK_EQ(fixed_word(0), 0);
    CHECK_EQ(fixed_word(32767), 32767);
    CHECK_EQ(fixed_word(32768), -32768);
    CHECK_EQ(fixed_word(65535), -1);
    CHECK_EQ(fixed_word(65536), 0);
    CHECK_EQ(fixed_word(-32769), 32767);
    CHECK_EQ(fixed_word(INT64_MIN), 0);
    for (int32_t a = -40000; a <= 40000; a += 7) {
        CHECK((fixed_word(a) - a) % 65536 == 0);
        CHECK_EQ(fixed_saturate16(a), a > 32767 ? 32767 : a < -32768 ? -32768 : a);
    }
    CHECK_EQ(fixed_saturate32(INT64_MAX), INT32_MAX);
    CHECK_EQ(fixed_saturate32(INT64_MIN), INT32_MIN);
    CHECK_EQ(fixed_saturate32(-5), -5);
}

/* The difference is right across the wrap, as long as it is within 16 bit. */
static void differences(void)
{
    uint64_t seed = 3;
    for (int i = 0; i < 20000; i++) {
        const int64_t a = check_random(&seed, -1000000, 1000000);
        const int64_t d = check_random(&seed, -32768, 32767);
        CHECK_EQ(fixed_subtract((uint16_t)(a + d), (uint16_t)a), d);
    }
    CHECK_EQ(fixed_subtract(0x8000, 0x7FFF), 1);
    CHECK_EQ(fixed_subtract(0, 0x8000), -32768);
}

static void products(void)
{
    CHECK_EQ(fixed_multiply(-32768, -32768), 1073741824);
    CHECK_EQ(fixed_multiply(32767, -32768), -1073709056);
    CHECK_EQ(fixed_multiply48(-32768, INT32_MIN), 70368744177664);
    CHECK_EQ(fixed_multiply48(32767, INT32_MIN), -70366596694016);
}

/* To the nearest, halves up. */
static void shifts(void)
{
    CHECK_EQ(fixed_scale(-7, 0), -7);
    CHECK_EQ(fixed_scale(1, 1), 1);
    CHECK_EQ(fixed_scale(-1, 1), 0);
    CHECK_EQ(fixed_scale(-3, 1), -1);
    uint64_t seed = 4;
    for (int i = 0; i < 20000; i++) {
        const int64_t x = check_random(&seed, -((int64_t)1 << 47), (int64_t)1 << 47);
        const int n = (int)check_random(&seed, 0, 31);
        CHECK_EQ(fixed_scale(x, n), floor((double)x / (double)((int64_t)1 << n) + 0.5));
    }
}

int main(void)
{
    words();
    differences();
    products();
    shifts();
    return check_result();
}
