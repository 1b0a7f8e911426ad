#include "job_check.h"

#include <string.h>

static enum job_fault set(struct job_check *c, enum job_fault fault)
{
    if (!c->fault)
        c->fault = fault;
    return c->fault;
}

enum job_fault job_check_start(struct job_check *c, const uint8_t header[JOB_PAGE_BYTES],
                               const uint32_t start_speed[JOB_AXES])
{
    memset(c, 0, sizeof *c);
    memcpy(c->start_speed, start_speed, sizeof c->start_speed);
    const enum job_fault fault = job_header_read(&c->header, header);
    c->page = !fault;
    return set(c, fault);
}

/* Whether all axes may start from rest, or stop, with the commands of this frame. */
static bool slow(const struct job_check *c, const struct job_frame *f)
{
    for (int i = 0; i < JOB_AXES; i++) {
        const uint64_t whole = (uint64_t)c->start_speed[i] * c->header.period_ns / 1000000000 + 1;
        if ((uint64_t)(f->command[i] < 0 ? -f->command[i] : f->command[i]) > whole)
            return false;
    }
    return true;
}

static void widen(struct job_check *c)
{
    for (int i = 0; i < JOB_AXES; i++) {
        c->low[i] = c->position[i] < c->low[i] ? c->position[i] : c->low[i];
        c->high[i] = c->position[i] > c->high[i] ? c->position[i] : c->high[i];
    }
}

enum job_fault job_check_page(struct job_check *c, const uint8_t bytes[JOB_PAGE_BYTES])
{
    if (c->fault)
        return c->fault;
    if (c->page > c->header.pages)
        return set(c, JOB_SIZE);
    struct job_page page;
    const enum job_fault fault = job_page_read(&page, &c->header, bytes);
    if (fault)
        return set(c, fault);
    if (page.first != c->frame)
        return set(c, JOB_FRAMES);
    if (memcmp(page.position, c->position, sizeof c->position))
        return set(c, JOB_POSITION);
    if (c->frame == 0 && !slow(c, &page.frame[0]))
        return set(c, JOB_REST);
    for (int32_t k = 0; k < page.frames; k++) {
        job_frame_move(c->position, &page.frame[k]);
        widen(c);
    }
    c->last = page.frame[page.frames - 1];
    c->frame += (uint32_t)page.frames;
    c->page++;
    return JOB_GOOD;
}

enum job_fault job_check_end(struct job_check *c)
{
    if (c->fault)
        return c->fault;
    if (c->page != c->header.pages + 1)
        return set(c, JOB_SIZE);
    if (c->frame != c->header.frames || memcmp(c->position, c->header.end, sizeof c->position))
        return set(c, JOB_END);
    return set(c, slow(c, &c->last) ? JOB_GOOD : JOB_REST);
}

enum job_fault job_check(struct job_check *c, const uint8_t *job, size_t bytes,
                         const uint32_t start_speed[JOB_AXES])
{
    if (bytes < JOB_PAGE_BYTES) {
        memset(c, 0, sizeof *c);
        return set(c, JOB_SIZE);
    }
    job_check_start(c, job, start_speed);
    if (!c->fault && bytes != ((uint64_t)c->header.pages + 1) * JOB_PAGE_BYTES)
        set(c, JOB_SIZE);
    while (!c->fault && c->page <= c->header.pages)
        job_check_page(c, job + (size_t)c->page * JOB_PAGE_BYTES);
    return job_check_end(c);
}
