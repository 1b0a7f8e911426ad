/* outputs - what a part program switches beside the axes. */
#ifndef OUTPUTS_H
#define OUTPUTS_H

#include <stdint.h>

enum { OUTPUTS_DIGITAL = 32 };      /* P0 .. P31 of M62 to M65 */

enum outputs_coolant { OUTPUTS_MIST = 1, OUTPUTS_FLOOD = 2 };   /* bits: M7, M8 */

struct outputs {
    double   spindle;   /* [rpm] M3 positive, M4 negative */
    uint32_t digital;   /* bit n is output Pn */
    int32_t  coolant;   /* enum outputs_coolant */
};

#endif
