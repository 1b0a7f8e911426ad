/* tool_table - the tools of a machine: number, pocket, offset and diameter of each, as a file in
 * the format of LinuxCNC lists them. */
#ifndef TOOL_TABLE_H
#define TOOL_TABLE_H

#include <stdbool.h>
#include <stdint.h>

#include "axis_count.h"

enum { TOOL_TABLE_MAX = 200, TOOL_NUMBER_MAX = 999999999 };

struct tool {
    int32_t number, pocket;
    double offset[AXES]; /* [mm], [deg] by axis: from the tip to the spindle, Z is the length */
    double diameter;     /* [mm] */
};

/* Tools in the order of their entry. An open table has no file behind it: a tool that it does not
 * list exists all the same, with offset and diameter 0. All zero is an empty, open table. Tool 0
 * is the empty spindle. */
struct tool_table {
    bool closed;
    int32_t count;
    struct tool tool[TOOL_TABLE_MAX];
};

/* The tool of a number; false: it does not exist. */
bool tool_table_find(const struct tool_table *t, int32_t number, struct tool *tool);

/* The entry of a number, to be written; an open table gets one if it has none. NULL: a closed table
 * does not have it, or an open one is full. */
struct tool *tool_table_entry(struct tool_table *t, int32_t number);

/* Place of a text in a line [characters]. */
struct tool_text {
    int32_t at, length;
};

/* Take one line of a table, which closes it: T number, P pocket, X to W offsets and D diameter in
 * mm; a ; begins a comment. I J Q, of turning, are passed over. With angles A B C are the last
 * three axes, in degrees. Returns NULL; or, without adding a tool, what is wrong with the
 * text at *at. */
const char *tool_table_line(struct tool_table *t, const char *text, int32_t length, bool angles,
                            struct tool_text *at);

#endif
