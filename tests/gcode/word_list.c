/* The words of one line as two arrays, which Python can read. */
#include "interpreter.h"
#include "tokens.h"

/* Returns how many words the line has, or the fault below 0. */
int32_t word_list(const char *line, int32_t length, char letter[TOKENS_WORDS_MAX],
                  double value[TOKENS_WORDS_MAX])
{
    static const struct interpreter in;
    static const struct program program;
    struct tokens t;
    struct fault_report r = { .notes = 0 };
    struct reading s = { .text = line, .end = length, .in = &in, .program = &program, .r = &r };
    const enum fault f = tokens_read(&t, &s);

    for (int i = 0; i < t.count; i++) {
        letter[i] = t.word[i].letter;
        value[i] = t.word[i].value;
    }
    return f == FAULT_NONE ? t.count : -(int32_t)f;
}
