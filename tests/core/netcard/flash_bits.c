/* The chip: what programs, erases and cuts do to its bits, against a plain array; its times. */
#include "check.h"
#include "flash_chip.h"

#include <string.h>

static struct flash_chip f;
static uint8_t plain[FLASH_BYTES], erased[FLASH_SECTOR];

/* All that is in a chip, until the next call. */
static const uint8_t *all(const struct flash_chip *chip)
{
    static uint8_t bytes[FLASH_BYTES];
    for (int32_t k = 0; k < FLASH_PAGES; k++)
        flash_look(chip, k, bytes + k * FLASH_PAGE);
    return bytes;
}

static void start(int32_t spread)
{
    static uint64_t seed;
    struct flash_config c = flash_config_usual();
    c.spread = spread;
    c.seed = ++seed;
    flash_start(&f, &c);
    memset(f.array, 0x5a, sizeof f.array); /* what nobody wrote may hold anything */
    memset(plain, 0xff, sizeof plain);
}

/* A chip with nonsense in the sectors of which nothing is written is the same chip; erased sectors
 * are such. */
static void unwritten(const struct flash_chip *chip)
{
    static struct flash_chip again;
    again = *chip;
    for (int k = 0; k < FLASH_SECTORS; k++) {
        if (!chip->written[k])
            memset(again.array + k * FLASH_SECTOR, 0xa5, FLASH_SECTOR);
        CHECK_EQ(chip->written[k], memcmp(plain + k * FLASH_SECTOR, erased, FLASH_SECTOR) != 0);
    }
    CHECK(!memcmp(all(&again), plain, sizeof plain));
}

/* Programs and erases at random; what is under way refuses all else. */
static void bits(void)
{
    uint64_t random = 3;
    uint32_t wear[FLASH_SECTORS] = { 0 }, refused = 0;
    int64_t now = 0, programs = 0;
    start(1000);
    for (int k = 0; k < 4000; k++) {
        uint8_t page[FLASH_PAGE], read[FLASH_PAGE];
        const int32_t at = (int32_t)check_random(&random, 0, 63) * 127; /* pages all over */
        const int64_t what = check_random(&random, 0, 20);
        int64_t took, least, most;
        for (int j = 0; j < FLASH_PAGE; j++)
            page[j] = (uint8_t)(check_random(&random, 0, 255) | check_random(&random, 0, 255));
        if (what == 0) {
            took = flash_erase_block(&f, at / 256, now);
            memset(plain + at / 256 * FLASH_BLOCK, 0xff, FLASH_BLOCK);
            for (int j = 0; j < 16; j++)
                wear[at / 256 * 16 + j]++;
            least = 150000000, most = 2000000000;
        } else if (what < 4) {
            took = flash_erase_sector(&f, at / 16, now);
            memset(plain + at / 16 * FLASH_SECTOR, 0xff, FLASH_SECTOR);
            wear[at / 16]++;
            least = 45000000, most = 400000000;
        } else {
            took = flash_program(&f, at, page, now);
            for (int j = 0; j < FLASH_PAGE; j++)
                plain[at * FLASH_PAGE + j] &= page[j];
            programs++;
            least = 700000, most = 3000000;
        }
        CHECK(took >= least && took <= most);
        CHECK(flash_busy(&f, now) && flash_busy(&f, now + took - 1) && !flash_busy(&f, now + took));
        CHECK(flash_read(&f, at, read, now + took - 1) == 0);
        CHECK(flash_program(&f, at, page, now + took / 2) == 0);
        CHECK(flash_erase_sector(&f, 0, now) == 0 && flash_erase_block(&f, 0, now) == 0);
        refused += 4;
        now += took;
        CHECK_EQ(flash_read(&f, at, read, now), 49715); /* 261 bytes at 42 MHz */
        CHECK(!memcmp(read, plain + at * FLASH_PAGE, FLASH_PAGE));
        if (k % 100 == 0)
            unwritten(&f);
    }
    CHECK(!memcmp(all(&f), plain, sizeof plain));
    CHECK(!memcmp(f.wear, wear, sizeof wear));
    CHECK_EQ(f.programs, programs);
    CHECK_EQ(f.refused, refused);
    uint32_t most = 0;
    for (int k = 0; k < FLASH_SECTORS; k++)
        most = wear[k] > most ? wear[k] : most;
    CHECK_EQ(flash_wear(&f), most);
    uint8_t page[FLASH_PAGE];
    CHECK(!flash_read(&f, -1, page, now) && !flash_read(&f, FLASH_PAGES, page, now));
    CHECK(!flash_program(&f, FLASH_PAGES, page, now) && !flash_erase_sector(&f, 512, now));
    CHECK(!flash_erase_block(&f, 32, now) && !flash_erase_block(&f, -1, now));
    CHECK(!memcmp(all(&f), plain, sizeof plain));
}

