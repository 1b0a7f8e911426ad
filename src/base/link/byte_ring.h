/* byte_ring - a byte stream between two ends that only see each other's words at instants.
 *
 * Byte n of a connection lies at byte n % 512 of 128 words, counted from the low end of word 0.
 * Counts are bytes since the start of the connection, modulo 2^31. The sender shows its words and
 * their count, the reader shows what it has taken: both can be read any number of times. */
#ifndef BYTE_RING_H
#define BYTE_RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { BYTE_RING_WORDS = 128, BYTE_RING_BYTES = 4 * BYTE_RING_WORDS };

/* Bytes put and not taken yet, 0 .. 512; -1 if these counts cannot be. */
int32_t byte_ring_held(int32_t count, int32_t taken);

/* Put up to n bytes behind `count`, where `taken` leaves room; returns how many. */
size_t byte_ring_put(int32_t words[BYTE_RING_WORDS], int32_t *count, int32_t taken,
                     const uint8_t *bytes, size_t n);

/* Copy up to `most` of the bytes that are held, without taking them; returns how many. */
size_t byte_ring_look(const int32_t words[BYTE_RING_WORDS], int32_t count, int32_t taken,
                      uint8_t *bytes, size_t most);

/* The count behind n more bytes. */
int32_t byte_ring_on(int32_t count, size_t n);

#endif
