#include "job_reader.h"

#include <string.h>

enum job_fault job_reader_start(struct job_reader *r, const struct job_header *h, uint32_t frame)
{
    memset(r, 0, sizeof *r);
    r->header = *h;
    if (frame > h->frames)
        return JOB_FRAMES;
    r->low = 1;
    r->high = frame ? h->pages : 1;
    r->frame = frame;
    r->known = frame == 0;
    return JOB_GOOD;
}

uint32_t job_reader_wants(const struct job_reader *r)
{
    if (r->frame >= r->header.frames || r->at < r->page.frames)
        return 0;
    return r->low + (r->high - r->low) / 2;
}

/* The page contains the next frame: read from there on. */
static enum job_fault take(struct job_reader *r, const struct job_page *page, uint32_t number)
{
    int32_t begin[JOB_AXES];
    memcpy(begin, page->position, sizeof begin);
    const int32_t at = (int32_t)(r->frame - page->first);
    for (int32_t k = 0; k < at; k++)
        job_frame_move(begin, &page->frame[k]);
    if (r->known && memcmp(begin, r->position, sizeof begin))
        return JOB_POSITION;
    memcpy(r->position, begin, sizeof begin);
    r->known = true;
    r->low = r->high = number;
    r->page = *page;
    r->at = at;
    return JOB_GOOD;
}

enum job_fault job_reader_page(struct job_reader *r, const uint8_t bytes[JOB_PAGE_BYTES])
{
    const uint32_t number = job_reader_wants(r);
    struct job_page page = { 0 }; /* unused frames are 0, so that equal states have equal bytes */
    const enum job_fault fault = number ? job_page_read(&page, &r->header, bytes) : JOB_SIZE;
    if (fault)
        return fault;
    const uint32_t end = page.first + (uint32_t)page.frames;
    if ((end == r->header.frames) != (number == r->header.pages))
        return JOB_FRAMES;
    const bool before = r->frame < page.first;
    const bool behind = r->frame >= end;
    if (!before && !behind)
        return take(r, &page, number);
    if (before ? number == r->low : number == r->high)
        return JOB_FRAMES; /* no page contains it */
    if (before)
        r->high = number - 1;
    else
        r->low = number + 1;
    return JOB_GOOD;
}

bool job_reader_next(struct job_reader *r, struct job_frame *f)
{
    if (r->at >= r->page.frames)
        return false;
    *f = r->page.frame[r->at++];
    job_frame_move(r->position, f);
    r->frame++;
    if (r->at == r->page.frames)
        r->high = ++r->low;
    return true;
}
