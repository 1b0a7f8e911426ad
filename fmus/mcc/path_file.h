/* path_file - writes the planned geometry of the mcc FMU, a row for each command, to a CSV file. */
#ifndef PATH_FILE_H
#define PATH_FILE_H

#include "fmu_output.h"
#include "interpreter.h"
#include "waiting.h"

/* Write a comma and a number with all its digits, with a decimal point in any locale. */
static void put(FILE *file, double x)
{
    char digits[32];
    snprintf(digits, sizeof digits, "%.17g", x);
    for (char *c = digits; *c; c++) {
        *c = *c == ',' ? '.' : *c;
    }
    fprintf(file, ",%s", digits);
}

static void put_command(FILE *file, const struct command *c)
{
    const struct path *p = &c->path;
    double centre[3] = { 0.0 };

    fprintf(file, "%d,%d,%d", (int)c->index, (int)c->line, (int)c->type);
    for (int i = 0; i < AXES; i++) {
        put(file, p->start[i]);
    }
    for (int i = 0; i < AXES; i++) {
        put(file, p->end[i]);
    }
    if (p->arc) {
        centre[p->plane] = p->start[p->plane];
        centre[path_first(p->plane)] = p->centre[0];
        centre[path_second(p->plane)] = p->centre[1];
    }
    for (int i = 0; i < 3; i++) {
        put(file, centre[i]);
    }
    for (int i = 0; i < 3; i++) {
        put(file, p->arc && i == (int)p->plane ? 1.0 : 0.0);
    }
    put(file, p->arc ? p->radius : 0.0);
    put(file, p->arc ? p->sweep : 0.0);
    put(file, p->length);
    put(file, c->feed);
    for (int i = 0; i < 6; i++) {
        put(file, p->cubic ? p->bezier.inner[i / 3][i % 3] : 0.0);
    }
    fputc('\n', file);
}

static void put_path(FILE *file, struct interpreter in, const struct program *program, int32_t last)
{
    struct command c;
    struct fault_report r;

    fputs("command,line,type,start_x,start_y,start_z,start_u,start_v,start_w,"
          "end_x,end_y,end_z,end_u,end_v,end_w,centre_x,centre_y,centre_z,"
          "normal_x,normal_y,normal_z,radius,sweep,length,feed,"
          "inner_0_x,inner_0_y,inner_0_z,inner_1_x,inner_1_y,inner_1_z\n",
          file);
    for (int32_t i = 1; i <= last;) {
        const enum interpreter_result got = interpreter_next(&in, program, &c, &r);
        if (got == INTERPRETER_WAIT) {
            waiting_pass(&in);
        } else if (got != INTERPRETER_COMMAND) {
            return;
        } else if (command_lasts(&c)) {
            c.index = i++;
            put_command(file, &c);
        }
    }
}

/* The commands of a path: of a program, made again from the interpreter's start, up to an index. */
struct path_rows {
    const struct interpreter *start;
    const struct program *program;
    int32_t last;
};

static const char *path_fill(const void *from, FILE *file)
{
    const struct path_rows *rows = from;

    put_path(file, *rows->start, rows->program, rows->last);
    return NULL;
}

#endif
