/* job_store - the job files in the flash chip: two slots, of which one holds the job in force while
 * the other is written. A loss of power at any time leaves the old job or the new one whole.
 *
 *     slot s    sectors 256 s .. 256 s + 253: the job file    254: record    255: mark
 *     one slot  sectors 0 .. 509                              510: record    511: mark
 *
 *     record    "MCR1", u32 sequence, slot, file bytes, CRC-32 of the file, job id, 0, CRC of these
 *     mark      "MCT1", u32 file bytes, CRC-32 of the file, 0, u8[32] SHA-256 of the file, 0 x 3,
 *               CRC of these
 *
 * A transfer erases the record, the mark and the sectors that it needs, programs the mark, then the
 * pages as they come, reads all back and programs the record last. So
 *  - at power-up the job in force is the one of the highest sequence whose record and file have
 *    the right CRC;
 *  - a mark says that all pages in its slot are of that file: after a loss of power a transfer goes
 *    on with the pages that are missing. A page neither erased nor whole costs its sector.
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
    STORE_BUFFER = 16, /* most pages that wait for the chip */
};

/* A job in the flash. */
struct job_place {
    int32_t slot; /* -1: there is no job */
    uint32_t sequence;
    uint32_t bytes, crc; /* of the file */
    uint32_t id;
    uint8_t hash[NET_SHA_BYTES]; /* of the file */
};

enum store_phase {
    STORE_REST,    /* no transfer */
    STORE_SCAN,    /* reads what a transfer has left that a loss of power broke off */
    STORE_ERASE,   /* erases the sectors that the file needs */
    STORE_MARK,    /* programs the mark */
    STORE_TAKE,    /* programs pages as they come */
    STORE_VERIFY,  /* reads the file back */
    STORE_RECORD,  /* erases the rest of a torn record, programs the record */
    STORE_CONFIRM, /* reads the record back */
    STORE_DISCARD, /* erases the mark of a file that is no job */
    STORE_PHASES
};

struct job_store {
    int32_t slots;                  /* number of slots, 1 or 2 */
    uint32_t start_speed[JOB_AXES]; /* [pulses/s] for job_check */
    struct job_place job;           /* the job in force */
    enum store_phase phase;
    struct job_place next; /* job of the transfer under way */
    bool hurried;          /* set by the caller: no erase may take longer than that of a sector */
    bool marked;           /* the mark of `next` is in the flash */
    bool again;            /* JOB_BEGIN named the job in force */
    bool ending;           /* JOB_END has come */
    bool ended;            /* job_store_ended has a result to tell, */
    enum net_code result;  /* which is this one */
    enum job_fault fault;  /* why a job is refused as NET_BAD_JOB */
    int32_t at;            /* page or sector that the phase has come to */
    uint32_t crc;          /* CRC of the pages verified so far */
    struct net_sha sha;
    struct job_check check;
    int32_t waiting;               /* number of pages in the buffer */
    uint16_t number[STORE_BUFFER]; /* of each of them in the file */
    uint8_t buffer[STORE_BUFFER][FLASH_PAGE];
    uint8_t have[FLASH_PAGES / 8];    /* a bit for each page that is programmed */
    uint8_t dirty[FLASH_SECTORS / 8]; /* a bit for each sector to be erased */
};

/* At power-up, with the chip idle, choose the job in force. Returns the time that its reading takes
 * [ns]. */
int64_t job_store_start(struct job_store *s, struct flash_chip *f, int32_t slots,
                        const uint32_t start_speed[JOB_AXES], int64_t now);

/* Put a job into slot 0 of an erased chip, as a workshop does. If it is not NET_DONE but
 * NET_TOO_LONG or NET_BAD_JOB (see s->fault), nothing is changed. */
enum net_code job_store_load(struct job_store *s, struct flash_chip *f, const uint8_t *file,
                             uint32_t bytes);

/* JOB_BEGIN. The transfer goes on if it is of this file, and there is none if this job is in force;
 * a transfer of another file is given up. NET_DONE, or NET_RANGE (not a whole number of pages, or
 * fewer than two), NET_TOO_LONG. */
enum net_code job_store_begin(struct job_store *s, uint32_t bytes,
                              const uint8_t hash[NET_SHA_BYTES], uint32_t crc);

/* True if it is known which pages are missing, so that JOB_BEGIN may be answered. */
bool job_store_known(const struct job_store *s);

/* First page that is neither programmed nor in the buffer; -1: there is no transfer, or no page is
 * missing. Only if job_store_known. */
int32_t job_store_missing(const struct job_store *s);

/* Number of pages that the buffer can take now. */
int32_t job_store_credit(const struct job_store *s);

/* A page of JOB_DATA; one that is there already changes nothing. NET_DONE, or NET_STATE (there is
 * no transfer), NET_PAGE (outside the file, or no credit), NET_BAD_JOB (wrong CRC of the page; the
 * transfer goes on). */
enum net_code job_store_page(struct job_store *s, uint32_t page, const uint8_t bytes[FLASH_PAGE]);

/* JOB_END, which may be repeated. NET_DONE: job_store_ended will tell the result. NET_STATE: there
 * is no transfer; NET_PAGE: pages are missing; NET_BAD_JOB: the CRC is not that of JOB_BEGIN. */
enum net_code job_store_end(struct job_store *s, uint32_t crc);

/* Begin the next operation of the chip, or the reading of a page, if the chip is idle. Returns the
 * time from now until the next call [ns]; 0: nothing to do until one of the functions above is
 * called. */
int64_t job_store_step(struct job_store *s, struct flash_chip *f, int64_t now);

/* Give the result of a JOB_END, once: NET_DONE (s->job is the new job), NET_BAD_JOB (see s->fault)
 * or NET_FLASH (the record does not read back). False: there is none. */
bool job_store_ended(struct job_store *s, enum net_code *result);

/* Read a page of a job, of which page 0 is the header. Returns the time that it takes [ns]; 0:
 * refused, as the chip is busy or there is no such page. */
int64_t job_store_read(const struct job_place *job, struct flash_chip *f, uint32_t page,
                       uint8_t bytes[FLASH_PAGE], int64_t now);

#endif
