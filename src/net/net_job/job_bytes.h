/* job_bytes - reading and writing little-endian integers of 1 to 8 bytes, as they are in the pages
 * of a job file. */
#ifndef JOB_BYTES_H
#define JOB_BYTES_H

#include <stdint.h>

static inline uint64_t job_get(const uint8_t *at, int bytes)
{
    uint64_t value = 0;
    for (int k = 0; k < bytes; k++)
        value |= (uint64_t)at[k] << 8 * k;
    return value;
}

static inline uint32_t job_get32(const uint8_t *at)
{
    return (uint32_t)job_get(at, 4);
}

static inline int32_t job_get_signed(const uint8_t *at)
{
    const uint32_t value = job_get32(at);
    return value < 0x80000000u ? (int32_t)value : (int32_t)(value - 0x80000000u) + INT32_MIN;
}

static inline void job_put(uint8_t *at, uint64_t value, int bytes)
{
    for (int k = 0; k < bytes; k++)
        at[k] = (uint8_t)(value >> 8 * k);
}

#endif
