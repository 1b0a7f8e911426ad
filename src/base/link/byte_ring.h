/* byte_ring - a byte stream through a ring of 128 words, between two ends that see each other's
 * variables only at communication points.
 *
 * Byte n of a connection is byte n % 512 of the words, counted from the low end of word 0. Counts
 * are bytes since the start of the connection, modulo 2^31. The sender shows the words and the
 * count that it has put, the receiver the count that it has taken; both may be read any number of
 * times. */
#ifndef BYTE_RING_H
#define BYTE_RING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { BYTE_RING_WORDS = 128, BYTE_RING_BYTES = 4 * BYTE_RING_WORDS };

/* Number of bytes put and not taken yet, 0 .. 512; -1 if the two counts contradict each other. */
int32_t byte_ring_held(int32_t count, int32_t taken);

/* Put up to n bytes, as many as there is room for, and advance *count. Returns their number. */
size_t byte_ring_put(int32_t words[BYTE_RING_WORDS], int32_t *count, int32_t taken,
                     const uint8_t *bytes, size_t n);

/* Copy up to `most` of the bytes that are held, without taking them. Returns their number. */
size_t byte_ring_look(const int32_t words[BYTE_RING_WORDS], int32_t count, int32_t taken,
                      uint8_t *bytes, size_t most);

/* The count after n more bytes, modulo 2^31. */
int32_t byte_ring_on(int32_t count, size_t n);

#endif
