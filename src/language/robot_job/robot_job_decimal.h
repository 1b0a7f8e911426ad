/* robot_job_decimal - a number as text, to 1e-6. */
#ifndef ROBOT_JOB_DECIMAL_H
#define ROBOT_JOB_DECIMAL_H

#include <stdint.h>

/* Where a text grows; `at` stays below `size`, what does not fit is left out. */
struct robot_job_text {
    char *text;
    int32_t size, at;
};

/* Each leaves the text with its end 0. */
void robot_job_text_add(struct robot_job_text *t, const char *more);
void robot_job_text_bytes(struct robot_job_text *t, const char *more, int32_t length);

/* |value| < 1e9, rounded to a millionth, without zeros at the end: -0.5, 12. */
void robot_job_text_number(struct robot_job_text *t, double value);

#endif
