/* flash_chip - a serial NOR flash of 2 MB as a W25Q16: 8192 pages, 512 sectors, 32 blocks.
 *
 * Erased bits are 1; a program only makes bits 0: what is there and what is programmed are ANDed.
 * One operation at a time: while it is under way everything else is refused, reads too. When the
 * power goes meanwhile, a program has made some of its bits 0 (each with the share of the time that
 * has passed), and of an erase each bit is as before, erased, or anything: nearly all as before at
 * its begin, nearly all erased at its end.
 *
 * All times are ns; `now` never falls.
 */
#ifndef FLASH_CHIP_H
#define FLASH_CHIP_H

#include <stdbool.h>
#include <stdint.h>

enum {
    FLASH_PAGE = 256,
    FLASH_SECTOR = 4096,
    FLASH_BLOCK = 65536,
    FLASH_BYTES = 2097152,
    FLASH_PAGES = FLASH_BYTES / FLASH_PAGE,
    FLASH_SECTORS = FLASH_BYTES / FLASH_SECTOR,
    FLASH_BLOCKS = FLASH_BYTES / FLASH_BLOCK,
    FLASH_SECTOR_PAGES = FLASH_SECTOR / FLASH_PAGE,
    FLASH_BLOCK_SECTORS = FLASH_BLOCK / FLASH_SECTOR,
    FLASH_COMMAND_BYTES = 5, /* of a fast read: code, address, a byte of waiting */
};

/* Time of an operation: typical + a share of (longest - typical) that is drawn evenly from 0 to
 * `spread`. */
struct flash_time {
    int64_t typical, longest;
};

struct flash_config {
    struct flash_time program, sector, block; /* [ns] */
    int32_t spread;                           /* [1/1000], 0 .. 1000 */
    int32_t read_hz;                          /* [Hz] clock of the bus, a bit each */
    uint64_t seed;
};

enum flash_work { FLASH_IDLE, FLASH_PROGRAM, FLASH_ERASE };

struct flash_chip {
    struct flash_config config;
    uint64_t random;
    enum flash_work work;         /* under way until `end` */
    int32_t at, bytes;            /* what it changes */
    int64_t begin, end;           /* [ns] */
    uint8_t page[FLASH_PAGE];     /* to be programmed */
    uint32_t wear[FLASH_SECTORS]; /* erases begun */
    uint32_t programs, sector_erases, block_erases, refused;
    bool written[FLASH_SECTORS]; /* something was programmed since its latest erase */
    uint8_t array[FLASH_BYTES];  /* of the others nobody reads it: they are 0xff */
};

/* Of the data sheet: 0.7 / 3 ms a page, 45 / 400 ms a sector, 150 / 2000 ms a block, no spread,
 * 42 MHz, seed 1. */
struct flash_config flash_config_usual(void);

/* A new chip, erased. */
void flash_start(struct flash_chip *f, const struct flash_config *config);

/* From outside, without time: some pages become these bytes; the bytes of a page. */
void flash_put(struct flash_chip *f, int32_t page, const uint8_t *bytes, int32_t pages);
void flash_look(const struct flash_chip *f, int32_t page, uint8_t bytes[FLASH_PAGE]);

/* Is an operation under way? */
bool flash_busy(const struct flash_chip *f, int64_t now);

/* Begin to program a page, erase a sector, erase a block; the time it takes, 0: refused (busy, no
 * such place). */
int64_t flash_program(struct flash_chip *f, int32_t page, const uint8_t bytes[FLASH_PAGE],
                      int64_t now);
int64_t flash_erase_sector(struct flash_chip *f, int32_t sector, int64_t now);
int64_t flash_erase_block(struct flash_chip *f, int32_t block, int64_t now);

/* Read a page; the time it takes on the bus, 0: refused. */
int64_t flash_read(struct flash_chip *f, int32_t page, uint8_t bytes[FLASH_PAGE], int64_t now);

/* The power goes; the chip is idle when it comes back. */
void flash_cut(struct flash_chip *f, int64_t now);

/* Most erases of any sector. */
uint32_t flash_wear(const struct flash_chip *f);

#endif
