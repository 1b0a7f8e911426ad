#include "link.h"

int32_t link_wrap(int64_t count)
{
    return (int32_t)(uint32_t)(uint64_t)count;
}

bool link_new(int32_t *taken, int32_t number)
{
    const bool new = number != *taken;

    *taken = number;
    return new;
}
