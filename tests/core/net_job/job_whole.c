/* A whole job: read from any frame, and each thing that can be wrong with it found. */
#include "job_make.h"

static struct made m;

static const uint8_t *page_of(uint32_t page)
{
    return m.file + page * JOB_PAGE_BYTES;
}

/* From a frame on; returns the pages it took to find it. */
static int read_from(uint32_t frame)
{
    struct job_reader r;
    struct job_frame f;
    int sought = 0, brought = 0;
    uint32_t at = frame, page;
    CHECK_EQ(job_reader_start(&r, &m.header, frame), JOB_GOOD);
    while ((page = job_reader_wants(&r)) != 0 && check_failures < 20) {
        CHECK_EQ(job_reader_page(&r, page_of(page)), JOB_GOOD);
        brought++;
        for (; job_reader_next(&r, &f); at++) {
            sought = sought ? sought : brought;
            CHECK_EQ(r.frame, at + 1);
            CHECK(!memcmp(&f, &m.frame[at], sizeof f));
        }
    }
    CHECK_EQ(at, m.frames);
    CHECK(frame == m.header.frames || !memcmp(r.position, m.header.end, sizeof r.position));
    return sought;
}

static void any_frame(void)
{
    uint64_t random = 5;
    int most = 0;
    make_job(&m, &random, 4000, 300);
    for (uint32_t k = 0; k <= m.header.frames; k += 1 + 6 * CHECK_EACH) {
        const int took = read_from(k);
        most = took > most ? took : most;
    }
    printf("a frame among %u pages: %d pages at most\n", m.header.pages, most);
    int halvings = 0;
    for (uint32_t left = m.header.pages; left; left /= 2)
        halvings++;
    CHECK_EQ(most, halvings);
    CHECK_EQ(read_from(0), 1);
    CHECK_EQ(read_from(m.header.frames), 0);
    struct job_reader r;
    CHECK_EQ(job_reader_start(&r, &m.header, m.header.frames + 1), JOB_FRAMES);
    CHECK_EQ(job_reader_wants(&r), 0);

    /* another page than the one that is wanted */
    job_reader_start(&r, &m.header, 0);
    CHECK_EQ(job_reader_page(&r, page_of(2)), JOB_FRAMES);
    CHECK_EQ(job_reader_wants(&r), 1);
    struct job_frame f;
    CHECK(!job_reader_next(&r, &f));
    CHECK_EQ(job_reader_page(&r, page_of(1)), JOB_GOOD);
    while (job_reader_next(&r, &f)) {
    }
    CHECK_EQ(job_reader_wants(&r), 2);
    CHECK_EQ(job_reader_page(&r, page_of(1)), JOB_FRAMES);
    CHECK_EQ(job_reader_page(&r, page_of(m.header.pages)), JOB_FRAMES);
    CHECK_EQ(job_reader_wants(&r), 2);
    CHECK_EQ(job_reader_page(&r, page_of(2)), JOB_GOOD);
}

/* The check's word on the file; where the fault is. */
static enum job_fault judged(uint32_t page)
{
    struct job_check c;
    const enum job_fault fault = job_check(&c, m.file, m.bytes, MAKE_START);
    if (fault)
        CHECK_EQ(c.page, page);
    return fault;
}

/* Write bytes at a place of a page, seal it, judge, and put all back. */
static enum job_fault with(uint32_t page, int at, uint64_t value, int bytes, uint32_t where)
{
    uint8_t kept[JOB_PAGE_BYTES], *now = m.file + page * JOB_PAGE_BYTES;
    memcpy(kept, now, sizeof kept);
    job_put(now + at, value, bytes);
    job_page_seal(now);
    const enum job_fault fault = judged(where);
    memcpy(now, kept, sizeof kept);
    return fault;
}

