/* The firmware on a PC: 20,000 pulses, printed each 50 ms.
 *
 *     run_axis [MILLISECONDS]
 *
 * For so long the timer's interrupt is held off at 100 ms. The status is 1 if a pulse was late. */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "axis.h"

int main(int count, char **word)
{
    const int held_off = count > 1 ? atoi(word[1]) : 0;
    static struct axis a;
    axis_start(&a);
    axis_go(&a, 20000);
    for (int ms = 0; ms <= 350; ms++) {
        if (ms < 100 || ms >= 100 + held_off)
            axis_plan(&a);
        if (ms % 50 == 0)
            printf("%3d ms  %5" PRId64 " pulses\n", ms, axis_pulses(&a, ms * AXIS_TICKS));
        axis_begin(&a);
    }
    printf("%d underflows\n", (int)a.underflows);
    return a.underflows > 0;
}
