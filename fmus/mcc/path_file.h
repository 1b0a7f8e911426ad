/* Writes the planned geometry of the mcc FMU. */
#ifndef PATH_FILE_H
#define PATH_FILE_H

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "interpreter.h"

/* "<name>.part", where the file is written until it is complete. */
struct path_part { char name[FMU_STRING_MAX + 8]; };

static struct path_part path_part_of(const char *name)
{
    struct path_part p;
    snprintf(p.name, sizeof p.name, "%s.part", name);
    return p;
}

/* Whether the file can be made, as an errno value; nothing is left behind. */
static int path_try(const char *name)
{
    const struct path_part part = path_part_of(name);
    FILE *file = fopen(part.name, "wb");
    if (!file) {
        return errno;
    }
    fclose(file);
    return remove(part.name) == 0 ? 0 : errno;
}

/* A number with all its digits, whatever decimal sign the host's locale has. */
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
    put(file, p->radius);
    put(file, p->sweep);
    put(file, p->length);
    put(file, c->feed);
    fputc('\n', file);
}

static void put_path(FILE *file, struct interpreter in, const struct program *program,
                     int32_t last)
{
    struct command c;
    struct fault_report r;

    fputs("command,line,type,start_x,start_y,start_z,start_u,start_v,start_w,"
          "end_x,end_y,end_z,end_u,end_v,end_w,centre_x,centre_y,centre_z,"
          "normal_x,normal_y,normal_z,radius,sweep,length,feed\n", file);
    for (int32_t i = 1; i <= last;) {
        if (interpreter_next(&in, program, &c, &r) != INTERPRETER_COMMAND) {
            return;
        }
        if (command_lasts(&c)) {
            c.index = i++;
            put_command(file, &c);
        }
    }
}

/* Write one row per command up to an index, as the interpreter makes them again from its start.
 * Returns an errno value; on an error there is no new file and the old one is untouched. */
static int path_write(const char *name, const struct interpreter *start,
                      const struct program *program, int32_t last)
{
    const struct path_part part = path_part_of(name);
    FILE *file = fopen(part.name, "wb");
    if (!file) {
        return errno;
    }
    errno = 0;
    put_path(file, *start, program, last);
    int error = ferror(file) ? (errno ? errno : EIO) : 0;
    if (fclose(file) != 0 && !error) {
        error = errno;
    }
#ifdef _WIN32
    if (!error) {
        remove(name);       /* rename does not replace there */
    }
#endif
    if (!error && rename(part.name, name) != 0) {
        error = errno;
    }
    if (error) {
        remove(part.name);
    }
    return error;
}

#endif
