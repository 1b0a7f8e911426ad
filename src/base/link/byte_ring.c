#include "byte_ring.h"

static uint32_t byte_at(uint32_t at)
{
    return at % BYTE_RING_BYTES;
}

int32_t byte_ring_held(int32_t count, int32_t taken)
{
    const uint32_t held = ((uint32_t)count - (uint32_t)taken) & INT32_MAX;
    return count >= 0 && taken >= 0 && held <= BYTE_RING_BYTES ? (int32_t)held : -1;
}

int32_t byte_ring_on(int32_t count, size_t n)
{
    return (int32_t)(((uint32_t)count + (uint32_t)n) & INT32_MAX);
}

size_t byte_ring_put(int32_t words[BYTE_RING_WORDS], int32_t *count, int32_t taken,
                     const uint8_t *bytes, size_t n)
{
    const int32_t held = byte_ring_held(*count, taken);
    const size_t room = held < 0 ? 0 : (size_t)(BYTE_RING_BYTES - held);
    const size_t part = n < room ? n : room;
    for (size_t i = 0; i < part; i++) {
        const uint32_t at = byte_at((uint32_t)*count + (uint32_t)i);
        const uint32_t shift = 8 * (at % 4);
        const uint32_t word = (uint32_t)words[at / 4];
        words[at / 4] =
            (int32_t)((word & ~(UINT32_C(0xFF) << shift)) | (uint32_t)bytes[i] << shift);
    }
    *count = byte_ring_on(*count, part);
    return part;
}

size_t byte_ring_look(const int32_t words[BYTE_RING_WORDS], int32_t count, int32_t taken,
                      uint8_t *bytes, size_t most)
{
    const int32_t held = byte_ring_held(count, taken);
    const size_t part = held < 0 ? 0 : most < (size_t)held ? most : (size_t)held;
    for (size_t i = 0; i < part; i++) {
        const uint32_t at = byte_at((uint32_t)taken + (uint32_t)i);
        bytes[i] = (uint8_t)((uint32_t)words[at / 4] >> (8 * (at % 4)));
    }
    return part;
}
