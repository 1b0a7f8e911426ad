#include "store_layout.h"

enum { RECORD_CRC_AT = 28, MARK_HASH_AT = 16, MARK_CRC_AT = 60 };

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
        .slot = slot, .sequence = job_get32(page + 4), .bytes = job_get32(page + 12),
        .crc = job_get32(page + 16), .id = job_get32(page + 20),
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
