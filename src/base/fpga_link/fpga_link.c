#include "fpga_link.h"

enum { STEP = 1, BACKWARD = 2 }; /* bits of FPGA_BITS */

int32_t fpga_slot_most(enum fpga_format format, int32_t slot_clocks)
{
    const int32_t most = (slot_clocks - 1) / FPGA_CLOCKS_A_PULSE;
    if (format == FPGA_BITS)
        return 1;
    return most < INT8_MAX ? most : INT8_MAX;
}

void fpga_slot_pack(int32_t word[FPGA_SLOT_WORDS], const int32_t pulses[FPGA_SLOT_AXES],
                    enum fpga_format format)
{
    uint8_t byte[FPGA_SLOT_AXES];
    for (int i = 0; i < FPGA_SLOT_AXES; i++) {
        const int32_t n = pulses[i];
        const int bits = n ? n < 0 ? STEP | BACKWARD : STEP : 0;
        byte[i] = (uint8_t)(format == FPGA_BITS ? bits : n);
    }
    for (int k = 0; k < FPGA_SLOT_WORDS; k++) {
        const uint8_t *b = byte + 4 * k;
        word[k] = link_wrap(b[0] | b[1] << 8 | b[2] << 16 | (int64_t)b[3] << 24);
    }
}

/* Signed pulses that a byte stands for; if it is not valid, a number larger than any slot holds. */
static int32_t byte_pulses(uint8_t byte, enum fpga_format format)
{
    if (format == FPGA_COUNTS)
        return byte < 128 ? byte : byte - 256;
    if (byte > (STEP | BACKWARD))
        return INT8_MAX + 1;
    return !(byte & STEP) ? 0 : byte & BACKWARD ? -1 : 1;
}

int32_t fpga_slot_unpack(const int32_t word[FPGA_SLOT_WORDS], enum fpga_format format, int32_t most,
                         int32_t pulses[FPGA_SLOT_AXES])
{
    int32_t bad = -1;
    for (int i = FPGA_SLOT_AXES - 1; i >= 0; i--) {
        const uint8_t byte = (uint8_t)((uint32_t)word[i / 4] >> 8 * (i % 4));
        const int32_t n = byte_pulses(byte, format);
        pulses[i] = n;
        if (n > most || n < -most || (i >= FPGA_PLAYED && byte))
            bad = i;
    }
    return bad;
}

int32_t fpga_slot_clock(int32_t j, int32_t n, int32_t slot_clocks)
{
    return (2 * j + 1) * slot_clocks / (2 * n);
}

/* With S = slot_clocks, pulse j has come if (2 j + 1) S / (2 n) < clock + 1, that is if 2 j + 1 < x
 * = 2 n (clock + 1) / S. There are floor(ceil(x) / 2) odd numbers 2 j + 1 below x. */
int32_t fpga_slot_played(int32_t n, int32_t clock, int32_t slot_clocks)
{
    const int32_t x = (2 * n * (clock + 1) + slot_clocks - 1) / slot_clocks;
    return x / 2;
}
