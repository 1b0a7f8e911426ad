#include "pair.h"

const struct side *const side[VERSIONS] = { &side_2, &side_3 };
struct slot pair_before;
struct pair *pair_refused;
static struct slot after;

struct side_told side_told[2];

void side_tell(int version, int status, const char *category, const char *text)
{
    static const char name[] = "two: ";
    struct side_told *told = &side_told[version - 2];
    HOLDS(text && text[0] && category);
    HOLDS((status == ERROR) == (strcmp(category, "logStatusError") == 0));
    HOLDS(version == 2 || strncmp(text, name, sizeof name - 1) == 0);
    text += version == 2 ? 0 : sizeof name - 1;
    char plain[SIDE_TEXT] = "";
    for (size_t n = 0; *text; text++) {
        if (version == 2 && *text == '%') { /* there it is a format of printf */
            HOLDS(*++text == '%');
        }
        if (n < sizeof plain - 1) {
            plain[n++] = *text;
        }
    }
    if (status == ERROR) {
        HOLDS(told->errors < SIDE_ERRORS);
        memcpy(told->text[told->errors++], plain, sizeof plain);
    }
}

/* Length of the file's name in a message on a line of it, 0 in others. */
static size_t name_of_file(const char *text)
{
    const char *line = strstr(text, ": line "), *more = strstr(text, ": ... and more");
    return line ? (size_t)(line - text) : more ? (size_t)(more - text) : 0;
}

void pair_alike(const int status[VERSIONS])
{
    const struct side_told *told = &side_told[0];
    HOLDS(status[0] == 0 || status[0] == ERROR);
    HOLDS(status[1] == status[0] && side_told[1].errors == told->errors);
    HOLDS((told->errors > 0) == (status[0] == ERROR));
    for (int i = 0; i < told->errors; i++) {
        const char *text = told->text[i], *first = told->text[0];
        const size_t n = name_of_file(text);
        const bool call = strncmp(text, "fmi2", 4) == 0; /* its names differ */
        HOLDS(call || strcmp(text, side_told[1].text[i]) == 0);
        HOLDS(i == 0 || (n > 0 && strncmp(text, first, n) == 0 && strcmp(text, text - SIDE_TEXT)));
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
    pair_settle();
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

void pair_settle(void)
{
    struct pair *p = pair_refused;
    pair_refused = NULL;
    if (p) {
        pair_same(p);
    }
}
