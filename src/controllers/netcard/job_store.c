#include "job_store.h"

#include "store_layout.h"

enum { RECORD_CRC_AT = 28, MARK_HASH_AT = 16, MARK_CRC_AT = 60 };

static const struct job_place NOWHERE = { .slot = -1 };

void store_write_record(const struct job_place *p, uint8_t page[FLASH_PAGE])
{
    memset(page, 0xff, FLASH_PAGE);
    memcpy(page, "MCR1", 4);
    job_put(page + 4, p->sequence, 4);
    job_put(page + 8, (uint32_t)p->slot, 4);
    job_put(page + 12, p->bytes, 4);
    job_put(page + 16, p->crc, 4);
    job_put(page + 20, p->id, 4);
    job_put(page + 24, 0, 4);
    job_put(page + RECORD_CRC_AT, net_crc(0, page, RECORD_CRC_AT), 4);
}

bool store_read_record(struct job_place *p, int32_t slots, int32_t slot,
                       const uint8_t page[FLASH_PAGE])
{
    const struct job_place read = {
        .slot = slot,
        .sequence = job_get32(page + 4),
        .bytes = job_get32(page + 12),
        .crc = job_get32(page + 16),
        .id = job_get32(page + 20),
    };
    if (memcmp(page, "MCR1", 4)
        || job_get32(page + RECORD_CRC_AT) != net_crc(0, page, RECORD_CRC_AT)
        || job_get32(page + 8) != (uint32_t)slot || read.bytes % FLASH_PAGE
        || read.bytes < 2 * FLASH_PAGE || store_pages(&read) > store_room(slots))
        return false;
    *p = read;
    return true;
}

void store_write_mark(const struct job_place *p, uint8_t page[FLASH_PAGE])
{
    memset(page, 0xff, FLASH_PAGE);
    memset(page, 0, MARK_CRC_AT);
    memcpy(page, "MCT1", 4);
    job_put(page + 4, p->bytes, 4);
    job_put(page + 8, p->crc, 4);
    memcpy(page + MARK_HASH_AT, p->hash, sizeof p->hash);
    job_put(page + MARK_CRC_AT, net_crc(0, page, MARK_CRC_AT), 4);
}

bool store_read_mark(struct job_place *p, const uint8_t page[FLASH_PAGE])
{
    if (memcmp(page, "MCT1", 4) || job_get32(page + MARK_CRC_AT) != net_crc(0, page, MARK_CRC_AT))
        return false;
    p->bytes = job_get32(page + 4);
    p->crc = job_get32(page + 8);
    memcpy(p->hash, page + MARK_HASH_AT, sizeof p->hash);
    return true;
}

/* CRC of the file of a record, by reading it; adds the time of that to *took. [ns] */
static uint32_t file_crc(const struct job_place *p, struct flash_chip *f, int64_t now,
                         int64_t *took)
{
    uint32_t crc = 0;
    for (uint32_t k = 0; k < store_pages(p); k++) {
        uint8_t page[FLASH_PAGE] = { 0 };
        *took += job_store_read(p, f, k, page, now);
        crc = net_crc(crc, page, FLASH_PAGE);
    }
    return crc;
}

int64_t job_store_start(struct job_store *s, struct flash_chip *f, int32_t slots,
                        const uint32_t start_speed[JOB_AXES], int64_t now)
{
    memset(s, 0, sizeof *s);
    s->slots = slots;
    memcpy(s->start_speed, start_speed, sizeof s->start_speed);
    s->job = s->next = NOWHERE;
    struct job_place found[2] = { NOWHERE, NOWHERE };
    uint8_t page[FLASH_PAGE] = { 0 };
    int64_t took = 0;
    for (int32_t k = 0; k < slots; k++) {
        const int32_t at = store_record_sector(slots, k) * FLASH_SECTOR_PAGES;
        took += flash_read(f, at, page, now);
        if (!store_read_record(&found[k], slots, k, page))
            found[k] = NOWHERE;
    }
    /* the newest first */
    const int newest =
        found[1].slot >= 0 && (found[0].slot < 0 || found[1].sequence > found[0].sequence);
    for (int k = 0; k < 2 && s->job.slot < 0; k++) {
        const struct job_place *p = &found[k ? 1 - newest : newest];
        if (p->slot >= 0 && file_crc(p, f, now, &took) == p->crc)
            s->job = *p;
    }
    if (s->job.slot < 0)
        return took;
    struct job_place mark = { 0 };
    took += flash_read(f, store_mark_sector(slots, s->job.slot) * FLASH_SECTOR_PAGES, page, now);
    if (store_read_mark(&mark, page) && mark.bytes == s->job.bytes && mark.crc == s->job.crc)
        memcpy(s->job.hash, mark.hash, sizeof mark.hash);
    return took;
}

