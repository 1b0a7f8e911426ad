/* Bytes as calls of the store, power cuts among them: the job in force is one of those that were
 * sent, whole, and once one has been stored there is always one. */
#include "holds.h"
#include "job_store.h"
#include "job_writer.h"
#include "net_crc.h"

const int fuzz_count = 2000;

enum { FILES = 3, PAGES = 20, CALLS = 400 };

static const uint32_t SPEED[JOB_AXES] = { 1000, 1000, 1000, 1000 };
static struct {
    uint32_t bytes, crc;
    uint8_t hash[NET_SHA_BYTES], page[PAGES][FLASH_PAGE];
} file[FILES];
static struct flash_chip chip;
static struct job_store store;
static int64_t now;

/* A job of so many frames that do not compress. */
static void make(int k, int32_t frames)
{
    struct job_header h = { .period_ns = 1000000, .axes = 3, .origin = { (uint8_t)k } };
    struct job_writer w;
    uint32_t n = 1;
    job_writer_start(&w, &h);
    for (int32_t i = 0; i < frames; i++) {
        const int32_t c = i == 0 || i == frames - 1 ? 0 : i % 2 ? 9000 : -9000;
        n += job_writer_add(&w, &(struct job_frame){ { c, -c }, 0 }, file[k].page[n]);
    }
    HOLDS(job_writer_end(&w, file[k].page[n], file[k].page[0]) == JOB_GOOD);
    file[k].bytes = (n + 1) * FLASH_PAGE;
    HOLDS(n < PAGES);
    file[k].crc = net_crc(0, file[k].page[0], file[k].bytes);
    net_sha(file[k].page[0], file[k].bytes, file[k].hash);
}

/* Which file is in force, byte by byte; -1 none. */
static int held(void)
{
    const struct job_place *p = &store.job;
    if (p->slot < 0)
        return -1;
    for (int k = 0; k < FILES; k++)
        if (p->crc == file[k].crc && p->bytes == file[k].bytes
            && !memcmp(chip.array + p->slot * (FLASH_BYTES / 2), file[k].page[0], p->bytes))
            return k;
    HOLDS(!"a job that nobody sent");
    return -1;
}

static void power_cut(void)
{
    flash_cut(&chip, now);
    now += job_store_start(&store, &chip, store.slots, SPEED, now);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct flash_config usual = flash_config_usual();
    int sent = -1, told = -1;
    if (size < 2)
        return 0;
    if (file[0].bytes == 0)
        for (int k = 0; k < FILES; k++)
            make(k, 60 + 250 * k);
    flash_start(&chip, &usual);
    now = 0;
    job_store_start(&store, &chip, data[0] % 2 ? 1 : 2, SPEED, 0);
    chip.random = data[1];
    for (size_t i = 2; i < size && i < CALLS; i++) {
        const int k = data[i] / 8 % FILES;
        const uint32_t page = data[i] / 8 % PAGES;
        enum net_code code;
        switch (data[i] % 8) {
        case 0:
            if (job_store_begin(&store, file[k].bytes, file[k].hash, file[k].crc) == NET_DONE)
                sent = k;
            if (store.slots == 1 && store.job.slot < 0)
                told = -1;
            break;
        case 1:
            if (sent >= 0)
                job_store_page(&store, page, file[sent].page[page]);
            break;
        case 2: /* all that is missing, as far as it is taken */
            for (int32_t p; sent >= 0 && (p = job_store_missing(&store)) >= 0;)
                if (job_store_page(&store, (uint32_t)p, file[sent].page[p]) != NET_DONE)
                    break;
            break;
        case 3:
            if (sent >= 0)
                job_store_end(&store, file[sent].crc);
            break;
        case 4:
            power_cut();
            sent = -1;
            break;
        case 5: /* another file's page: it has its CRC, and is found out at the end */
            job_store_page(&store, page, file[k].page[page]);
            break;
        default:
            for (int n = data[i] / 8; n >= 0; n--) {
                const int64_t took = job_store_step(&store, &chip, now);
                now += n ? took : took * (int64_t)(i % 5) / 5; /* the last one is under way */
            }
        }
        HOLDS(job_store_credit(&store) >= 0 && job_store_missing(&store) < PAGES);
        if (job_store_ended(&store, &code) && code == NET_DONE)
            told = held();
        const int is = held();
        HOLDS(told < 0 || is >= 0);
    }
    return 0;
}
