/* driver - runs a harness without libFuzzer: first its corpus as it is, then mutations of it, drawn
 * from a seed. The same arguments give the same inputs on every machine.
 *
 *     fuzz_program short corpus/...           as many mutations as the harness's fuzz_count
 *     fuzz_program 20000 corpus/...           20,000 mutations
 *     fuzz_program 600s corpus/...            mutations for 600 s
 *     fuzz_program 600s@7 corpus/...          the same with seed 7 (else 0)
 *     fuzz_program 600s@7 +found corpus/...   also of the inputs in the folder `found`, which grows
 *
 * Inputs grow if the code is compiled with -fsanitize-coverage=trace-pc, which gcc has: whatever
 * goes a way that none went before, or goes it many times more, is kept in the folder, and what
 * brings nothing beside smaller ones is deleted there at the next start. An input that fails is
 * written beside the folder, or else into the working folder.
 */
#define _XOPEN_SOURCE 700 /* folders, timers */
#include <dirent.h>
#include <inttypes.h>
#include <signal.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include "holds.h"

enum { FILES = 1 << 14, BYTES_MAX = 4096, CHANGES_MAX = 8, WAYS = 1 << 16 };
enum { PATIENCE = 60 /* [s] of processor time for an input */ };

/* ASan calls this before it ends the program; absent without it. */
__attribute__((weak)) void __sanitizer_set_death_callback(void (*call)(void));

struct input {
    uint8_t *data;
    size_t size;
    char *name;
}; /* a name: it is in the folder */
static struct input corpus[FILES];
static int files;
static const char *folder; /* NULL: nothing is kept */
static uint64_t seed;
static const struct input *under_way;

/* How often this input went a way, and of each way the powers of two that were seen. */
static uint8_t went[WAYS], seen[WAYS];

/* Called at each branch of the code under test. A way leads from one branch to the next. */
void __sanitizer_cov_trace_pc(void);
void __sanitizer_cov_trace_pc(void)
{
    static uintptr_t latest;
    const uintptr_t here = (uintptr_t)__builtin_return_address(0) * 0x9e3779b97f4a7c15u >> 40;
    uint8_t *way = &went[(here ^ latest) % WAYS];
    *way = (uint8_t)(*way + (*way < 255));
    latest = here >> 1;
}

/* Are there ways that no input went before, or not as often? Most were not gone at all. */
static int news(void)
{
    static const uint64_t none;
    int found = 0;
    for (size_t k = 0; k < WAYS; k += sizeof none) {
        for (size_t i = k; i < k + sizeof none && memcmp(&went[k], &none, sizeof none); i++) {
            int bits = 0;
            for (int n = went[i]; n > 0; n /= 2) {
                bits++;
            }
            const uint8_t bit = (uint8_t)(1u << bits >> 1);
            found |= bit & ~seen[i];
            seen[i] |= bit;
        }
    }
    return found;
}

/* Write an input under a name made of its bytes; returns the name. */
static char *write_input(const char *head, const struct input *in)
{
    static char name[4096];
    uint64_t hash = 0xcbf29ce484222325u; /* FNV-1a */
    for (size_t i = 0; i < in->size; i++) {
        hash = (hash ^ in->data[i]) * 0x100000001b3u;
    }
    snprintf(name, sizeof name, "%s%016" PRIx64, head, hash);
    FILE *f = fopen(name, "wb");
    if (!f || fwrite(in->data, 1, in->size, f) != in->size || fclose(f)) {
        fprintf(stderr, "fuzz: %s: cannot be written\n", name);
    }
    return name;
}

static void tell(void)
{
    char head[4096];
    if (under_way) {
        snprintf(head, sizeof head, "%s%s", folder ? folder : "fuzz", "-failed-");
        fprintf(stderr, "fuzz: seed %" PRIu64 ": the input is %s\n", seed,
                write_input(head, under_way));
        under_way = NULL;
    }
}

static void on_signal(int number)
{
    if (number == SIGPROF) {
        fprintf(stderr, "fuzz: no end within %d s\n", PATIENCE);
    }
    tell();
    signal(number, SIG_DFL);
    raise(number);
}

static void load(const char *name, int ours)
{
    FILE *f = fopen(name, "rb");
    static uint8_t buffer[1 << 16];
    if (!f || files == FILES) {
        fprintf(stderr, "fuzz: %s: cannot be read\n", name);
        exit(2);
    }
    const size_t size = fread(buffer, 1, sizeof buffer, f);
    fclose(f);
    /* just as large as it is, so that reading beyond it is seen */
    struct input *in = &corpus[files++];
    *in = (struct input){ malloc(size ? size : 1), size, ours ? strdup(name) : NULL };
    memcpy(in->data, buffer, size);
}

