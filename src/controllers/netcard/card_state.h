/* card_state - the one state word of the card and the table of state and command.
 *
 *     EMPTY --job--> READY --START--> RUNNING <--START-- PAUSED
 *                      ^                 |  PAUSE          ^
 *                      |                 '---> PAUSING ----'       STOP from any that moves:
 *                      '--- STOPPING <------------------------     STOPPING, then READY or EMPTY
 *
 * HOME is taken at rest, running and paused: it ends the job. HOMING can be paused and stopped. A
 * limit, an alarm, an emergency stop lead to FAULT from anywhere; RESET leads out when the cause is
 * gone. Behind STOP, HOME and FAULT only a new START moves, from the job's begin.
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

/* What the table says. */
struct card_rule {
    enum net_code code; /* NET_DONE: accepted */
    bool acts;          /* the task of the command is woken: else there is nothing to do */
};

/* Rule of a command in a state. */
struct card_rule card_rule(enum net_state state, enum card_command command);

/* The axes move, or may at once. */
bool card_state_moves(enum net_state state);

#endif
