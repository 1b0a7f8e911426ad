/* robot_job_reading - a program while it is being read, line by line.
 *
 * A function that returns -1 has written the report.
 */
#ifndef ROBOT_JOB_READING_H
#define ROBOT_JOB_READING_H

#include "robot_job.h"
#include "robot_job_scan.h"

/* A block that is still open. */
struct robot_job_block {
    enum {
        ROBOT_JOB_BLOCK_IF,
        ROBOT_JOB_BLOCK_ELSE,
        ROBOT_JOB_BLOCK_LOOP,
        ROBOT_JOB_BLOCK_WHILE,
        ROBOT_JOB_BLOCK_FOR,
        ROBOT_JOB_BLOCK_SWITCH,
        ROBOT_JOB_BLOCK_DEFAULT
    } kind;
    int32_t code; /* number of its latest IF, ELSEIF, WHILE, FOR, CASE or LOOP, which jumps if not
                   * taken; -1: no CASE yet */
    struct robot_job_operand operand; /* of FOR what counts, of SWITCH what is looked at */
    double step;                      /* of FOR */
    int32_t out; /* latest jump to the end of an IF, whose `to` is the jump before it; -1: none */
    int32_t else_line;
    int32_t line;
    struct robot_job_span begin; /* the text that opened it */
};

struct robot_job_reading {
    struct robot_job_program *p;
    const struct robot_job_points *points;
    struct robot_job_scan s;
    struct robot_job_block block[ROBOT_JOB_BLOCKS];
    int32_t blocks;
    int32_t end_line; /* of END of this job, or 0 */
    int32_t last;     /* latest line of this job so far */
    struct robot_job_span last_at;
    int32_t arc;      /* number of MOVC of one point in a row so far: 0 .. 3 */
    int32_t arc_line; /* line of the latest of them */
    struct robot_job_span arc_at;
    struct robot_job_instruction via; /* the second of them */
    int32_t splines;                  /* MOVS in a row so far */
    int32_t first, jobs;              /* instructions and jobs of the texts before */
    enum {
        ROBOT_JOB_INSIDE,     /* among instructions */
        ROBOT_JOB_POSITIONED, /* among positions */
        ROBOT_JOB_SKIPPED     /* what describes arguments */
    } section;
    enum robot_job_point_kind kind;  /* of the positions that follow */
    struct robot_job_point position; /* their configuration, tool and frame */
    bool in_user;                    /* they are in that user frame, not in the base */
};

/* Append an instruction of this line, to be filled in. NULL: there are too many. */
struct robot_job_instruction *robot_job_reading_add(struct robot_job_reading *in,
                                                    enum robot_job_op op);

/* robot_job_operands: what instructions work with. Kinds of the variables of whole numbers. */
enum {
    ROBOT_JOB_WHOLES = 1u << ROBOT_JOB_B | 1u << ROBOT_JOB_I | 1u << ROBOT_JOB_D
                       | 1u << ROBOT_JOB_LB | 1u << ROBOT_JOB_LI | 1u << ROBOT_JOB_LD
};

/* Read a variable, signal, analog input or number; `kinds` has a bit for each kind that is
 * allowed. */
int robot_job_operand(struct robot_job_reading *in, uint32_t kinds, struct robot_job_operand *o);

/* Read [n] or [variable] behind the letter of an array of `most` elements, if it stands here: 1, 0
 * or -1. */
int robot_job_operand_element(struct robot_job_reading *in, int32_t most, int32_t *index,
                              struct robot_job_by *by);

/* Read IN#(n)=ON or OFF behind UNTIL. */
int robot_job_operand_until(struct robot_job_reading *in, struct robot_job_instruction *c);

/* Read #(n) behind a name; *index is n - 1. */
int robot_job_operand_channel(struct robot_job_reading *in, int32_t most, int32_t *index);

/* Read a condition, `left relation right`, in brackets or not. */
int robot_job_operand_condition(struct robot_job_reading *in, struct robot_job_instruction *c);

/* Read IF and a condition, or find the end of the line. */
int robot_job_operand_if(struct robot_job_reading *in, struct robot_job_instruction *c);

/* Read T= and a time [s]. */
int robot_job_operand_time(struct robot_job_reading *in, struct robot_job_instruction *c);

