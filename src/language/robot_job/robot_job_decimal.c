#include "robot_job_decimal.h"

#include <math.h>

void robot_job_text_bytes(struct robot_job_text *t, const char *more, int32_t length)
{
    for (int32_t i = 0; i < length && t->at < t->size - 1; i++) {
        t->text[t->at++] = more[i];
    }
    t->text[t->at] = '\0';
}

void robot_job_text_add(struct robot_job_text *t, const char *more)
{
    while (*more != '\0') {
        robot_job_text_bytes(t, more++, 1);
    }
}

void robot_job_text_number(struct robot_job_text *t, double value)
{
    char digits[24];
    int32_t at = sizeof digits, places = 6;
    int64_t left = llround(fabs(value) * 1e6);

    if (value < 0.0 && left > 0) {
        robot_job_text_add(t, "-");
    }
    while (places > 0 && left % 10 == 0) {
        left /= 10;
        places--;
    }
    for (int32_t n = 0; n <= places || left > 0; n++) {
        if (n == places && places > 0) {
            digits[--at] = '.';
        }
        digits[--at] = (char)('0' + left % 10);
        left /= 10;
    }
    robot_job_text_bytes(t, digits + at, (int32_t)sizeof digits - at);
}
