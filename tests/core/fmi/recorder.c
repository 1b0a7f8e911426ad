/* Recorder: rows to .npy files, whole or not at all. A folder as argument: a recording for
 * tests/fmi/test_recorder.py to read by numpy. */
#define _GNU_SOURCE /* RLIMIT_FSIZE, room ahead of a file's end */

#include <signal.h>
#include <sys/resource.h>

#include "check.h"
#include "fmu_recorder.h"

static struct {
    double six[6], one, two[2], late;
    int32_t count, counts[6];
    bool on, many[6];
} now;

static const struct recorder_column columns[] = { { "a.six", 'd', 6 },    { "a.count", 'i', 1 },
                                                  { "a.many", 'b', 6 },   { "b.one", 'd', 1 },
                                                  { "b.two", 'd', 2 },    { "b.on", 'b', 1 },
                                                  { "b.counts", 'i', 6 }, { "c.late", 'd', 1 } };
enum { COLUMNS = sizeof columns / sizeof *columns };
static const void *const values[COLUMNS] = { now.six, &now.count, now.many,   &now.one,
                                             now.two, &now.on,    now.counts, &now.late };

/* The values of row k: every element another. */
static void set(int64_t k)
{
    for (int i = 0; i < 6; i++) {
        now.six[i] = (double)k + 0.125 * i;
        now.counts[i] = (int32_t)(k * 6 + i);
        now.many[i] = (k >> i) & 1;
    }
    now.one = -0.5 * (double)k;
    now.two[0] = (double)(k * k);
    now.two[1] = 1.0 / (double)(k + 1);
    now.count = (int32_t)-k;
    now.on = k % 3 == 0;
    now.late = k >= 10000 && k < 10100; /* blocks of 0 before and behind it */
}

static int row(struct recorder *r)
{
    if (recorder_row(r) != 0) {
        return -1;
    }
    for (const struct recorder_group *g = r->groups; g < r->groups + r->group_count; g++) {
        for (int k = 0; k < g->count; k++) {
            const int column = g->streams[k].column;
            memcpy(r->block[column + 1] + recorder_place(r, g),
                   column < 0 ? &r->time : values[column], g->width);
        }
    }
    return recorder_row_end(r);
}

static int rows(struct recorder *r, int64_t from, int64_t to)
{
    for (int64_t k = from; k < to; k++) {
        set(k);
        if (row(r) != 0) {
            return -1;
        }
    }
    return 0;
}

static bool there(const char *name)
{
    file_stat s;
    return file_look_at_link(name, &s) == 0;
}

static char folder[200], inside[240], why[RECORDER_WHY];

static struct recorder *begin(void)
{
    why[0] = '\0';
    return recorder_open(folder, columns, COLUMNS, 1e-4, why, sizeof why);
}

static int64_t size_of(const char *signal)
{
    file_stat s = { 0 };
    snprintf(inside, sizeof inside, "%s/%s.npy", folder, signal);
    return file_look_at_link(inside, &s) == 0 ? (int64_t)s.st_size : -1;
}

/* A long recording takes the place of an older one, and nothing is left beside it. */
static void test_replaced(const char *part, const char *old)
{
    for (int round = 0; round < 2; round++) {
        struct recorder *r = begin();
        CHECK(r && there(part));
        CHECK_EQ(rows(r, 0, round ? 50000 : 1), 0);
        /* the older one stands to the end */
        CHECK_EQ(size_of("a.six"), round ? RECORDER_HEAD + 48 : -1);
        CHECK_EQ(recorder_end(r), 0);
        recorder_close(r);
        CHECK(!there(part) && !there(old));
    }
    CHECK_EQ(size_of("a.six"), RECORDER_HEAD + 50000 * 48);
    CHECK_EQ(size_of("b.on"), RECORDER_HEAD + 50000);
    CHECK_EQ(size_of("c.late"), RECORDER_HEAD + 50000 * 8);
    CHECK_EQ(size_of("time"), RECORDER_HEAD + 50000 * 8);
}

/* Given up: the older recording is as it was. */
static void test_given_up(const char *part)
{
    struct recorder *r = begin();
    CHECK_EQ(rows(r, 0, 60000), 0);
    recorder_close(r);
    CHECK(!there(part));
    CHECK_EQ(size_of("a.six"), RECORDER_HEAD + 50000 * 48);
}

/* Rows after a restored state: those behind it are forgotten, those jumped over are 0. */
static void test_restored(void)
{
    struct recorder *r = begin();
    CHECK_EQ(rows(r, 0, 15000), 0);
    CHECK_EQ(recorder_at(r, 9000), 0);
    CHECK_EQ(rows(r, 9000, 9003), 0);
    CHECK_EQ(recorder_at(r, 9005), 0);
    CHECK_EQ(rows(r, 9005, 9010), 0);
    CHECK_EQ(recorder_end(r), 0);
    recorder_close(r);
    CHECK_EQ(size_of("time"), RECORDER_HEAD + 9010 * 8);
    double time[9010];
    snprintf(inside, sizeof inside, "%s/time.npy", folder);
    FILE *f = fopen(inside, "rb");
    CHECK(f && fseek(f, RECORDER_HEAD, SEEK_SET) == 0 && fread(time, 8, 9010, f) == 9010);
    fclose(f);
    for (int k = 0; k < 9010; k++) {
        CHECK(time[k] == (k == 9003 || k == 9004 ? 0.0 : k * 1e-4));
    }
}

/* Rows in memory are those of the files, after a restored state, too; one more than there is room
 * for ends the recording. */
