/* inside - what the harness knows of an FMU beside its calls: variables, layout of the state. */
#ifndef INSIDE_H
#define INSIDE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "sides.h"

struct inside_variable {
    uint32_t ref, count;
    int type;      /* SIDE_REAL and so on */
    bool settable; /* a parameter or an input, */
    bool running;  /* also while the FMU runs: an input or tunable */
    double min, max;
};

size_t inside_count(void);
struct inside_variable inside_variable(size_t i);
union side_value inside_start(size_t i, size_t k); /* start value of element k */
const char *inside_token(void);
int inside_tick(void);             /* [ns] */
int inside_string_max(void);       /* [byte] */
bool inside_strict(const void *c); /* does an FMI 3.0 instance refuse steps between ticks? */

size_t inside_most(void);              /* [byte] of a serialized state, at most, */
size_t inside_size(const char *state); /* and of this one */

/* Are serialized states of two instances alike? Padding in the model's structs may differ. */
bool inside_alike(const char *a, const char *b);

#endif
