/* scratch - a folder of its own for the files of an FMU: what string parameters name is there. */
#ifndef SCRATCH_H
#define SCRATCH_H

#include <stddef.h>

/* Names for string parameters: some of files that are there, some of none, some that are none; and
 * texts beside them: the file of a saved state, lines that are run by hand. */
enum { SCRATCH_NAMES = 17, SCRATCH_TEXTS = 8 };
extern const char *const scratch_names[SCRATCH_NAMES], *const scratch_texts[SCRATCH_TEXTS];

/* Make the folder the working folder, all files as they were at first. */
void scratch_open(void);

/* Write the file of a saved state. */
void scratch_state(const char *bytes, size_t size);

/* A run has ended: what is no regular file is still there, nothing half written is left. */
void scratch_check(void);

#endif
