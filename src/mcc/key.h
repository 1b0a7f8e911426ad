/* key - a key of a panel: it counts as pressed when it goes down, until somebody takes that. */
#ifndef KEY_H
#define KEY_H

#include <stdbool.h>

struct key {
    bool down;          /* when it was looked at last */
    bool pressed;       /* since it was taken last */
};

void key_look(struct key *k, bool down);

/* Has it been pressed? Once for all times that it was. */
bool key_take(struct key *k);

#endif