/* Share of bits in n bytes that are 1. */
static double ones(const uint8_t *at, int n)
{
    int sum = 0;
    for (int k = 0; k < 8 * n; k++)
        sum += at[k / 8] >> k % 8 & 1;
    return sum / (8.0 * n);
}

/* A torn program: a subset of its 0-bits, as many as the share of the time. */
static void torn_programs(void)
{
    uint8_t page[FLASH_PAGE], before[FLASH_PAGE];
    for (int percent = 0; percent <= 100; percent += 10) {
        double made = 0;
        for (int k = 0; k < 20; k++) {
            start(0);
            memset(page, 0xa5, sizeof page);
            memset(before, 0x3c, sizeof before);
            flash_put(&f, 77, before, 1);
            flash_program(&f, 77, page, 1000);
            flash_cut(&f, 1000 + 7000 * percent - (percent == 100));
            const uint8_t *now = all(&f) + 256 * 77;
            for (int j = 0; j < FLASH_PAGE; j++)
                CHECK((now[j] & (0xa5 & 0x3c)) == (0xa5 & 0x3c) && (now[j] & ~0x3c) == 0);
            made += 4 - 8 * ones(now, FLASH_PAGE);
            CHECK(!flash_busy(&f, 1000) && now[-FLASH_PAGE] == 0xff && now[FLASH_PAGE] == 0xff);
        }
        CHECK_NEAR(made / 20 / 2, percent / 100.0, 0.02);
    }
    start(0);
    flash_program(&f, 0, page, 0);
    flash_cut(&f, 700000); /* it was over */
    CHECK_EQ(all(&f)[0], 0xa5);
}

/* A torn erase of zeros: (1 - p)^2 are left as they were, p^2 are 1, of the rest half. */
static void torn_erases(void)
{
    static uint8_t zeros[FLASH_BYTES];
    for (int percent = 0; percent <= 100; percent += 10) {
        const double p = percent / 100.0;
        start(0);
        flash_put(&f, 0, zeros, FLASH_PAGES);
        flash_erase_block(&f, 3, 0);
        flash_cut(&f, 1500000 * percent - (percent == 100));
        const uint8_t *now = all(&f);
        CHECK_NEAR(ones(now + 3 * FLASH_BLOCK, FLASH_BLOCK), p * p + p * (1 - p), 0.003);
        CHECK(!memcmp(now, zeros, FLASH_BLOCK));
        CHECK(!memcmp(now + 4 * FLASH_BLOCK, zeros, FLASH_BLOCK));
        CHECK_EQ(f.wear[47] + f.wear[48] + f.wear[63] + f.wear[64], 2);
        start(0);
        flash_erase_sector(&f, 5, 0);
        flash_cut(&f, 450000 * percent);
        CHECK_NEAR(ones(all(&f) + 5 * FLASH_SECTOR, FLASH_SECTOR), 1 - p * (1 - p), 0.02);
    }
}

/* The same seed is the same chip. */
static void seeds(void)
{
    static struct flash_chip g, h;
    static uint8_t zeros[FLASH_BLOCK];
    struct flash_config c = flash_config_usual();
    static struct flash_chip *const chip[] = { &f, &g, &h };
    for (int k = 0; k < 3; k++) {
        c.seed = k < 2 ? 4 : 5;
        flash_start(chip[k], &c);
        flash_put(chip[k], 0, zeros, FLASH_BLOCK / FLASH_PAGE);
        flash_erase_block(chip[k], 0, 0);
        flash_cut(chip[k], 70000000);
    }
    CHECK(!memcmp(f.array, g.array, FLASH_BLOCK) && memcmp(f.array, h.array, FLASH_BLOCK));
}

int main(void)
{
    memset(erased, 0xff, sizeof erased);
    bits();
    torn_programs();
    torn_erases();
    seeds();
    return check_result();
}
