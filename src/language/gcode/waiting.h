/* waiting - what only the machine can tell a program: inputs (M66), where a probe touched (G38).
 *
 * While struct interpreter's `waits` is set, reading has stopped behind the commands so far. The
 * controller lets these end, waits as `wait` says and gives the answer; then reading goes on.
 */
#ifndef WAITING_H
#define WAITING_H

#include "gcode.h"
#include "modes.h"

/* Execute M66 of a block: it waits for an input. FAULT_NO_INPUTS; FAULT_MISSING: no P or E, or no Q
 * with L1 to L4; FAULT_SHARED: P and E; FAULT_VALUE. */
enum fault waiting_input(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

/* From now on reading waits behind the commands made so far. */
void waiting_for(struct interpreter *in, enum wait_kind kind);

/* The answer to M66: 0 or 1, an analog value, or -1 if it did not come in time. */
void waiting_answer(struct interpreter *in, double value);

/* Whether the machine is to be asked now: the commands in front of the wait are handed out. */
static inline bool waiting_now(const struct interpreter *in)
{
    return in->waits && in->taken == in->wait.behind;
}

/* The answer to WAIT_FREE: the probing motion may begin. Behind it comes WAIT_PROBE. */
void waiting_free(struct interpreter *in);

/* The answer to WAIT_PROBE, in machine coordinates [mm], [deg]: place of the contact, and where the
 * motion came to rest. Without contact both are the end of the motion. */
void waiting_probed(struct interpreter *in, const double contact[AXES], const double rest[AXES],
                    bool touched);

/* The answer of a check, which has no machine: inputs are 0, and a probing motion goes to its end
 * without contact. */
void waiting_pass(struct interpreter *in);

/* Value of a numbered parameter: 5061 .. 5069 place of the latest contact [mm], [deg], 5070: 1 if
 * there was one, 5399 latest answer to M66. False: it is none of these. */
bool waiting_parameter(const struct interpreter *in, bool angles, int number, double *value);

/* Set 5061 .. 5070, as programs do in front of a loop of probing. False: it is none of these. */
bool waiting_set(struct interpreter *in, bool angles, int number, double value);

/* Whether the wait ends: `is` is the value of the input now, `was` when it was looked at before. */
bool waiting_done(const struct waiting *w, double is, double was);

#endif
