/* interpreter - a part program becomes motion commands, one at a time.
 *
 * The text stays outside: the state is a place in it and the modal values, so a program of any
 * length streams through, and checking it is one pass with a copy of the state.
 */
#ifndef INTERPRETER_H
#define INTERPRETER_H

#include <stddef.h>

#include "command.h"

enum { INTERPRETER_SYSTEMS = 6 };   /* G54 .. G59 */

/* What a program is read against; all of it constant while it runs. */
struct program {
    const char *text;
    size_t length;
    const struct machine *machine;
    const double (*offset)[AXES];   /* [mm] origins of G54 .. G59 in machine coordinates */
};

struct interpreter {
    int64_t offset;         /* next line in the text */
    int32_t line;           /* lines read */
    bool    ended;
    bool    percent;        /* the first % has passed */
    int32_t motion;         /* 0..3, or -1 before the first motion code */
    enum path_plane plane;
    bool    inch, incremental, absolute_centre;
    bool    blend;          /* G64 */
    int32_t system;         /* 0..5 for G54 .. G59 */
    double  feed;           /* [mm/s] */
    double  point[AXES];    /* [mm] end of the last command, machine coordinates */
};

enum interpreter_result { INTERPRETER_COMMAND, INTERPRETER_END, INTERPRETER_FAULT };

/* Begin at the first line, at rest in a point; G17 G21 G90 G91.1 G54 G61 in force. */
void interpreter_start(struct interpreter *in, const double point[AXES], double feed);

/* Read on until there is a command (its index is left to the caller). A fault ends the program. */
enum interpreter_result interpreter_next(struct interpreter *in, const struct program *p,
                                         struct command *c, struct fault_report *r);

/* Read a whole program to its end, from a copy of the state; FAULT_NONE in *r if it is good. */
void interpreter_check(const struct interpreter *from, const struct program *p,
                       struct fault_report *r);

#endif
