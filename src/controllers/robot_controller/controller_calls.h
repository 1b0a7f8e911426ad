/* controller_calls - moves, jogs and outputs by calls of a program of your own instead of the robot
 * language.
 *
 * Calls come between two instants and act from the next interrupt on. One that is refused changes
 * nothing; ROBOT_BUSY: a program runs, the card has stopped, moves before are not planned yet.
 */
#ifndef CONTROLLER_CALLS_H
#define CONTROLLER_CALLS_H

#include "controller.h"

/* A move behind those given before; its target says all, its line is set here. Another tool than
 * before has to wait until the arm is idle. */
enum robot_status controller_move(struct controller *s, const struct controller_config *c,
                                  const struct robot_move *move, const struct pose *tool,
                                  struct robot_refusal *why);

/* robot_jog by the pendant's directions: until they are 0 again, or so far as `way`. */
enum robot_status controller_jog(struct controller *s, const struct controller_config *c,
                                 struct controller_panel *panel, struct robot_refusal *why);

/* Outputs of the order (ORDER_OUT, ORDER_ANALOG) change once the arm has passed the points of all
 * moves given so far. */
enum robot_status controller_output(struct controller *s, struct order *order);

/* Line of a points file for a taught point, 0 .. s->taught_count - 1; as robot_job_point_write. */
int controller_taught(const struct controller *s, int32_t n, char line[ROBOT_JOB_POINT_TEXT]);

#endif
