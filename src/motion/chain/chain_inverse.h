/* chain_inverse - joints of a pose: all branches in closed form where the arm has one (chain_form),
 * else by iteration the one near joints that are given.
 *
 *     flag          of joints whose factor is negative   factor
 *     CHAIN_BACK    the arm reaches behind its axis      shoulder [m]
 *     CHAIN_ELBOW   the other elbow                      elbow, 1
 *     CHAIN_FLIP    the wrist is flipped                 wrist, 1
 *
 * A factor is the derivative of the equation whose two solutions the flag tells apart, so it is 0
 * where both are one: there the arm is singular.
 */
#ifndef CHAIN_INVERSE_H
#define CHAIN_INVERSE_H

#include "chain_form.h"

enum { CHAIN_BRANCHES = 8 };

/* Joints of the wanted branches, a bit each, that reach a pose; turning ones within half a turn of
 * 0. [rad], [m] Returns a bit for each branch that is there. A joint that the pose leaves open, and
 * one that is held, stays as in near[]; an arm angle, too. By iteration: branch 0. */
uint32_t chain_inverse(const struct chain_form *f, const struct chain_pose *pose,
                       const double near[CHAIN_JOINTS], uint32_t wanted,
                       double joint[CHAIN_BRANCHES][CHAIN_JOINTS]);

/* The same with another value of the held joint or of the arm angle. */
uint32_t chain_inverse_held(const struct chain_form *f, const struct chain_pose *pose,
                            const double near[CHAIN_JOINTS], double value, uint32_t wanted,
                            double joint[CHAIN_BRANCHES][CHAIN_JOINTS]);

/* The branch whose joints, by whole turns and within their limits, are nearest to near[] in the
 * joint that differs most (a turning one in rad, a sliding one in lengths of the arm). Gives its
 * joints. -1: none is within the limits. */
int chain_nearest(const struct chain_form *f, uint32_t branches,
                  const double all[CHAIN_BRANCHES][CHAIN_JOINTS], const double near[CHAIN_JOINTS],
                  const double low[CHAIN_JOINTS], const double high[CHAIN_JOINTS],
                  double joint[CHAIN_JOINTS]);

/* How far from singular: shoulder, elbow, wrist; 1 of one that the arm's form has not. Of an arm
 * that is iterated: the reciprocal of the largest rate of a joint at a unit rate of the flange.
 * Returns chain_branch. */
int chain_factors(const struct chain_form *f, const double joint[CHAIN_JOINTS], double factor[3]);

/* The branch that joints belong to: a sum of enum chain_flag. */
int chain_branch(const struct chain_form *f, const double joint[CHAIN_JOINTS]);

/* Angle [rad] of the elbow of an arm of kind CHAIN_SHOULDER_WRIST about the line from its shoulder
 * to its wrist. It counts from a direction that is undefined only where the wrist is straight
 * below the shoulder, seen along axis 1 (Elias and Wen 2024, stereographic shoulder-elbow-wrist
 * angle). */
double chain_arm_angle(const struct chain_form *f, const double joint[CHAIN_JOINTS]);

#endif
