/* epcio_damage - whether a card whose state comes back from outside can be worked with: every
 * index, count and divisor is in its range, and what is due has not been due for long. Booleans and
 * enumerations must have been looked at; values that are only wrong are not seen. */
#ifndef EPCIO_DAMAGE_H
#define EPCIO_DAMAGE_H

#include "epcio.h"
#include "single_buffer.h"

/* What is wrong, in words, or NULL. The card has been advanced to its clock; `period`: [clocks]
 * since the latest sample of the pins at most. */
const char *epcio_damage(const struct epcio *card, int64_t period);
const char *epcio_damage_single_buffer(const struct single_buffer *card);

#endif
