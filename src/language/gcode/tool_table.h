/* tool_table - numbers, lengths and diameters of the tools, as a file has them. */
#ifndef TOOL_TABLE_H
#define TOOL_TABLE_H

#include <stdbool.h>
#include <stdint.h>

#include "axis_count.h"

enum { TOOL_TABLE_MAX = 200, TOOL_NUMBER_MAX = 999999999 };

struct tool {
    int32_t number, pocket;
    double offset[AXES]; /* [mm], [deg] length and more: from the tip to the spindle */
    double diameter;     /* [mm] */
};

/* Tools by number. An open table has no file behind it: every tool it does not have exists, too,
 * with length and diameter 0. Cleared it is open. Tool 0 is none: the spindle is empty. */
struct tool_table {
    bool closed;
    int32_t count;
    struct tool tool[TOOL_TABLE_MAX];
};

/* The tool of a number; false if there is none. */
bool tool_table_find(const struct tool_table *t, int32_t number, struct tool *tool);

/* The entry of a number, to be written; an open table gets one. NULL if there is none. */
struct tool *tool_table_entry(struct tool_table *t, int32_t number);

/* Text of a line that is wrong. */
struct tool_text {
    int32_t at, length;
};

/* Take one line of a table, which closes it: T number, P pocket, X to W offsets, D diameter, all in
 * mm; a ; begins a comment, I J Q are of turning and passed over. With angles A B C are the last
 * three axes. Returns NULL, or what is wrong with the text at *at; then the table is as before. */
const char *tool_table_line(struct tool_table *t, const char *text, int32_t length, bool angles,
                            struct tool_text *at);

#endif
