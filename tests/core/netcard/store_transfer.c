/* A transfer: what is refused with what word, pages in any order, what is known already, times. */
#include "store_rig.h"

static struct made file, other;
static struct rig r;
static enum net_code result;

static const uint8_t *page_of(const struct made *m, uint32_t page)
{
    return m->file + FLASH_PAGE * page;
}

static void steps(void)
{
    CHECK(rig_settle(&r));
}

static void refused(void)
{
    const struct sent a = sent_of(&file);
    const uint32_t bytes = (uint32_t)file.bytes, pages = bytes / FLASH_PAGE;
    uint8_t page[FLASH_PAGE];
    rig_start(&r, 2);
    CHECK_EQ(job_store_missing(&r.store), -1);
    CHECK_EQ(job_store_credit(&r.store), 0);
    CHECK_EQ(job_store_page(&r.store, 0, page_of(&file, 0)), NET_STATE);
    CHECK_EQ(job_store_end(&r.store, a.crc), NET_STATE);
    CHECK_EQ(job_store_begin(&r.store, 0, a.hash, a.crc), NET_RANGE);
    CHECK_EQ(job_store_begin(&r.store, 256, a.hash, a.crc), NET_RANGE);
    CHECK_EQ(job_store_begin(&r.store, bytes + 1, a.hash, a.crc), NET_RANGE);
    CHECK_EQ(job_store_begin(&r.store, 254 * 4096 + 256, a.hash, a.crc), NET_TOO_LONG);
    CHECK_EQ(r.store.phase, STORE_REST);
    CHECK_EQ(job_store_begin(&r.store, 254 * 4096, a.hash, a.crc), NET_DONE);
    CHECK_EQ(job_store_begin(&r.store, bytes, a.hash, a.crc), NET_DONE);
    CHECK(!job_store_known(&r.store));
    CHECK_EQ(job_store_end(&r.store, a.crc), NET_PAGE);
    steps();
    CHECK(job_store_known(&r.store));
    CHECK_EQ(job_store_missing(&r.store), 0);
    CHECK_EQ(job_store_page(&r.store, pages, page_of(&file, 0)), NET_PAGE);
    CHECK_EQ(job_store_page(&r.store, 0xffffffff, page_of(&file, 0)), NET_PAGE);
    for (int k = 0; k < FLASH_PAGE; k += 5) {
        memcpy(page, page_of(&file, 1), sizeof page);
        page[k] ^= 8;
        CHECK_EQ(job_store_page(&r.store, 1, page), NET_BAD_JOB);
    }
    CHECK_EQ(job_store_credit(&r.store), STORE_BUFFER);
    for (uint32_t k = 0; k < STORE_BUFFER; k++) {
        CHECK_EQ(job_store_page(&r.store, k, page_of(&file, k)), NET_DONE);
        CHECK_EQ(job_store_page(&r.store, 0, page_of(&file, 0)), NET_DONE); /* once more */
        CHECK_EQ(job_store_credit(&r.store), STORE_BUFFER - 1 - k);
        CHECK_EQ(job_store_missing(&r.store), k + 1);
    }
    CHECK_EQ(job_store_page(&r.store, STORE_BUFFER, page_of(&file, STORE_BUFFER)), NET_PAGE);
    CHECK_EQ(job_store_end(&r.store, a.crc), NET_PAGE);
    CHECK_EQ(job_store_end(&r.store, a.crc + 1), NET_BAD_JOB);
    const uint32_t programs = r.chip.programs;
    steps();
    CHECK_EQ(r.chip.programs, programs + STORE_BUFFER);
    CHECK_EQ(job_store_page(&r.store, 3, page_of(&file, 4)), NET_DONE); /* it is there already */
    steps();
    CHECK_EQ(r.chip.programs, programs + STORE_BUFFER);
    CHECK(rig_send(&r, &a, &result) && result == NET_DONE && rig_holds(&r, &a));
    CHECK_EQ(r.pages_sent, pages - STORE_BUFFER);
    CHECK_EQ(r.chip.refused, 0);
}

/* Pages in a random order, some twice, steps between them, and a second JOB_BEGIN in the midst. */
static void any_order(void)
{
    const struct sent a = sent_of(&file);
    uint64_t random = 9;
    for (int k = 0; k < 20; k++) {
        int64_t took;
        rig_start(&r, 2);
        job_store_begin(&r.store, (uint32_t)file.bytes, a.hash, a.crc);
        for (int n = 0; job_store_missing(&r.store) >= 0 || !job_store_known(&r.store); n++) {
            const uint32_t page = (uint32_t)check_random(&random, 0, file.header.pages);
            const enum net_code code = job_store_page(&r.store, page, page_of(&file, page));
            CHECK(code == NET_DONE || (code == NET_PAGE && job_store_credit(&r.store) == 0));
            if (check_random(&random, 0, 2))
                rig_step(&r, &took);
            if (n % 100 == 99)
                CHECK_EQ(job_store_begin(&r.store, (uint32_t)file.bytes, a.hash, a.crc), NET_DONE);
        }
        CHECK_EQ(job_store_end(&r.store, a.crc), NET_DONE);
        CHECK_EQ(job_store_end(&r.store, a.crc), NET_DONE);
        CHECK_EQ(job_store_begin(&r.store, (uint32_t)file.bytes, a.hash, a.crc), NET_DONE);
        CHECK_EQ(job_store_missing(&r.store), -1);
        CHECK(!job_store_ended(&r.store, &result));
        steps();
        CHECK(job_store_ended(&r.store, &result) && result == NET_DONE && rig_holds(&r, &a));
        CHECK(!job_store_ended(&r.store, &result));
        CHECK_EQ(r.chip.programs, file.bytes / FLASH_PAGE + 2); /* a mark, a record */
    }
}

