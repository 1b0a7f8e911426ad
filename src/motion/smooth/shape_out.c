#include "shape.h"

int32_t shape_count(const struct shape *s)
{
    const int64_t cut_from = s->corner ? s->corner_cut_from : s->cut_from;
    const int64_t end = s->corner ? s->corner_made : s->made;
    const int64_t held = end - SHAPE_HELD > cut_from ? end - SHAPE_HELD : cut_from;

    return (int32_t)((held < s->made ? held : s->made) - s->gone);
}

const struct segment *shape_segment(const struct shape *s, int32_t i)
{
    return &s->segment[(s->gone + i) % SHAPE_SEGMENTS];
}

int32_t shape_marks(const struct shape *s)
{
    return (int32_t)(s->marks_set - s->marks_gone);
}

const struct shape_mark *shape_mark(const struct shape *s, int32_t i)
{
    return &s->mark[(s->marks_gone + i) % SHAPE_MARKS];
}

void shape_drop_marks(struct shape *s, int32_t n)
{
    s->marks_gone += n;
}
