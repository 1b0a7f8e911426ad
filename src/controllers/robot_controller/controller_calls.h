/* controller_calls - moves, jogs and outputs by calls of a user's own program, instead of a job.
 *
 * Calls come between two instants and act from the next interrupt on. A call that is refused
 * changes nothing. ROBOT_BUSY: a program runs, the card has stopped, or earlier moves are not
 * planned yet.
 */
#ifndef CONTROLLER_CALLS_H
#define CONTROLLER_CALLS_H

#include "controller.h"

/* Append a move to those given before. Its target leaves nothing open; its line is set here. A
 * change of the tool has to wait until the arm is idle. */
enum robot_status controller_move(struct controller *s, const struct controller_config *c,
                                  const struct robot_move *move, const struct pose *tool,
                                  struct robot_refusal *why);

/* Jog as robot_jog does, by the pendant's directions, until they are 0 again or jog_way is done. */
enum robot_status controller_jog(struct controller *s, const struct controller_config *c,
                                 struct controller_panel *panel, struct robot_refusal *why);

/* Change the outputs of an order (ORDER_OUT, ORDER_ANALOG) once the arm has passed the points of
 * all moves given so far. */
enum robot_status controller_output(struct controller *s, struct order *order);

/* Write a taught point, n = 0 .. s->taught_count - 1, as a line of a points file; as
 * robot_job_point_write. */
int controller_taught(const struct controller *s, const struct controller_config *c, int32_t n,
                      char line[ROBOT_JOB_POINT_TEXT]);

#endif
