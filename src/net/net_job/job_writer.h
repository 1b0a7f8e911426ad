/* job_writer - frames into pages, which are the caller's.
 *
 *     job_writer_start(&w, &header);
 *     for (each frame)
 *         if (job_writer_add(&w, &f, page))
 *             append page
 *     job_writer_end(&w, page, header_page);
 *     append page, put header_page before them all
 */
#ifndef JOB_WRITER_H
#define JOB_WRITER_H

#include "job_page.h"

struct job_writer {
    struct job_header header; /* pages, frames and end are those so far */
    enum job_fault fault;     /* of the first frame refused; no other is taken then */
    uint32_t first;           /* frame of the page under way, */
    int32_t begin[JOB_AXES];  /* [pulses] where it begins, */
    int32_t frames, bytes;    /* and what it has */
    struct job_frame last;
    uint8_t payload[JOB_PAYLOAD];
};

/* The header's counts, end and id are made by the writer; the rest is the caller's. */
void job_writer_start(struct job_writer *w, const struct job_header *h);

/* True: the frame began a new page, and the one before is in `page`. Refused (w->fault): a command
 * above job_command_max() or of an axis that is not in the mask, an event that is not in the table,
 * a position outside 32 bits. */
bool job_writer_add(struct job_writer *w, const struct job_frame *f, uint8_t page[JOB_PAGE_BYTES]);

/* The last page, and the header. Not good: a frame was refused, or there was none. */
enum job_fault job_writer_end(struct job_writer *w, uint8_t page[JOB_PAGE_BYTES],
                              uint8_t header[JOB_PAGE_BYTES]);

#endif
