/* Slots: packing in both formats, what a byte may hold, where the pulses lie. */
#include "check.h"
#include "fpga_link.h"

/* Byte order is that of the hardware: axis 0 lowest; both formats come back as they went. */
static void packing(void)
{
    int32_t word[2], back[8];
    fpga_slot_pack(word, (int32_t[8]){ 1, -1, 49, -49, 2, -3 }, FPGA_COUNTS);
    CHECK_EQ((uint32_t)word[0], 0xcf31ff01);
    CHECK_EQ((uint32_t)word[1], 0x0000fd02);
    CHECK_EQ(fpga_slot_unpack(word, FPGA_COUNTS, 49, back), -1);
    CHECK_EQ(back[0] + 100 * back[1] + 10000 * back[3], 1 - 100 - 490000);
    fpga_slot_pack(word, (int32_t[8]){ 1, -1, 0, -1, 0, 1 }, FPGA_BITS);
    CHECK_EQ((uint32_t)word[0], 0x03000301);
    CHECK_EQ((uint32_t)word[1], 0x00000100);
    CHECK_EQ(fpga_slot_unpack(word, FPGA_BITS, 1, back), -1);
    CHECK_EQ(back[0] + 10 * back[1] + 100 * back[3] + 1000 * back[5], 1 - 10 - 100 + 1000);
}

/* Every byte in every place: what is a number of pulses, and what is refused. */
static void bytes(void)
{
    CHECK_EQ(fpga_slot_most(FPGA_COUNTS, 200), 49);
    CHECK_EQ(fpga_slot_most(FPGA_BITS, 200), 1);
    CHECK_EQ(fpga_slot_most(FPGA_COUNTS, 4000), 127);
    for (int axis = 0; axis < FPGA_SLOT_AXES; axis++) {
        for (int byte = 0; byte < 256; byte++) {
            int32_t word[2] = { 0, 0 }, n[8];
            word[axis / 4] = (int32_t)((uint32_t)byte << 8 * (axis % 4));
            const int value = byte < 128 ? byte : byte - 256;
            const bool counts = value >= -49 && value <= 49 && (axis < FPGA_PLAYED || !byte);
            CHECK_EQ(fpga_slot_unpack(word, FPGA_COUNTS, 49, n), counts ? -1 : axis);
            CHECK_EQ(n[axis], value);
            const bool bits = byte < 4 && (axis < FPGA_PLAYED || !byte);
            CHECK_EQ(fpga_slot_unpack(word, FPGA_BITS, 1, n), bits ? -1 : axis);
            if (bits)
                CHECK_EQ(n[axis], byte == 1 ? 1 : byte == 3 ? -1 : 0);
        }
    }
}

/* Pulses lie where the formula says, at least 4 clocks apart, over the border of two slots too; and
 * the closed count is theirs at every clock. */
static void spreading(void)
{
    int least = 1000, last[50];
    for (int n = 1; n <= 49; n++) {
        int j = 0;
        for (int clock = 0; clock < 200; clock++) {
            if (j < n && clock == (2 * j + 1) * 200 / (2 * n)) {
                CHECK_EQ(fpga_slot_clock(j, n, 200), clock);
                if (j > 0 && clock - last[n] < least)
                    least = clock - last[n];
                last[n] = clock;
                j++;
            }
            CHECK_EQ(fpga_slot_played(n, clock, 200), j);
        }
        CHECK_EQ(j, n);
    }
    CHECK_EQ(least, 4);
    least = 1000;
    for (int n = 1; n <= 49; n++) {
        for (int m = 1; m <= 49; m++) {
            const int gap = 200 - last[n] + fpga_slot_clock(0, m, 200);
            least = gap < least ? gap : least;
        }
    }
    CHECK_EQ(least, 5);
}

int main(void)
{
    packing();
    bytes();
    spreading();
    return check_result();
}
