#include "flash_chip.h"

#include <stddef.h>
#include <string.h>

/* The next random number, by splitmix64. */
static uint64_t draw(uint64_t *random)
{
    uint64_t x = *random += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

struct flash_config flash_config_usual(void)
{
    return (struct flash_config){
        .program = { 700000, 3000000 },
        .sector = { 45000000, 400000000 },
        .block = { 150000000, 2000000000 },
        .read_hz = 42000000,
        .seed = 1,
    };
}

void flash_start(struct flash_chip *f, const struct flash_config *config)
{
    memset(f, 0, offsetof(struct flash_chip, array));
    f->config = *config;
    f->random = config->seed;
}

/* From now on the content of the sector is in the array. */
static void open_sector(struct flash_chip *f, int32_t sector)
{
    if (!f->written[sector])
        memset(f->array + sector * FLASH_SECTOR, 0xff, FLASH_SECTOR);
    f->written[sector] = true;
}

void flash_put(struct flash_chip *f, int32_t page, const uint8_t *bytes, int32_t pages)
{
    for (int32_t k = 0; k < pages; k++) {
        open_sector(f, (page + k) / FLASH_SECTOR_PAGES);
        memcpy(f->array + (page + k) * FLASH_PAGE, bytes + k * FLASH_PAGE, FLASH_PAGE);
    }
}

void flash_look(const struct flash_chip *f, int32_t page, uint8_t bytes[FLASH_PAGE])
{
    if (f->written[page / FLASH_SECTOR_PAGES])
        memcpy(bytes, f->array + page * FLASH_PAGE, FLASH_PAGE);
    else
        memset(bytes, 0xff, FLASH_PAGE);
}

bool flash_busy(const struct flash_chip *f, int64_t now)
{
    return f->work != FLASH_IDLE && now < f->end;
}

/* If the operation is over, let it have its effect. */
static void settle(struct flash_chip *f, int64_t now)
{
    if (f->work == FLASH_IDLE || now < f->end)
        return;
    if (f->work == FLASH_ERASE) {
        memset(f->written + f->at / FLASH_SECTOR, 0, (size_t)(f->bytes / FLASH_SECTOR));
    } else {
        open_sector(f, f->at / FLASH_SECTOR);
        for (int k = 0; k < FLASH_PAGE; k++)
            f->array[f->at + k] &= f->page[k];
    }
    f->work = FLASH_IDLE;
}

static int64_t begin(struct flash_chip *f, enum flash_work work, int32_t at, int32_t bytes,
                     const struct flash_time *time, int64_t now)
{
    /* the spread as a share of 2^-20 */
    const int64_t share = (int64_t)(draw(&f->random) >> 44) * f->config.spread / 1000;
    f->work = work;
    f->at = at;
    f->bytes = bytes;
    f->begin = now;
    f->end = now + time->typical + (((time->longest - time->typical) * share) >> 20);
    return f->end - now;
}

/* True if an operation may begin at place `which` of `of` places. One that is over takes effect
 * first. */
static bool ready(struct flash_chip *f, int32_t which, int32_t of, int64_t now)
{
    settle(f, now);
    if (f->work == FLASH_IDLE && which >= 0 && which < of)
        return true;
    f->refused++;
    return false;
}

int64_t flash_program(struct flash_chip *f, int32_t page, const uint8_t bytes[FLASH_PAGE],
                      int64_t now)
{
    if (!ready(f, page, FLASH_PAGES, now))
        return 0;
    memcpy(f->page, bytes, FLASH_PAGE);
    f->programs++;
    return begin(f, FLASH_PROGRAM, page * FLASH_PAGE, FLASH_PAGE, &f->config.program, now);
}

/* An erase of a sector begins. */
static void wear(struct flash_chip *f, int32_t sector)
{
    f->wear[sector]++;
    if (f->wear[sector] > f->most_wear)
        f->most_wear = f->wear[sector];
}

int64_t flash_erase_sector(struct flash_chip *f, int32_t sector, int64_t now)
{
    if (!ready(f, sector, FLASH_SECTORS, now))
        return 0;
    wear(f, sector);
    f->sector_erases++;
    return begin(f, FLASH_ERASE, sector * FLASH_SECTOR, FLASH_SECTOR, &f->config.sector, now);
}

int64_t flash_erase_block(struct flash_chip *f, int32_t block, int64_t now)
{
    if (!ready(f, block, FLASH_BLOCKS, now))
        return 0;
    for (int k = 0; k < FLASH_BLOCK_SECTORS; k++)
        wear(f, block * FLASH_BLOCK_SECTORS + k);
    f->block_erases++;
    return begin(f, FLASH_ERASE, block * FLASH_BLOCK, FLASH_BLOCK, &f->config.block, now);
}

int64_t flash_read(struct flash_chip *f, int32_t page, uint8_t bytes[FLASH_PAGE], int64_t now)
{
    if (!ready(f, page, FLASH_PAGES, now))
        return 0;
    flash_look(f, page, bytes);
    const int64_t bits = 8 * (FLASH_PAGE + FLASH_COMMAND_BYTES);
    return (bits * 1000000000 + f->config.read_hz - 1) / f->config.read_hz;
}

/* Eight bits, each 1 with a probability of p / 2^16. */
static uint8_t bits_of(uint64_t *random, uint32_t p)
{
    const uint64_t low = draw(random), high = draw(random);
    uint8_t bits = 0;
    for (int k = 0; k < 8; k++)
        bits |= (uint8_t)((((k < 4 ? low : high) >> 16 * (k % 4) & 0xffff) < p) << k);
    return bits;
}

void flash_cut(struct flash_chip *f, int64_t now)
{
    settle(f, now);
    const uint32_t p =
        f->work == FLASH_IDLE ? 0 : (uint32_t)(((now - f->begin) << 16) / (f->end - f->begin));
    for (int32_t k = 0; f->work != FLASH_IDLE && k < f->bytes; k += FLASH_SECTOR)
        open_sector(f, (f->at + k) / FLASH_SECTOR);
    for (int32_t k = 0; f->work != FLASH_IDLE && k < f->bytes; k++) {
        uint8_t *byte = f->array + f->at + k;
        const uint8_t reached = bits_of(&f->random, p);
        if (f->work == FLASH_PROGRAM) {
            *byte &= (uint8_t)(f->page[k] | ~reached);
            continue;
        }
        /* neither of two draws holds: as before; both hold: erased; one holds: anything */
        const uint8_t again = bits_of(&f->random, p), any = (uint8_t)draw(&f->random);
        const uint8_t open = reached ^ again;
        *byte = (uint8_t)((*byte & ~open) | (reached & again) | (any & open));
    }
    f->work = FLASH_IDLE;
}

uint32_t flash_wear(const struct flash_chip *f)
{
    return f->most_wear;
}
