/* task - the interpolation (IPO) task of the library: it reads the part program into the command
 * ring and the commands into the queue of interpolation points. Around it stand the calls that
 * check, start and operate a program.
 *
 *     part program --task_read--> command ring --task_point--> point queue --> card (pcl.h)
 */
#ifndef TASK_H
#define TASK_H

#include "mcc.h"

/* The library's group status, as far as it occurs here, with the library's numbers. */
enum task_status { TASK_RUNNING, TASK_STOPPED, TASK_HOLD, TASK_DELAY, TASK_BLOCK_HOLD, TASK_WHEEL };

/* A program whose text comes from s, with the machine, dialect and switches it is read with. */
struct program task_program(const struct mcc *m, const struct source *s);

/* Read the whole program as it would run from the end of the latest command, without any motion;
 * *r gets its first fault. */
void task_check(const struct mcc *m, const struct source *s, struct fault_report *r);

/* The same, with all faults and notes. */
void task_check_all(const struct mcc *m, const struct source *s, struct fault_list *all);

/* Start a program that task_check has found good. Refused with MCC_COMMAND_NOTACCEPTED while a
 * program runs, an abort is under way or axes move by hand, with MCC_RUN_TIME after an error. */
int task_start(struct mcc *m);

/* Check a program, with the modes, origins and parameters that are in force, and start it; with a
 * line `from` > 1 it begins there: the lines before are read for what they set, without motion.
 * MCC_PARAMETER: it is not good, and *r has the first fault. Else the codes of task_start. */
int task_start_at(struct mcc *m, const struct source *s, int32_t from, struct fault_report *r);

/* Let the interpreter go on with another text: lines by hand, or the program from its first line.
 * The first that is started begins with the modes of interpreter_start; what comes later has what
 * is left (resuming.h). */
void task_resume(struct mcc *m, bool by_hand);

/* Read no further; what has been read is dropped, so its modes are those of a start, and lines by
 * hand that wait are forgotten. */
void task_drop(struct mcc *m);

/* Set an origin [mm] with which programs start: system 1 is that of G54, 6 that of G59. Refused
 * while a program runs. */
int task_set_origin(struct mcc *m, int system, const double origin[AXES]);

/* Switches of the panel: skip blocks that begin with /, stop at M1. They act from the next block
 * that is read; both are off at first. */
void task_set_switches(struct mcc *m, bool block_delete, bool optional_stop);

/* Set the tool table with which programs start, and whether M6 waits for task_continue; at first it
 * does not. */
void task_set_tools(struct mcc *m, const struct tool_table *tools, bool change_stops);

/* Set the dialect in which programs are read from now on. */
void task_set_dialect(struct mcc *m, const struct mcc_dialect *d);

/* Single block: come to rest before each block of the program or call of the API, until
 * task_continue. The block with which a program starts does not wait. A block that waits when this
 * is switched off still needs task_continue. */
int task_set_single_block(struct mcc *m, bool on);

/* Go on after M0 or M1, or with the next single block. Refused with MCC_CONTI_ILLEGAL unless the
 * axes rest there and the card has taken every point. */
int task_continue(struct mcc *m);

/* Hold or go on, and set the overrides of feed and of point-to-point (1 is 100 %), as a panel does
 * in every cycle. A call that the library refuses has no effect. */
void task_operate(struct mcc *m, bool hold, double feed, double ptp);

/* One cycle: fill the point queue, as far as there are commands. s is the text that task_check has
 * found good; NULL if no program runs. */
void task_run(struct mcc *m, const struct source *s);

/* The cycle in parts, for a PC on which interpreter and interpolation are modules of their own.
 * True if a command can be read, if a point can be computed. */
bool task_can_read(const struct mcc *m);
bool task_can_point(const struct mcc *m);

/* Read the next command of the program into the ring. Only if task_can_read. */
void task_read(struct mcc *m, const struct source *s);

/* Read commands while the ring has room for them. Returns how often it read. */
int task_read_all(struct mcc *m, const struct source *s);

/* Compute the next point. Only if task_can_point. With a source s, the ring is filled again as
 * commands leave it; without (NULL) the point is made of what the ring has. Returns how often it
 * read. */
int task_point(struct mcc *m, const struct source *s);

/* Call after the last point of a cycle: once all commands are done, the next one begins where the
 * axes rest, and axes that were moved by hand take commands again. */
void task_settle(struct mcc *m);

/* True in the middle of a motion: a card that got no point now would stand still too early. */
bool task_moving(const struct mcc *m);

enum task_status task_status(const struct mcc *m);

/* A key of a panel. It is pressed when it goes down, and stays so until key_take. */
struct key {
    bool down;    /* when it was looked at last */
    bool pressed; /* since it was taken last */
};

static inline void key_look(struct key *k, bool down)
{
    k->pressed = k->pressed || (down && !k->down);
    k->down = down;
}

/* True if the key has been pressed since the last call, however often. */
static inline bool key_take(struct key *k)
{
    const bool pressed = k->pressed;

    k->pressed = false;
    return pressed;
}

#endif
