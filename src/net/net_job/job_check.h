/* job_check - checks a whole job file, page by page or all at once: each page by itself, frame
 * numbers and positions from page to page, counts and end position of the header, and that it
 * begins and ends at rest. */
#ifndef JOB_CHECK_H
#define JOB_CHECK_H

#include <stddef.h>
#include "job_page.h"

struct job_check {
    struct job_header header;
    uint32_t start_speed[JOB_AXES];        /* [pulses/s] speed that an axis reaches at once */
    enum job_fault fault;                  /* the first fault found */
    uint32_t page;                         /* next page of the file; that of the fault */
    uint32_t frame;                        /* next frame; the first of the page of the fault */
    int32_t position[JOB_AXES];            /* [pulses] at the begin of that frame */
    int32_t low[JOB_AXES], high[JOB_AXES]; /* [pulses] extremes of the positions so far */
    struct job_frame last;                 /* the latest frame */
};

/* Begin with the header page. At start_speed [pulses/s] an axis may start from rest and stop, so
 * the first and the last command of a job may be its pulses in a period, rounded down, and one
 * more. */
enum job_fault job_check_start(struct job_check *c, const uint8_t header[JOB_PAGE_BYTES],
                               const uint32_t start_speed[JOB_AXES]);

/* Check the next data page. Returns the first fault so far. */
enum job_fault job_check_page(struct job_check *c, const uint8_t bytes[JOB_PAGE_BYTES]);

/* Check the end, after the last page. */
enum job_fault job_check_end(struct job_check *c);

/* Check a whole file; c->page and c->frame tell where a fault is. */
enum job_fault job_check(struct job_check *c, const uint8_t *job, size_t bytes,
                         const uint32_t start_speed[JOB_AXES]);

#endif
