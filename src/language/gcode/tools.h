/* tools - lengths by G43 to G49, and G10 L1, L10, L11, which change the table. */
#ifndef TOOLS_H
#define TOOLS_H

#include "gcode.h"
#include "modes.h"

/* A tool number of a word, into *number. */
enum fault tools_number(const struct token *w, int32_t *number, struct fault_report *r);

/* G43, G43.1, G43.2, G49: what is between the tip of the tool and the spindle from here on. */
enum fault tools_lengths(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

/* Whether the block has G10 with L1, L10 or L11, and that. */
bool tools_measured(const struct block *b);
enum fault tools_measure(struct interpreter *in, const struct program *p, const struct block *b,
                         struct fault_report *r);

/* The offset that every coordinate of the program gets last. [mm], [deg] */
double tools_length(const struct interpreter *in, int axis);

/* Whether any axis has one. */
bool tools_any_length(const struct interpreter *in);

/* Numbered parameters of tools in mm and degrees: 5081 .. 5089 the length in force, 5400 number,
 * 5401 .. 5409 offset, 5410 diameter of the tool in the spindle; 5411 .. 5413, of turning, are 0.
 * False: no such parameter here. */
bool tools_parameter(const struct interpreter *in, bool angles, int number, double *value);

/* Diameter of the tool of a number, 0: of the one in the spindle; false if there is none. [mm] */
bool tools_diameter(const struct interpreter *in, int32_t number, double *diameter);

#endif
