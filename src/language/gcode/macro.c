#include "macro.h"

#include <stddef.h>

#include "gcode.h"

/* Number of the local parameter of each letter A .. Z; 0: it has none. */
static const int32_t NUMBER[26] = { 1, 2, 3, 7,  8,  9,  0,  11, 4,  5,  6,  0,  13,
                                    0, 0, 0, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26 };

enum { MODAL = 660 }; /* G66 */

/* Words of a call so far. I J K may come ten times, and each time take the next three numbers. */
struct arguments {
    uint32_t seen; /* bits of letters, from A on */
    int group;     /* how many times I J K have begun */
    char latest;   /* the latest of I J K */
};

/* Number of the local parameter that a word of G65 or G66 sets; 0: none. */
static enum fault number_of(struct arguments *a, const struct token *w, int32_t *number,
                            struct fault_report *r)
{
    const bool letter = w->letter >= 'A' && w->letter <= 'Z';
    const uint32_t bit = letter ? UINT32_C(1) << (w->letter - 'A') : 0;

    *number = bit ? NUMBER[w->letter - 'A'] : 0;
    if (w->letter >= 'I' && w->letter <= 'K') {
        a->group += a->group == 0 || w->letter <= a->latest;
        a->latest = w->letter;
        *number += 3 * (a->group - 1);
        return *number <= PARAMETERS_LOCAL_FANUC ? FAULT_NONE : tokens_at_word(r, FAULT_UNUSED, w);
    }
    if (a->seen & bit) {
        return tokens_at_word(r, FAULT_TWICE, w);
    }
    a->seen |= bit;
    return FAULT_NONE;
}

/* The first word that is no line number, or NULL. */
static const struct token *first(const struct tokens *t)
{
    int i = 0;

    while (i < t->count && t->word[i].letter == 'N') {
        i++;
    }
    return i < t->count ? &t->word[i] : NULL;
}

bool macro_calls(const struct tokens *t)
{
    const struct token *w = first(t);
    return w && w->letter == 'G' && (gcode_code(w) == 650 || gcode_code(w) == MODAL);
}

enum fault macro_call(struct interpreter *in, const struct program *p, const struct tokens *t,
                      struct fault_report *r)
{
    const struct token *const g65 = first(t), *number = NULL, *runs = NULL;
    struct flow_local local = { .set = 0 };
    struct arguments arguments = { 0 };

    for (const struct token *w = g65 + 1; w < t->word + t->count; w++) {
        int32_t n;
        const enum fault f = number_of(&arguments, w, &n, r);
        if (f != FAULT_NONE) {
            return f;
        }
        if (w->letter == 'P' || w->letter == 'L') {
            *(w->letter == 'P' ? &number : &runs) = w;
        } else if (n) {
            local.value[n - 1] = w->value;
            local.set |= UINT64_C(1) << (n - 1);
        } else {
            return tokens_at_word(r, FAULT_UNUSED, w);
        }
    }
    if (!number) {
        return tokens_at_word(r, FAULT_NO_SUB, g65);
    }
    tokens_at_word(r, FAULT_NO_SUB, number);
    return gcode_code(g65) == MODAL
               ? flow_modal_begin(in, p, number->value, runs ? &runs->value : NULL, &local, r)
               : flow_subprogram(in, p, number->value, runs ? &runs->value : NULL, &local, r);
}

const struct token *macro_user(const struct tokens *t)
{
    for (int i = 0; i < t->count; i++) {
        if (gcode_user(&t->word[i])) {
            return &t->word[i];
        }
    }
    return NULL;
}

enum fault macro_call_user(struct interpreter *in, const struct program *p, const struct tokens *t,
                           struct oword_place here, struct fault_report *r)
{
    const struct token *const m = macro_user(t);
    double given[2] = { -1.0, -1.0 }; /* without a word, as in LinuxCNC */

    for (int i = 0; i < t->count; i++) {
        const char letter = t->word[i].letter;
        if (letter == 'P' || letter == 'Q') {
            given[letter - 'P'] = t->word[i].value;
        }
        if (gcode_user(&t->word[i]) && &t->word[i] != m) {
            return tokens_at_words(r, FAULT_GROUP, &t->word[i], m);
        }
    }
    tokens_at_word(r, FAULT_USER, m);
    return flow_user(in, p, gcode_code(m) / 10, given, here, r);
}