/* Pages that come before it is known that they are there. */
static void early(void)
{
    const struct sent a = sent_of(&file);
    rig_start(&r, 2);
    job_store_begin(&r.store, (uint32_t)file.bytes, a.hash, a.crc);
    for (uint32_t k = 0; k < 10; k++)
        CHECK_EQ(job_store_page(&r.store, k, page_of(&file, k)), NET_DONE);
    steps();
    rig_power(&r);
    const uint32_t programs = r.chip.programs;
    job_store_begin(&r.store, (uint32_t)file.bytes, a.hash, a.crc);
    for (uint32_t k = 5; k < 15; k++)
        CHECK_EQ(job_store_page(&r.store, k, page_of(&file, k)), NET_DONE);
    CHECK(!job_store_known(&r.store));
    steps();
    CHECK_EQ(job_store_missing(&r.store), 15);
    CHECK_EQ(r.chip.programs, programs + 5);
}

/* What the flash knows already is not sent again: the job in force, the one before it. */
static void known(void)
{
    const struct sent a = sent_of(&file), b = sent_of(&other);
    rig_start(&r, 2);
    CHECK(rig_send(&r, &a, &result) && rig_send(&r, &b, &result) && rig_holds(&r, &b));
    CHECK_EQ(r.store.job.sequence, 2);
    const uint32_t programs = r.chip.programs, sent = r.pages_sent;
    CHECK(rig_send(&r, &b, &result) && result == NET_DONE && rig_holds(&r, &b));
    CHECK_EQ(r.chip.programs, programs);
    CHECK(rig_send(&r, &a, &result) && result == NET_DONE && rig_holds(&r, &a));
    CHECK_EQ(r.chip.programs, programs + 1); /* its record */
    CHECK_EQ(r.store.job.sequence, 3);
    CHECK_EQ(r.pages_sent, sent);
    rig_power(&r);
    CHECK(rig_holds(&r, &a));

    /* given up for another in its midst */
    job_store_begin(&r.store, (uint32_t)other.bytes - 256, b.hash, b.crc);
    steps();
    CHECK_EQ(job_store_page(&r.store, 1, page_of(&other, 1)), NET_DONE);
    CHECK(rig_send(&r, &b, &result) && result == NET_DONE && rig_holds(&r, &b));
}

/* With one slot the job in force goes as soon as another is begun, for its sectors are erased next;
 * its own, told again or refused, leaves it. With two it stays until the other is whole. */
static void one_slot(void)
{
    const struct sent a = sent_of(&file), b = sent_of(&other);
    uint8_t page[FLASH_PAGE];
    for (int32_t slots = 1; slots <= 2; slots++) {
        rig_start(&r, slots);
        CHECK(rig_send(&r, &a, &result) && result == NET_DONE && rig_holds(&r, &a));
        CHECK_EQ(job_store_begin(&r.store, 256, b.hash, b.crc), NET_RANGE);
        CHECK_EQ(job_store_begin(&r.store, (uint32_t)file.bytes, a.hash, a.crc), NET_DONE);
        CHECK(rig_holds(&r, &a));
        CHECK_EQ(job_store_begin(&r.store, (uint32_t)other.bytes, b.hash, b.crc), NET_DONE);
        CHECK_EQ(r.store.job.slot, slots == 1 ? -1 : 0);
        CHECK_EQ(job_store_read(&r.store.job, &r.chip, 0, page, r.now) > 0, slots == 2);
        steps();
        CHECK_EQ(r.store.job.slot, slots == 1 ? -1 : 0);
        CHECK(rig_send(&r, &b, &result) && result == NET_DONE && rig_holds(&r, &b));
    }
}

/* A file that is no job, or not that of its hash: the job in force stays, and nothing of the file
 * counts. */
