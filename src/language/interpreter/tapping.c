#include "tapping.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "block.h"
#include "frame.h"
#include "switching.h"

static const uint32_t FIXED = OUTPUTS_FEED_FIXED | OUTPUTS_SPEED_FIXED;

/* What is wrong with the words of the block, or with the spindle. */
static enum fault refused(const struct interpreter *in, const struct program *p,
                          const struct block *b, struct fault_report *r)
{
    const struct token *k = gcode_word(&b->g, 'K'), *i = gcode_word(&b->g, 'I');

    if (!gcode_first(&b->g, BLOCK_AXES "@^")) {
        return tokens_at_line(r, FAULT_NO_AXES, &b->tokens);
    }
    if (!k) {
        return tokens_at_line(r, FAULT_TAP_K, &b->tokens);
    }
    if (!(k->value > 0.0) || (i && !(i->value > 0.0))) {
        return tokens_at_word(r, FAULT_VALUE, k->value > 0.0 ? i : k);
    }
    if (switches_spindle(&in->switches) == 0.0 || in->switches.by_radius || p->bare) {
        return tokens_at_line(r, FAULT_CYCLE_SPINDLE, &b->tokens);
    }
    return FAULT_NONE;
}

enum fault tapping_block(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r)
{
    struct switches *s = &in->switches;
    const struct switches before = *s;
    const struct token *i = gcode_word(&b->g, 'I');
    double begin[AXES], end[AXES];
    enum fault f = refused(in, p, b, r);

    f = f == FAULT_NONE ? frame_end(in, p, b, end, r) : f;
    if (f != FAULT_NONE) {
        return f;
    }
    const double faster = i && i->value > 1.0 ? i->value : 1.0;
    const double feed = gcode_word(&b->g, 'K')->value * b->scale * s->speed / 60.0;
    if (feed * faster > p->limits.feed) { /* a lower feed would leave the thread */
        r->value = feed * faster * 60.0;
        r->limit = p->limits.feed * 60.0;
        return tokens_at_line(r, FAULT_FEED, &b->tokens);
    }
    memcpy(begin, in->point, sizeof begin);
    if ((s->overrides & FIXED) != FIXED) {
        s->overrides |= FIXED;
        switching_make(in, 0, 0);
    }
    f = block_straight(in, p, end, feed, true, r);
    s->turning = -before.turning;
    s->speed = before.speed * faster;
    switching_make(in, 0, 0);
    f = f == FAULT_NONE ? block_straight(in, p, begin, feed * faster, true, r) : f;
    s->turning = before.turning;
    s->speed = before.speed;
    s->overrides = before.overrides;
    switching_make(in, 0, 0);
    return tokens_at_line(r, f, &b->tokens);
}