/* Read a variable of whole numbers, if a letter stands here: 1, 0 or -1. */
int robot_job_operand_whole(struct robot_job_reading *in, struct robot_job_operand *o);

/* Keep the comparison `t` for a condition or the argument of a call; -1: there are too many. */
int robot_job_operand_keep(struct robot_job_reading *in, const struct robot_job_term *t);

/* robot_job_positions: what stands in the job itself. A word of a pendant's file; a line among
 * positions: 1 if it is one, 0 if it is something else. */
void robot_job_positions_begin(struct robot_job_reading *in);
int robot_job_positions_word(struct robot_job_reading *in);
int robot_job_positions_line(struct robot_job_reading *in);

/* Number of a position of this job, 'C', or of all jobs, 'P'; -1: there is none. */
int32_t robot_job_positions_find(const struct robot_job_reading *in, char letter, int32_t number);

/* The axes outside the arm whose position a word is, BC00000; *own: of this job, *number: behind
 * the letters. */
enum robot_job_outside robot_job_positions_outside(const struct robot_job_scan *s,
                                                   struct robot_job_span w, bool *own,
                                                   int32_t *number);

/* Take such a position for a move: the axis it is of has to be there. */
int robot_job_positions_beside(struct robot_job_reading *in, struct robot_job_span w,
                               struct robot_job_instruction *c);

/* robot_job_places: positions that change. Take P001, P[B000], or C00001 of this job: 1, 0 if
 * something else stands here, or -1. */
int robot_job_place_take(struct robot_job_reading *in, int32_t *number, struct robot_job_by *by);

/* SET ADD SUB of a position that follows: 1, 0 if none does, or -1. SETE GETE GETS CNVRT MSHIFT. */
int robot_job_place_calculate(struct robot_job_reading *in, enum robot_job_op op);
int robot_job_place_line(struct robot_job_reading *in, enum robot_job_op op);

/* robot_job_lacking: whether a word is INFORM's, but not of this controller. */
bool robot_job_lacks(const struct robot_job_scan *s, struct robot_job_span w);

/* robot_job_moves: MOVJ MOVL MOVC MOVS IMOV SPEED SFTON. */
int robot_job_move(struct robot_job_reading *in, enum robot_job_path path);
int robot_job_move_by(struct robot_job_reading *in);
int robot_job_move_speed(struct robot_job_reading *in);
int robot_job_move_shift(struct robot_job_reading *in);

/* Take the frame of an increment, BF RF UF#(1) TF, by its first word: 1, 0: it is none, or -1. */
int robot_job_move_frame(struct robot_job_reading *in, struct robot_job_span w,
                         struct robot_job_instruction *c);

/* Another instruction than MOVC follows: the MOVC of one point before it must be three. */
int robot_job_move_arc_over(struct robot_job_reading *in);

/* robot_job_blocks: IF ELSEIF ELSE ENDIF, LOOP ENDLOOP, WHILE ENDWHILE, FOR NEXT, SWITCH CASE
 * DEFAULT ENDSWITCH. */
int robot_job_block_if(struct robot_job_reading *in);
int robot_job_block_else(struct robot_job_reading *in, bool condition);
int robot_job_block_endif(struct robot_job_reading *in);
int robot_job_block_loop(struct robot_job_reading *in);
int robot_job_block_endloop(struct robot_job_reading *in);
int robot_job_block_while(struct robot_job_reading *in);
int robot_job_block_endwhile(struct robot_job_reading *in);
int robot_job_block_for(struct robot_job_reading *in);
int robot_job_block_next(struct robot_job_reading *in);
int robot_job_block_switch(struct robot_job_reading *in);
int robot_job_block_case(struct robot_job_reading *in, bool value);
int robot_job_block_endswitch(struct robot_job_reading *in);

/* Whether a SWITCH has been opened and no CASE of it yet. */
bool robot_job_block_before_case(const struct robot_job_reading *in);

/* The job ends here, so no block may be open. */
int robot_job_block_all_closed(struct robot_job_reading *in);

/* Number of the innermost LOOP that is open; -1: none is. */
int32_t robot_job_block_loop_inside(const struct robot_job_reading *in);

/* robot_job_words: read one line. */
int robot_job_words(struct robot_job_reading *in);

#endif
