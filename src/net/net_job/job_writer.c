#include "job_writer.h"

#include <string.h>

#include "job_bytes.h"

void job_writer_start(struct job_writer *w, const struct job_header *h)
{
    memset(w, 0, sizeof *w);
    w->header = *h;
    w->header.pages = 0;
    w->header.frames = 0;
    memset(w->header.end, 0, sizeof w->header.end);
}

static enum job_fault judge(const struct job_header *h, const struct job_frame *f)
{
    const int32_t most = job_command_max(h->period_ns);
    for (int i = 0; i < JOB_AXES; i++) {
        const int32_t c = f->command[i];
        if (c < -most || c > most)
            return JOB_COMMAND;
        if (c && !(h->axes >> i & 1))
            return JOB_MASK;
    }
    return f->event < 0 || (uint32_t)f->event > h->events ? JOB_EVENT : JOB_GOOD;
}

static void write_page(struct job_writer *w, uint8_t page[JOB_PAGE_BYTES])
{
    memset(page, 0xff, JOB_PAGE_BYTES);
    job_put(page, w->first, 4);
    for (int i = 0; i < JOB_AXES; i++)
        job_put(page + 4 + 4 * i, (uint32_t)w->begin[i], 4);
    job_put(page + 20, (uint32_t)w->frames, 2);
    job_put(page + 22, (uint32_t)w->bytes, 2);
    memcpy(page + JOB_PAYLOAD_AT, w->payload, (size_t)w->bytes);
    job_page_seal(page);
    w->header.pages++;
}

bool job_writer_add(struct job_writer *w, const struct job_frame *f, uint8_t page[JOB_PAGE_BYTES])
{
    int32_t end[JOB_AXES];
    memcpy(end, w->header.end, sizeof end);
    if (!w->fault)
        w->fault = judge(&w->header, f);
    if (!w->fault && !job_frame_move(end, f))
        w->fault = JOB_POSITION;
    if (w->fault)
        return false;
    uint8_t bytes[JOB_FRAME_BYTES];
    int32_t n = job_frame_pack(bytes, f, w->frames ? &w->last : NULL, w->header.axes);
    const bool full = w->bytes + n > JOB_PAYLOAD;
    if (full) {
        write_page(w, page);
        w->first = w->header.frames;
        memcpy(w->begin, w->header.end, sizeof w->begin);
        w->frames = w->bytes = 0;
        n = job_frame_pack(bytes, f, NULL, w->header.axes);
    }
    memcpy(w->payload + w->bytes, bytes, (size_t)n);
    w->bytes += n;
    w->frames++;
    w->header.frames++;
    w->last = *f;
    memcpy(w->header.end, end, sizeof end);
    return full;
}

enum job_fault job_writer_end(struct job_writer *w, uint8_t page[JOB_PAGE_BYTES],
                              uint8_t header[JOB_PAGE_BYTES])
{
    if (!w->fault && w->frames == 0)
        w->fault = JOB_COUNT;
    if (w->fault)
        return w->fault;
    write_page(w, page);
    job_header_write(&w->header, header);
    return job_header_read(&w->header, header);
}
