/* waiting - what only the machine can tell a program: inputs (M66), where a probe touched (G38).
 *
 * Where `waits` is set, reading has stopped behind the commands so far. Who runs the program lets
 * them end, waits as `wait` says and gives the answer; then reading goes on.
 */
#ifndef WAITING_H
#define WAITING_H

#include "gcode.h"
#include "modes.h"

/* M66. */
enum fault waiting_input(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

/* Note the wait behind the commands made so far. */
void waiting_for(struct interpreter *in, enum wait_kind kind);

/* The input: 0 or 1, an analog value, -1 if it did not come in time. */
void waiting_answer(struct interpreter *in, double value);

/* Reading waits now: the commands before have been handed out. */
static inline bool waiting_now(const struct interpreter *in)
{
    return in->waits && in->taken == in->wait.behind;
}

/* The probe may move; from there on it is waited for. */
void waiting_free(struct interpreter *in);

/* The probe: place of its contact and where the motion came to rest, machine coordinates. Without
 * contact both are where the motion ended. */
void waiting_probed(struct interpreter *in, const double contact[AXES], const double rest[AXES],
                    bool touched);

/* The answer where no machine is: inputs are 0, the probe goes to its end and touches nothing. */
void waiting_pass(struct interpreter *in);

/* Numbered parameters of the answers: 5061 .. 5069 the contact, 5070 whether there was one, 5399
 * the input. False: no such parameter here. */
bool waiting_parameter(const struct interpreter *in, bool angles, int number, double *value);

/* Set one of them but the input: a program prepares a loop of probing. False: it is none. */
bool waiting_set(struct interpreter *in, bool angles, int number, double value);

/* Whether the input has done what is waited for; *was is its value at the look before. */
bool waiting_done(const struct waiting *w, double is, double was);

#endif
