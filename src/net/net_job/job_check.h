/* job_check - is a job whole? Page by page, or all at once: each page by itself, frame numbers and
 * positions in a row, the counts and the end of the header, rest at both ends. */
#ifndef JOB_CHECK_H
#define JOB_CHECK_H

#include <stddef.h>
#include "job_page.h"

struct job_check {
    struct job_header header;
    uint32_t start_speed[JOB_AXES];        /* [pulses/s] */
    enum job_fault fault;                  /* the first */
    uint32_t page;                         /* of the file, the next; of a fault, where it is */
    uint32_t frame;                        /* the next; of a fault, that or the first of its page */
    int32_t position[JOB_AXES];            /* [pulses] there */
    int32_t low[JOB_AXES], high[JOB_AXES]; /* [pulses] of all positions so far */
    struct job_frame last;
};

/* Begin with the header. start_speed: an axis at rest may begin and end a job with it; a command
 * of whole pulses may be one more than it gives in a period. */
enum job_fault job_check_start(struct job_check *c, const uint8_t header[JOB_PAGE_BYTES],
                               const uint32_t start_speed[JOB_AXES]);

/* The next data page. A fault stays. */
enum job_fault job_check_page(struct job_check *c, const uint8_t bytes[JOB_PAGE_BYTES]);

/* Behind the last. */
enum job_fault job_check_end(struct job_check *c);

/* All at once; c->page and c->frame tell where a fault is. */
enum job_fault job_check(struct job_check *c, const uint8_t *job, size_t bytes,
                         const uint32_t start_speed[JOB_AXES]);

#endif
