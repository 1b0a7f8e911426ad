/* What of a process valgrind counts: from count_begin to count_end. Without it they do nothing. */
#include <valgrind/callgrind.h>

#define SHOWN __attribute__((visibility("default")))

SHOWN void count_begin(void);
SHOWN void count_end(void);

void count_begin(void)
{
    CALLGRIND_START_INSTRUMENTATION;
}

void count_end(void)
{
    CALLGRIND_STOP_INSTRUMENTATION;
}
