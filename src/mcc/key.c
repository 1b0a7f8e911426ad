#include "key.h"

void key_look(struct key *k, bool down)
{
    k->pressed = k->pressed || (down && !k->down);
    k->down = down;
}

bool key_take(struct key *k)
{
    const bool pressed = k->pressed;

    k->pressed = false;
    return pressed;
}
