/* card_state - the state of the network card, and the table that says for each state and command
 * whether the command is accepted.
 *
 *     EMPTY --job--> READY --START--> RUNNING <--START-- PAUSED
 *                      ^                 |  PAUSE          ^
 *                      |                 '---> PAUSING ----'       STOP from any that moves:
 *                      '--- STOPPING <------------------------     STOPPING, then READY or EMPTY
 *
 * HOME is accepted at rest, running and paused, and ends the job. HOMING can be paused and stopped.
 * A limit switch, an alarm or an emergency stop leads to FAULT from anywhere; RESET leads out of it
 * when the cause is gone. After STOP, HOME and FAULT only a new START moves the axes, from the
 * begin of the job.
 */
#ifndef CARD_STATE_H
#define CARD_STATE_H

#include <stdbool.h>

#include "net_codes.h"

enum card_command {
    CARD_DO_START,
    CARD_DO_PAUSE,
    CARD_DO_STOP,
    CARD_DO_HOME,
    CARD_DO_RESET,
    CARD_DO_OUTPUT,
    CARD_DO_SET,     /* of a setting */
    CARD_DO_RECEIVE, /* of a job */
    CARD_COMMANDS
};

/* What the table says of a command in a state. */
struct card_rule {
    enum net_code code; /* NET_DONE: accepted */
    bool acts;          /* the task of the command is woken; else there is nothing to do */
};

/* Look up a command in a state. */
struct card_rule card_rule(enum net_state state, enum card_command command);

/* True in the states in which axes move, or may begin to move at any time. */
bool card_state_moves(enum net_state state);

#endif
