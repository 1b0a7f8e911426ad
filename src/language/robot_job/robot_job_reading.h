/* robot_job_reading - a program while it is being read; functions that return -1 have reported. */
#ifndef ROBOT_JOB_READING_H
#define ROBOT_JOB_READING_H

#include "robot_job.h"
#include "robot_job_scan.h"

/* A block that is open: IF (`from` its latest branch), LOOP, WHILE. */
struct robot_job_block {
    enum {
        ROBOT_JOB_BLOCK_IF,
        ROBOT_JOB_BLOCK_ELSE,
        ROBOT_JOB_BLOCK_LOOP,
        ROBOT_JOB_BLOCK_WHILE
    } kind;
    int32_t code; /* the branch not taken jumps from here: IF, ELSEIF, WHILE, LOOP */
    int32_t out;  /* latest jump to the end of an IF, each has the one before; -1 */
    int32_t else_line;
    int32_t line;
    struct robot_job_span begin; /* its line */
};

struct robot_job_reading {
    struct robot_job_program *p;
    const struct robot_job_points *points;
    struct robot_job_scan s;
    struct robot_job_block block[ROBOT_JOB_BLOCKS];
    int32_t blocks;
    int32_t end_line; /* of END of this job, or 0 */
    int32_t last;     /* latest line of this job */
    int32_t arc;      /* MOVC of one point in a row: 0 .. 3 */
    int32_t arc_line; /* of the latest */
    struct robot_job_span arc_at;
    struct robot_job_instruction via; /* of the second */
};

/* A new instruction of this line, to be filled in; NULL: too many. */
struct robot_job_instruction *robot_job_reading_add(struct robot_job_reading *in,
                                                    enum robot_job_op op);

/* robot_job_operands: what instructions work with. */

/* A variable, signal or analog input, or a number; `kinds` has a bit for each kind that may be. */
int robot_job_operand(struct robot_job_reading *in, uint32_t kinds, struct robot_job_operand *o);

/* name#(n), n counted from 0 afterwards; the name has been read. */
int robot_job_operand_channel(struct robot_job_reading *in, int32_t most, int32_t *index);

/* left relation right, in brackets or not. */
int robot_job_operand_condition(struct robot_job_reading *in, struct robot_job_instruction *c);

/* Nothing, or IF and a condition. */
int robot_job_operand_if(struct robot_job_reading *in, struct robot_job_instruction *c);

/* T= with a time in s. */
int robot_job_operand_time(struct robot_job_reading *in, struct robot_job_instruction *c);

/* robot_job_moves: MOVJ MOVL MOVC SPEED. */
int robot_job_move(struct robot_job_reading *in, enum robot_job_path path);
int robot_job_move_speed(struct robot_job_reading *in);

/* A run of MOVC of one point each ends here. */
int robot_job_move_arc_over(struct robot_job_reading *in);

/* robot_job_blocks: IF ELSEIF ELSE ENDIF, LOOP ENDLOOP, WHILE ENDWHILE. */
int robot_job_block_if(struct robot_job_reading *in);
int robot_job_block_else(struct robot_job_reading *in, bool condition);
int robot_job_block_endif(struct robot_job_reading *in);
int robot_job_block_loop(struct robot_job_reading *in);
int robot_job_block_endloop(struct robot_job_reading *in);
int robot_job_block_while(struct robot_job_reading *in);
int robot_job_block_endwhile(struct robot_job_reading *in);

/* The job ends: nothing may be open. */
int robot_job_block_all_closed(struct robot_job_reading *in);

/* The LOOP that is open innermost, -1: none. */
int32_t robot_job_block_loop_inside(const struct robot_job_reading *in);

/* robot_job_words: one line. */
int robot_job_words(struct robot_job_reading *in);

#endif
