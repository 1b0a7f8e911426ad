/* check - checks for the C tests: of the first checks that fail file, line and values are printed,
 * and the test goes on; main returns check_result(), which is not 0 if one has failed. */
#ifndef CHECK_H
#define CHECK_H

#include <math.h>
#include <stdint.h>
#include <stdio.h>

static int check_failures;
enum { CHECK_SHOWN = 20 }; /* the others are counted */

/* Stride of loops over similar cases: under ASan, where a case takes several times as long, every
 * fifth case is enough for the sanitizers. */
#ifdef __SANITIZE_ADDRESS__
enum { CHECK_EACH = 5 };
#else
enum { CHECK_EACH = 1 };
#endif

/* The condition must hold. */
#define CHECK(condition) \
    do { \
        if (!(condition)) { \
            if (check_failures++ < CHECK_SHOWN) \
                printf("%s:%d: %s\n", __FILE__, __LINE__, #condition); \
        } \
    } while (0)

/* Two whole numbers must be equal. */
#define CHECK_EQ(got, want) \
    do { \
        long long check_got = (long long)(got), check_want = (long long)(want); \
        if (check_got != check_want) { \
            if (check_failures++ < CHECK_SHOWN) \
                printf("%s:%d: %s = %lld, want %lld\n", __FILE__, __LINE__, #got, check_got, \
                       check_want); \
        } \
    } while (0)

/* Two numbers may differ by the tolerance at most. */
#define CHECK_NEAR(got, want, tolerance) \
    do { \
        const double check_got = (got), check_want = (want); \
        if (!(fabs(check_got - check_want) <= (tolerance))) { \
            if (check_failures++ < CHECK_SHOWN) \
                printf("%s:%d: %s = %.17g, want %.17g\n", __FILE__, __LINE__, #got, check_got, \
                       check_want); \
        } \
    } while (0)

static inline int check_result(void)
{
    if (check_failures != 0)
        printf("%d checks failed\n", check_failures);
    return check_failures != 0;
}

/* A random integer in low .. high, the same sequence on every machine (xorshift64). */
static inline int64_t check_random(uint64_t *state, int64_t low, int64_t high)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return low + (int64_t)(*state % (uint64_t)(high - low + 1));
}

/* A random number, uniform in [low, high), the same sequence on every machine (xorshift64). */
static inline double check_real(uint64_t *state, double low, double high)
{
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    return low + (high - low) * ((double)(*state >> 11) * 0x1p-53);
}

#endif
