#include "shape.h"

int32_t shape_count(const struct shape *s)
{
    const int64_t stretch = s->corner ? s->corner_stretch : s->stretch;
    const int64_t end = s->corner ? s->corner_made : s->made;
    const int64_t held = end - SHAPE_HELD > stretch ? end - SHAPE_HELD : stretch;

    return (int32_t)((held < s->made ? held : s->made) - s->gone);
}

const struct piece *shape_piece(const struct shape *s, int32_t i)
{
    return &s->piece[(s->gone + i) % SHAPE_PIECES];
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
