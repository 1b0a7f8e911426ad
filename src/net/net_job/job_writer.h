/* job_writer - writes the frames of a job into the pages of a job file, which the caller stores.
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
    struct job_header header;     /* its pages, frames and end are those so far */
    enum job_fault fault;         /* fault of the first frame refused; no other is taken then */
    uint32_t first;               /* number of the first frame of the page being written */
    int32_t begin[JOB_AXES];      /* [pulses] position at its begin */
    int32_t frames, bytes;        /* number of its frames; of bytes in its payload */
    struct job_frame last;        /* the latest frame */
    uint8_t payload[JOB_PAYLOAD]; /* of the page being written */
};

/* Start. Counts, end and id of the header are made by the writer; the rest is the caller's. */
void job_writer_start(struct job_writer *w, const struct job_header *h);

/* Add a frame. True if it begins a new page; then the one before is in `page`. A frame is refused
 * (w->fault) if a command is above job_command_max() or of an axis that is not in the mask, if the
 * event is not in the table, or if a position reaches +-2^31. */
bool job_writer_add(struct job_writer *w, const struct job_frame *f, uint8_t page[JOB_PAGE_BYTES]);

/* Write the last page and the header page. A fault if a frame was refused or there was none. */
enum job_fault job_writer_end(struct job_writer *w, uint8_t page[JOB_PAGE_BYTES],
                              uint8_t header[JOB_PAGE_BYTES]);

#endif
