#include "slots.h"

#include <math.h>

bool slots_pulses(double from, double to, double scale, int32_t slots, int32_t pulses[])
{
    const int64_t end = llround(to * scale);
    int64_t before = llround(from * scale);

    if (before == end) {
        return false;
    }
    for (int32_t n = 1; n <= slots; n++) { /* at both ends exactly where the joint is */
        const double part = (double)n / slots;
        const int64_t at = n == slots ? end : llround((from + (to - from) * part) * scale);
        pulses[n - 1] = (int32_t)(at - before);
        before = at;
    }
    return true;
}