enum net_code job_store_load(struct job_store *s, struct flash_chip *f, const uint8_t *file,
                             uint32_t bytes)
{
    if (bytes / FLASH_PAGE > store_room(s->slots))
        return NET_TOO_LONG;
    s->fault = job_check(&s->check, file, bytes, s->start_speed);
    if (s->fault)
        return NET_BAD_JOB;
    s->job = (struct job_place){
        .sequence = 1, .bytes = bytes, .crc = net_crc(0, file, bytes), .id = s->check.header.id
    };
    net_sha(file, bytes, s->job.hash);
    uint8_t page[FLASH_PAGE];
    flash_put(f, 0, file, (int32_t)store_pages(&s->job));
    store_write_record(&s->job, page);
    flash_put(f, store_record_sector(s->slots, 0) * FLASH_SECTOR_PAGES, page, 1);
    store_write_mark(&s->job, page);
    flash_put(f, store_mark_sector(s->slots, 0) * FLASH_SECTOR_PAGES, page, 1);
    return NET_DONE;
}

enum net_code job_store_begin(struct job_store *s, uint32_t bytes,
                              const uint8_t hash[NET_SHA_BYTES], uint32_t crc)
{
    struct job_place want = { .slot = s->job.slot == 0 && s->slots == 2,
                              .bytes = bytes,
                              .crc = crc };
    memcpy(want.hash, hash, sizeof want.hash);
    if (bytes % FLASH_PAGE || bytes < 2 * FLASH_PAGE)
        return NET_RANGE;
    if (store_pages(&want) > store_room(s->slots))
        return NET_TOO_LONG;
    if (s->phase != STORE_REST && store_same(&s->next, &want))
        return NET_DONE;
    want.sequence = s->job.slot < 0 ? 1 : s->job.sequence + 1;
    s->again = s->job.slot >= 0 && store_same(&s->job, &want);
    s->phase = s->again ? STORE_REST : STORE_SCAN;
    s->next = s->again ? NOWHERE : want;
    s->marked = s->ending = s->ended = false;
    s->fault = JOB_GOOD;
    s->waiting = 0;
    s->at = -1;
    memset(s->have, 0, sizeof s->have);
    memset(s->dirty, 0, sizeof s->dirty);
    if (s->slots == 1 && !s->again)
        s->job = NOWHERE;
    return NET_DONE;
}

bool job_store_known(const struct job_store *s)
{
    return s->phase != STORE_SCAN;
}

static bool waits(const struct job_store *s, uint32_t page)
{
    for (int32_t k = 0; k < s->waiting; k++)
        if (s->number[k] == page)
            return true;
    return false;
}

int32_t job_store_missing(const struct job_store *s)
{
    for (uint32_t k = 0; s->phase != STORE_REST && k < store_pages(&s->next); k++)
        if (!store_bit(s->have, k) && !waits(s, k))
            return (int32_t)k;
    return -1;
}

int32_t job_store_credit(const struct job_store *s)
{
    return s->phase >= STORE_SCAN && s->phase <= STORE_TAKE ? STORE_BUFFER - s->waiting : 0;
}

enum net_code job_store_page(struct job_store *s, uint32_t page, const uint8_t bytes[FLASH_PAGE])
{
    if (s->phase == STORE_REST)
        return s->again ? NET_DONE : NET_STATE;
    if (page >= store_pages(&s->next))
        return NET_PAGE;
    if (!job_page_whole(bytes))
        return NET_BAD_JOB;
    if (store_bit(s->have, page) || waits(s, page))
        return NET_DONE;
    if (job_store_credit(s) == 0)
        return NET_PAGE;
    s->number[s->waiting] = (uint16_t)page;
    memcpy(s->buffer[s->waiting++], bytes, FLASH_PAGE);
    return NET_DONE;
}

enum net_code job_store_end(struct job_store *s, uint32_t crc)
{
    if (s->phase == STORE_REST && !s->again)
        return NET_STATE;
    if (crc != (s->again ? s->job.crc : s->next.crc))
        return NET_BAD_JOB;
    if (s->again) {
        s->again = false;
        s->ended = true;
        s->result = NET_DONE;
        return NET_DONE;
    }
    if (!job_store_known(s) || job_store_missing(s) >= 0)
        return NET_PAGE;
    s->ending = true;
    return NET_DONE;
}

bool job_store_ended(struct job_store *s, enum net_code *result)
{
    const bool ended = s->ended;
    if (ended)
        *result = s->result;
    s->ended = false;
    return ended;
}

int64_t job_store_read(const struct job_place *job, struct flash_chip *f, uint32_t page,
                       uint8_t bytes[FLASH_PAGE], int64_t now)
{
    if (job->slot < 0 || page >= store_pages(job))
        return 0;
    return flash_read(f, store_first_page(job->slot) + (int32_t)page, bytes, now);
}
