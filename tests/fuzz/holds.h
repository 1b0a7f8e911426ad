/* holds - what every harness has: the input, an assertion that ends the run. */
#ifndef HOLDS_H
#define HOLDS_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Mutations of a short run: about 5 s with sanitizers. */
extern const int fuzz_count;

#define HOLDS(condition) \
    do { \
        if (!(condition)) { \
            fprintf(stderr, "%s:%d: %s does not hold\n", __FILE__, __LINE__, #condition); \
            abort(); \
        } \
    } while (0)

#endif
