/* What job_store_step does in each phase: one operation of the chip, or one page read. */
#include "job_store.h"

#include "store_layout.h"

/* Number of sectors of the file, from the first of its slot. */
static int32_t file_sectors(const struct job_store *s)
{
    return (int32_t)(store_pages(&s->next) + FLASH_SECTOR_PAGES - 1) / FLASH_SECTOR_PAGES;
}

static int32_t record_sector(const struct job_store *s)
{
    return store_record_sector(s->slots, s->next.slot);
}

static int32_t mark_sector(const struct job_store *s)
{
    return store_mark_sector(s->slots, s->next.slot);
}

static void finish(struct job_store *s, enum net_code result)
{
    s->phase = STORE_REST;
    s->next = (struct job_place){ .slot = -1 };
    s->ended = true;
    s->result = result;
}

/* Nothing of the file is in the slot: mark all sectors that it needs to be erased. */
static void afresh(struct job_store *s)
{
    for (int32_t k = 0; k < file_sectors(s); k++)
        store_set(s->dirty, (uint32_t)(store_first_sector(s->next.slot) + k), true);
    store_set(s->dirty, (uint32_t)record_sector(s), true);
    store_set(s->dirty, (uint32_t)mark_sector(s), true);
    s->phase = STORE_ERASE;
}

/* Read the mark of a slot, which tells whether the slot holds pages of this file. Without a job in
 * force these may be in either slot. */
static int64_t scan_mark(struct job_store *s, struct flash_chip *f, int64_t now)
{
    struct job_place mark;
    uint8_t page[FLASH_PAGE];
    const int64_t took = flash_read(f, mark_sector(s) * FLASH_SECTOR_PAGES, page, now);
    s->marked = store_read_mark(&mark, page) && store_same(&mark, &s->next);
    if (s->marked) {
        s->at = 0;
    } else if (s->job.slot < 0 && s->slots == 2 && s->next.slot == 0) {
        s->next.slot = 1;
    } else {
        if (s->job.slot < 0)
            s->next.slot = 0;
        afresh(s);
    }
    return took;
}

static int64_t scan_page(struct job_store *s, struct flash_chip *f, int64_t now)
{
    uint8_t page[FLASH_PAGE];
    const uint32_t k = (uint32_t)s->at++;
    const int32_t at = store_first_page(s->next.slot) + (int32_t)k;
    const int64_t took = flash_read(f, at, page, now);
    if (job_page_whole(page))
        store_set(s->have, k, true);
    else if (!store_blank(page))
        store_set(s->dirty, (uint32_t)at / FLASH_SECTOR_PAGES, true);
    if (k + 1 < store_pages(&s->next))
        return took;
    const uint32_t first = (uint32_t)store_first_sector(s->next.slot);
    for (uint32_t j = 0; j <= k; j++)
        if (store_bit(s->dirty, first + j / FLASH_SECTOR_PAGES))
            store_set(s->have, j, false);
    s->at = 0;
    s->phase = STORE_ERASE;
    return took;
}

/* Erase a sector; or its whole block, if all of that is to be erased and there is time. */
static int64_t erase(struct job_store *s, struct flash_chip *f, int32_t sector, int64_t now)
{
    const int32_t block = sector / FLASH_BLOCK_SECTORS;
    bool all = !s->hurried;
    for (int32_t k = 0; all && k < FLASH_BLOCK_SECTORS; k++)
        all = store_bit(s->dirty, (uint32_t)(block * FLASH_BLOCK_SECTORS + k));
    if (!all) {
        store_set(s->dirty, (uint32_t)sector, false);
        return flash_erase_sector(f, sector, now);
    }
    for (int32_t k = 0; k < FLASH_BLOCK_SECTORS; k++)
        store_set(s->dirty, (uint32_t)(block * FLASH_BLOCK_SECTORS + k), false);
    return flash_erase_block(f, block, now);
}

/* The record first: without it the slot is no job. The mark second: without it nothing in the slot
 * counts. */
static int64_t erase_next(struct job_store *s, struct flash_chip *f, int64_t now)
{
    const int32_t first[] = { record_sector(s), mark_sector(s) };
    for (int k = 0; k < 2; k++)
        if (store_bit(s->dirty, (uint32_t)first[k])) {
            store_set(s->dirty, (uint32_t)first[k], false);
            return flash_erase_sector(f, first[k], now);
        }
    const int32_t begin = store_first_sector(s->next.slot);
    for (int32_t k = begin; k < begin + file_sectors(s); k++)
        if (store_bit(s->dirty, (uint32_t)k))
            return erase(s, f, k, now);
    s->phase = s->marked ? STORE_TAKE : STORE_MARK;
    return 0;
}

