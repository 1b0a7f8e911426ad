#define _GNU_SOURCE /* MAP_ANONYMOUS, malloc_usable_size */
#include "fence.h"
#undef malloc
#undef calloc
#undef realloc
#undef free

#include <malloc.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <sys/mman.h>

#include "holds.h"

void *fence_malloc(size_t size);
void *fence_calloc(size_t n, size_t size);
void *fence_realloc(void *old, size_t size);
void fence_free(void *block);

enum { LARGE = 1 << 18, FEW = 1 << 15 /* [byte] */, PAGE = 4096, BLOCKS = 64, KNOWN = 64 };
enum { ALIGN = 16 };

/* Pages with one behind them that nobody may touch; a block ends where that begins. */
static struct block {
    char *pages, *start;
    size_t size;
    bool used, written;
} blocks[BLOCKS];

/* A leak checker looks for addresses in them, too. */
__attribute__((weak)) void __lsan_register_root_region(const void *begin, size_t size);
__attribute__((weak)) void __lsan_unregister_root_region(const void *begin, size_t size);

static size_t room(size_t size)
{
    return (size + PAGE - 1) / PAGE * PAGE;
}

/* A block of that size, which nobody has; NULL if it is a small one or there are too many. */
static struct block *find(size_t size)
{
    const size_t all = (size + ALIGN - 1) / ALIGN * ALIGN;
    for (struct block *b = blocks; size >= LARGE && b < blocks + BLOCKS; b++) {
        if (!b->pages) {
            b->pages = mmap(NULL, room(all) + PAGE, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
            HOLDS(b->pages != MAP_FAILED);
            b->size = all;
            b->start = b->pages + room(all) - all;
        }
        if (!b->used && b->size == all) {
            return b;
        }
    }
    return NULL;
}

static void *take(struct block *b)
{
    HOLDS(mprotect(b->pages, room(b->size), PROT_READ | PROT_WRITE) == 0);
    if (__lsan_register_root_region) {
        __lsan_register_root_region(b->pages, room(b->size));
    }
    b->used = b->written = true;
    return b->start;
}

void *fence_malloc(size_t size)
{
    struct block *b = find(size);
    return b ? take(b) : malloc(size);
}

void *fence_calloc(size_t n, size_t size)
{
    struct block *b = find(n * size);
    if (b && b->written) {
        HOLDS(madvise(b->pages, room(b->size), MADV_DONTNEED) == 0);
    }
    return b ? take(b) : calloc(n, size);
}

/* Let the system clear the whole pages from `to` to `to` + n, each when it is used: the first one
 * and, in *end, what is behind the last. NULL: they are few, or not all in one block. */
static char *clear_pages(char *to, size_t n, char **end)
{
    for (struct block *b = blocks; n >= FEW && b < blocks + BLOCKS && b->pages; b++) {
        if (b->used && to >= b->start && to <= b->start + b->size
            && n <= (size_t)(b->start + b->size - to)) {
            char *first = b->pages + room((size_t)(to - b->pages));
            *end = first + (size_t)(to + n - first) / PAGE * PAGE;
            HOLDS(madvise(first, (size_t)(*end - first), MADV_DONTNEED) == 0);
            return first;
        }
    }
    return NULL;
}

/* What gcc and clang call for memset is wrapped by the linker (--wrap): a model that clears all of
 * its memory uses little of it. */
#define WRAP(name) \
    void *__real_##name(void *to, int byte, size_t n); \
    void *__wrap_##name(void *to, int byte, size_t n); \
    void *__wrap_##name(void *to, int byte, size_t n) \
    { \
        char *end, *first = byte == 0 ? clear_pages(to, n, &end) : NULL; \
        if (!first) { \
            return __real_##name(to, byte, n); \
        } \
        __real_##name(to, 0, (size_t)(first - (char *)to)); \
        __real_##name(end, 0, (size_t)((char *)to + n - end)); \
        return to; \
    }
WRAP(memset)
WRAP(__asan_memset)

static struct block *block_of(const void *start)
{
    for (struct block *b = blocks; b < blocks + BLOCKS && b->pages; b++) {
        if (start == b->start) {
            HOLDS(b->used); /* else it is gone already */
            return b;
        }
    }
    return NULL;
}

void fence_free(void *start)
{
    struct block *b = block_of(start);
    if (!b) {
        free(start);
        return;
    }
    b->used = false;
    if (__lsan_unregister_root_region) {
        __lsan_unregister_root_region(b->pages, room(b->size));
    }
    HOLDS(mprotect(b->pages, room(b->size), PROT_NONE) == 0);
}

void *fence_realloc(void *old, size_t size)
{
    const struct block *b = block_of(old);
    if (!b && size < LARGE) {
        return realloc(old, size);
    }
    const size_t before = b ? b->size : old ? malloc_usable_size(old) : 0;
    void *block = fence_malloc(size);
    if (block) {
        memcpy(block, old ? old : "", before < size ? before : size);
        fence_free(old);
    }
    return block;
}

double fence_known(double (*f)(const double *, const double *, const double *), const double *x,
                   int nx, const double *u, int nu, const double *p, int np)
{
    static struct {
        double *argument, value;
    } known[KNOWN];
    static unsigned latest;
    const size_t n = (size_t)(nx + nu + np);
    double *argument = malloc(n * sizeof *argument);
    HOLDS(argument);
    memcpy(argument, x, (size_t)nx * sizeof *x);
    memcpy(argument + nx, u, (size_t)nu * sizeof *u);
    memcpy(argument + nx + nu, p, (size_t)np * sizeof *p);
    for (int i = 0; i < KNOWN; i++) {
        if (known[i].argument && memcmp(known[i].argument, argument, n * sizeof *argument) == 0) {
            free(argument);
            return known[i].value;
        }
    }
    const unsigned i = latest++ % KNOWN;
    free(known[i].argument);
    known[i].argument = argument;
    return known[i].value = f(x, u, p);
}
