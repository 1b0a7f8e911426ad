/* job_reader - reads the frames of a job one by one, from any frame on. It has no memory of the
 * file: it says which page it wants, and the caller brings that:
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
    uint32_t low, high;         /* data pages that may contain the next frame; low <= high */
    uint32_t frame;             /* number of the next frame */
    int32_t position[JOB_AXES]; /* [pulses] at the begin of the next frame, if `known` */
    bool known;                 /* the position is known: the next page must begin there */
    int32_t at;                 /* index of the next frame in the page */
    struct job_page page;       /* page being read; frames 0: none */
};

/* Start at a frame: 0 is the first, header.frames the end. Finding a frame other than the first
 * takes about log2(pages) pages. JOB_FRAMES if there is no such frame. */
enum job_fault job_reader_start(struct job_reader *r, const struct job_header *h, uint32_t frame);

/* Number of the file's page, 1 .. header.pages, that the reader needs for the next frame; 0 if it
 * needs none: the next frame is there or the job is over. */
uint32_t job_reader_wants(const struct job_reader *r);

/* Bring the wanted page. On a fault the reader does not change. */
enum job_fault job_reader_page(struct job_reader *r, const uint8_t bytes[JOB_PAGE_BYTES]);

/* Take the next frame. False if a page is wanted or the job is over. */
bool job_reader_next(struct job_reader *r, struct job_frame *f);

#endif
