/* driver - runs a harness without libFuzzer: first its corpus as it is, then seeded mutations of
 * it. It knows nothing of coverage; the same arguments give the same inputs on every machine.
 *
 *     fuzz_program short corpus/...           as many mutations as the harness's fuzz_count
 *     fuzz_program 20000 corpus/...           20,000 mutations
 *     fuzz_program 600s corpus/...            mutations for 600 s
 *     fuzz_program @1234 corpus/...           mutation 1234 alone, which is also written to stdout
 */
#include <signal.h>
#include <time.h>

#include "holds.h"

enum { FILES = 256, BYTES_MAX = 4096, CHANGES_MAX = 8 };

/* ASan calls this before it ends the program; absent without it. */
__attribute__((weak)) void __sanitizer_set_death_callback(void (*call)(void));

static struct { uint8_t *data; size_t size; } corpus[FILES];
static int files;
static long long current = -1;  /* mutation under way; -1: the corpus itself */

static void tell(void)
{
    fprintf(stderr, "fuzz: mutation %lld; run it alone with @%lld\n", current, current);
}

static void on_abort(int number)
{
    tell();
    signal(number, SIG_DFL);
}

static void load(const char *name)
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
    corpus[files].data = malloc(size ? size : 1);
    memcpy(corpus[files].data, buffer, size);
    corpus[files++].size = size;
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
static uint8_t *mutation(long long i, size_t *size)
{
    static uint8_t work[BYTES_MAX];
    uint64_t state = (uint64_t)i * 0x632be59bd9b4e019u;
    const int base = (int)pick(&state, (size_t)files);
    size_t n = corpus[base].size < BYTES_MAX ? corpus[base].size : BYTES_MAX;
    memcpy(work, corpus[base].data, n);
    for (size_t k = 1 + pick(&state, CHANGES_MAX); k > 0; k--) {
        n = change(work, n, &state);
    }
    uint8_t *data = malloc(n ? n : 1);
    memcpy(data, work, n);
    *size = n;
    return data;
}

static void run(long long i, int show)
{
    size_t size;
    uint8_t *data = mutation(i, &size);
    current = i;
    if (show) {
        fwrite(data, 1, size, stdout);
        fflush(stdout);
    }
    LLVMFuzzerTestOneInput(data, size);
    free(data);
}

int main(int argc, char **argv)
{
    const char *much = argc > 1 ? argv[1] : "short";
    const int alone = much[0] == '@', brief = strcmp(much, "short") == 0;
    const int timed = !brief && strchr(much, 's') != NULL;
    const long long n = brief ? fuzz_count : strtoll(much + alone, NULL, 10);
    const time_t start = time(NULL);
    long long i = 0;

    for (int k = 2; k < argc; k++) {
        load(argv[k]);
    }
    if (files == 0) {
        fprintf(stderr, "fuzz: no corpus\n");
        return 2;
    }
    signal(SIGABRT, on_abort);
    if (__sanitizer_set_death_callback) {
        __sanitizer_set_death_callback(tell);
    }
    if (alone) {
        run(n, 1);
        return 0;
    }
    for (int k = 0; k < files; k++) {
        LLVMFuzzerTestOneInput(corpus[k].data, corpus[k].size);
    }
    while (timed ? time(NULL) - start < n : i < n) {
        run(i++, 0);
    }
    printf("%d inputs of the corpus and %lld mutations of them hold\n", files, i);
    return 0;
}
