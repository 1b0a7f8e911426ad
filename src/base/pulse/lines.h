/* The two lines A and B that carry pulses: their levels in quadrature, and how they are wired. */
#ifndef LINES_H
#define LINES_H

#include <stdbool.h>
#include <stdint.h>

struct lines {
    bool a, b;
};

/* Bits of a wiring; inversion comes before the swap. */
enum { LINES_A_INVERSE = 1, LINES_B_INVERSE = 2, LINES_SWAP = 4 };

/* Levels in a quarter of a line period: A is high in quarter mod 4 = 0, 1, B in 1, 2, so A leads
 * going up. */
struct lines lines_of_quarter(int64_t quarter);

/* At the terminals, after inversion and swap. */
struct lines lines_wired(struct lines l, uint32_t wiring);

#endif
