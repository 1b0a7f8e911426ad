/* mix - motion by commands one by one, the next beginning while the one before decelerates:
 *
 *     point = A(s_A) + B(s_B) - B(0)          at most two commands at a time
 */
#ifndef MIX_H
#define MIX_H

#include "command.h"
#include "limited.h"

struct mix_move {
    struct command command;
    struct profile profile;
};

struct mix {
    struct mix_move move[2]; /* the older first */
    int32_t count;           /* number of commands under way */
};

/* A command that lasts begins, at a speed under an override; not when two are under way. */
void mix_begin(struct mix *x, const struct command *c, double override);

/* The older one has ended; the newer takes its place. */
void mix_retire(struct mix *x);

/* Plan the newest afresh from where it is. An older one beside it decelerates to its end. */
void mix_replan(struct mix *x, double override);

/* Whether a further command, which blends, may begin with the next tail. */
bool mix_open(const struct mix *x);

/* Let time pass that crosses no end. [s] */
void mix_shift(struct mix *x, double dt);

/* Point and velocity; `rest` is the point while there is no command. [mm], [mm/s] */
void mix_place(const struct mix *x, const double rest[AXES], double point[AXES],
               double velocity[AXES]);

/* No command can go on by time alone; delays do not while they are held. */
bool mix_rests(const struct mix *x, bool held);

/* A command other than a delay can. */
bool mix_moves(const struct mix *x);

/* What limits the newest command. */
struct limited mix_limited(const struct mix *x, const struct mechanism *m);

/* Time until the last comes to its end, or to rest before. [s] */
double mix_left(const struct mix *x);

/* Bounds of the way from here to there, the sum of those of the commands; exact if there is one.
 * [mm] */
void mix_extent(const struct mix *x, const double rest[AXES], double low[AXES], double high[AXES]);

#endif