static void test_in_memory(void)
{
    enum { ROWS = 100, FIRST = 40 };
    static double time[ROWS + 1], six[ROWS + 1][6], one[ROWS + 1], two[ROWS + 1][2], late[ROWS + 1];
    static int32_t count[ROWS + 1], counts[ROWS + 1][6];
    static bool on[ROWS + 1], many[ROWS + 1][6];
    char *const place[] = { (char *)time, (char *)six, (char *)count,  (char *)many, (char *)one,
                            (char *)two,  (char *)on,  (char *)counts, (char *)late };
    struct recorder *r = recorder_in_memory(columns, COLUMNS, 1e-4, place, ROWS);
    recorder_begin(r, FIRST);
    CHECK_EQ(rows(r, FIRST, FIRST + 60), 0);
    CHECK_EQ(recorder_at(r, FIRST + 50), 0);
    CHECK_EQ(recorder_at(r, FIRST + 55), 0);
    CHECK_EQ(rows(r, FIRST + 55, FIRST + ROWS), 0);
    for (int k = 0; k < ROWS; k++) {
        const bool jumped = k >= 50 && k < 55;
        set(FIRST + k);
        if (jumped) {
            memset(&now, 0, sizeof now);
        }
        CHECK(time[k] == (jumped ? 0.0 : (FIRST + k) * 1e-4) && one[k] == now.one);
        CHECK(late[k] == now.late && count[k] == now.count && on[k] == now.on);
        CHECK(!memcmp(six[k], now.six, sizeof *six) && !memcmp(two[k], now.two, sizeof *two));
        CHECK(!memcmp(counts[k], now.counts, sizeof *counts));
        CHECK(!memcmp(many[k], now.many, sizeof *many));
    }
    CHECK_EQ(recorder_at(r, FIRST - 1), -1);
    recorder_close(r);
    for (int jump = 0; jump < 2; jump++) {
        r = recorder_in_memory(columns, COLUMNS, 1e-4, place, ROWS);
        recorder_begin(r, 0);
        CHECK_EQ(rows(r, 0, ROWS), 0);
        CHECK_EQ(jump ? recorder_at(r, ROWS + 1) : rows(r, ROWS, ROWS + 1), -1);
        CHECK(strstr(r->why, "more rows than there is memory for"));
        CHECK_EQ(row(r), -1);
        CHECK_EQ(recorder_end(r), -1);
        recorder_close(r);
    }
    r = recorder_in_memory(columns, COLUMNS, 1e-4, place, ROWS);
    recorder_begin(r, 0);
    CHECK_EQ(rows(r, 0, ROWS), 0);
    CHECK_EQ(recorder_end(r), 0);
    recorder_close(r);
}

/* No room: told with the file, nothing is left, and what comes after it is refused, too. */
static void test_full(const char *part)
{
    const struct rlimit little = { 3000000, RLIM_INFINITY };
    struct rlimit before;
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    setrlimit(RLIMIT_FSIZE, &little);
    struct recorder *r = begin();
    const int64_t most = 3000000 / 48;
    CHECK_EQ(rows(r, 0, 2 * most), -1);
    CHECK(r->row > most && r->row < most + 2000);
    CHECK(strstr(r->why, "a.six.npy: File too large"));
    CHECK_EQ(row(r), -1);
    CHECK_EQ(recorder_at(r, 5), -1);
    CHECK_EQ(recorder_end(r), -1);
    recorder_close(r);
    setrlimit(RLIMIT_FSIZE, &before);
    CHECK(!there(part));
    CHECK_EQ(size_of("time"), RECORDER_HEAD + 9010 * 8);
}

/* What is somebody's is left alone, and told before the run. */
static void test_refused(void)
{
    snprintf(inside, sizeof inside, "%s/notes.txt", folder);
    fclose(fopen(inside, "w"));
    CHECK(!begin() && strstr(why, "something else than an older recording"));
    remove(inside);
    snprintf(inside, sizeof inside, "%s/time.npy", folder);
    remove(inside);
    CHECK(!begin() && strstr(why, "something else than an older recording"));
    recorder_remove(folder);
    CHECK(!there(folder));
    fclose(fopen(folder, "w"));
    CHECK(!begin() && strstr(why, ": not a folder"));
    remove(folder);
    CHECK(!recorder_open("", columns, COLUMNS, 1e-4, why, sizeof why) && strstr(why, "a name"));
    CHECK(!recorder_open("/nowhere/at/all", columns, COLUMNS, 1e-4, why, sizeof why));
    CHECK(strstr(why, "cannot write /nowhere/at/all: No such file"));
    const struct recorder_column wrong = { "no/such", 'd', 1 };
    CHECK(!recorder_open(folder, &wrong, 1, 1e-4, why, sizeof why));
    CHECK(strstr(why, "no/such.npy: No such file"));
}

int main(int arguments, char **argument)
{
    const char *temporary = getenv("TMPDIR");
    char part[240], old[240];
    snprintf(folder, sizeof folder, "%s/recorder%d", temporary ? temporary : "/tmp", (int)getpid());
    if (arguments > 1) {
        snprintf(folder, sizeof folder, "%s", argument[1]);
    }
    snprintf(part, sizeof part, "%s.part", folder);
    snprintf(old, sizeof old, "%s.old", folder);
    test_replaced(part, old);
    if (arguments == 1) {
        test_given_up(part);
        test_restored();
        test_in_memory();
        test_full(part);
        test_refused();
        CHECK(!there(part) && !there(old) && !there(folder));
    }
    return check_result();
}
