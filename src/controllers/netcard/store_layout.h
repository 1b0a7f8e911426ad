/* store_layout - where the slots of the job store, their records and marks lie in the flash, and
 * how records and marks are written and read. */
#ifndef STORE_LAYOUT_H
#define STORE_LAYOUT_H

#include <string.h>

#include "job_bytes.h"
#include "job_store.h"
#include "net_crc.h"

enum { STORE_HALF = FLASH_SECTORS / 2 }; /* sectors of one slot of two */

static inline int32_t store_first_sector(int32_t slot)
{
    return STORE_HALF * slot;
}

static inline int32_t store_first_page(int32_t slot)
{
    return store_first_sector(slot) * FLASH_SECTOR_PAGES;
}

static inline int32_t store_record_sector(int32_t slots, int32_t slot)
{
    return (slots == 1 ? FLASH_SECTORS : store_first_sector(slot) + STORE_HALF) - 2;
}

static inline int32_t store_mark_sector(int32_t slots, int32_t slot)
{
    return store_record_sector(slots, slot) + 1;
}

/* Number of pages for a job file in a slot. */
static inline uint32_t store_room(int32_t slots)
{
    return (uint32_t)(store_record_sector(slots, 0) * FLASH_SECTOR_PAGES);
}

static inline uint32_t store_pages(const struct job_place *p)
{
    return p->bytes / FLASH_PAGE;
}

static inline bool store_bit(const uint8_t *bits, uint32_t k)
{
    return bits[k / 8] >> k % 8 & 1;
}

static inline void store_set(uint8_t *bits, uint32_t k, bool to)
{
    bits[k / 8] = (uint8_t)((bits[k / 8] & ~(1 << k % 8)) | to << k % 8);
}

static inline bool store_blank(const uint8_t page[FLASH_PAGE])
{
    for (int k = 0; k < FLASH_PAGE; k++)
        if (page[k] != 0xff)
            return false;
    return true;
}

/* True if both are of the same file, by size, CRC and hash. */
static inline bool store_same(const struct job_place *a, const struct job_place *b)
{
    return a->bytes == b->bytes && a->crc == b->crc && !memcmp(a->hash, b->hash, sizeof a->hash);
}

void store_write_record(const struct job_place *p, uint8_t page[FLASH_PAGE]);
void store_write_mark(const struct job_place *p, uint8_t page[FLASH_PAGE]);

/* Read the record of a slot, which has all but the hash; or a mark, which has size, CRC and hash.
 * False: the page is no record, or no mark. */
bool store_read_record(struct job_place *p, int32_t slots, int32_t slot,
                       const uint8_t page[FLASH_PAGE]);
bool store_read_mark(struct job_place *p, const uint8_t page[FLASH_PAGE]);

#endif
