/* flash_chip - the network card's serial NOR flash of 2 MB, as a W25Q16: 8192 pages, 512 sectors,
 * 32 blocks, with the times of its operations and what a loss of power leaves of them.
 *
 * Erased bits are 1; programming only makes bits 0: the old content and the new one are ANDed. The
 * chip does one operation at a time and refuses everything else meanwhile, reads too. If the power
 * goes during programming, each bit has become 0 with a probability equal to the share of the time
 * that has passed. If it goes during an erase, each bit is as before, erased, or anything: nearly
 * all are as before at its begin, nearly all erased at its end.
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
    FLASH_COMMAND_BYTES = 5, /* of a fast read: code, 3 of the address, a dummy */
};

/* Time of an operation: typical + r (longest - typical), with r uniformly random from 0 to
 * `spread`. */
struct flash_time {
    int64_t typical, longest;
};

struct flash_config {
    struct flash_time program, sector, block; /* [ns] */
    int32_t spread;                           /* [1/1000], 0 .. 1000 */
    int32_t read_hz;                          /* [Hz] clock of the bus: bits per second */
    uint64_t seed;
};

enum flash_work { FLASH_IDLE, FLASH_PROGRAM, FLASH_ERASE };

struct flash_chip {
    struct flash_config config;
    uint64_t random;
    enum flash_work work;         /* operation under way until `end` */
    int32_t at, bytes;            /* first byte that it changes, and how many */
    int64_t begin, end;           /* [ns] of the operation */
    uint8_t page[FLASH_PAGE];     /* content to be programmed */
    uint32_t wear[FLASH_SECTORS]; /* erases begun of each sector */
    uint32_t most_wear;           /* erases begun of the sector with the most */
    uint32_t programs, sector_erases, block_erases, refused;
    bool written[FLASH_SECTORS]; /* the sector has been programmed since its latest erase */
    uint8_t array[FLASH_BYTES];  /* content of such sectors; the others are 0xff, unread here */
};

/* Times of the data sheet, typical / longest: 0.7 / 3 ms a page, 45 / 400 ms a sector, 150 / 2000
 * ms a block; no spread, 42 MHz, seed 1. */
struct flash_config flash_config_usual(void);

/* A new chip, erased. */
void flash_start(struct flash_chip *f, const struct flash_config *config);

/* From outside the model, without taking time: set the bytes of some pages; get those of a page. */
void flash_put(struct flash_chip *f, int32_t page, const uint8_t *bytes, int32_t pages);
void flash_look(const struct flash_chip *f, int32_t page, uint8_t bytes[FLASH_PAGE]);

/* True while an operation is under way. */
bool flash_busy(const struct flash_chip *f, int64_t now);

/* Begin to program a page, erase a sector or erase a block. Returns the time that it takes [ns]; 0:
 * refused, as the chip is busy or there is no such place. */
int64_t flash_program(struct flash_chip *f, int32_t page, const uint8_t bytes[FLASH_PAGE],
                      int64_t now);
int64_t flash_erase_sector(struct flash_chip *f, int32_t sector, int64_t now);
int64_t flash_erase_block(struct flash_chip *f, int32_t block, int64_t now);

/* Read a page. Returns the time that it takes on the bus [ns]; 0: refused, as above. */
int64_t flash_read(struct flash_chip *f, int32_t page, uint8_t bytes[FLASH_PAGE], int64_t now);

/* The power goes. The chip is idle when it comes back. */
void flash_cut(struct flash_chip *f, int64_t now);

/* Number of erases of the sector with the most. */
uint32_t flash_wear(const struct flash_chip *f);

#endif