static int64_t program_mark(struct job_store *s, struct flash_chip *f, int64_t now)
{
    uint8_t page[FLASH_PAGE];
    store_write_mark(&s->next, page);
    s->marked = true;
    s->phase = STORE_TAKE;
    return flash_program(f, mark_sector(s) * FLASH_SECTOR_PAGES, page, now);
}

static int64_t program_page(struct job_store *s, struct flash_chip *f, int64_t now)
{
    if (s->waiting == 0) {
        if (s->ending) {
            s->phase = STORE_VERIFY;
            s->at = 0;
            s->crc = 0;
            net_sha_start(&s->sha);
        }
        return 0;
    }
    uint8_t page[FLASH_PAGE];
    const uint32_t number = s->number[0];
    memcpy(page, s->buffer[0], FLASH_PAGE);
    s->waiting--;
    memmove(s->number, s->number + 1, (size_t)s->waiting * sizeof *s->number);
    memmove(s->buffer, s->buffer + 1, (size_t)s->waiting * sizeof *s->buffer);
    if (store_bit(s->have, number))
        return 0;
    store_set(s->have, number, true);
    return flash_program(f, store_first_page(s->next.slot) + (int32_t)number, page, now);
}

static int64_t verify_page(struct job_store *s, struct flash_chip *f, int64_t now)
{
    uint8_t page[FLASH_PAGE], hash[NET_SHA_BYTES];
    const int64_t took = job_store_read(&s->next, f, (uint32_t)s->at, page, now);
    s->crc = net_crc(s->crc, page, FLASH_PAGE);
    net_sha_add(&s->sha, page, FLASH_PAGE);
    if (s->at == 0)
        job_check_start(&s->check, page, s->start_speed);
    else
        job_check_page(&s->check, page);
    if ((uint32_t)s->at + 1 < store_pages(&s->next)) {
        s->at++;
        return took;
    }
    net_sha_end(&s->sha, hash);
    s->fault = job_check_end(&s->check);
    const bool same = s->crc == s->next.crc && net_equal(hash, s->next.hash, sizeof hash);
    s->next.id = s->check.header.id;
    s->phase = same && !s->fault ? STORE_RECORD : STORE_DISCARD;
    return took;
}

static int64_t program_record(struct job_store *s, struct flash_chip *f, int64_t now)
{
    uint8_t page[FLASH_PAGE];
    const int32_t at = record_sector(s) * FLASH_SECTOR_PAGES;
    flash_read(f, at, page, now);
    if (!store_blank(page))
        return flash_erase_sector(f, record_sector(s), now);
    store_write_record(&s->next, page);
    s->phase = STORE_CONFIRM;
    return flash_program(f, at, page, now);
}

static int64_t confirm(struct job_store *s, struct flash_chip *f, int64_t now)
{
    struct job_place read;
    uint8_t page[FLASH_PAGE];
    const int64_t took = flash_read(f, record_sector(s) * FLASH_SECTOR_PAGES, page, now);
    const bool good =
        store_read_record(&read, s->slots, s->next.slot, page) && read.sequence == s->next.sequence;
    if (good)
        s->job = s->next;
    finish(s, good ? NET_DONE : NET_FLASH);
    return took;
}

static int64_t discard(struct job_store *s, struct flash_chip *f, int64_t now)
{
    const int64_t took = flash_erase_sector(f, mark_sector(s), now);
    finish(s, NET_BAD_JOB);
    return took;
}

static int64_t step(struct job_store *s, struct flash_chip *f, int64_t now)
{
    switch (s->phase) {
    case STORE_SCAN:    return s->at < 0 ? scan_mark(s, f, now) : scan_page(s, f, now);
    case STORE_ERASE:   return erase_next(s, f, now);
    case STORE_MARK:    return program_mark(s, f, now);
    case STORE_TAKE:    return program_page(s, f, now);
    case STORE_VERIFY:  return verify_page(s, f, now);
    case STORE_RECORD:  return program_record(s, f, now);
    case STORE_CONFIRM: return confirm(s, f, now);
    case STORE_DISCARD: return discard(s, f, now);
    case STORE_REST:
    case STORE_PHASES:  break;
    }
    return 0;
}

int64_t job_store_step(struct job_store *s, struct flash_chip *f, int64_t now)
{
    if (s->phase == STORE_REST)
        return 0;
    if (flash_busy(f, now))
        return f->end - now;
    int64_t took;
    enum store_phase before;
    int32_t waiting;
    do { /* what takes no time is done at once */
        before = s->phase;
        waiting = s->waiting;
        took = step(s, f, now);
    } while (took == 0 && (s->phase != before || s->waiting != waiting));
    return took;
}
