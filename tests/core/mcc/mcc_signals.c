/* Counts of an axis that is turned round, also at the end of the counters. */
#include "mcc_check.h"
#include "signals.h"

int main(void)
{
    struct machine m = mcc_machine();
    struct signals s = { .enc = { 5, 6, INT32_MIN },
                         .err = { -7, 8, 9 },
                         .latch = { 0, 1, 2 },
                         .pulses = { 3, 4, INT32_MIN } };
    m.axis[0].inverted = m.axis[2].inverted = true;
    struct signals t = s;
    signals_turn(&t, &m);
    CHECK(t.enc[0] == -5 && t.enc[1] == 6 && t.enc[2] == INT32_MIN);
    CHECK(t.err[0] == 7 && t.err[1] == 8 && t.err[2] == -9);
    CHECK(t.pulses[0] == -3 && t.pulses[1] == 4 && t.pulses[2] == INT32_MIN);
    CHECK(t.latch[0] == 0 && t.latch[1] == 1 && t.latch[2] == -2);
    signals_turn(&t, &m);
    CHECK(memcmp(&t, &s, sizeof s) == 0);
    return check_result();
}
