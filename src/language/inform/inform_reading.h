/* inform_reading - a program while it is being read; functions that return -1 have reported. */
#ifndef INFORM_READING_H
#define INFORM_READING_H

#include "inform.h"
#include "inform_scan.h"

/* A block that is open: IF (`from` its latest branch), LOOP, WHILE. */
struct inform_block {
    enum { INFORM_BLOCK_IF, INFORM_BLOCK_ELSE, INFORM_BLOCK_LOOP, INFORM_BLOCK_WHILE } kind;
    int32_t code; /* the branch not taken jumps from here: IF, ELSEIF, WHILE, LOOP */
    int32_t out;  /* latest jump to the end of an IF, each has the one before; -1 */
    int32_t else_line;
    int32_t line;
    struct inform_piece begin; /* its line */
};

struct inform_reading {
    struct inform_program *p;
    const struct inform_points *points;
    struct inform_scan s;
    struct inform_block block[INFORM_BLOCKS];
    int32_t blocks;
    int32_t end_line; /* of END of this job, or 0 */
    int32_t last;     /* latest line of this job */
    int32_t arc;      /* MOVC of one point in a row: 0 .. 3 */
    int32_t arc_line; /* of the latest */
    struct inform_piece arc_at;
    struct inform_code via; /* of the second */
};

/* A new instruction of this line, to be filled in; NULL: too many. */
struct inform_code *inform_reading_add(struct inform_reading *in, enum inform_op op);

/* inform_operands: what instructions work with. */

/* A variable, signal or analog input, or a number; `kinds` has a bit for each kind that may be. */
int inform_operand(struct inform_reading *in, uint32_t kinds, struct inform_operand *o);

/* name#(n), n counted from 0 afterwards; the name has been read. */
int inform_operand_channel(struct inform_reading *in, int32_t most, int32_t *index);

/* left relation right, in brackets or not. */
int inform_operand_condition(struct inform_reading *in, struct inform_code *c);

/* Nothing, or IF and a condition. */
int inform_operand_if(struct inform_reading *in, struct inform_code *c);

/* T= with a time in s. */
int inform_operand_time(struct inform_reading *in, struct inform_code *c);

/* inform_moves: MOVJ MOVL MOVC SPEED. */
int inform_move(struct inform_reading *in, enum inform_path path);
int inform_move_speed(struct inform_reading *in);

/* A run of MOVC of one point each ends here. */
int inform_move_arc_over(struct inform_reading *in);

/* inform_blocks: IF ELSEIF ELSE ENDIF, LOOP ENDLOOP, WHILE ENDWHILE. */
int inform_block_if(struct inform_reading *in);
int inform_block_else(struct inform_reading *in, bool condition);
int inform_block_endif(struct inform_reading *in);
int inform_block_loop(struct inform_reading *in);
int inform_block_endloop(struct inform_reading *in);
int inform_block_while(struct inform_reading *in);
int inform_block_endwhile(struct inform_reading *in);

/* The job ends: nothing may be open. */
int inform_block_all_closed(struct inform_reading *in);

/* The LOOP that is open innermost, -1: none. */
int32_t inform_block_loop_inside(const struct inform_reading *in);

/* inform_words: one line. */
int inform_words(struct inform_reading *in);

#endif
