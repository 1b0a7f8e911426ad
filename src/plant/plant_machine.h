/* plant_machine - asks the processor at run time whether it has AVX2, the wide vectors with which a
 * plant computes several axes at once. */
#ifndef PLANT_MACHINE_H
#define PLANT_MACHINE_H

#include <stdbool.h>

#include "el_lanes.h"

/* The condition of EL_WIDE (el_lanes.h) again, because packed sources include the system's headers
 * before any of ours. */
#if defined(__GNUC__) && defined(__x86_64__) && !defined(_WIN32) && !defined(EL_PLAIN)
#include <cpuid.h>
#include <stdatomic.h>
#endif

#ifdef EL_WIDE

/* Whether processor and operating system support AVX2 (Intel SDM 1, 14.7.1). */
static inline bool plant_ask_avx2(void)
{
    enum { OSXSAVE_AVX = 1 << 27 | 1 << 28, AVX2 = 1 << 5, XMM_YMM = 6 };
    unsigned a, b, c, d, kept, rest;
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c & OSXSAVE_AVX) != OSXSAVE_AVX) {
        return false;
    }
    __asm__("xgetbv" : "=a"(kept), "=d"(rest) : "c"(0));
    return (kept & XMM_YMM) == XMM_YMM && __get_cpuid_count(7, 0, &a, &b, &c, &d) && (b & AVX2);
}

/* The same, asked only once: in a virtual machine cpuid may take as long as a step. */
static inline bool plant_has_avx2(void)
{
    static _Atomic signed char known; /* 0: not asked yet; 1 yes, -1 no; the same in all threads */
    signed char found = atomic_load_explicit(&known, memory_order_relaxed);
    if (found == 0) {
        found = plant_ask_avx2() ? 1 : -1;
        atomic_store_explicit(&known, found, memory_order_relaxed);
    }
    return found > 0;
}
#else
static inline bool plant_has_avx2(void)
{
    return false;
}
#endif

#endif
