/* Pages: against bytes computed by hand, there and back, and every damage found. */
#include "job_make.h"

static struct made m;

/* Frames (1, -1), (2, -1) with event 1, (0, 0), (25000, 0), (-25000, 0) of axes X and Y. The CRC is
 * that of Python's zlib. */
static void literal(void)
{
    static const uint8_t payload[] = {
        0x04, 0x01, 0x05, 0x00, 0x01, 0x06, 0x02, 0xa0, 0x8d, 0x06, 0x00, 0xbe, 0x9a, 0x0c, 0x00,
    };
    static const uint8_t begin[JOB_PAYLOAD_AT] = { [20] = 5, [22] = sizeof payload };
    m.header = make_header(3, 1);
    m.frames = 5;
    memset(m.frame, 0, sizeof m.frame);
    m.frame[0] = (struct job_frame){ { 1, -1 }, 0 };
    m.frame[1] = (struct job_frame){ { 2, -1 }, 1 };
    m.frame[3] = (struct job_frame){ { 25000 }, 0 };
    m.frame[4] = (struct job_frame){ { -25000 }, 0 };
    make_file(&m);
    const uint8_t *page = m.file + JOB_PAGE_BYTES;
    CHECK_EQ(m.bytes, 2 * JOB_PAGE_BYTES);
    CHECK(!memcmp(page, begin, sizeof begin));
    CHECK(!memcmp(page + JOB_PAYLOAD_AT, payload, sizeof payload));
    for (size_t k = JOB_PAYLOAD_AT + sizeof payload; k < JOB_CRC_AT; k++)
        CHECK_EQ(page[k], 0xff);
    CHECK_EQ(job_get32(page + JOB_CRC_AT), 0x3b9d4f5d);
    static const uint8_t header[32] = {
        'M', 'C', 'J', '1', 1, 0, 0, 1, 3, 20, 37, 54, 0x40, 0x42, 0x0f, 0,
        3,   0,   0,   0,   1, 0, 0, 0, 5, 0,  0,  0,  1,    0,    0,    0,
    };
    static const uint8_t ends[16] = { 3, 0, 0, 0, 0xfe, 0xff, 0xff, 0xff };
    CHECK(!memcmp(m.file, header, sizeof header));
    CHECK(!memcmp(m.file + 112, ends, sizeof ends));
    CHECK_EQ(job_get32(m.file + JOB_CRC_AT), 0x50f426d8);
}

/* A decoder that shares nothing with the core: numbers first, then what they mean. */
static int32_t decode(const uint8_t *page, uint32_t axes, struct job_frame *out)
{
    int64_t number[JOB_PAGE_BYTES];
    const int frames = page[20] + 256 * page[21], bytes = page[22] + 256 * page[23];
    int at = 0;
    struct job_frame last = { 0 };
    for (int k = 0; k < frames; k++) {
        int n = 0;
        for (int i = 0; i < JOB_AXES; i++)
            n += axes >> i & 1;
        for (int j = 0; j < n; j++) {
            int64_t weight = 1;
            number[j] = 0;
            do {
                number[j] += weight * (page[24 + at] % 128);
                weight *= 128;
            } while (page[24 + at++] >= 128);
        }
        last.event = number[0] % 2 ? page[24 + at++] : 0;
        number[0] /= 2;
        for (int i = 0, j = 0; i < JOB_AXES; i++)
            if (axes >> i & 1) {
                const int64_t z = number[j++];
                last.command[i] += (int32_t)(z % 2 ? -(z + 1) / 2 : z / 2);
            }
        out[k] = last;
    }
    CHECK_EQ(at, bytes);
    return frames;
}

