#include "card_state.h"

#define DO(code) { NET_##code, true }  /* the task is woken */
#define NO(code) { NET_##code, false } /* refused; NO(DONE): there is nothing to do */

/*                START      PAUSE      STOP       HOME       RESET      OUTPUT    SET       job */
static const struct card_rule table[NET_STATES][CARD_COMMANDS] = {
    [NET_EMPTY] = { NO(NO_JOB), NO(STATE), NO(DONE), DO(DONE), NO(DONE), DO(DONE), DO(DONE),
                    DO(DONE) },
    [NET_READY] = { DO(DONE), NO(STATE), NO(DONE), DO(DONE), NO(DONE), DO(DONE), DO(DONE),
                    DO(DONE) },
    [NET_RUNNING] = { NO(STATE), DO(DONE), DO(DONE), DO(DONE), NO(STATE), DO(DONE), NO(BUSY),
                      NO(BUSY) },
    [NET_PAUSING] = { DO(DONE), NO(DONE), DO(DONE), DO(DONE), NO(STATE), DO(DONE), NO(BUSY),
                      NO(BUSY) },
    [NET_PAUSED] = { DO(DONE), NO(DONE), DO(DONE), DO(DONE), NO(STATE), DO(DONE), NO(BUSY),
                     NO(BUSY) },
    [NET_STOPPING] = { NO(STATE), NO(STATE), NO(DONE), NO(STATE), NO(STATE), DO(DONE), NO(BUSY),
                       NO(BUSY) },
    [NET_HOMING] = { NO(STATE), DO(DONE), DO(DONE), NO(STATE), NO(STATE), DO(DONE), NO(BUSY),
                     NO(BUSY) },
    [NET_FAULT] = { NO(ALARM), NO(ALARM), NO(DONE), NO(ALARM), DO(DONE), DO(DONE), DO(DONE),
                    DO(DONE) },
};

struct card_rule card_rule(enum net_state state, enum card_command command)
{
    return table[state][command];
}

bool card_state_moves(enum net_state state)
{
    return state == NET_RUNNING || state == NET_PAUSING || state == NET_STOPPING
           || state == NET_HOMING;
}
