/* slot_memory - a pulse memory: what each slot adds to the position of each axis. */
#ifndef SLOT_MEMORY_H
#define SLOT_MEMORY_H

#include "fpga_link.h"

struct slot_memory {
    int32_t slots; /* 0 free, else marked full or playing */
    int64_t mark;  /* number of its mark: of two full ones the lower plays first */
    int16_t sum[FPGA_SLOTS + 1][FPGA_AXES]; /* [pulses] of the slots before slot k */
};

/* A byte of a slot that is no number of pulses. */
struct slot_fault {
    int32_t slot, axis;
};

/* Fill a free memory with 1 .. FPGA_SLOTS slots. False: a byte is bad (see fpga_slot_unpack) and
 * the memory stays free. */
bool slot_memory_fill(struct slot_memory *m, const int32_t words[FPGA_WORDS], int32_t slots,
                      enum fpga_format format, int32_t most, struct slot_fault *fault);

/* Pulses of each axis from its first slot up to and including `clock` behind its start. */
void slot_memory_played(const struct slot_memory *m, int64_t clock, int32_t slot_clocks,
                        int32_t pulses[FPGA_AXES]);

#endif
