/* controller_parts - what the files of this core share. */
#ifndef CONTROLLER_PARTS_H
#define CONTROLLER_PARTS_H

#include "controller.h"

/* A key counts once each time it goes down. */
static inline void controller_key_look(struct controller_key *k, bool down)
{
    k->pressed = k->pressed || (down && !k->down);
    k->down = down;
}

static inline bool controller_key_take(struct controller_key *k)
{
    const bool pressed = k->pressed;

    k->pressed = false;
    return pressed;
}

/* Start the program; drop it with all its moves; carry out its orders of one run of the driver, and
 * return their number. */
void controller_program_start(struct controller *s, const struct controller_config *c,
                              const struct orders_text *t);
void controller_program_drop(struct controller *s);
int32_t controller_program_run(struct controller *s, const struct controller_config *c,
                               const struct orders_text *t, const struct controller_panel *panel,
                               const struct robot_job_inputs *in);

/* The user program reads lines into the queue at a poll. */
void controller_program_poll(struct controller *s, const struct controller_config *c,
                             const struct orders_text *t, const struct robot_job_inputs *in,
                             int64_t clock);

/* Put out the program's outputs whose moves have reached their points, with the copy that is
 * complete at clock `done`. */
void controller_program_outputs(struct controller *s, int64_t done);

/* Whether a move with this tool may be given now; if so, the tool is in force. */
bool controller_program_ready(struct controller *s, const struct controller_config *c,
                              const struct pose *tool);

/* Give the arm a move that stands in a line of the program. */
enum robot_status controller_program_give(struct controller *s, const struct controller_config *c,
                                          struct robot_move *move, int32_t line,
                                          struct robot_refusal *why);

/* Keep an output until its move has reached its point. False: there is no room now. */
bool controller_program_put(struct controller *s, const struct order *o);

/* Give the arm the move of an order. True: the order is done with, which it is, too, if refused. */
bool controller_program_move(struct controller *s, const struct controller_config *c,
                             struct order *order);

/* Act on the keys and the jogging that a run of the driver finds. */
void controller_panel_run(struct controller *s, const struct controller_config *c,
                          const struct orders_text *t, const struct controller_panel *panel,
                          int64_t clock);

/* Jog by the pendant's directions. An increment is in mm, or in deg if the tool only turns. */
enum robot_status controller_panel_jog(struct controller *s, const struct controller_config *c,
                                       const struct controller_panel *panel,
                                       struct robot_refusal *why);

#endif
