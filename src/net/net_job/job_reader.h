/* job_reader - frames of a job one by one, from any on. The caller brings the pages it wants:
 *
 *     job_reader_start(&r, header, frame);
 *     while ((page = job_reader_wants(&r)) != 0 && job_reader_page(&r, bytes of page) == JOB_GOOD)
 *         while (job_reader_next(&r, &f)) ...
 */
#ifndef JOB_READER_H
#define JOB_READER_H

#include "job_page.h"

struct job_reader {
    struct job_header header;
    uint32_t low, high;         /* data pages among which the next one is sought; low <= high */
    uint32_t frame;             /* the next */
    int32_t position[JOB_AXES]; /* [pulses] at the begin of the next frame, if that is */
    bool known;                 /* then the next page must begin there */
    int32_t at;                 /* in the page */
    struct job_page page;       /* frames 0: none is there */
};

/* From a frame on: 0 is the first, header.frames the end. Finding another than the first takes
 * about log2(pages) pages. JOB_FRAMES: there is no such frame. */
enum job_fault job_reader_start(struct job_reader *r, const struct job_header *h, uint32_t frame);

/* Page of the file, 1 .. header.pages, to be brought before there can be a next frame; 0: none, the
 * next frame is there or the job is over. */
uint32_t job_reader_wants(const struct job_reader *r);

/* Here it is. Not good: the reader is as before. */
enum job_fault job_reader_page(struct job_reader *r, const uint8_t bytes[JOB_PAGE_BYTES]);

/* Take the next frame. False: a page is wanted, or the job is over. */
bool job_reader_next(struct job_reader *r, struct job_frame *f);

#endif
