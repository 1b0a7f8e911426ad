/* A part: an FMU's model without FMI, to be linked into a program that runs several in one loop.
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
#include <stddef.h>
#include <stdint.h>

#include "fmu_in_use.h"

enum fmu_message { FMU_ERROR, FMU_WARNING, FMU_EVENT };

/* Who runs a part, as one component of a system. */
struct fmu_host {
    void *owner;
    const char *name;      /* of the component */
    const char *resources; /* folder of the FMU's resources, ends in a separator; "" if none */
    void (*tell)(const struct fmu_host *host, enum fmu_message kind, const char *format,
                 va_list args);
};

/* Sizes stand in the object as digits, so that who generates C text can read them there. */
#define FMU_PART_MARK "motionfmu part 3 "
enum { FMU_PART_DIGITS = 9, FMU_PART_ALIGN = 16 };

struct fmu_part {
    struct {
        char mark[sizeof FMU_PART_MARK - 1];
        char instance[FMU_PART_DIGITS]; /* [byte] */
        char space;
        char vars[FMU_PART_DIGITS]; /* [byte] of struct vars */
        char end;
    } sizes;
    size_t size; /* [byte] of an instance */

    /* Cleared memory becomes an instance whose variables have their start values. */
    void (*clear)(void *part);

    /* Give an instance its host and what `open` made; take both away: returns what `open` made. */
    void (*attach)(void *part, const struct fmu_host *host, void *blob);
    void *(*detach)(void *part);

    /* As the functions of fmi_model.h. `open` is followed by `close`, also if it failed. */
    int (*open)(void *part);
    int (*start)(void *part);
    int (*step)(void *part, int64_t t0, int64_t t1);
    int (*end)(void *part);
    void (*close)(void *part);

    /* Warn once of communication steps [ns] that do not go with the FMU's own grid. */
    void (*watch)(void *part, int64_t step);

    /* Tell which elements of an input, by its offset in struct vars, break its limits: -1. */
    int (*refuse)(void *part, size_t offset);

    /* Which part of its arrays is in use: MODEL_IN_USE, places in the instance. */
    const struct fmu_row *rows;
    size_t row_count;
};

#endif
