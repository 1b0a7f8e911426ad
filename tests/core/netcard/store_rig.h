/* store_rig - for the tests: a flash chip with its job store, a sender of jobs, and a power cut at
 * any moment of any flash operation. */
#ifndef STORE_RIG_H
#define STORE_RIG_H

#include "job_make.h"
#include "job_store.h"
#include "net_crc.h"
#include "store_layout.h"

struct sent {
    const struct made *file;
    uint8_t hash[NET_SHA_BYTES];
    uint32_t crc;
};

struct rig {
    struct flash_chip chip;
    struct job_store store;
    int64_t now;
    int32_t slots;
    uint32_t pages_sent;
    uint32_t operations; /* number of flash operations begun so far */
    uint32_t cut;        /* number of the operation in which the power fails; 0: none */
    int32_t share;       /* [1/1000] of its duration after which it does */
};

static inline struct sent sent_of(const struct made *file)
{
    struct sent s = { .file = file, .crc = net_crc(0, file->file, file->bytes) };
    net_sha(file->file, file->bytes, s.hash);
    return s;
}

static inline void rig_power(struct rig *r)
{
    r->now += job_store_start(&r->store, &r->chip, r->slots, MAKE_START, r->now);
}

static inline void rig_start(struct rig *r, int32_t slots)
{
    const struct flash_config usual = flash_config_usual();
    memset(r, 0, sizeof *r);
    flash_start(&r->chip, &usual);
    r->slots = slots;
    rig_power(r);
}

/* Whether the job in force is this file, byte by byte, and the store knows its hash. */
static inline bool rig_holds(struct rig *r, const struct sent *s)
{
    const struct job_place *p = &r->store.job;
    if (p->slot < 0 || p->bytes != s->file->bytes || memcmp(p->hash, s->hash, sizeof s->hash)
        || p->id != s->file->header.id)
        return false;
    for (uint32_t k = 0; k < p->bytes / FLASH_PAGE; k++) {
        uint8_t page[FLASH_PAGE];
        if (job_store_read(p, &r->chip, k, page, r->chip.end) == 0
            || memcmp(page, s->file->file + FLASH_PAGE * k, FLASH_PAGE))
            return false;
    }
    return true;
}

/* One step of the store. False if the power failed in the operation that it began. */
static inline bool rig_step(struct rig *r, int64_t *took)
{
    const struct flash_chip *c = &r->chip;
    const uint32_t before = c->programs + c->sector_erases + c->block_erases;
    *took = job_store_step(&r->store, &r->chip, r->now);
    if (c->programs + c->sector_erases + c->block_erases == before) {
        r->now += *took;
        return true;
    }
    uint8_t page[FLASH_PAGE];
    flash_look(c, c->at / FLASH_PAGE, page);
    CHECK(c->work != FLASH_PROGRAM || store_blank(page)); /* only what is erased is programmed */
    if (++r->operations != r->cut) {
        r->now += *took;
        return true;
    }
    const int64_t last = *took - 1; /* 1000: the last ns before its end */
    flash_cut(&r->chip, r->now + (r->share >= 1000 ? last : last * r->share / 1000));
    r->now += 1000000000;
    rig_power(r);
    return false;
}

/* Step until the store waits for something. */
static inline bool rig_settle(struct rig *r)
{
    int64_t took = 1;
    while (took > 0)
        if (!rig_step(r, &took))
            return false;
    return true;
}

/* Send the missing pages in order. False if the power failed. */
static inline bool rig_send(struct rig *r, const struct sent *s, enum net_code *result)
{
    int64_t took;
    *result = job_store_begin(&r->store, (uint32_t)s->file->bytes, s->hash, s->crc);
    while (*result == NET_DONE && !job_store_known(&r->store))
        if (!rig_step(r, &took))
            return false;
    for (int32_t page; *result == NET_DONE && (page = job_store_missing(&r->store)) >= 0;) {
        if (job_store_credit(&r->store) > 0) {
            *result = job_store_page(&r->store, (uint32_t)page, s->file->file + FLASH_PAGE * page);
            r->pages_sent++;
        } else if (!rig_step(r, &took)) {
            return false;
        }
    }
    if (*result == NET_DONE)
        *result = job_store_end(&r->store, s->crc);
    while (*result == NET_DONE && !job_store_ended(&r->store, result))
        if (!rig_step(r, &took))
            return false;
    return rig_settle(r);
}

#endif
