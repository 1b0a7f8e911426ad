/* The recorder of a system (fmu_recorder.h), and which functions are compiled quickly. A program
 * that is made for a run or two shall not wait for the optimization of what runs once a call: that
 * takes longer than the rest. Then only the loop, with the recorder's row, is optimized. */
#ifndef SYSTEM_RECORDER_H
#define SYSTEM_RECORDER_H

#if defined(SYSTEM_QUICKLY) && defined(__clang__)
#define SYSTEM_COLD_BEGIN _Pragma("clang optimize off")
#define SYSTEM_COLD_END   _Pragma("clang optimize on")
#define SYSTEM_HOT
#elif defined(SYSTEM_QUICKLY) && defined(__GNUC__)
#define SYSTEM_COLD_BEGIN _Pragma("GCC push_options") _Pragma("GCC optimize(\"O0\")")
#define SYSTEM_COLD_END   _Pragma("GCC pop_options")
#define SYSTEM_HOT        __attribute__((optimize("O2")))
#else
#define SYSTEM_COLD_BEGIN
#define SYSTEM_COLD_END
#define SYSTEM_HOT
#endif

struct recorder;
SYSTEM_HOT static inline int recorder_row(struct recorder *r);

SYSTEM_COLD_BEGIN
#include "fmu_recorder.h"
SYSTEM_COLD_END

#endif
