/* tools - offsets of the tool: G43, G43.1, G43.2 and G49 choose the one in force, G10 L1, L10 and
 * L11 change the program's tool table. */
#ifndef TOOLS_H
#define TOOLS_H

#include "gcode.h"
#include "modes.h"

/* The tool number that a word has. FAULT_VALUE: it is no whole number from 0 to TOOL_NUMBER_MAX. */
enum fault tools_number(const struct token *w, int32_t *number, struct fault_report *r);

/* Execute G43, G43.1, G43.2 or G49 of a block: the offset from the tool's tip to the spindle from
 * here on. FAULT_TOOL, FAULT_AXIS; FAULT_MISSING, FAULT_SHARED: none or two things give it. */
enum fault tools_lengths(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

/* Whether the block has G10 with L1, L10 or L11; and its execution. FAULT_MISSING: no P, or neither
 * R nor an axis word; FAULT_TOOL: no such tool; FAULT_AXIS. */
bool tools_measured(const struct block *b);
enum fault tools_measure(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

/* Offset of the tool in force along an axis [mm], [deg]; coordinates of the program get it last. */
double tools_length(const struct interpreter *in, int axis);

/* Whether it is not 0 along any axis. */
bool tools_any_length(const struct interpreter *in);

/* Value of a numbered parameter, in mm and degrees: 5081 .. 5089 offset in force; of the tool in
 * the spindle 5400 number, 5401 .. 5409 offset, 5410 diameter; 5411 .. 5413, of turning, are 0.
 * False: it is none of these. */
bool tools_parameter(const struct interpreter *in, bool angles, int number, double *value);

/* Diameter [mm] of a tool by its number; 0: of the one in the spindle. False: there is none. */
bool tools_diameter(const struct interpreter *in, int32_t number, double *diameter);

#endif
