/* fence - memory of an FMU under a sanitizer: the FMU's own unit is compiled with it before all
 * else. Of a large block ASan marks every eighth byte when it comes and goes, which takes most of
 * an input's time where states have megabytes. Here such a block is pages of its own, the same
 * ones again, cleared by the system where they must be, also by a memset of much of it: whoever
 * writes behind it or uses it when it is gone is stopped by the processor. Small blocks are
 * malloc's. */
#ifndef FENCE_H
#define FENCE_H

/* A function of its arguments alone that takes long, from what it gave before if that is known.
 * Numbers of elements stand behind the arrays. */
double fence_known(double (*f)(const double *, const double *, const double *), const double *x,
                   int nx, const double *u, int nu, const double *p, int np);

/* No header is included here, for those of the unit have macros before them. */
#define malloc  fence_malloc
#define calloc  fence_calloc
#define realloc fence_realloc
#define free    fence_free

/* The hash of a state takes each of its words in one loop, which tells a fuzzer nothing of the way
 * an input went; telling it took half of the time of states of megabytes. */
struct fmi_snapshot;
#ifdef __clang__
__attribute__((no_sanitize("coverage")))
#else
__attribute__((no_sanitize_coverage))
#endif
static __UINT64_TYPE__
fmi_hash(const struct fmi_snapshot *p);

#define PLANT_STIFFNESS(x, u, p) \
    fence_known(plant_stiffness, x, PLANT_STATES, u, PLANT_INPUTS, p, PLANT_PARAMETERS)

#endif
