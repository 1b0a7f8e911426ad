/* Groups on two cards: the pulses of each are those it has alone, whatever the others do. */
#include "group.h"
#include "mcc_card.h"

static struct groups set; /* 2 MB: not on the stack */
static struct groups before;

enum { PERIODS = 30000, GROUPS = 4 };

static const struct group_panel calm = { .override = 1.0 };

static struct group_config usual(void)
{
    return (struct group_config){ .bus = 4000,
                                  .ipo = 40000,
                                  .latency = 10000.0,
                                  .jitter = 60000.0,
                                  .seed = 3,
                                  .min_stock = 3,
                                  .batch = 4 };
}

/* Two cards of six channels, two of them finer. */
static void cards(struct machine card[GROUP_CARDS])
{
    for (int k = 0; k < GROUP_CARDS; k++) {
        card[k] = mcc_machine();
        card[k].axis[3].ppr = 20000;
        card[k].axis[4].ppr = 5000;
    }
}

static const struct machine *motion(void)
{
    static struct machine m;
    m = mcc_machine();
    m.acc_time = m.dec_time = 0.02;
    return &m;
}

static void codes(void)
{
    static const int32_t xy[AXES] = { 0, 1, -1, -1, -1, -1 }, vw[AXES] = { 5, -1, 4, -1, -1, -1 };
    static const int32_t bad[][AXES] = { { -1, -1, -1, -1, -1, -1 },
                                         { 6, -1, -1, -1, -1, -1 },
                                         { 2, 2, -1, -1, -1, -1 },
                                         { 2, 1, -1, -1, -1, -1 },
                                         { -2, -1, -1, -1, -1, -1 } };
    struct machine card[GROUP_CARDS], none = mcc_machine();
    const struct group_config config = usual();
    cards(card);
    groups_init(&set, &config, card);
    CHECK_EQ(groups_start(&set), MCC_GROUP_PARAMETER);
    CHECK_EQ(group_create(&set, 0, xy, motion()), 0);
    before = set;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        CHECK_EQ(group_create(&set, 0, bad[i], motion()), MCC_GROUP_PARAMETER);
    }
    CHECK_EQ(group_create(&set, 2, vw, motion()), MCC_GROUP_PARAMETER);
    CHECK_EQ(group_create(&set, -1, vw, motion()), MCC_GROUP_PARAMETER);
    none.feed = -1.0;
    CHECK_EQ(group_create(&set, 0, vw, &none), MCC_PARAMETER);
    CHECK_EQ(group_close(&set, 1), MCC_GROUP_PARAMETER);
    CHECK_EQ(group_close(&set, GROUP_MAX), MCC_GROUP_PARAMETER);
    CHECK_EQ(group_program(&set, 1, 0), MCC_GROUP_PARAMETER);
    CHECK(!memcmp(&set, &before, sizeof set));
    CHECK_EQ(group_create(&set, 0, vw, motion()), 1);
    CHECK_EQ(group_close(&set, 0), MCC_NO_ERR);
    CHECK_EQ(group_create(&set, 0, xy, motion()), 0); /* its channels are free again */
    CHECK_EQ(group_create(&set, 1, xy, motion()), 2);
    for (int n = 3; n < GROUP_MAX; n++) {
        const int32_t one[AXES] = { n - 1, -1, -1, -1, -1, -1 };
        CHECK_EQ(group_create(&set, 1, one, motion()), n);
    }
    before = set;
    const int32_t last[AXES] = { -1, -1, 5, -1, -1, -1 };
    CHECK_EQ(group_create(&set, 1, last, motion()), MCC_GROUP_RAN_OUT);
    CHECK(!memcmp(&set, &before, sizeof set));
    CHECK_EQ(groups_start(&set), MCC_NO_ERR);
    before = set;
    CHECK_EQ(groups_start(&set), MCC_COMMAND_NOTACCEPTED);
    CHECK_EQ(group_create(&set, 1, last, motion()), MCC_COMMAND_NOTACCEPTED);
    CHECK_EQ(group_close(&set, 0), MCC_COMMAND_NOTACCEPTED);
    CHECK_EQ(group_program(&set, 0, 0), MCC_COMMAND_NOTACCEPTED);
    CHECK(!memcmp(&set, &before, sizeof set));
}

/* --- Random groups with random programs and operators. ---------------------------------------- */
struct job {
    int card;
    int32_t channel[AXES];
    int64_t start;
    char text[2048];
    uint64_t seed; /* of what its operator does; 0: nothing */
    bool aborts;
};

/* What came out of each channel in each bus period. */
struct trace {
    int32_t sum[PERIODS][GROUP_CARDS][AXES];
};
static struct trace together, alone;
static bool done[GROUPS];
static int64_t starved;

static void operate(struct job *j, struct group_panel *p, int k)
{
    if (!j->seed) {
        return;
    }
    const int64_t die = check_random(&j->seed, 0, 100000);
    p->hold = die < 30 ? !p->hold : p->hold && die > 2000;
    p->override = die > 99900 ? (double)(die % 100 + 60) / 100.0 : p->override;
    p->abort = j->aborts && k > 3000;
}

