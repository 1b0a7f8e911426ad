/* soft_words - what went wrong, in words. */
#ifndef SOFT_WORDS_H
#define SOFT_WORDS_H

#include "soft.h"

enum { SOFT_WORDS = 256 };

/* Why a move is refused: a joint leaves its limits: joint 3 to 85 deg, limit 75 deg, ... */
void soft_refusal_words(enum robot_status status, const struct robot_refusal *why,
                        char text[SOFT_WORDS]);

/* Why the program was ended. */
void soft_words(const struct soft_trouble *t, char text[SOFT_WORDS]);

#endif
