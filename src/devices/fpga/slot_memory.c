#include "slot_memory.h"

bool slot_memory_fill(struct slot_memory *m, const int32_t words[FPGA_WORDS], int32_t slots,
                      enum fpga_format format, int32_t most, struct slot_fault *fault)
{
    int32_t pulses[FPGA_SLOT_AXES];
    memset(m->sum[0], 0, sizeof m->sum[0]);
    for (int32_t k = 0; k < slots; k++) {
        const int32_t *word = words + FPGA_SLOT_WORDS * k;
        memcpy(m->sum[k + 1], m->sum[k], sizeof m->sum[0]);
        if (!word[0] && !word[1])
            continue;
        const int32_t bad = fpga_slot_unpack(word, format, most, pulses);
        if (bad >= 0) {
            *fault = (struct slot_fault){ k, bad };
            return false;
        }
        for (int i = 0; i < FPGA_PLAYED; i++)
            m->sum[k + 1][i] = (int16_t)(m->sum[k + 1][i] + pulses[i]);
    }
    m->slots = slots;
    return true;
}

void slot_memory_played(const struct slot_memory *m, int64_t clock, int32_t slot_clocks,
                        int32_t pulses[FPGA_PLAYED])
{
    const int64_t k = clock / slot_clocks;
    const int32_t within = (int32_t)(clock - k * slot_clocks);
    for (int i = 0; i < FPGA_PLAYED; i++) {
        pulses[i] = m->sum[k][i];
        const int32_t n = k < m->slots ? m->sum[k + 1][i] - m->sum[k][i] : 0;
        if (within && n > 0)
            pulses[i] += fpga_slot_played(n, within, slot_clocks);
        else if (within && n < 0)
            pulses[i] -= fpga_slot_played(-n, within, slot_clocks);
    }
}
