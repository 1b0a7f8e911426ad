#include "feed.h"

#include <math.h>
#include <stddef.h>

#include "cycles.h"
#include "el_extremes.h"

/* Lowest feed, so that a path of any length comes to its end. [mm/s] */
static const double FEED_MIN = 1e-9;

enum { INVERSE_TIME = 930, PER_MINUTE = 940, PER_TURN = 950 };

/* A feed [mm/s] above the highest is a note if that may be driven instead, else a fault. */
static enum fault check(const struct program *p, double feed, bool exact, const struct token *f,
                        const struct tokens *line, struct fault_report *r)
{
    if (!(feed >= FEED_MIN)) {
        return f ? tokens_at_word(r, FAULT_VALUE, f) : tokens_at_line(r, FAULT_NO_FEED, line);
    }
    if (feed > p->limits.feed && (exact || p->strict_feed)) {
        r->value = feed * 60.0;
        r->limit = p->limits.feed * 60.0;
        return f ? tokens_at_word(r, FAULT_FEED, f) : tokens_at_line(r, FAULT_FEED, line);
    }
    if (feed > p->limits.feed) {
        fault_note_limit(r, FAULT_NOTE_FEED, f ? f->at : line->at, f ? f->length : line->length,
                         feed * 60.0, p->limits.feed * 60.0);
    }
    return FAULT_NONE;
}

enum fault feed_set(struct interpreter *in, const struct program *p, const struct block *b,
                    struct fault_report *r)
{
    const int mode = b->g.code[GCODE_FEED_MODE];
    const struct token *f = gcode_word(&b->g, 'F');

    if (mode != GCODE_ABSENT && mode != in->words.feed_mode) {
        in->words.feed_mode = mode; /* F has another unit now */
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
        const bool tap = cycles_taps(in->motion) && gcode_first(&b->g, BLOCK_AXES "@^");
        const enum fault fault = check(p, feed, tap, f, &b->tokens, r);
        in->feed = fault == FAULT_NONE ? feed : in->feed;
        return fault;
    }
    return FAULT_NONE;
}

enum fault feed_of(const struct interpreter *in, const struct program *p, const struct block *b,
                   double length, bool exact, double *feed, struct fault_report *r)
{
    const struct words *w = &in->words;
    const struct token *f = gcode_word(&b->g, 'F');

    if (w->feed_mode == PER_MINUTE) {
        *feed = el_min(in->feed, p->limits.feed);
        return *feed == 0.0 ? tokens_at_line(r, FAULT_NO_FEED, &b->tokens)
               : exact      ? check(p, in->feed, exact, f, &b->tokens, r)
                            : FAULT_NONE;
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
    const double asked =
        (w->feed_mode == PER_TURN ? w->per_turn * fabs(rpm) : length * f->value) / 60.0;
    *feed = el_min(asked, p->limits.feed);
    return check(p, asked, exact, f, &b->tokens, r);
}
