/* The power goes in every operation of the chip, at several instants of each: the old job whole or
 * the new job whole, never a third; and the transfer goes on. */
#include "store_rig.h"

static struct made first_file, second_file, third_file, large_file;
static struct rig base, cut, again;
static const int32_t SHARE[] = { 0, 100, 500, 900, 1000 };
enum { SHARES = sizeof SHARE / sizeof *SHARE, EACH_SHARE = CHECK_EACH == 1 ? 1 : 2 };

/* At power-up: 1 the new job, 0 the old one, which is none on an empty chip and may be none with
 * one slot; -1: neither. */
static int which(struct rig *r, const struct sent *old, const struct sent *new)
{
    if (rig_holds(r, new))
        return 1;
    if (r->store.job.slot < 0)
        return !old || r->slots == 1 ? 0 : -1;
    return old && rig_holds(r, old) ? 0 : -1;
}

/* Operations of an upload over the state `base`. */
static uint32_t operations(const struct sent *new)
{
    enum net_code result;
    cut = base;
    cut.operations = cut.cut = 0;
    CHECK(rig_send(&cut, new, &result));
    CHECK_EQ(result, NET_DONE);
    CHECK(rig_holds(&cut, new));
    return cut.operations;
}

/* What is of the job in force must not be touched: its slot, and its wear. */
static bool kept(const struct rig *r, const struct rig *before)
{
    const int32_t slot = before->store.job.slot;
    const size_t half = FLASH_BYTES / 2, sectors = FLASH_SECTORS / 2;
    return slot < 0
           || (!memcmp(r->chip.array + half * (size_t)slot,
                       before->chip.array + half * (size_t)slot, half)
               && !memcmp(r->chip.written + sectors * (size_t)slot,
                          before->chip.written + sectors * (size_t)slot, sectors)
               && !memcmp(r->chip.wear + sectors * (size_t)slot,
                          before->chip.wear + sectors * (size_t)slot,
                          sectors * sizeof *r->chip.wear));
}

/* Cut an upload over `base` in every operation, or in those at its begin and end and every
 * `each`-th between, and cut the recovery in one of its operations too. */
static void everywhere(const char *what, const struct sent *old, const struct sent *new,
                       uint32_t each)
{
    const uint32_t all = operations(new), pages = (uint32_t)(new->file->bytes / FLASH_PAGE);
    uint32_t cuts = 0, news = 0, twice = 0, most = 0, blocks = 0;
    uint64_t random = 4;
    enum net_code result;
    blocks = cut.chip.block_erases - base.chip.block_erases;
    for (uint32_t k = 1; k <= all; k++) {
        if (k > 20 && k < all - 4 && k % each)
            continue;
        for (int j = 0; j < SHARES; j += EACH_SHARE) {
            cut = base;
            cut.operations = cut.pages_sent = 0;
            cut.cut = k;
            cut.share = SHARE[j];
            cut.chip.random = ++random;
            CHECK(!rig_send(&cut, new, &result));
            const int got = which(&cut, old, new);
            CHECK(got >= 0 && (got == 0 || k == all));
            CHECK(base.slots == 1 || kept(&cut, &base));
            news += got == 1;
            cuts++;
            /* the recovery is cut in its turn, then nothing stands in its way */
            again = cut;
            again.operations = 0;
            again.cut = (uint32_t)check_random(&random, 1, 8);
            again.share = (int32_t)check_random(&random, 0, 1000);
            if (!rig_send(&again, new, &result)) {
                const int then = which(&again, old, new);
                CHECK(then >= got);
                CHECK(base.slots == 1 || got == 1 || kept(&again, &base));
                twice++;
            }
            again.cut = 0;
            CHECK(rig_send(&again, new, &result) && result == NET_DONE && rig_holds(&again, new));
            cut.cut = 0;
            CHECK(rig_send(&cut, new, &result) && result == NET_DONE && rig_holds(&cut, new));
            /* pages behind the cut, those in the buffer, at most a sector anew */
            most = cut.pages_sent > most ? cut.pages_sent : most;
            if (check_failures > 20)
                return;
        }
    }
    printf("%s: %u pages, %u operations (%u blocks), %u cuts, %u with the new job, %u twice; "
           "at most %u pages sent\n",
           what, pages, all, blocks, cuts, news, twice, most);
    CHECK(news >= 1 && news < SHARES);
    CHECK(most > pages && most <= pages + STORE_BUFFER + FLASH_SECTOR_PAGES + 1);
}

/* Uploads with cuts at random, for a long time. Once new, the job is never the old one again. */
static void on_and_on(int32_t slots, int uploads)
{
    static struct made *const file[] = { &first_file, &second_file, &third_file };
    uint64_t random = 77;
    uint32_t cuts = 0;
    struct sent old = { 0 };
    rig_start(&base, slots);
    for (int k = 0; k < uploads; k++) {
        const struct sent new = sent_of(file[k % 3]);
        enum net_code result = NET_BUSY;
        int seen = 0;
        do {
            base.operations = 0;
            base.cut = (uint32_t)check_random(&random, 1, 80);
            base.share = (int32_t)check_random(&random, 0, 1000);
            if (rig_send(&base, &new, &result))
                break;
            cuts++;
            const int got = which(&base, old.file ? &old : NULL, &new);
            CHECK(got >= seen);
            seen = got;
        } while (check_failures < 20);
        CHECK_EQ(result, NET_DONE);
        CHECK(rig_holds(&base, &new));
        old = new;
    }
    printf("%d uploads, %d slot(s), %u cuts: wear %u\n", uploads, slots, cuts,
           flash_wear(&base.chip));
    CHECK(cuts > (uint32_t)uploads / 4);
    /* with two slots each is written every second time */
    CHECK(flash_wear(&base.chip) >= (uint32_t)(uploads / slots));
    CHECK(flash_wear(&base.chip) <= (uint32_t)(uploads / slots) + cuts);
}

static void make(struct made *file, int32_t frames, int32_t step, uint32_t pages)
{
    static uint64_t random = 1;
    do
        make_job(file, &random, frames, step);
    while (file->header.axes != 15);
    CHECK(file->header.pages + 1 >= pages && file->header.pages + 1 < pages + 20);
}

int main(void)
{
    make(&first_file, 1200, 300, 35);
    make(&second_file, 2000, 300, 60);
    make(&third_file, 700, 5000, 20);
    make(&large_file, 6500, 50000, 265);
    const struct sent a = sent_of(&first_file), b = sent_of(&second_file), c = sent_of(&third_file);
    const struct sent d = sent_of(&large_file);
    enum net_code result;

    rig_start(&base, 2);
    everywhere("first", NULL, &a, 1);
    CHECK(rig_send(&base, &a, &result) && rig_holds(&base, &a));
    everywhere("second", &a, &b, 1);
    CHECK(rig_send(&base, &b, &result) && rig_holds(&base, &b));
    everywhere("third", &b, &c, 1);
    everywhere("large", &b, &d, 61);
    CHECK_EQ(flash_wear(&base.chip), 1);

    /* one slot: the old job goes, so what is left is none or the new one */
    rig_start(&base, 1);
    CHECK(rig_send(&base, &a, &result) && rig_holds(&base, &a));
    everywhere("one slot", &a, &b, 1);
    on_and_on(2, 90 / CHECK_EACH);
    on_and_on(1, 30 / CHECK_EACH);
    return check_result();
}
