/* sides - one set of calls for both FMI versions. A status is 0 (OK) or 3 (Error). */
#ifndef SIDES_H
#define SIDES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { SIDE_REAL, SIDE_INTEGER, SIDE_BOOLEAN, SIDE_STRING };

/* Values of a variable: as many elements as it has, of its type. */
union side_value {
    double real;
    int32_t integer;
    int32_t boolean;
    const char *string;
};

/* What a call told of errors: how many, and the beginning of each text. */
enum { SIDE_ERRORS = 32, SIDE_TEXT = 256 };
struct side_told {
    int errors;
    char text[SIDE_ERRORS][SIDE_TEXT];
};

struct side {
    void *(*instantiate)(const char *token, const char *resources);
    void (*release)(void *c);
    /* `hasty`: FMI 2.0 first tries to enter without its experiment, which must be refused. */
    int (*enter)(void *c, double start, bool stops, double stop, bool hasty);
    int (*leave)(void *c);
    int (*step)(void *c, double point, double size);
    int (*terminate)(void *c);
    int (*reset)(void *c);
    int (*set)(void *c, int type, uint32_t ref, size_t n, const union side_value *x);
    int (*get)(void *c, int type, uint32_t ref, size_t n, union side_value *x);
    int (*get_state)(void *c, void **state);
    int (*set_state)(void *c, void *state);
    int (*free_state)(void *c, void **state);
    int (*size)(void *c, void *state, size_t *size);
    int (*serialize)(void *c, void *state, char *bytes, size_t size);
    int (*deserialize)(void *c, const char *bytes, size_t size, void **state);
    int (*log)(void *c, bool on, size_t n, const char *const *names);
    int (*odd)(void *c, unsigned which); /* a call that must always be refused */
};

enum { SIDE_ODDS = 8, SIDE_ELEMENTS = 256 };
extern const struct side side_2, side_3;

/* What was told of FMI 2.0 and of 3.0 since it was cleared. */
extern struct side_told side_told[2];

/* Looks at a message of FMI version 2 or 3 and keeps that of an error. */
void side_tell(int version, int status, const char *category, const char *text);

#endif
