/* job_store - jobs in the flash chip: two slots, of which one holds the job in force while the
 * other is written.
 *
 *     slot s    sectors 256 s .. 256 s + 253: the job file    254: record    255: mark
 *     one slot  sectors 0 .. 509                              510: record    511: mark
 *
 *     record    "MCR1", u32 sequence, slot, file bytes, CRC-32 of the file, job id, 0, CRC of these
 *     mark      "MCT1", u32 file bytes, CRC-32 of the file, 0, u8[32] SHA-256 of the file, 0 x 3,
 *               CRC of these
 *
 * A transfer erases the record, the mark and the sectors it needs, programs the mark, the pages as
 * they come, reads all back and programs the record last. So
 *  - at power-up the highest sequence whose record and file have their CRC is the job: the old one
 *    or the new one whole, wherever the power went;
 *  - a mark says that all that is in its slot is of that file: after the power a transfer goes on
 *    with the pages that are missing. A page that is neither erased nor whole costs its sector.
 *
 * The store begins one operation of the chip at a time, and only in job_store_step. With one slot
 * the old job is gone when a transfer begins.
 */
#ifndef JOB_STORE_H
#define JOB_STORE_H

#include "flash_chip.h"
#include "job_check.h"
#include "net_codes.h"
#include "net_sha.h"

enum {
    STORE_BUFFER = 16, /* pages that wait for the chip */
};

/* A job in the flash. */
struct job_place {
    int32_t slot; /* -1: none */
    uint32_t sequence;
    uint32_t bytes, crc; /* of the file */
    uint32_t id;
    uint8_t hash[NET_SHA_BYTES]; /* of the file */
};

enum store_phase {
    STORE_REST, /* no transfer */
    STORE_SCAN, /* reads what a transfer before the power went has left */
    STORE_ERASE,
    STORE_MARK,
    STORE_TAKE,    /* programs pages as they come */
    STORE_VERIFY,  /* reads the file back */
    STORE_RECORD,  /* erases what a torn record has left, programs the record */
    STORE_CONFIRM, /* reads the record back */
    STORE_DISCARD, /* erases the mark of a file that is no job */
    STORE_PHASES
};

struct job_store {
    int32_t slots;                  /* 1, 2 */
    uint32_t start_speed[JOB_AXES]; /* [pulses/s], for job_check */
    struct job_place job;           /* in force */
    enum store_phase phase;
    struct job_place next; /* the transfer under way */
    bool hurried;          /* the caller's: no erase longer than that of a sector */
    bool marked;           /* its mark is in the flash */
    bool again;            /* JOB_BEGIN was that of the job in force */
    bool ending;           /* JOB_END has come */
    bool ended;            /* job_store_ended has a result to tell, */
    enum net_code result;  /* this one */
    enum job_fault fault;  /* of a job refused as NET_BAD_JOB */
    int32_t at;            /* page or sector that the phase has come to */
    uint32_t crc;          /* of the pages verified so far */
    struct net_sha sha;
    struct job_check check;
    int32_t waiting; /* pages in the buffer */
    uint16_t number[STORE_BUFFER];
    uint8_t buffer[STORE_BUFFER][FLASH_PAGE];
    uint8_t have[FLASH_PAGES / 8];    /* a bit for each page that is programmed */
    uint8_t dirty[FLASH_SECTORS / 8]; /* a bit for each sector to be erased */
};

/* Power-up, the chip idle: choose the job. Returns the time that the reading takes [ns]. */
int64_t job_store_start(struct job_store *s, struct flash_chip *f, int32_t slots,
                        const uint32_t start_speed[JOB_AXES], int64_t now);

/* Put a job into slot 0 of an erased chip, as a workshop does. Not NET_DONE: NET_TOO_LONG,
 * NET_BAD_JOB (s->fault), and nothing is changed. */
enum net_code job_store_load(struct job_store *s, struct flash_chip *f, const uint8_t *file,
                             uint32_t bytes);

/* JOB_BEGIN. The file under way, or that in force: goes on. Another: the one under way is given up.
 * Not NET_DONE: NET_RANGE (no whole number of pages, fewer than two), NET_TOO_LONG. */
enum net_code job_store_begin(struct job_store *s, uint32_t bytes,
                              const uint8_t hash[NET_SHA_BYTES], uint32_t crc);

/* May JOB_BEGIN be answered: is it known what is missing? */
bool job_store_known(const struct job_store *s);

/* First page neither programmed nor in the buffer; -1: no transfer, or all are there. Only when it
 * is known. */
int32_t job_store_missing(const struct job_store *s);

/* Pages it can take now. */
int32_t job_store_credit(const struct job_store *s);

/* JOB_DATA, a page of it. One that is there already changes nothing. Not NET_DONE: NET_STATE (no
 * transfer), NET_PAGE (outside, or no credit), NET_BAD_JOB (not its CRC; the transfer goes on). */
enum net_code job_store_page(struct job_store *s, uint32_t page, const uint8_t bytes[FLASH_PAGE]);

/* JOB_END, which may come again. NET_DONE: what comes of it is told by job_store_ended. NET_STATE:
 * no transfer; NET_PAGE: pages are missing; NET_BAD_JOB: not the CRC of JOB_BEGIN. */
enum net_code job_store_end(struct job_store *s, uint32_t crc);

/* Begin the next operation or page of reading, if the chip is idle. Returns when to call again [ns
 * from now]; 0: there is nothing to do until a call of the above. */
int64_t job_store_step(struct job_store *s, struct flash_chip *f, int64_t now);

/* The result of a JOB_END, once: NET_DONE (s->job is the new one), NET_BAD_JOB (s->fault) or
 * NET_FLASH (the record does not read back). */
bool job_store_ended(struct job_store *s, enum net_code *result);

/* Read a page of a job: 0 its header. The time it takes [ns]; 0: refused, the chip is busy, or
 * there is no such page. */
int64_t job_store_read(const struct job_place *job, struct flash_chip *f, uint32_t page,
                       uint8_t bytes[FLASH_PAGE], int64_t now);

#endif
