/* el_lanes - sine and cosine of several angles at once, by AVX2 where the processor has it, with
 * the same bits as one by one. Plants use it. */
#ifndef EL_LANES_H
#define EL_LANES_H

/* EL_WIDE: functions for processors with AVX2 are compiled. Define EL_PLAIN to leave them out. Not
 * on Windows, where gcc does not align vectors on the stack.
 * EL_AVX2_TWO: of these instructions those for two numbers at a time, as a load of four waits for
 * two stores of two. */
#if defined(__GNUC__) && defined(__x86_64__) && !defined(_WIN32) && !defined(EL_PLAIN)
#define EL_WIDE
#define EL_AVX2 __attribute__((target("avx2")))
#if defined(__clang__)
#define EL_AVX2_TWO EL_AVX2
#else
#define EL_AVX2_TWO __attribute__((target("avx2,prefer-vector-width=128")))
#endif
#else
#define EL_AVX2
#define EL_AVX2_TWO
#endif

/* Sine and cosine of n angles [rad]. */
typedef void el_turns(int n, const double *angle, double *sine, double *cosine);
/* One by one. */
el_turns el_turns_each;
/* The same, four at once in 40 % of the time, and a rest of two at once. Call it only if the
 * processor has AVX2; without EL_WIDE it is el_turns_each. */
el_turns el_turns_avx2;

#endif
