/* protect - calls that set and read what protects the machine. The document's own are in mcc.h;
 * these two it does not have. */
#ifndef PROTECT_H
#define PROTECT_H

#include "mcc.h"

/* What the limit switches do: enum machine_limit, -1 nothing. */
int protect_set_limit_mode(struct mcc *m, int mode);

/* Largest following errors, 0: not watched. [counts] */
int protect_set_track_limit(struct mcc *m, const int32_t counts[AXES]);

#endif
