/* soft_parts - what the files of soft share. */
#ifndef SOFT_PARTS_H
#define SOFT_PARTS_H

#include "soft.h"

/* A key counts once each time it goes down. */
static inline void soft_key_look(struct soft_key *k, bool down)
{
    k->pressed = k->pressed || (down && !k->down);
    k->down = down;
}

static inline bool soft_key_take(struct soft_key *k)
{
    const bool pressed = k->pressed;

    k->pressed = false;
    return pressed;
}

/* Program: start, drop all of it, one run's orders. Returns how many were done. */
void soft_program_start(struct soft *s, const struct soft_config *c, const struct orders_text *t);
void soft_program_drop(struct soft *s);
int32_t soft_program_run(struct soft *s, const struct soft_config *c, const struct orders_text *t,
                         const struct soft_panel *panel, const struct robot_job_inputs *in);

/* The user program reads lines at a poll. */
void soft_program_poll(struct soft *s, const struct soft_config *c, const struct orders_text *t,
                       const struct robot_job_inputs *in, int64_t clock);

/* Outputs of the program whose moves are reached, into the copy that is complete at a clock. */
void soft_program_outputs(struct soft *s, int64_t done);

/* Whether a move with a tool may be given now; the tool is in force then. */
bool soft_program_ready(struct soft *s, const struct soft_config *c, const struct pose *tool);

/* Give the arm a move of a line. */
enum robot_status soft_program_give(struct soft *s, const struct soft_config *c,
                                    struct robot_move *move, int32_t line,
                                    struct robot_refusal *why);

/* An output behind a move; false: no room now. */
bool soft_program_put(struct soft *s, const struct order *o);

/* Give the arm an order's move: true if it is done with, also if it is refused. */
bool soft_program_move(struct soft *s, const struct soft_config *c, struct order *order);

/* Keys and jogging, as a run finds them. */
void soft_panel_run(struct soft *s, const struct soft_config *c, const struct orders_text *t,
                    const struct soft_panel *panel, int64_t clock);

/* Jog by the pendant's directions; an increment is in mm, or in deg where it only turns. */
enum robot_status soft_panel_jog(struct soft *s, const struct soft_config *c,
                                 const struct soft_panel *panel, struct robot_refusal *why);

#endif
