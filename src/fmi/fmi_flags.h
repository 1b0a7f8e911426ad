/* What the generated state_flags.h is made of: does a byte that was a Boolean still hold one? */
#ifndef FMI_FLAGS_H
#define FMI_FLAGS_H

#include <stdbool.h>
#include <stddef.h>

_Static_assert(sizeof(bool) == sizeof(unsigned char), "a Boolean is a byte");

/* Look at a member, which may be an array of any dimensions. */
#define FMI_ALL_GOOD(type, member, good)                                                          \
    for (size_t i = 0; i < sizeof(member) / sizeof(type); i++) {                                  \
        if (!good((const type *)&(member) + i)) {                                                 \
            return false;                                                                         \
        }                                                                                         \
    }

#define FMI_ALL_WITHIN(member, first, last)                                                       \
    for (size_t i = 0; i < sizeof(member) / sizeof(int); i++) {                                   \
        const int x = ((const int *)&(member))[i];                                                \
        if (x < (int)(first) || x > (int)(last)) {                                                \
            return false;                                                                         \
        }                                                                                         \
    }

static inline bool fmi_good_bool(const unsigned char *p)
{
    return *p <= 1;
}

#endif