static void load_folder(void)
{
    char name[4096];
    DIR *d = folder ? opendir(folder) : NULL;
    for (struct dirent *e; d && (e = readdir(d)) != NULL;) {
        snprintf(name, sizeof name, "%s/%s", folder, e->d_name);
        if (e->d_name[0] != '.' && files < FILES) {
            load(name, 1);
        }
    }
    if (d) {
        closedir(d);
    }
}

/* Small ones first. */
static int before(const void *a, const void *b)
{
    const struct input *x = a, *y = b;
    const int size = (x->size > y->size) - (x->size < y->size);
    return size ? size : memcmp(x->data, y->data, x->size);
}

/* Next of a sequence, below n (SplitMix64). */
static size_t pick(uint64_t *state, size_t n)
{
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (size_t)((x ^ (x >> 31)) % (n ? n : 1));
}

/* One change: a byte, a piece taken out, a piece of the corpus put in or over. */
static size_t change(uint8_t *data, size_t size, uint64_t *state)
{
    const size_t at = pick(state, size + 1), what = pick(state, 5);
    const int from = (int)pick(state, (size_t)files);
    const size_t start = pick(state, corpus[from].size);
    size_t n = 1 + pick(state, what == 4 ? 200 : 12);

    if (what < 2) {
        if (at < size) {
            data[at] = (uint8_t)(what ? pick(state, 256) : data[at] ^ 1u << pick(state, 8));
        }
        return size;
    }
    if (what == 2) {
        n = n < size - at ? n : size - at;
        memmove(data + at, data + at + n, size - at - n);
        return size - n;
    }
    n = n < corpus[from].size - start ? n : corpus[from].size - start;
    n = n < BYTES_MAX - size ? n : BYTES_MAX - size;
    memmove(data + at + n, data + at, size - at);
    memcpy(data + at, corpus[from].data + start, n);
    return size + n;
}

/* Mutation i of the corpus, in memory of just its size. */
static struct input mutation(long long i)
{
    static uint8_t work[BYTES_MAX];
    uint64_t state = ((uint64_t)i + seed * 0x9fb21c651e98df25u) * 0x632be59bd9b4e019u;
    const int base = (int)pick(&state, (size_t)files);
    size_t n = corpus[base].size < BYTES_MAX ? corpus[base].size : BYTES_MAX;
    memcpy(work, corpus[base].data, n);
    for (size_t k = 1 + pick(&state, CHANGES_MAX); k > 0; k--) {
        n = change(work, n, &state);
    }
    struct input in = { malloc(n ? n : 1), n, NULL };
    memcpy(in.data, work, n);
    return in;
}

/* Run an input; whether it is one to be kept. */
static int run(const struct input *in)
{
    const struct itimerval patience = { { 0, 0 }, { PATIENCE, 0 } }; /* of processor time */
    setitimer(ITIMER_PROF, &patience, NULL);
    memset(went, 0, sizeof went);
    under_way = in;
    LLVMFuzzerTestOneInput(in->data, in->size);
    under_way = NULL;
    return news();
}

/* The corpus as it is; what brings nothing new is deleted, if it was once found. */
static int run_corpus(void)
{
    int kept = 0;
    for (int i = 0; i < files; i++) {
        const struct input in = corpus[i];
        if (!run(&in) && in.name) {
            remove(in.name);
            free(in.data);
            free(in.name);
            continue;
        }
        corpus[kept++] = in;
    }
    return kept;
}

static void run_mutation(long long i)
{
    struct input in = mutation(i);
    if (run(&in) && folder && files < FILES) {
        char head[4096];
        snprintf(head, sizeof head, "%s/", folder);
        write_input(head, &in);
        corpus[files++] = in;
    } else {
        free(in.data);
    }
}

int main(int argc, char **argv)
{
    const char *much = argc > 1 ? argv[1] : "short", *at = strchr(much, '@');
    const int brief = strncmp(much, "short", 5) == 0, timed = !brief && strchr(much, 's') != NULL;
    const long long n = brief ? fuzz_count : strtoll(much, NULL, 10);
    const time_t start = time(NULL);
    long long i = 0;

    seed = at ? strtoull(at + 1, NULL, 10) : 0;
    for (int k = 2; k < argc; k++) {
        if (argv[k][0] == '+') {
            folder = argv[k] + 1;
        } else {
            load(argv[k], 0);
        }
    }
    const int given = files;
    load_folder();
    qsort(corpus + given, (size_t)(files - given), sizeof *corpus, before);
    if (files == 0) {
        fprintf(stderr, "fuzz: no corpus\n");
        return 2;
    }
    signal(SIGABRT, on_signal);
    signal(SIGPROF, on_signal);
    if (__sanitizer_set_death_callback) {
        __sanitizer_set_death_callback(tell);
    }
    const int loaded = files = run_corpus();
    while (timed ? time(NULL) - start < n : i < n) {
        run_mutation(i++);
    }
    printf("%d inputs of the corpus and %lld mutations of them hold (seed %" PRIu64 "), "
           "%d more kept\n",
           loaded, i, seed, files - loaded);
    return 0;
}
