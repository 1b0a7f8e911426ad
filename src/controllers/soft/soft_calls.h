/* soft_calls - moves, jogs and outputs by calls of a program of your own instead of the robot
 * language.
 *
 * Calls come between two instants and act from the next interrupt on. One that is refused changes
 * nothing; ROBOT_BUSY: a program runs, the card has stopped, moves before are not planned yet.
 */
#ifndef SOFT_CALLS_H
#define SOFT_CALLS_H

#include "soft.h"

/* A move behind those given before; its target says all, its line is set here. Another tool than
 * before has to wait until the arm is idle. */
enum robot_status soft_move(struct soft *s, const struct soft_config *c,
                            const struct robot_move *move, const struct pose *tool,
                            struct robot_refusal *why);

/* robot_jog by the pendant's directions: until they are 0 again, or so far as `way`. */
enum robot_status soft_jog(struct soft *s, const struct soft_config *c, struct soft_panel *panel,
                           struct robot_refusal *why);

/* Outputs of the order (ORDER_OUT, ORDER_ANALOG) change once the arm has passed the points of all
 * moves given so far. */
enum robot_status soft_output(struct soft *s, struct order *order);

/* Line of a points file for a taught point, 0 .. s->taught_count - 1; as robot_job_point_write. */
int soft_taught(const struct soft *s, int32_t n, char line[ROBOT_JOB_POINT_TEXT]);

#endif