static void header_faults(void)
{
    CHECK_EQ(with(0, 0, 'm', 1, 0), JOB_MAGIC);
    CHECK_EQ(with(0, 4, 2, 2, 0), JOB_FORMAT);
    CHECK_EQ(with(0, 6, 512, 2, 0), JOB_FORMAT);
    CHECK_EQ(with(0, 8, 0, 1, 0), JOB_ID);
    CHECK_EQ(with(0, 12, 249980, 4, 0), JOB_PERIOD);
    CHECK_EQ(with(0, 12, 10000020, 4, 0), JOB_PERIOD);
    CHECK_EQ(with(0, 12, 1000010, 4, 0), JOB_PERIOD);
    CHECK_EQ(with(0, 16, 0, 1, 0), JOB_MASK);
    CHECK_EQ(with(0, 16, 16, 1, 0), JOB_MASK);
    CHECK_EQ(with(0, 17, m.header.events, 1, 0), JOB_GOOD);
    CHECK_EQ(with(0, 17, m.header.events + 1, 1, 0), JOB_EVENT);
    CHECK_EQ(with(0, 18, 1, 1, 0), JOB_FILL);
    CHECK_EQ(with(0, 19, 1, 1, 0), JOB_FILL);
    CHECK_EQ(with(0, 20, 0, 4, 0), JOB_COUNT);
    CHECK_EQ(with(0, 20, m.header.pages + 1, 4, 1), JOB_SIZE);
    CHECK_EQ(with(0, 20, 0xffffffff, 4, 0), JOB_COUNT);
    CHECK_EQ(with(0, 24, 0, 4, 0), JOB_COUNT);
    CHECK_EQ(with(0, 24, 228 * m.header.pages + 1, 4, 0), JOB_COUNT);
    CHECK_EQ(with(0, 24, m.header.frames + 1, 4, m.header.pages + 1), JOB_END);
    CHECK_EQ(with(0, 24, m.header.frames - 1, 4, m.header.pages), JOB_FRAMES);
    CHECK_EQ(with(0, 28, 12, 4, 0), JOB_COUNT);
    CHECK_EQ(with(0, 28, m.header.events + 1, 4, m.header.pages + 1), JOB_GOOD);
    CHECK_EQ(with(0, 28, m.header.events - 1, 4, 0), JOB_EVENT);
    CHECK_EQ(with(0, 112, (uint32_t)m.header.end[0] + 1, 4, m.header.pages + 1), JOB_END);
    CHECK_EQ(with(0, 162, 2, 1, 0), JOB_EVENT);
    CHECK_EQ(with(0, 163, 2, 1, 0), JOB_EVENT);
    CHECK_EQ(with(0, 164, 1, 4, 0), JOB_EVENT); /* a level has no width */
    CHECK_EQ(with(0, 170, 2, 1, 0), JOB_EVENT);
    CHECK_EQ(with(0, 172, 0, 4, 0), JOB_EVENT);       /* a pulse has, */
    CHECK_EQ(with(0, 172, 1000001, 4, 0), JOB_EVENT); /* up to a second */
    CHECK_EQ(with(0, 172, 1, 4, 0), JOB_GOOD);
    CHECK_EQ(with(0, 247, 1, 1, 0), JOB_EVENT);
    CHECK_EQ(with(0, 248, 1, 1, 0), JOB_FILL);
    CHECK_EQ(with(0, 251, 1, 1, 0), JOB_FILL);
}

static void page_faults(void)
{
    const uint32_t last = m.header.pages;
    CHECK_EQ(with(3, 0, 0, 4, 3), JOB_FRAMES);
    CHECK_EQ(with(3, 0, 0xffffffff, 4, 3), JOB_FRAMES);
    CHECK_EQ(with(3, 4, 12345678, 4, 3), JOB_POSITION);
    CHECK_EQ(with(3, 16, 1, 4, 3), JOB_POSITION); /* an axis that the mask does not have */
    CHECK_EQ(with(3, 4, 0x7fffffff, 4, 3), JOB_POSITION);
    CHECK_EQ(with(3, 4, 0x80000000, 4, 3), JOB_POSITION);
    CHECK_EQ(with(3, 20, 0, 2, 3), JOB_FRAMES);
    CHECK_EQ(with(3, 20, 229, 2, 3), JOB_FRAMES);
    CHECK_EQ(with(3, 22, 229, 2, 3), JOB_VARINT);
    CHECK_EQ(with(3, 22, 65535, 2, 3), JOB_VARINT);
    CHECK_EQ(with(last, 251, 0, 1, last), JOB_FILL);
    CHECK_EQ(with(1, JOB_PAYLOAD_AT, 0x80, 2, 1), JOB_VARINT); /* 0 in two bytes */
    CHECK_EQ(with(1, JOB_PAYLOAD_AT, 0xffffffff, 4, 1), JOB_VARINT);
    CHECK_EQ(with(1, JOB_PAYLOAD_AT, 20, 1, 1), JOB_REST); /* 5 pulses, 3 + 1 may be */
    CHECK_EQ(with(1, JOB_PAYLOAD_AT, 16, 1, 2), JOB_POSITION);
    CHECK_EQ(with(2, JOB_PAYLOAD_AT, 0x0c3500 << 1 | 0x8080, 3, 2), JOB_COMMAND);
}

