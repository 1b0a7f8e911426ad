#include "link.h"

extern inline int32_t link_wrap(int64_t count);
extern inline bool link_new(int32_t *taken, int32_t number);
extern inline bool link_silent(const struct link_host *host);
