/* Functions of several arguments at once, with the same bits as one by one. */
#ifndef EL_LANES_H
#define EL_LANES_H

/* EL_WIDE: functions for processors with AVX2 are compiled. EL_PLAIN: not even here. Windows: gcc
 * aligns no vectors on its stack. */
#if defined(__GNUC__) && defined(__x86_64__) && !defined(_WIN32) && !defined(EL_PLAIN)
#define EL_WIDE
#define EL_AVX2 __attribute__((target("avx2")))
#else
#define EL_AVX2
#endif

/* Sine and cosine of n angles [rad]. */
typedef void el_turns(int n, const double *angle, double *sine, double *cosine);
el_turns el_turns_each;
/* Four at once, in 40 % of the time. Only where the processor has AVX2; without EL_WIDE it is the
 * other one. */
el_turns el_turns_avx2;

#endif
