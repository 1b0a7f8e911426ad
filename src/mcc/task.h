/* task - the IPO task: part program -> command ring -> interpolation points. */
#ifndef TASK_H
#define TASK_H

#include "mcc.h"

/* Codes of the library's group status that occur here. */
enum task_status { TASK_RUNNING, TASK_STOPPED, TASK_HOLD, TASK_DELAY };

/* Read the whole program as it would run from the last command's end; nothing moves. */
void task_check(const struct mcc *m, const char *text, size_t length, struct fault_report *r);

/* Start a program that task_check found good. Refused like a motion call. */
int task_start(struct mcc *m);

/* Origins of G54 (system 1) .. G59 (6). [mm] Refused while a program runs. */
int task_set_origin(struct mcc *m, int system, const double origin[AXES]);

/* One cycle: fill the point queue as far as commands reach. The text is that of task_start. */
void task_run(struct mcc *m, const char *text, size_t length);

/* True while a card that gets no point would stand still in the middle of a motion. */
bool task_moving(const struct mcc *m);

enum task_status task_status(const struct mcc *m);

#endif
