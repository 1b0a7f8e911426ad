/* preview - a whole program as it will be commanded: each point is taken as soon as it is made.
 *
 * There is no card. Inputs are 0, a probe goes to its end without contact, axes are in position at
 * once, and the operator goes on at once: none of these waits takes time.
 */
#ifndef PREVIEW_H
#define PREVIEW_H

#include "limited.h"
#include "mcc.h"

/* Is told each point in its order, and what limits the motion at its end. */
typedef void preview_point(void *to, const struct point *p, const struct limited *l);

enum preview_end {
    PREVIEW_DONE,
    PREVIEW_ERROR, /* MCC_get_errcode() says which */
    PREVIEW_LONG   /* it has more points than were allowed */
};

/* Run a program that task_check has found good from where the axes rest, up to `most` points. The
 * library is left where it ends. */
enum preview_end preview_run(struct mcc *m, const struct source *s, int64_t most,
                             preview_point *told, void *to);

#endif
