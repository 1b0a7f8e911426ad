/* What wires bring to a system, asked about all at once: against each element by itself. */
#include "fmu_system.h"

#include "check.h"

static const double reals[] = { 0.0,    -0.0,    1.0,   -1.0, DBL_MAX, -DBL_MAX, DBL_MIN,
                                5e-324, -5e-324, 1e300, NAN,  -NAN,    INFINITY, -INFINITY };
static const int32_t wholes[] = { 0, 1, -1, 2, 62, 63, 65535, 65536, INT32_MAX, INT32_MIN };
enum { REALS = sizeof reals / sizeof *reals, WHOLES = sizeof wholes / sizeof *wholes };

/* Each value at each place of arrays of every length. */
static void of_reals(void)
{
    for (int n = 1; n <= 7; n++) {
        for (int at = 0; at < n; at++) {
            for (int k = 0; k < REALS; k++) {
                double x[7] = { 1.5, -2.5, 0.0, DBL_MAX, -DBL_MAX, DBL_MAX, -1.0 };
                struct system_check finite = { .good = true }, within = { .good = true };
                x[at] = reals[k];
                system_finite(&finite, x, (size_t)n);
                CHECK_EQ(system_good(&finite), isfinite(reals[k]) != 0);
                for (int i = 0; i < n; i++) {
                    x[i] = i == at ? reals[k] : 0.25;
                }
                system_reals(&within, x, (size_t)n, -1.0, 1e300);
                CHECK_EQ(system_good(&within), reals[k] >= -1.0 && reals[k] <= 1e300);
            }
        }
    }
}

static void of_wholes(void)
{
    for (int n = 1; n <= 7; n++) {
        for (int at = 0; at < n; at++) {
            for (int k = 0; k < WHOLES; k++) {
                int32_t x[7] = { 1, 0, 1, 1, 0, 1, 0 };
                struct system_check one = { .good = true }, port = one, stock = one, wide = one;
                const int32_t y = x[at] = wholes[k];
                system_bits(&one, x, (size_t)n, 1);
                CHECK_EQ(system_good(&one), y >= 0 && y <= 1);
                system_bits(&port, x, (size_t)n, 65535);
                CHECK_EQ(system_good(&port), y >= 0 && y <= 65535);
                system_wholes(&stock, x, (size_t)n, 0, 62);
                CHECK_EQ(system_good(&stock), y >= 0 && y <= 62);
                system_wholes(&wide, x, (size_t)n, INT32_MIN, 65535);
                CHECK_EQ(system_good(&wide), y <= 65535);
            }
        }
    }
}

/* One bad value among several wires, wherever it is. */
static void together(void)
{
    for (int bad = 0; bad < 4; bad++) {
        const double x[3] = { 1.0, bad == 1 ? NAN : 2.0, 3.0 }, y = bad == 2 ? INFINITY : -1.0;
        const int32_t n[2] = { 3, bad == 3 ? 4 : 0 };
        struct system_check check = { .good = true };
        SYSTEM_FINITE(x);
        SYSTEM_FINITE(y);
        SYSTEM_BITS(n, 3);
        SYSTEM_WHOLES(n, 0, 4);
        SYSTEM_REALS(y, -2.0, DBL_MAX);
        CHECK_EQ(system_good(&check), bad == 0);
    }
}

int main(void)
{
    of_reals();
    of_wholes();
    together();
    return check_result();
}