static void no_job(void)
{
    const struct sent a = sent_of(&file);
    static struct made bad;
    rig_start(&r, 2);
    CHECK(rig_send(&r, &a, &result) && result == NET_DONE);
    bad = other;
    uint8_t *page = bad.file + 3 * FLASH_PAGE;
    job_put(page + 4, 1234567, 4); /* a position */
    job_page_seal(page);
    const struct sent b = sent_of(&bad);
    CHECK(rig_send(&r, &b, &result));
    CHECK_EQ(result, NET_BAD_JOB);
    CHECK_EQ(r.store.fault, JOB_POSITION);
    CHECK(rig_holds(&r, &a));
    struct sent c = sent_of(&other);
    c.hash[31] ^= 1;
    uint32_t sent = r.pages_sent;
    CHECK(rig_send(&r, &c, &result) && result == NET_BAD_JOB && rig_holds(&r, &a));
    CHECK_EQ(r.store.fault, JOB_GOOD);
    CHECK(rig_send(&r, &c, &result) && result == NET_BAD_JOB && rig_holds(&r, &a));
    CHECK_EQ(r.pages_sent, sent + 2 * (other.bytes / FLASH_PAGE));
    c = sent_of(&other);
    c.crc ^= 1;
    sent = r.pages_sent;
    CHECK(rig_send(&r, &c, &result) && result == NET_BAD_JOB && rig_holds(&r, &a));
    CHECK_EQ(r.pages_sent, sent + other.bytes / FLASH_PAGE);
    rig_power(&r);
    CHECK(rig_holds(&r, &a));
}

/* A record or a file that has been damaged at rest: the job before it is in force. */
static void fallen_back(void)
{
    const struct sent a = sent_of(&file), b = sent_of(&other);
    static struct rig both;
    rig_start(&both, 2);
    CHECK(rig_send(&both, &a, &result) && rig_send(&both, &b, &result));
    static const int32_t at[] = { 510 * FLASH_SECTOR, 510 * FLASH_SECTOR + 31, 256 * FLASH_SECTOR,
                                  256 * FLASH_SECTOR + 5000 };
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        r = both;
        r.chip.array[at[k]] ^= 1;
        rig_power(&r);
        CHECK(rig_holds(&r, &a));
        CHECK_EQ(r.store.job.slot, 0);
        CHECK(rig_send(&r, &b, &result) && result == NET_DONE && rig_holds(&r, &b));
        rig_power(&r);
        CHECK(rig_holds(&r, &b));
    }
    r = both;
    r.chip.array[511 * FLASH_SECTOR + 20] ^= 1; /* without its mark it has no hash */
    rig_power(&r);
    CHECK_EQ(r.store.job.slot, 1);
    CHECK(!memcmp(r.store.job.hash, (uint8_t[NET_SHA_BYTES]){ 0 }, NET_SHA_BYTES));
}

static void from_workshop(void)
{
    const struct sent a = sent_of(&file), b = sent_of(&other);
    for (int32_t slots = 1; slots <= 2; slots++) {
        rig_start(&r, slots);
        CHECK_EQ(job_store_load(&r.store, &r.chip, file.file, (uint32_t)file.bytes - 256),
                 NET_BAD_JOB);
        CHECK_EQ(r.store.fault, JOB_SIZE);
        CHECK_EQ(r.store.job.slot, -1);
        CHECK_EQ(job_store_load(&r.store, &r.chip, file.file, (uint32_t)file.bytes), NET_DONE);
        CHECK(rig_holds(&r, &a));
        rig_power(&r);
        CHECK(rig_holds(&r, &a));
        CHECK(rig_send(&r, &b, &result) && result == NET_DONE && rig_holds(&r, &b));
        CHECK_EQ(r.store.job.slot, slots - 1);
        CHECK_EQ(flash_wear(&r.chip), 1);
    }
}

/* The largest job of a slot, in typical and in longest times of the chip. */
static void times(void)
{
    static struct made unit;
    uint64_t random = 5;
    make_job(&unit, &random, 40, 5000);
    for (int32_t longest = 0; longest < 2; longest++) {
        rig_start(&r, 2);
        struct flash_config *c = &r.chip.config;
        c->program.typical = longest ? c->program.longest : 700000;
        c->sector.typical = longest ? c->sector.longest : 45000000;
        c->block.typical = longest ? c->block.longest : 150000000;
        const uint32_t pages = 254 * 16;
        struct sent a = sent_of(&unit);
        const int64_t begin = r.now;
        CHECK_EQ(job_store_begin(&r.store, pages * FLASH_PAGE, a.hash, a.crc), NET_DONE);
        for (uint32_t k = 0; k < pages; k++) {
            CHECK_EQ(job_store_page(&r.store, k, page_of(&unit, k ? 1 : 0)), NET_DONE);
            steps();
        }
        CHECK_EQ(job_store_missing(&r.store), -1);
        CHECK_EQ(r.chip.block_erases, 15);
        CHECK_EQ(r.chip.sector_erases, 14 + 2);
        const double seconds = (double)(r.now - begin) * 1e-9;
        printf("%u pages: %.2f s\n", pages, seconds);
        const double want =
            longest ? 15 * 2.0 + 16 * 0.4 + 4065 * 3e-3 : 15 * 0.15 + 16 * 0.045 + 4065 * 0.7e-3;
        CHECK_NEAR(seconds, want, 1e-3);
    }
}

int main(void)
{
    uint64_t random = 6;
    do
        make_job(&file, &random, 800, 300);
    while (file.header.pages < 20);
    make_job(&other, &random, 1300, 300);
    refused();
    any_order();
    early();
    known();
    one_slot();
    no_job();
    fallen_back();
    from_workshop();
    times();
    return check_result();
}
