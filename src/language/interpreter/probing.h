/* probing - G38.2 to G38.5: a straight motion at the feed that ends where a probe gets contact, or
 * loses it (G38.4, G38.5). */
#ifndef PROBING_H
#define PROBING_H

#include "gcode.h"
#include "modes.h"

/* Whether the block has one of these codes. */
bool probing_asked(const struct block *b);

/* Make that motion; reading waits in front of it and behind it. Then axis words need a code of
 * motion again. FAULT_NO_PROBE; FAULT_NO_AXES; FAULT_SHARED: M66 is in the block;
 * FAULT_PROBE_POINT: the tool stands there already, with G38.2 and G38.4. */
enum fault probing_block(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

#endif
