/* readout - what a panel shows of the program beside the position: codes in force, coordinate
 * system, and where the zero of the work is.
 *
 * The interpreter is ahead of the motion. So system and offset are kept with the command from which
 * on they hold, and come into sight when it moves.
 */
#ifndef READOUT_H
#define READOUT_H

#include <stdint.h>

#include "active_codes.h"

struct mcc;

/* Changes that lie ahead of the motion; of more, the oldest come into sight early. */
enum { READOUT_KEPT = 16 };

struct readout_zero {
    int32_t command;     /* index of the first command from which on it holds */
    int32_t system;      /* 1 is G54 */
    double offset[AXES]; /* [mm], [deg] machine coordinates of the program's zero, before scaling
                          * and rotation; the tool's offset counts */
};

struct readout {
    struct readout_zero zero[READOUT_KEPT];
    int32_t first, count;        /* of zero[]: in sight; and that with those ahead */
    int32_t codes[ACTIVE_CODES]; /* of the line read last */
};

/* Note what is in force once the interpreter has read on; at a start and behind a motion that was
 * dropped, what was noted before is forgotten. */
void readout_note(struct mcc *m);
void readout_start(struct mcc *m);

/* Call at each look at the machine: what holds for the command that moves comes into sight. */
void readout_look(struct mcc *m);

/* What is in sight. */
const struct readout_zero *readout_zero(const struct readout *r);

#endif
