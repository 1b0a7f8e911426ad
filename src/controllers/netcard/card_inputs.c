#include "card_inputs.h"

#include <string.h>

enum { LINES = (1 << CARD_INPUTS) - 1 };

static uint32_t bit(int line)
{
    return (uint32_t)1 << line;
}

int card_inputs_vector(int line)
{
    return line < 5 ? line : line < 10 ? 5 : 6;
}

uint32_t card_inputs_vectors(const struct card_inputs *c)
{
    uint32_t vectors = 0;

    for (int i = 0; c->pending >> i != 0; i++) {
        vectors |= (c->pending >> i & 1) << card_inputs_vector(i);
    }
    return vectors;
}

static bool wanted(const struct card_input *in, bool level)
{
    return in->edge == CARD_EDGE_BOTH || level == (in->edge == CARD_EDGE_RISE);
}

/* True if an action does not wait for the end of the deaf time: pause and stop, or no such time. */
static bool urgent(const struct card_input *in)
{
    return in->action == CARD_PAUSE || in->action == CARD_STOP || in->debounce == 0;
}

void card_inputs_start(struct card_inputs *c, const struct card_inputs_config *config,
                       uint32_t levels)
{
    memset(c, 0, sizeof *c);
    c->config = *config;
    c->levels = c->taken = levels & LINES;
}

/* An edge at a line that hears. A line with a deaf time hears both edges, as its level must be
 * known; one without has the hardware choose. */
static void edge(struct card_inputs *c, int line)
{
    const struct card_input *in = &c->config.line[line];

    if (in->debounce == 0 && !wanted(in, c->levels >> line & 1)) {
        return;
    }
    c->lost += c->pending >> line & 1;
    c->pending |= bit(line);
    c->ended &= ~bit(line);
}

uint32_t card_inputs_set(struct card_inputs *c, uint32_t levels, int64_t now)
{
    const uint32_t changed = (levels ^ c->levels) & LINES;

    card_inputs_advance(c, now);
    c->levels = levels & LINES;
    for (int i = 0; changed >> i != 0; i++) {
        if (changed >> i & 1) {
            c->edges++;
            if (c->deaf >> i & 1) {
                c->ignored++;
            } else {
                edge(c, i);
            }
        }
    }
    return card_inputs_vectors(c);
}

int64_t card_inputs_next(const struct card_inputs *c)
{
    int64_t next = INT64_MAX;

    for (int i = 0; c->deaf >> i != 0; i++) {
        if (c->deaf >> i & 1 && c->hears[i] < next) {
            next = c->hears[i];
        }
    }
    return next;
}

uint32_t card_inputs_advance(struct card_inputs *c, int64_t now)
{
    for (int i = 0; c->deaf >> i != 0; i++) {
        if (c->deaf >> i & 1 && c->hears[i] <= now) {
            c->deaf &= ~bit(i);
            if (((c->waiting | (c->levels ^ c->taken)) >> i & 1) != 0) {
                c->pending |= bit(i);
                c->ended |= bit(i);
            }
        }
    }
    return card_inputs_vectors(c);
}

/* The routine of a line with a deaf time, after an edge or at the end of that time, takes the level
 * that is there now. An action that waited is done if its level is still there. If the level after
 * an edge is the old one again, the edge was a spike, which has two edges. */
static enum card_action take(struct card_inputs *c, int line, int64_t now)
{
    const struct card_input *in = &c->config.line[line];
    const bool level = c->levels >> line & 1, changed = level != (c->taken >> line & 1),
               spike = !changed && !(c->ended >> line & 1), waited = c->waiting >> line & 1;

    c->waiting &= ~bit(line);
    c->ended &= ~bit(line);
    c->taken ^= changed ? bit(line) : 0;
    if (changed || spike) {
        c->deaf |= bit(line);
        c->hears[line] = now + in->debounce;
    }
    if (!changed && waited) {
        return in->action;
    }
    if (spike) {
        return urgent(in) ? in->action : CARD_NONE;
    }
    if (!changed || !wanted(in, level)) {
        return CARD_NONE;
    }
    if (urgent(in)) {
        return in->action;
    }
    c->waiting |= in->action != CARD_NONE ? bit(line) : 0;
    return CARD_NONE;
}

struct card_input_served card_inputs_serve(struct card_inputs *c, int vector, int64_t now)
{
    for (int i = 0; i < CARD_INPUTS; i++) {
        if (card_inputs_vector(i) == vector && (c->pending >> i & 1) != 0) {
            c->pending &= ~bit(i);
            if (c->config.line[i].debounce == 0) {
                c->taken = (c->taken & ~bit(i)) | (c->levels & bit(i));
                return (struct card_input_served){ i, c->config.line[i].action };
            }
            return (struct card_input_served){ i, take(c, i, now) };
        }
    }
    return (struct card_input_served){ -1, CARD_NONE };
}
