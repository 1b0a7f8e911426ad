#include "tool_table.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "gcode.h"
#include "tokens.h"

/* The entry of a number, or NULL. */
static struct tool *entry_of(struct tool_table *t, int32_t number)
{
    for (int32_t i = 0; i < t->count; i++) {
        if (t->tool[i].number == number) {
            return &t->tool[i];
        }
    }
    return NULL;
}

bool tool_table_find(const struct tool_table *t, int32_t number, struct tool *tool)
{
    memset(tool, 0, sizeof *tool);
    tool->number = number;
    for (int32_t i = 0; i < t->count; i++) {
        if (t->tool[i].number == number) {
            *tool = t->tool[i];
            return true;
        }
    }
    return !t->closed || number == 0;
}

struct tool *tool_table_entry(struct tool_table *t, int32_t number)
{
    struct tool *tool = entry_of(t, number);

    if (tool || t->closed || t->count == TOOL_TABLE_MAX) {
        return tool;
    }
    tool = &t->tool[t->count++];
    memset(tool, 0, sizeof *tool);
    tool->number = number;
    return tool;
}

/* A value as a whole number from 0 to TOOL_NUMBER_MAX; -1: it is none. */
static int32_t whole(double x)
{
    return x >= 0.0 && x <= TOOL_NUMBER_MAX && x == round(x) ? (int32_t)x : -1;
}

/* Take one word; returns NULL, or what is wrong with it. */
static const char *take_word(struct tool *tool, const struct token *w, bool angles)
{
    static const char axes[] = BLOCK_AXES, turned[] = "XYZABC", passed[] = "IJQ";
    const char *place = strchr(angles ? turned : axes, w->letter);

    if (w->letter == 'T' || w->letter == 'P') {
        const int32_t number = whole(w->value);
        *(w->letter == 'T' ? &tool->number : &tool->pocket) = number;
        return number < (w->letter == 'T') ? "not a whole number" : NULL;
    }
    if (w->letter == 'D') {
        tool->diameter = w->value;
        return w->value >= 0.0 ? NULL : "a diameter below 0";
    }
    if (place) {
        tool->offset[place - (angles ? turned : axes)] = w->value;
        return NULL;
    }
    return strchr(passed, w->letter) || (strchr("ABCUVW", w->letter) && w->value == 0.0)
               ? NULL
               : "no column of a tool table";
}

/* Take the words of a line, which are one tool's, each letter once. */
static const char *take_words(struct tool *tool, const struct tokens *t, bool angles,
                              struct tool_text *at)
{
    uint32_t seen = 0;

    tool->number = tool->pocket = -1;
    for (int i = 0; i < t->count; i++) {
        const struct token *w = &t->word[i];
        const uint32_t bit = (uint32_t)1 << (w->letter - 'A');
        const char *why = seen & bit ? "given twice" : take_word(tool, w, angles);
        if (why) {
            *at = (struct tool_text){ w->at, w->length };
            return why;
        }
        seen |= bit;
    }
    *at = (struct tool_text){ t->at, t->length };
    return tool->number < 0 ? "no tool number T" : NULL;
}

const char *tool_table_line(struct tool_table *t, const char *text, int32_t length, bool angles,
                            struct tool_text *at)
{
    struct tool tool = { .pocket = 0 };
    struct tokens words;
    struct fault_report r = { .notes = 0 };
    struct reading line = { .text = text, .end = length, .r = &r };

    if (tokens_read(&words, &line) != FAULT_NONE || words.flow) {
        *at = (struct tool_text){ r.at, r.length };
        return "not a word of a letter and a number";
    }
    t->closed = true;
    if (words.count == 0) {
        return NULL;
    }
    const char *why = take_words(&tool, &words, angles, at);
    why = why                          ? why
          : entry_of(t, tool.number)   ? "a tool that is in the table already"
          : t->count == TOOL_TABLE_MAX ? "more than 200 tools"
                                       : NULL;
    if (!why) {
        t->tool[t->count++] = tool;
    }
    return why;
}
