/* fmu_part - interface of a part: an FMU's model without FMI, to be linked with others into a
 * system that runs all of them in one loop.
 *
 * A relocatable object of one FMU shows one name, motionfmu_part_<model identifier>, which is a
 * const struct fmu_part. It has no variables of its own: all state is in instances, memory of
 * whoever runs them. An instance begins with the FMU's struct vars, which are read and written in
 * place; whoever writes keeps the limits of the description (finite numbers, ends of strings).
 *
 * Between fmu_part.attach and .detach an instance holds pointers; else it is plain bytes that may
 * be copied, saved and compared. All other functions but `clear` want it attached.
 * Functions return 0, or -1 after a message to the host.
 */
#ifndef FMU_PART_H
#define FMU_PART_H

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "fmu_in_use.h"

enum fmu_message { FMU_ERROR, FMU_WARNING, FMU_EVENT };

/* The system that runs a part, as the part sees it. */
struct fmu_host {
    void *owner;           /* the system's struct fmu */
    const char *name;      /* name of the component */
    const char *resources; /* folder of the FMU's resources, ends in a separator; "" if none */
    void (*tell)(const struct fmu_host *host, enum fmu_message kind, const char *format,
                 va_list args);
};

/* The sizes are in the object file as decimal digits too, for the generator of a system's C
 * text. */
#define FMU_PART_MARK "motionfmu part 6 "
enum { FMU_PART_DIGITS = 9, FMU_PART_ALIGN = 16 };

/* So many instances are stepped at once at most. */
enum { FMU_PART_RUNS = 8 };

struct fmu_part {
    struct {
        char mark[sizeof FMU_PART_MARK - 1];
        char instance[FMU_PART_DIGITS]; /* [byte] */
        char space;
        char vars[FMU_PART_DIGITS]; /* [byte] of struct vars */
        char end;
    } sizes;
    size_t size; /* [byte] of an instance */

    /* Make an instance of memory whose part in use (`rows`) is 0: set its variables to their start
     * values. For `open` alone the memory may hold anything. */
    void (*clear)(void *part);

    /* Give an instance its host and its blob; take both away and return the blob. */
    void (*attach)(void *part, const struct fmu_host *host, void *blob);
    void *(*detach)(void *part);

    /* The model's functions of fmi_model.h. `open` is followed by `close`, also if it failed. */
    int (*open)(void *part);
    int (*start)(void *part);
    int (*step)(void *part, int64_t t0, int64_t t1);
    int (*end)(void *part);
    void (*close)(void *part);

    /* The parameters may have changed: to be called behind a change after `start`. */
    void (*tuned)(void *part);

    /* Warn if communication steps [ns] and the FMU's own grid do not divide each other. */
    void (*watch)(void *part, int64_t step);

    /* Report the first element of an input, by its offset in struct vars, that is out of range.
     * Returns -1, or 0 if none is. */
    int (*refuse)(void *part, size_t offset);

    /* Time since the start [ns]. */
    int64_t (*now)(const void *part);

    /* The state as its FMU serializes it: its size [byte], and the bytes themselves if there is
     * room for them. */
    size_t (*save)(const void *part, void *bytes, size_t room);

    /* Rows of MODEL_IN_USE, with places in the instance: which part of its arrays is in use. */
    const struct fmu_row *rows;
    size_t row_count;

    /* `step` of several instances at once, with the bits that each has alone. Whoever has failed is
     * left out, and who fails is told in `failed`. NULL if that is no quicker. */
    void (*together)(void *const *part, int runs, int64_t t0, int64_t t1, bool *failed);
};

#endif