/* One byte wrong anywhere is found at its page; a page more, less or twice. */
static void damaged_files(void)
{
    uint64_t random = 8;
    for (size_t k = 0; k < m.bytes; k += 1 + 2 * CHECK_EACH) {
        const uint8_t wrong = (uint8_t)check_random(&random, 1, 255);
        m.file[k] ^= wrong;
        CHECK(judged((uint32_t)(k / JOB_PAGE_BYTES)) == (k < 4 ? JOB_MAGIC : JOB_CRC));
        m.file[k] ^= wrong;
    }
    const size_t bytes = m.bytes;
    for (size_t n = 0; n <= 2 * JOB_PAGE_BYTES; n++) {
        m.bytes = n;
        CHECK_EQ(judged(n >= JOB_PAGE_BYTES), JOB_SIZE);
    }
    m.bytes = bytes - JOB_PAGE_BYTES;
    CHECK_EQ(judged(1), JOB_SIZE);
    m.bytes = bytes + JOB_PAGE_BYTES;
    CHECK_EQ(judged(1), JOB_SIZE);
    m.bytes = bytes;
    uint8_t kept[JOB_PAGE_BYTES];
    memcpy(kept, m.file + 3 * JOB_PAGE_BYTES, sizeof kept);
    memcpy(m.file + 3 * JOB_PAGE_BYTES, m.file + 2 * JOB_PAGE_BYTES, sizeof kept);
    CHECK_EQ(judged(3), JOB_FRAMES);
    memcpy(m.file + 3 * JOB_PAGE_BYTES, kept, sizeof kept);
    CHECK_EQ(judged(0), JOB_GOOD);
}

/* Rest at both ends: a start speed of 3 pulses in a frame lets 4 through. */
static void rest(void)
{
    for (int32_t c = -6; c <= 6; c++)
        for (int end = 0; end < 2; end++) {
            m.header = make_header(1, 0);
            m.frames = 300;
            memset(m.frame, 0, sizeof m.frame);
            m.frame[end ? m.frames - 1 : 0].command[0] = c;
            make_file(&m);
            CHECK_EQ(judged(end ? m.header.pages + 1 : 1), c < -4 || c > 4 ? JOB_REST : JOB_GOOD);
        }
}

/* As many frames as a page can hold, a byte each, and the number of one more. */
static void full_page(void)
{
    m.header = make_header(1, 0);
    m.frames = 2 * JOB_PAGE_FRAMES;
    memset(m.frame, 0, sizeof m.frame);
    make_file(&m);
    CHECK_EQ(m.header.pages, 2);
    CHECK_EQ(judged(0), JOB_GOOD);
    CHECK_EQ(with(1, 20, JOB_PAGE_FRAMES + 1, 2, 1), JOB_FRAMES);
    CHECK_EQ(with(1, 20, JOB_PAGE_FRAMES - 1, 2, 1), JOB_VARINT);
}

/* What a writer does not take, and the widest way. */
static void refused(void)
{
    struct job_writer w;
    struct job_check c;
    uint8_t page[JOB_PAGE_BYTES], header[JOB_PAGE_BYTES];
    static const struct {
        struct job_frame f;
        enum job_fault fault;
    } bad[] = {
        { { { 25001 }, 0 }, JOB_COMMAND }, { { { 0, -25001 }, 0 }, JOB_COMMAND },
        { { { 0, 0, 1 }, 0 }, JOB_MASK },  { { { 0 }, 3 }, JOB_EVENT },
        { { { 0 }, -1 }, JOB_EVENT },
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        const struct job_header h = make_header(3, 2);
        job_writer_start(&w, &h);
        CHECK(!job_writer_add(&w, &bad[k].f, page));
        CHECK_EQ(w.fault, bad[k].fault);
        CHECK(!job_writer_add(&w, &(struct job_frame){ { 0 }, 0 }, page));
        CHECK_EQ(job_writer_end(&w, page, header), bad[k].fault);
    }
    struct job_header h = make_header(1, 0);
    job_writer_start(&w, &h);
    CHECK_EQ(job_writer_end(&w, page, header), JOB_COUNT);
    h.period_ns = 10000000;
    CHECK_EQ(job_command_max(h.period_ns), 32767);
    CHECK_EQ(job_command_max(1000000), 25000);
    job_writer_start(&w, &h);
    for (int32_t k = 0; k < 65538; k++)
        job_writer_add(&w, &(struct job_frame){ { -32767 }, 0 }, page);
    CHECK_EQ(w.fault, JOB_GOOD);
    CHECK_EQ(w.header.end[0], -2147483646);
    job_writer_add(&w, &(struct job_frame){ { -2 }, 0 }, page);
    CHECK_EQ(w.fault, JOB_POSITION);

    m.header = h;
    m.frames = 3;
    memset(m.frame, 0, sizeof m.frame);
    m.frame[0].command[0] = 7, m.frame[1].command[0] = -20, m.frame[2].command[0] = 1;
    make_file(&m);
    CHECK_EQ(job_check(&c, m.file, m.bytes, MAKE_START), JOB_GOOD);
    CHECK_EQ(c.low[0], -13);
    CHECK_EQ(c.high[0], 7);
    CHECK_EQ(c.high[1], 0);
}

int main(void)
{
    any_frame();
    rest();
    full_page();
    refused();
    uint64_t random = 2;
    do
        make_job(&m, &random, 1200, 300);
    while (m.header.axes != 7 || m.header.events < 3 || m.header.events == JOB_EVENTS
           || m.header.pages < 6);
    CHECK_EQ(judged(0), JOB_GOOD);
    header_faults();
    page_faults();
    damaged_files();
    return check_result();
}
