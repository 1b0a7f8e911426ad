/* lines - levels of the two lines A and B that carry pulses between a card and a drive or encoder:
 * in quadrature as a function of the quarter of a line period, and behind inverting or crossed
 * wiring. */
#ifndef LINES_H
#define LINES_H

#include <stdbool.h>
#include <stdint.h>

struct lines {
    bool a, b;
};

/* Bits of a wiring: A inverted, B inverted, then A and B swapped. */
enum { LINES_A_INVERSE = 1, LINES_B_INVERSE = 2, LINES_SWAP = 4 };

/* Levels in quadrature in a quarter of a line period: A is high in quarter mod 4 = 0, 1, B in 1, 2;
 * A leads when the quarter goes up. */
struct lines lines_of_quarter(int64_t quarter);

/* Levels at the terminals, behind the wiring: after inversion and swap. */
struct lines lines_wired(struct lines l, uint32_t wiring);

#endif
