#include "feed.h"

#include <math.h>
#include <stddef.h>

/* So that a path of any length has an end. [mm/s] */
static const double FEED_MIN = 1e-9;

enum { INVERSE_TIME = 930, PER_MINUTE = 940, PER_TURN = 950 };

static enum fault check(const struct program *p, double feed, const struct token *f,
                        const struct tokens *line, struct fault_report *r)
{
    if (!(feed >= FEED_MIN)) {
        return f ? tokens_at_word(r, FAULT_VALUE, f) : tokens_at_line(r, FAULT_NO_FEED, line);
    }
    if (feed > p->limits.feed) {
        r->value = feed * 60.0;
        r->limit = p->limits.feed * 60.0;
        return f ? tokens_at_word(r, FAULT_FEED, f) : tokens_at_line(r, FAULT_FEED, line);
    }
    return FAULT_NONE;
}

enum fault feed_set(struct interpreter *in, const struct program *p, const struct block *b,
                    struct fault_report *r)
{
    const int mode = b->g.code[GCODE_FEED_MODE];
    const struct token *f = gcode_word(&b->g, 'F');

    if (mode != GCODE_ABSENT && mode != in->words.feed_mode) {
        in->words.feed_mode = mode;     /* an F of another unit says nothing in this one */
        in->words.per_turn = in->feed = 0.0;
    }
    if (!f) {
        return FAULT_NONE;
    }
    if (!(f->value > 0.0)) {
        return tokens_at_word(r, FAULT_VALUE, f);
    }
    if (in->words.feed_mode == PER_TURN) {
        in->words.per_turn = f->value * b->scale;
    } else if (in->words.feed_mode == PER_MINUTE) {
        const double feed = f->value * b->scale / 60.0;
        const enum fault fault = check(p, feed, f, &b->tokens, r);
        in->feed = fault == FAULT_NONE ? feed : in->feed;
        return fault;
    }
    return FAULT_NONE;
}

enum fault feed_of(const struct interpreter *in, const struct program *p, const struct block *b,
                   double length, double *feed, struct fault_report *r)
{
    const struct words *w = &in->words;
    const struct token *f = gcode_word(&b->g, 'F');

    if (w->feed_mode == PER_MINUTE) {
        *feed = in->feed;
        return *feed > 0.0 ? FAULT_NONE : tokens_at_line(r, FAULT_NO_FEED, &b->tokens);
    }
    if (w->feed_mode == INVERSE_TIME ? !f : w->per_turn == 0.0) {
        return tokens_at_line(r, FAULT_NO_FEED, &b->tokens);
    }
    const double rpm = switches_spindle(&in->switches);
    if (w->feed_mode == PER_TURN && in->switches.by_radius) {
        return tokens_at_line(r, FAULT_SURFACE, &b->tokens);
    }
    if (w->feed_mode == PER_TURN && rpm == 0.0) {
        return tokens_at_line(r, FAULT_REST, &b->tokens);
    }
    *feed = (w->feed_mode == PER_TURN ? w->per_turn * fabs(rpm) : length * f->value) / 60.0;
    return check(p, *feed, f, &b->tokens, r);
}
