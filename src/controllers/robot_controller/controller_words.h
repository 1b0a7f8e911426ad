/* controller_words - why a move is refused and why a program has ended, in words. */
#ifndef CONTROLLER_WORDS_H
#define CONTROLLER_WORDS_H

#include "controller.h"

enum { CONTROLLER_WORDS = 256 };

/* Why a move is refused, such as: a joint leaves its limits: joint 3 to 85 deg, limit 75 deg,
 * ... */
void controller_refusal_words(enum robot_status status, const struct robot_refusal *why,
                              char text[CONTROLLER_WORDS]);

/* Why the program was ended. */
void controller_words(const struct controller_trouble *t, char text[CONTROLLER_WORDS]);

#endif
