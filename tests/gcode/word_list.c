/* The words of one line as two arrays, which Python can read. */
#include "tokens.h"

/* Returns how many words the line has, or the fault below 0. */
int32_t word_list(const char *line, int32_t length, char letter[TOKENS_WORDS_MAX],
                  double value[TOKENS_WORDS_MAX])
{
    struct tokens t;
    struct fault_report r;
    const enum fault f = tokens_read(&t, line, length, &r);

    for (int i = 0; i < t.count; i++) {
        letter[i] = t.word[i].letter;
        value[i] = t.word[i].value;
    }
    return f == FAULT_NONE ? t.count : -(int32_t)f;
}
