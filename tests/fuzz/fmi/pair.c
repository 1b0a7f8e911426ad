#include "pair.h"

const struct side *const side[VERSIONS] = { &side_2, &side_3 };
struct slot pair_before;
static struct slot after;

int  side_errors;
char side_said[256];

void side_tell(int status, const char *category, const char *text, bool format)
{
    HOLDS(text && text[0] && category);
    HOLDS((status == ERROR) == (strcmp(category, "logStatusError") == 0));
    side_errors += status == ERROR;
    snprintf(side_said, sizeof side_said, "%s", text);
    for (const char *p = text; format && (p = strchr(p, '%')) != NULL; p += 2) {
        HOLDS(p[1] == '%');
    }
}

void pair_save(struct pair *p, struct slot *s)
{
    HOLDS(BOTH(get_state(p->c[v_], &s->state[v_])) == 0);
    s->stand = p->stand;
    s->point = p->point;
}

void pair_write(struct pair *p, struct slot *s, char *const to[VERSIONS])
{
    for (int v = 0; v < VERSIONS; v++) {
        size_t n = 0;
        HOLDS(side[v]->size(p->c[v], s->state[v], &n) == 0 && n == inside_size(s->state[v]));
        HOLDS(side[v]->serialize(p->c[v], s->state[v], to[v], n) == 0);
    }
    HOLDS(inside_alike(to[0], to[1]));
}

void pair_look(struct pair *p)
{
    if (p->stand != FAILED) {
        pair_save(p, &pair_before);
    }
}

void pair_same(struct pair *p)
{
    if (p->stand == FAILED) {
        return;
    }
    pair_save(p, &after);
    for (int v = 0; v < VERSIONS; v++) {
        /* A state in memory is what its bytes are, but for the hash. */
        const size_t n = inside_size(after.state[v]);
        HOLDS(inside_size(pair_before.state[v]) == n);
        HOLDS(memcmp(pair_before.state[v], after.state[v], n) == 0);
    }
}
