/* pair - an instance of each FMI version, which must answer alike and stand at the same place. */
#ifndef PAIR_H
#define PAIR_H

#include "holds.h"
#include "inside.h"

enum { VERSIONS = 2, ERROR = 3 };

enum stand { NEW, INITIALIZING, RUNNING, ENDED, FAILED };

/* Instances of both versions, and where they must stand. */
struct pair {
    void *c[VERSIONS];
    enum stand stand;
    double point, stop;     /* [s] */
};

/* A saved state of both. */
struct slot {
    void *state[VERSIONS];
    enum stand stand;
    double point;
};

extern const struct side *const side[VERSIONS];

/* Make a call of both versions, which must answer alike and tell an error once. */
#define BOTH(call) __extension__ ({ \
    int status_[VERSIONS]; \
    for (int v_ = 0; v_ < VERSIONS; v_++) { \
        side_errors = 0; \
        status_[v_] = side[v_]->call; \
        HOLDS(status_[v_] == 0 || status_[v_] == ERROR); \
        HOLDS(side_errors == (status_[v_] == ERROR)); \
    } \
    HOLDS(status_[0] == status_[1]); \
    status_[0]; \
})

void pair_save(struct pair *p, struct slot *s);

/* The state as bytes, in which both versions have the same. */
void pair_write(struct pair *p, struct slot *s, char *const to[VERSIONS]);

/* Where an instance is, and that it is still there; nothing is seen while it has failed. */
extern struct slot pair_before;
void pair_look(struct pair *p);
void pair_same(struct pair *p);

/* A call that must be refused and change nothing. */
#define REFUSED(p, call) do { \
    pair_look(p); \
    HOLDS(BOTH(call) == ERROR); \
    pair_same(p); \
} while (0)

#endif
