/* job_make - for the tests: random jobs, and their job files. */
#ifndef JOB_MAKE_H
#define JOB_MAKE_H

#include <string.h>
#include "check.h"
#include "job_bytes.h"
#include "job_check.h"
#include "job_reader.h"
#include "job_writer.h"

enum { MAKE_FRAMES = 7000, MAKE_PAGES = 400 };

struct made {
    struct job_header header;
    int32_t frames;
    struct job_frame frame[MAKE_FRAMES];
    size_t bytes;
    uint8_t file[MAKE_PAGES * JOB_PAGE_BYTES];
};

static const uint32_t MAKE_START[JOB_AXES] = { 3000, 3000, 3000, 3000 }; /* 3 pulses in 1 ms */

static inline struct job_header make_header(uint32_t axes, uint32_t events)
{
    struct job_header h = { .period_ns = 1000000,
                            .axes = axes,
                            .events = events,
                            .pulses_per_m = { 1000000, 1000000, 1, 2 },
                            .speed_max = { 1, 2, 3, 4 },
                            .acc_max = { 5, 6, 7, 0xffffffff },
                            .jerk_max = { 8, 9, 10, 0xfedcba9876543210 } };
    for (int k = 0; k < JOB_ORIGIN_BYTES; k++)
        h.origin[k] = (uint8_t)(17 * k + 3);
    for (uint32_t k = 0; k < events; k++)
        h.event[k] = (struct job_event){ (uint16_t)(1u << k), k & 1, 1, k & 1 ? 1000000 : 0 };
    return h;
}

/* Write the frames of a job into its file. */
static inline void make_file(struct made *m)
{
    struct job_writer w;
    uint8_t *end = m->file + JOB_PAGE_BYTES;
    job_writer_start(&w, &m->header);
    for (int32_t k = 0; k < m->frames; k++)
        if (job_writer_add(&w, &m->frame[k], end))
            end += JOB_PAGE_BYTES;
    CHECK_EQ(job_writer_end(&w, end, m->file), JOB_GOOD);
    m->header = w.header;
    m->bytes = (size_t)(end + JOB_PAGE_BYTES - m->file);
}

/* Make a job whose commands change at random by at most `step` per frame, at rest at both ends. */
static inline void make_job(struct made *m, uint64_t *random, int32_t frames, int32_t step)
{
    m->header = make_header((uint32_t)check_random(random, 1, 15),
                            (uint32_t)check_random(random, 0, JOB_EVENTS));
    m->frames = frames;
    memset(m->frame, 0, sizeof m->frame);
    for (int32_t k = 1; k < frames - 1; k++) {
        for (int i = 0; i < JOB_AXES; i++) {
            const int64_t c = m->frame[k - 1].command[i] + check_random(random, -step, step);
            if (m->header.axes >> i & 1)
                m->frame[k].command[i] = (int32_t)(c > 25000 ? 25000 : c < -25000 ? -25000 : c);
        }
        if (m->header.events && check_random(random, 0, 9) == 0)
            m->frame[k].event = (int32_t)check_random(random, 1, m->header.events);
    }
    make_file(m);
}

#endif