/* Run those of the jobs that are in `mask`. */
static void play(const struct job *given, int mask, int32_t room, struct trace *trace)
{
    struct machine card[GROUP_CARDS];
    const struct group_config config = usual();
    struct group_panel panel[GROUP_MAX] = { { 0 } };
    struct source_text text[GROUP_MAX] = { { 0 } };
    struct source source[GROUP_MAX] = { { 0 } };
    struct job job[GROUPS];
    struct card c[GROUP_CARDS];
    int at[GROUPS];
    memcpy(job, given, sizeof job);
    cards(card);
    groups_init(&set, &config, card);
    for (int n = 0; n < GROUPS; n++) {
        at[n] = -1;
        if (mask >> n & 1) {
            const int g = at[n] = group_create(&set, job[n].card, job[n].channel, motion());
            CHECK(g >= 0);
            CHECK_EQ(group_program(&set, g, job[n].start), MCC_NO_ERR);
            text[g] = (struct source_text){ job[n].text, (int64_t)strlen(job[n].text) };
            source[g] = source_of(&text[g]);
            panel[g] = calm;
        }
    }
    CHECK_EQ(groups_start(&set), MCC_NO_ERR);
    for (int k = 0; k < GROUP_CARDS; k++) {
        card_begin(&c[k], &set.card[k].pcl, machine_dda_clocks(&card[k]), config.min_stock);
        c[k].room = room;
    }
    for (int i = 0; i < PERIODS; i++) {
        struct pcl_card shows[GROUP_CARDS];
        for (int k = 0; k < GROUP_CARDS; k++) {
            c[k].shows.stock = c[k].stock;
            shows[k] = c[k].shows;
            card_read(&c[k]);
        }
        for (int n = 0; n < GROUPS; n++) {
            if (at[n] >= 0) {
                operate(&job[n], &panel[at[n]], i);
            }
        }
        groups_instant(&set, i * config.bus, shows, panel, source);
        for (int k = 0; k < GROUP_CARDS; k++) {
            card_advance(&c[k], (i + 1) * config.bus);
            memcpy(trace->sum[i][k], c[k].sum, sizeof c[k].sum);
        }
    }
    starved = 0;
    for (int n = 0; n < GROUPS; n++) {
        done[n] = at[n] < 0 || group_done(&set, at[n]);
        starved += at[n] < 0 ? 0 : set.group[at[n]].starved;
    }
}

/* A program of lines on the first axes. */
static void random_program(uint64_t *seed, struct job *j, int axes)
{
    static const char NAMES[] = "XYZUVW";
    strcpy(j->text, "G91 F3000\n");
    for (int k = 0; k < 12; k++) {
        size_t n = strlen(j->text);
        n += (size_t)snprintf(j->text + n, sizeof j->text - n, "%s G1",
                              check_random(seed, 0, 1) ? "G61" : "G64");
        for (int a = 0; a < axes; a++) {
            n += (size_t)snprintf(j->text + n, sizeof j->text - n, " %c%.3f", NAMES[a],
                                  (double)check_random(seed, -3000, 3000) / 1000.0);
        }
        snprintf(j->text + n, sizeof j->text - n, k % 5 == 4 ? "\nG4 P0.03\n" : "\n");
    }
}

/* Two to four groups, each on one to three channels drawn from what its card has left. */
static int random_jobs(uint64_t *seed, struct job job[GROUPS])
{
    int left[GROUP_CARDS] = { AXES, AXES };
    int32_t order[GROUP_CARDS][AXES];
    for (int k = 0; k < GROUP_CARDS; k++) {
        for (int i = 0; i < AXES; i++) {
            const int64_t j = check_random(seed, 0, i);
            order[k][i] = order[k][j];
            order[k][j] = i;
        }
    }
    const int count = (int)check_random(seed, 2, GROUPS);
    for (int n = 0; n < count; n++) {
        struct job *j = &job[n];
        memset(j, 0, sizeof *j);
        j->card = n < 2 ? n : (int)check_random(seed, 0, 1);
        const int room = left[j->card];
        const int axes = (int)check_random(seed, 1, room > 4 ? 3 : room > 2 ? 2 : 1);
        for (int i = 0; i < AXES; i++) {
            j->channel[i] = i < axes ? order[j->card][--left[j->card]] : -1;
        }
        j->start = check_random(seed, 0, 40000000);
        j->seed = (uint64_t)check_random(seed, 1, 1000000);
        j->aborts = check_random(seed, 0, 5) == 0;
        random_program(seed, j, axes);
    }
    return count;
}

/* Does a channel belong to the job? */
static bool has(const struct job *j, int card, int channel)
{
    for (int i = 0; i < AXES; i++) {
        if (j->card == card && j->channel[i] == channel) {
            return true;
        }
    }
    return false;
}

