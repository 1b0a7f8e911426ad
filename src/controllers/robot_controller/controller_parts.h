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

/* Program: start, drop all of it, one run's orders. Returns how many were done. */
void controller_program_start(struct controller *s, const struct controller_config *c,
                              const struct orders_text *t);
void controller_program_drop(struct controller *s);
int32_t controller_program_run(struct controller *s, const struct controller_config *c,
                               const struct orders_text *t, const struct controller_panel *panel,
                               const struct robot_job_inputs *in);

/* The user program reads lines at a poll. */
void controller_program_poll(struct controller *s, const struct controller_config *c,
                             const struct orders_text *t, const struct robot_job_inputs *in,
                             int64_t clock);

/* Outputs of the program whose moves are reached, into the copy that is complete at a clock. */
void controller_program_outputs(struct controller *s, int64_t done);

/* Whether a move with a tool may be given now; the tool is in force then. */
bool controller_program_ready(struct controller *s, const struct controller_config *c,
                              const struct pose *tool);

/* Give the arm a move of a line. */
enum robot_status controller_program_give(struct controller *s, const struct controller_config *c,
                                          struct robot_move *move, int32_t line,
                                          struct robot_refusal *why);

/* An output behind a move; false: no room now. */
bool controller_program_put(struct controller *s, const struct order *o);

/* Give the arm an order's move: true if it is done with, also if it is refused. */
bool controller_program_move(struct controller *s, const struct controller_config *c,
                             struct order *order);

/* Keys and jogging, as a run finds them. */
void controller_panel_run(struct controller *s, const struct controller_config *c,
                          const struct orders_text *t, const struct controller_panel *panel,
                          int64_t clock);

/* Jog by the pendant's directions; an increment is in mm, or in deg where it only turns. */
enum robot_status controller_panel_jog(struct controller *s, const struct controller_config *c,
                                       const struct controller_panel *panel,
                                       struct robot_refusal *why);

#endif
