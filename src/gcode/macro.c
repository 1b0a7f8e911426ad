#include "macro.h"

#include <stddef.h>

/* The parameter of each letter A .. Z; 0: it has none. */
static const int32_t NUMBER[26] = {
    1, 2, 3, 7, 8, 9, 0, 11, 4, 5, 6, 0, 13, 0, 0, 0, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26
};

/* The first word behind line numbers, or NULL. */
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
    return w && w->letter == 'G' && w->value == 65.0;
}

enum fault macro_call(struct interpreter *in, const struct program *p, const struct tokens *t,
                      struct fault_report *r)
{
    const struct token *const g65 = first(t), *number = NULL, *runs = NULL;
    double local[PARAMETERS_LOCAL] = { 0.0 };

    for (const struct token *w = g65 + 1; w < t->word + t->count; w++) {
        const int32_t n = w->letter >= 'A' && w->letter <= 'Z' ? NUMBER[w->letter - 'A'] : 0;
        if (w->letter == 'P' || w->letter == 'L') {
            const struct token **const to = w->letter == 'P' ? &number : &runs;
            if (*to) {
                return tokens_at_word(r, FAULT_TWICE, w);
            }
            *to = w;
        } else if (n) {
            local[n - 1] = w->value;
        } else {
            return tokens_at_word(r, FAULT_UNUSED, w);
        }
    }
    if (!number) {
        return tokens_at_word(r, FAULT_NO_SUB, g65);
    }
    tokens_at_word(r, FAULT_NO_SUB, number);
    return flow_subprogram(in, p, number->value, runs ? &runs->value : NULL, local, r);
}