static void there_and_back(void)
{
    static struct job_frame frames[JOB_PAGE_BYTES];
    uint64_t random = 7;
    int64_t bytes = 0, numbers = 0;
    for (int k = 0; k < 300; k += CHECK_EACH) {
        static const int32_t step[] = { 1, 20, 300, 5000, 50000, 20 };
        make_job(&m, &random, (int32_t)check_random(&random, 2, 1500), step[k % 6]);
        uint32_t frame = 0, page = 1;
        int32_t position[JOB_AXES] = { 0 };
        for (; page <= m.header.pages; page++) {
            const uint8_t *at = m.file + page * JOB_PAGE_BYTES;
            struct job_page p;
            CHECK_EQ(job_page_read(&p, &m.header, at), JOB_GOOD);
            CHECK_EQ(p.frames, decode(at, m.header.axes, frames));
            CHECK_EQ(p.first, frame);
            CHECK(!memcmp(p.position, position, sizeof position));
            CHECK(!memcmp(p.frame, frames, sizeof *frames * (size_t)p.frames));
            CHECK(!memcmp(frames, m.frame + frame, sizeof *frames * (size_t)p.frames));
            frame += (uint32_t)p.frames;
            for (int32_t j = 0; j < p.frames; j++)
                CHECK(job_frame_move(position, &p.frame[j]));
            /* another frame would not have found room */
            if (page < m.header.pages)
                CHECK(JOB_PAYLOAD - (at[22] + 256 * at[23]) < JOB_FRAME_BYTES);
            if (step[k % 6] == 20) {
                bytes += at[22] + 256 * at[23];
                for (int i = 0; i < JOB_AXES; i++)
                    numbers += m.header.axes >> i & 1 ? p.frames : 0;
            }
        }
        CHECK_EQ(frame, m.frames);
        CHECK_EQ(m.bytes, page * JOB_PAGE_BYTES);
        CHECK(!memcmp(position, m.header.end, sizeof position));
    }
    printf("differences up to 20: %.2f bytes an axis and frame\n", (double)bytes / (double)numbers);
}

/* Each bit of each byte of a header and a page. */
static void damaged_bits(void)
{
    uint64_t random = 3;
    make_job(&m, &random, 100, 20);
    struct job_header h;
    struct job_page p;
    for (int bit = 0; bit < 8 * JOB_PAGE_BYTES; bit++) {
        m.file[bit / 8] ^= (uint8_t)(1 << bit % 8);
        CHECK(job_header_read(&h, m.file) == (bit < 32 ? JOB_MAGIC : JOB_CRC));
        CHECK_EQ(h.pages + h.axes + h.period_ns, 0);
        m.file[bit / 8] ^= (uint8_t)(1 << bit % 8);
        uint8_t *at = m.file + JOB_PAGE_BYTES;
        at[bit / 8] ^= (uint8_t)(1 << bit % 8);
        CHECK_EQ(job_page_read(&p, &m.header, at), JOB_CRC);
        CHECK_EQ(p.frames, 0);
        at[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
}

/* Pages with a good CRC and anything in them: refused, or written they are the same bytes. */
static void any_content(void)
{
    uint64_t random = 11;
    int good = 0, seen[JOB_FAULTS] = { 0 };
    for (int k = 0; k < 60000; k += CHECK_EACH) {
        if (k % 600 == 0)
            make_job(&m, &random, (int32_t)check_random(&random, 2, 200), 300);
        uint8_t page[JOB_PAGE_BYTES];
        memcpy(page, m.file + JOB_PAGE_BYTES, sizeof page);
        for (int64_t j = check_random(&random, 1, 3); j > 0; j--) {
            const int64_t at = check_random(&random, 0, check_random(&random, 0, 3) ? 60 : 251);
            page[at] = (uint8_t)check_random(&random, 0, 255);
        }
        job_page_seal(page);
        struct job_page p;
        const enum job_fault fault = job_page_read(&p, &m.header, page);
        seen[fault]++;
        CHECK_EQ(p.frames > 0, fault == JOB_GOOD);
        if (fault)
            continue;
        good++;
        uint8_t again[JOB_PAGE_BYTES + JOB_FRAME_BYTES];
        int32_t bytes = 0;
        for (int32_t j = 0; j < p.frames; j++) {
            for (int i = 0; i < JOB_AXES; i++)
                CHECK(p.frame[j].command[i] >= -25000 && p.frame[j].command[i] <= 25000);
            bytes += job_frame_pack(again + bytes, &p.frame[j], j ? &p.frame[j - 1] : NULL,
                                    m.header.axes);
        }
        CHECK_EQ(bytes, page[22] + 256 * page[23]);
        CHECK(!memcmp(again, page + JOB_PAYLOAD_AT, (size_t)bytes));
    }
    for (int k = 0; k < JOB_FAULTS; k++)
        if (seen[k])
            printf("%6d pages: %s\n", seen[k], job_fault_text((enum job_fault)k));
    CHECK(good > 100 && seen[JOB_VARINT] && seen[JOB_COMMAND] && seen[JOB_FILL]);
    CHECK(seen[JOB_FRAMES] && seen[JOB_POSITION]);
}

int main(void)
{
    literal();
    there_and_back();
    damaged_bits();
    any_content();
    return check_result();
}
