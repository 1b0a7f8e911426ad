#include "robot_job_fault.h"

#include "robot_job_decimal.h"

/* The texts themselves, not pointers to them, which would not be constant in a shared library. */
#define ROW(name, text)  [name] = text,
#define FITS(name, text) _Static_assert(sizeof text <= sizeof TEXT[0], #name " is too long");
static const char TEXT[ROBOT_JOB_FAULT_COUNT][51] = { ROBOT_JOB_FAULT_TEXTS(ROW) };
ROBOT_JOB_FAULT_TEXTS(FITS)

const char *robot_job_fault_text(enum robot_job_fault f)
{
    return (uint32_t)f < ROBOT_JOB_FAULT_COUNT ? TEXT[f] : "";
}

void robot_job_message(const struct robot_job_report *r, const char *text,
                       char message[ROBOT_JOB_MESSAGE_MAX])
{
    struct robot_job_text t = { message, ROBOT_JOB_MESSAGE_MAX, 0 };

    if (r->line > 0) {
        robot_job_text_add(&t, "line ");
        robot_job_text_number(&t, r->line);
        robot_job_text_add(&t, ": ");
    }
    robot_job_text_add(&t, robot_job_fault_text(r->fault));
    if (r->length > 0) {
        robot_job_text_add(&t, " \"");
        robot_job_text_bytes(&t, text + r->offset, r->length);
        robot_job_text_add(&t, "\"");
    }
    if (r->fault == ROBOT_JOB_BAD_VALUE) {
        robot_job_text_add(&t, " (");
        robot_job_text_number(&t, r->low);
        robot_job_text_add(&t, " to ");
        robot_job_text_number(&t, r->high);
        robot_job_text_add(&t, ")");
    } else if (r->fault == ROBOT_JOB_BAD_TOO_MANY || r->fault == ROBOT_JOB_BAD_NAME
               || r->fault == ROBOT_JOB_BAD_TEXT_LENGTH || r->fault == ROBOT_JOB_BAD_LINE_LENGTH) {
        robot_job_text_add(&t, " (at most ");
        robot_job_text_number(&t, r->high);
        robot_job_text_add(&t, ")");
    }
    if (r->other > 0) {
        robot_job_text_add(&t, " (line ");
        robot_job_text_number(&t, r->other);
        robot_job_text_add(&t, ")");
    }
}
