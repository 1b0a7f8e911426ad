/* Bytes as a job file, as they are and with the CRC of each page made good: refused with a reason,
 * or read from any frame, and each page is the same bytes when it is written again. */
#include "holds.h"
#include "job_bytes.h"
#include "job_check.h"
#include "job_reader.h"

const int fuzz_count = 30000;

enum { PAGES = 16 };

static const uint32_t SPEED[JOB_AXES] = { 100000, 100000, 100000, 100000 };
static uint8_t file[PAGES][JOB_PAGE_BYTES];

static void write_again(const struct job_page *p, const struct job_header *h, const uint8_t *bytes)
{
    uint8_t packed[JOB_PAYLOAD + JOB_FRAME_BYTES];
    int32_t n = 0;
    for (int32_t k = 0; k < p->frames; k++) {
        HOLDS(n <= JOB_PAYLOAD);
        n += job_frame_pack(packed + n, &p->frame[k], k ? &p->frame[k - 1] : NULL, h->axes);
    }
    HOLDS(n == (int32_t)job_get(bytes + 22, 2));
    HOLDS(!memcmp(packed, bytes + JOB_PAYLOAD_AT, (size_t)n));
}

/* A good job from a frame to its end. */
static void read_from(const struct job_header *h, uint32_t frame)
{
    struct job_reader r;
    struct job_frame f;
    HOLDS(job_reader_start(&r, h, frame) == JOB_GOOD);
    for (uint32_t page; (page = job_reader_wants(&r)) != 0;) {
        HOLDS(page <= h->pages && job_reader_page(&r, file[page]) == JOB_GOOD);
        while (job_reader_next(&r, &f))
            frame++;
    }
    HOLDS(frame == h->frames && r.frame == frame);
    HOLDS(!r.known || !memcmp(r.position, h->end, sizeof h->end));
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct job_check c;
    if (size > sizeof file || size == 0)
        return 0;
    uint8_t *exact = malloc(size);
    HOLDS(exact);
    memcpy(exact, data, size);
    HOLDS(job_check(&c, exact, size, SPEED) == c.fault);
    free(exact);
    memset(file, 0xff, sizeof file);
    memcpy(file, data, size);
    const size_t pages = (size + JOB_PAGE_BYTES - 1) / JOB_PAGE_BYTES;
    for (size_t k = 0; k < pages; k++)
        job_page_seal(file[k]);
    const enum job_fault fault = job_check(&c, file[0], pages * JOB_PAGE_BYTES, SPEED);
    HOLDS(fault == c.fault && fault < JOB_FAULTS && job_fault_text(fault)[0]);
    HOLDS(c.page <= pages && c.frame <= c.header.frames);
    for (uint32_t k = 1; k < c.page && k < pages; k++) {
        struct job_page p;
        HOLDS(job_page_read(&p, &c.header, file[k]) == JOB_GOOD);
        write_again(&p, &c.header, file[k]);
    }
    if (fault == JOB_GOOD)
        for (int k = 0; k < 4; k++)
            read_from(&c.header, data[(size_t)k * 7 % size] * 5u % (c.header.frames + 1));
    return 0;
}