/* Together and alone: the same pulses in every bus period; other channels stand still. */
static void undisturbed(void)
{
    uint64_t seed = 21;
    long long pulses = 0;
    for (int round = 0; round < 20 && !check_failures; round++) {
        struct job job[GROUPS] = { { 0 } };
        const int count = random_jobs(&seed, job);
        play(job, (1 << count) - 1, PCL_FIFO, &together);
        for (int n = 0; n < count; n++) {
            CHECK(done[n]);
        }
        CHECK_EQ(starved, 0);
        for (int n = 0; n < count; n++) {
            play(job, 1 << n, PCL_FIFO, &alone);
            for (int i = 0; i < PERIODS; i++) {
                for (int a = 0; a < AXES * GROUP_CARDS; a++) {
                    const int k = a / AXES, channel = a % AXES;
                    const int32_t sum = alone.sum[i][k][channel];
                    CHECK_EQ(sum, has(&job[n], k, channel) ? together.sum[i][k][channel] : 0);
                    pulses += i == PERIODS - 1 && sum != 0;
                }
            }
        }
    }
    CHECK(pulses > 80);
}

/* One group alone is the library of pc, pulse for pulse. */
static void as_the_single_library(int64_t start)
{
    static struct trace one;
    const struct machine m = *motion();
    struct job job[GROUPS] = { { .channel = { 0, 1, 2, -1, -1, -1 }, .start = start } };
    const struct group_config g = usual();
    const struct pc_config config = { .bus = g.bus,
                                      .ipo = g.ipo,
                                      .latency = g.latency,
                                      .jitter = g.jitter,
                                      .seed = g.seed,
                                      .min_stock = g.min_stock,
                                      .batch = g.batch,
                                      .start = start };
    const struct pc_panel panel = { .override = 1.0, .rapid = 1.0 };
    struct card c;
    uint64_t seed = 22;
    random_program(&seed, &job[0], 3);
    card_start(&c, &m, &config, true);
    for (int i = 0; i < PERIODS; i++) {
        card_period(&c, i * config.bus, &panel, job[0].text);
        memcpy(one.sum[i][0], c.sum, sizeof c.sum);
    }
    play(job, 1, PCL_FIFO, &alone);
    CHECK(pc_done(&pc) && done[0]);
    CHECK(!memcmp(&one, &alone, sizeof one));
}

/* A FIFO too small for n + N: refused frames come again; every group ends where it should. */
static void refused(void)
{
    uint64_t seed = 23;
    for (int round = 0; round < 5; round++) {
        struct job job[GROUPS] = { { 0 } };
        const int count = random_jobs(&seed, job);
        for (int n = 0; n < count; n++) {
            job[n].aborts = false;
        }
        play(job, (1 << count) - 1, PCL_FIFO, &alone);
        play(job, (1 << count) - 1, 5, &together);
        for (int k = 0; k < GROUP_CARDS; k++) {
            CHECK(set.card[k].pcl.refused > 100);
        }
        for (int n = 0; n < count; n++) {
            CHECK(done[n]);
        }
        CHECK(!memcmp(alone.sum[PERIODS - 1], together.sum[PERIODS - 1],
                      sizeof alone.sum[PERIODS - 1]));
    }
}

/* An IPO of 20 ms that makes 16 points at a time: its own group starves by the frames that are
 * missing, a group beside it that stands does not. */
static void too_slow(void)
{
    static const int32_t channel[2][AXES] = { { 0, -1, -1, -1, -1, -1 },
                                              { 1, -1, -1, -1, -1, -1 } };
    struct machine card[GROUP_CARDS], m = mcc_machine();
    struct group_config config = usual();
    struct group_panel panel[GROUP_MAX] = { { 0 } };
    struct source_text text = { "G1 X100 F6000\nM2\n", 18 };
    struct source source[GROUP_MAX] = { { 0 } };
    struct card c;
    cards(card);
    config.ipo = 800000;
    config.jitter = 0.0;
    m.queue_depth = 16;
    groups_init(&set, &config, card);
    for (int n = 0; n < 2; n++) {
        CHECK_EQ(group_create(&set, 0, channel[n], &m), n);
        panel[n] = calm;
    }
    CHECK_EQ(group_program(&set, 0, 0), MCC_NO_ERR);
    source[0] = source_of(&text);
    CHECK_EQ(groups_start(&set), MCC_NO_ERR);
    card_begin(&c, &set.card[0].pcl, machine_dda_clocks(&card[0]), config.min_stock);
    for (int k = 0; k < 20000 && !group_done(&set, 0); k++) {
        c.shows.stock = c.stock;
        const struct pcl_card shows[GROUP_CARDS] = { c.shows };
        card_read(&c);
        groups_instant(&set, k * config.bus, shows, panel, source);
        card_advance(&c, (k + 1) * config.bus);
    }
    CHECK(group_done(&set, 0));
    /* 1.1 s are 1075 points, 16 in 20 ms of 19.53 frames */
    CHECK_NEAR(set.group[0].starved, 1075 * (20.0 / 1.024 - 16.0) / 16.0, 8.0);
    CHECK_EQ(set.group[1].starved, 0);
}

int main(void)
{
    codes();
    too_slow();
    undisturbed();
    as_the_single_library(0);
    as_the_single_library(400000);
    as_the_single_library(400001);
    refused();
    return check_result();
}
