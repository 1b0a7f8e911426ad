#include "spline.h"

#include <stddef.h>

#include "frame.h"

/* The words of two letters, 0 for one that is not there, as a displacement in machine axes [mm]. */
static void way_of(const struct interpreter *in, const struct block *b, const char letters[2],
                   double way[3])
{
    for (int i = 0; i < 2; i++) {
        const struct token *w = gcode_word(&b->g, letters[i]);
        way[i] = w ? w->value * b->scale : 0.0;
    }
    way[2] = 0.0;
    frame_way(in, way);
}

/* CCN 19: G5 and G5.1 share all but which words they take and where the inner points lie. */
enum fault spline_path(struct interpreter *in, const struct program *p, const struct block *b,
                       const double end[AXES], struct path *path, struct fault_report *r)
{
    struct words *w = &in->words;
    const bool i = gcode_word(&b->g, 'I'), j = gcode_word(&b->g, 'J');
    const bool ends = gcode_word(&b->g, 'P') && gcode_word(&b->g, 'Q');
    const bool cubic = in->motion == 50, on = cubic && w->spline && !i && !j;
    const struct token *other = gcode_first(&b->g, "ZUVWABC");
    double first[3], second[3], inner[2][3];

    if (other) {
        return tokens_at_word(r, FAULT_UNUSED, other);
    }
    if (p->plain || in->plane != PATH_XY) {
        return tokens_at_line(r, p->plain ? FAULT_PLAIN : FAULT_SPLINE_PLANE, &b->tokens);
    }
    if (cubic ? !ends || (i != j) || (!i && !on) : !i && !j) {
        return tokens_at_line(r, FAULT_SPLINE, &b->tokens);
    }
    way_of(in, b, "IJ", first);
    way_of(in, b, "PQ", second);
    for (int k = 0; k < 3; k++) {
        const double corner = in->point[k] + first[k];
        inner[0][k] = on ? in->point[k] + w->onward[k] : corner;
        inner[1][k] = end[k] + second[k];
        w->onward[k] = -second[k];
        if (!cubic) {
            inner[0][k] = in->point[k] + 2.0 / 3.0 * first[k];
            inner[1][k] = end[k] + 2.0 / 3.0 * (corner - end[k]);
        }
    }
    w->spline = cubic;
    const enum path_status s = path_cubic(path, in->point, end, (const double(*)[3])inner);
    return s == PATH_OK ? FAULT_NONE : tokens_at_line(r, FAULT_CUSP, &b->tokens);
}
