/* robot_job_decimal - numbers written as text, rounded to a millionth. */
#ifndef ROBOT_JOB_DECIMAL_H
#define ROBOT_JOB_DECIMAL_H

#include <stdint.h>

/* A text that grows within a buffer of `size` bytes. What does not fit is left out. */
struct robot_job_text {
    char *text;
    int32_t size, at;
};

/* Append text. Each of these functions leaves the text with a 0 at its end. */
void robot_job_text_add(struct robot_job_text *t, const char *more);
void robot_job_text_bytes(struct robot_job_text *t, const char *more, int32_t length);

/* Append a number, |value| < 1e9, without zeros at its end: -0.5, 12. */
void robot_job_text_number(struct robot_job_text *t, double value);

#endif
