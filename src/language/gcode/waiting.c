#include "waiting.h"

#include <math.h>
#include <string.h>

#include "frame.h"
#include "offsets.h"

static const double WAIT_MAX = 86400.0; /* [s] longest wait, a day */

void waiting_for(struct interpreter *in, enum wait_kind kind)
{
    in->waits = true;
    in->wait.kind = kind;
    in->wait.behind = in->count;
}

/* A word's value as a whole number from 0 to `most`; -1: it is none. */
static int whole(const struct token *w, int most)
{
    return w->value >= 0.0 && w->value <= most && w->value == round(w->value) ? (int)w->value : -1;
}

/* CCN 20: a row of rules of M66, each with its fault, in the order in which they are told. */
enum fault waiting_input(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r)
{
    const struct token *m = b->g.by[GCODE_IO], *l = gcode_word(&b->g, 'L');
    const struct token *digital = gcode_word(&b->g, 'P'), *analog = gcode_word(&b->g, 'E');
    const struct token *of = digital ? digital : analog, *limit = gcode_word(&b->g, 'Q');

    if (b->g.code[GCODE_IO] != 660) {
        return FAULT_NONE;
    }
    if (!p->has_inputs) {
        return tokens_at_word(r, FAULT_NO_INPUTS, m);
    }
    if (!of) {
        return tokens_at_word(r, FAULT_MISSING, m);
    }
    if (digital && analog) {
        return tokens_at_words(r, FAULT_SHARED, digital, analog);
    }
    const int index = whole(of, digital ? INPUTS_DIGITAL - 1 : INPUTS_ANALOG - 1);
    const int mode = l ? whole(l, digital ? WAIT_LOW : WAIT_NOW) : WAIT_NOW;
    if (index < 0 || mode < 0) {
        return tokens_at_word(r, FAULT_VALUE, index < 0 ? of : l);
    }
    if (mode != WAIT_NOW && !limit) {
        return tokens_at_word(r, FAULT_MISSING, m);
    }
    if (mode != WAIT_NOW && !(limit->value > 0.0 && limit->value <= WAIT_MAX)) {
        return tokens_at_word(r, FAULT_VALUE, limit);
    }
    waiting_for(in, digital ? WAIT_DIGITAL : WAIT_ANALOG);
    in->wait.index = index;
    in->wait.mode = (enum wait_mode)mode;
    in->wait.limit = mode == WAIT_NOW ? 0.0 : limit->value;
    return FAULT_NONE;
}

void waiting_answer(struct interpreter *in, double value)
{
    in->waits = false;
    in->input = value;
}

void waiting_free(struct interpreter *in)
{
    in->wait.kind = WAIT_PROBE;
    in->wait.behind = in->wait.until;
}

void waiting_probed(struct interpreter *in, const double contact[AXES], const double rest[AXES],
                    bool touched)
{
    in->waits = false;
    in->touched = touched ? 1.0 : 0.0;
    frame_program(in, contact, in->contact);
    memcpy(in->point, rest, sizeof in->point);
}

bool waiting_parameter(const struct interpreter *in, bool angles, int number, double *value)
{
    if (number == 5399 || number == 5070) {
        *value = number == 5399 ? in->input : in->touched;
        return true;
    }
    if (number < 5061 || number > 5069) {
        return false;
    }
    const int axis = offsets_axis(angles, number - 5061);
    *value = axis < 0 ? 0.0 : in->contact[axis];
    return true;
}

bool waiting_set(struct interpreter *in, bool angles, int number, double value)
{
    if (number < 5061 || number > 5070) {
        return false;
    }
    const int axis = number < 5070 ? offsets_axis(angles, number - 5061) : -1;
    if (axis >= 0) {
        in->contact[axis] = value;
    } else if (number == 5070) {
        in->touched = value;
    }
    return true;
}

void waiting_pass(struct interpreter *in)
{
    if (in->wait.kind == WAIT_FREE) {
        waiting_free(in);
    } else if (in->wait.kind == WAIT_PROBE) {
        waiting_probed(in, in->point, in->point, false);
    } else {
        waiting_answer(in, 0.0);
    }
}

bool waiting_done(const struct waiting *w, double is, double was)
{
    switch (w->mode) {
    case WAIT_RISE: return is != 0.0 && was == 0.0;
    case WAIT_FALL: return is == 0.0 && was != 0.0;
    case WAIT_HIGH: return is != 0.0;
    case WAIT_LOW:  return is == 0.0;
    default:        return true;
    }
}
