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
    double point, stop; /* [s] */
};

/* A saved state of both. */
struct slot {
    void *state[VERSIONS];
    enum stand stand;
    double point;
};

extern const struct side *const side[VERSIONS];

/* Make a call of both versions, which must answer alike and tell the same errors. */
#define BOTH(call) \
    __extension__({ \
        int status_[VERSIONS]; \
        pair_settle(); \
        EACH_OF_BOTH(call); \
        status_[0]; \
    })
#define EACH_OF_BOTH(call) \
    do { \
        for (int v_ = 0; v_ < VERSIONS; v_++) { \
            side_told[v_].errors = 0; \
            status_[v_] = side[v_]->call; \
        } \
        pair_alike(status_); \
    } while (0)

/* Were calls of both versions answered alike? An error is told once; of a part program, as often as
 * it has lines that are wrong. */
void pair_alike(const int status[VERSIONS]);

void pair_save(struct pair *p, struct slot *s);

/* The state as bytes, in which both versions have the same. */
void pair_write(struct pair *p, struct slot *s, char *const to[VERSIONS]);

/* Where an instance is, and that it is still there; nothing is seen while it has failed. */
extern struct slot pair_before;
void pair_look(struct pair *p);
void pair_same(struct pair *p);

/* The pair whose latest calls were all refused: where it is, is looked at before the next other
 * call, which takes long if states are large. */
extern struct pair *pair_refused;
void pair_settle(void);

/* A call that must be refused and change nothing. */
#define REFUSED(p, call) \
    do { \
        int status_[VERSIONS]; \
        if (pair_refused != (p)) { \
            pair_look(p); \
        } \
        EACH_OF_BOTH(call); \
        HOLDS(status_[0] == ERROR && side_told[0].errors == 1); \
        pair_refused = (p); \
    } while (0)

#endif
