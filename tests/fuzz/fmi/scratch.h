/* scratch - a folder of its own for the files of an FMU: what string parameters name is there. */
#ifndef SCRATCH_H
#define SCRATCH_H

/* Names for string parameters: some of files that are there, some of none, some that are none. */
enum { SCRATCH_NAMES = 17 };
extern const char *const scratch_names[SCRATCH_NAMES];

/* Make the folder the working folder, all files as they were at first. */
void scratch_open(void);

/* A run has ended: what is no regular file is still there, nothing half written is left. */
void scratch_check(void);

#endif
