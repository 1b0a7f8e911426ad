/* mdi - lines of a part program that are given by hand (manual data input), while no program runs.
 *
 *     mdi_take --text--> buffer --line by line, each checked as a whole--> interpreter --> ring
 *
 * Lines run in the order in which they are taken, read ahead and joined as those of a program are.
 * A line is refused as a whole, before any motion of it, and reading goes on with the next one.
 * When the lines are used up the motion comes to rest at the end of the last one, unless others
 * come before it has to brake.
 */
#ifndef MDI_H
#define MDI_H

#include <stdbool.h>
#include <stdint.h>

#include "fault.h"
#include "source.h"

struct mcc;
struct program;

enum { MDI_SIZE = 8192 }; /* [byte] of text that is kept, with a LF behind each line */

/* Places are [byte] from the first line that was ever taken. */
struct mdi {
    bool on;             /* the interpreter reads these lines, or has read them last */
    bool refuses;        /* a line has been refused since mdi_look */
    int32_t line, ended; /* lines begun to be read, refused or dropped; and those that are over */
    int32_t refused;     /* number of the latest line that was refused, from 1; 0: none */
    struct fault_report fault; /* of that line */
    int64_t base;              /* place of text[0] */
    int64_t from, until;       /* the line that is being read; equal: there is none */
    int32_t length;            /* [byte] of text[] in use */
    char text[MDI_SIZE];
};

/* Take lines, with LF between them. What is not possible now (a program runs, axes are moved by
 * hand, there is an error) is refused as a fault of the last of these lines. False, and nothing
 * done: there is no room. */
bool mdi_take(struct mcc *m, const char *text, int32_t length);

/* [byte] Room for further lines; each takes one byte more for its end. */
int32_t mdi_room(const struct mdi *d);

/* Whether lines wait to be read. */
bool mdi_waits(const struct mdi *d);

/* Begin to read the lines that wait, if nothing else has the machine. */
void mdi_start(struct mcc *m);

/* Forget the lines that wait. */
void mdi_drop(struct mdi *d);

/* Call at each look at the machine: lines whose motion is over have ended, and behind a line that
 * was refused reading goes on. So a caller who looks at `refused` each time sees every one. */
void mdi_look(struct mcc *m);

/* The text as a source, with the files of another source (NULL: none) as those that it calls; only
 * up to the end of the line that is being read. */
struct mdi_view {
    const struct mdi *mdi;
    const struct source *files;
};
struct source mdi_source(struct mdi_view *v);

/* Before the interpreter is asked: go on to the next line, with p as it is read. False: there is
 * none, or it was refused. */
bool mdi_next(struct mcc *m, const struct program *p);

/* The interpreter has used up the line that was read. */
void mdi_read(struct mcc *m);

#endif
