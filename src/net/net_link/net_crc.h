/* net_crc - CRC-32 of frames, pages and records: polynomial 04C11DB7, reflected, start and final
 * XOR FFFFFFFF, as in IEEE 802.3 and zlib. "123456789" gives CBF43926. The CRC unit of an STM32F407
 * computes another one (words, not reflected, no final XOR). */
#ifndef NET_CRC_H
#define NET_CRC_H

#include <stddef.h>
#include <stdint.h>

/* CRC of n bytes that follow others whose CRC is `before` (0 if there are none). */
uint32_t net_crc(uint32_t before, const uint8_t *bytes, size_t n);

#endif
