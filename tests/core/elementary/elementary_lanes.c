/* Sines and cosines of several angles at once: the bits of each by itself, whoever is beside it. */
#include <stdbool.h>
#include <string.h>

#include "check.h"
#include "el_lanes.h"
#include "elementary.h"

enum { MOST = 13 };

static uint64_t seed = 7;

/* Those that lanes are good for; one in eight is any other number, half of these are special. */
static double some(void)
{
    static const double special[] = { 0.0,
                                      -0.0,
                                      0x1p-1074,
                                      -0x1p-27,
                                      0x1.fffffffffffffp-28,
                                      0x1p17,
                                      -0x1.fffffffffffffp16,
                                      INFINITY,
                                      -INFINITY,
                                      NAN };
    if (check_random(&seed, 0, 7)) {
        return check_random(&seed, 0, 1) ? check_real(&seed, -7.0, 7.0)
                                         : check_real(&seed, -1.3e5, 1.3e5);
    }
    if (check_random(&seed, 0, 1)) {
        return special[check_random(&seed, 0, sizeof special / sizeof *special - 1)];
    }
    return ldexp(check_real(&seed, -1.0, 1.0), (int)check_random(&seed, -1040, 1000));
}

static bool same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0 || (isnan(a) && isnan(b));
}

static void check_turns(el_turns *turns)
{
    for (int i = 0; i < 40000; i += CHECK_EACH) {
        double angle[MOST], sine[MOST + 1], cosine[MOST + 1];
        const int n = (int)check_random(&seed, 0, MOST);
        for (int k = 0; k < n; k++) {
            angle[k] = some();
        }
        sine[n] = cosine[n] = 42.0;
        turns(n, angle, sine, cosine);
        for (int k = 0; k < n; k++) {
            const struct el_turn t = el_sincos(angle[k]);
            if (!same(sine[k], t.sine) || !same(cosine[k], t.cosine)) {
                printf("%a: %a %a, want %a %a\n", angle[k], sine[k], cosine[k], t.sine, t.cosine);
                check_failures++;
            }
        }
        CHECK(sine[n] == 42.0 && cosine[n] == 42.0);
    }
}

int main(void)
{
    check_turns(el_turns_each);
#ifdef EL_WIDE
    if (!__builtin_cpu_supports("avx2")) {
        printf("no AVX2 here\n");
        return check_result();
    }
#endif
    check_turns(el_turns_avx2);
    return check_result();
}
