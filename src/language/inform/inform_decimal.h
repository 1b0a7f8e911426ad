/* inform_decimal - a number as text, to 1e-6. */
#ifndef INFORM_DECIMAL_H
#define INFORM_DECIMAL_H

#include <stdint.h>

/* Where a text grows; `at` stays below `size`, what does not fit is left out. */
struct inform_text {
    char *text;
    int32_t size, at;
};

/* Each leaves the text with its end 0. */
void inform_text_add(struct inform_text *t, const char *more);
void inform_text_bytes(struct inform_text *t, const char *more, int32_t length);

/* |value| < 1e9, rounded to a millionth, without zeros at the end: -0.5, 12. */
void inform_text_number(struct inform_text *t, double value);

#endif
