/* chain_iterate - joints of a pose by Newton's method, each time with a proof that they are there.
 *
 * F(q) is the residual, of the flange's place in sizes of the arm and of its turning. A is a left
 * inverse of F'(q0), e = |A F(q0)| the first step and K a bound of |A F''| all over. Then the
 * theorem of Newton and Kantorovich says of the largest joint's way:
 *
 *     K e <= 1/2   =>   one q* with A F(q*) = 0 within r = (1 + sqrt(1 - 2 K e)) / K of q0, and it
 *                       is no further than 2 e
 *
 * So where it holds at the joints given, what is found is the only solution near them. Where it
 * does not, the pose is approached in steps for which it does, along the straight way from where
 * the flange is.
 */
#ifndef CHAIN_ITERATE_H
#define CHAIN_ITERATE_H

#include "chain.h"

enum chain_iterate_status {
    CHAIN_LOST,    /* none are found */
    CHAIN_FOUND,   /* they are there, but others may be nearer */
    CHAIN_FOLLOWED /* they are the ones to which those given lead */
};

/* What is left of |F|, at most. */
#define CHAIN_RESIDUAL 1e-12

/* Joints of a pose that joint[] leads to; joint `held` (-1: none) stays. `size` is that of the arm
 * [m]. CHAIN_LOST: joint[] is as it was. */
enum chain_iterate_status chain_iterate(const struct chain *c, int held, double size,
                                        const struct chain_pose *pose, double joint[CHAIN_JOINTS]);

/* The same from further away, by steps that are halved until less is left. Which of several
 * solutions it comes to is not said. */
bool chain_iterate_damped(const struct chain *c, int held, double size,
                          const struct chain_pose *pose, double joint[CHAIN_JOINTS]);

/* Joints close to those of a pose become those of it. False, and joint[] as it was: it is not
 * proved that there are any. */
bool chain_iterate_close(const struct chain *c, int held, double size,
                         const struct chain_pose *pose, double joint[CHAIN_JOINTS]);

/* The pose at a part (0 .. 1) of the straight way from one to another, which turns about one
 * axis. */
void chain_iterate_between(const struct chain_pose *from, const struct chain_pose *to, double part,
                           struct chain_pose *pose);

/* Largest rate of a joint for a unit rate of the flange, `size` [m] counting as 1; INFINITY where
 * it is singular. */
double chain_iterate_gain(const struct chain *c, int held, double size,
                          const double joint[CHAIN_JOINTS]);

#endif
