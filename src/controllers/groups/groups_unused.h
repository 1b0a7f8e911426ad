/* groups_unused - parts of a state of groups, which is not damaged, that need no copy. */
#ifndef GROUPS_UNUSED_H
#define GROUPS_UNUSED_H

#include "group.h"
#include "spans.h"

void groups_unused(const struct groups *g, struct spans *s);

#endif
