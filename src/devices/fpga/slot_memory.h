/* slot_memory - a pulse memory of the FPGA card, stored as running sums of the slots' pulses, so
 * that the position of an axis at any clock costs the same in every slot. */
#ifndef SLOT_MEMORY_H
#define SLOT_MEMORY_H

#include "fpga_link.h"

struct slot_memory {
    int32_t slots; /* number of slots, marked full or playing; 0: the memory is free */
    int64_t mark;  /* number of its mark "full": of two memories the lower plays first */
    int16_t sum[FPGA_SLOTS + 1][FPGA_PLAYED]; /* [pulses] of all slots before slot k */
};

/* Where a byte is not a valid number of pulses. */
struct slot_fault {
    int32_t slot, axis;
};

/* Fill a free memory with 1 .. FPGA_SLOTS slots. False, with *fault, if a byte is not valid (see
 * fpga_slot_unpack); then the memory stays free. */
bool slot_memory_fill(struct slot_memory *m, const int32_t words[FPGA_WORDS], int32_t slots,
                      enum fpga_format format, int32_t most, struct slot_fault *fault);

/* Pulses of each axis from the first slot up to and including `clock`, counted from its start. */
void slot_memory_played(const struct slot_memory *m, int64_t clock, int32_t slot_clocks,
                        int32_t pulses[FPGA_PLAYED]);

#endif
