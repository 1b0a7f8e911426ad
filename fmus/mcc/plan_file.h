/* plan_file - writes the commanded motion of a whole program, a row for each DDA time, to a NumPy
 * file, before the run begins. */
#ifndef PLAN_FILE_H
#define PLAN_FILE_H

#include "fmu_output.h"
#include "preview.h"

/* [s] The longest motion that is written: a day. */
#define PLAN_LONGEST 86400.0

/* A row; its members are those of plan_head(), little-endian, without gaps. */
struct plan_row {
    double time;        /* [s] end of the DDA time */
    double place[AXES]; /* [mm] */
    double speed, feed; /* [mm/s] along the path: driven, programmed */
    int32_t line, command;
    int32_t cause, axis; /* what limits the motion: limited.h */
};

struct plan_file {
    FILE *file;
    double frame; /* [s] DDA time */
    int64_t rows;
};

/* The header of format 1.0, always as long. */
static void plan_head(const struct plan_file *f)
{
    enum { LENGTH = 246 }; /* with the ten bytes before it a multiple of 64 */
    char text[LENGTH + 1];
    const int n = snprintf(text, sizeof text,
                           "{'descr': [('time', '<f8'), ('place', '<f8', (%d,)), ('speed', '<f8'), "
                           "('feed', '<f8'), ('line', '<i4'), ('command', '<i4'), "
                           "('cause', '<i4'), ('axis', '<i4')], "
                           "'fortran_order': False, 'shape': (%lld,), }",
                           AXES, (long long)f->rows);

    memset(text + n, ' ', (size_t)(LENGTH - n));
    text[LENGTH - 1] = '\n';
    rewind(f->file);
    fwrite("\x93NUMPY\x01\x00", 1, 8, f->file);
    fputc(LENGTH % 256, f->file);
    fputc(LENGTH / 256, f->file);
    fwrite(text, 1, LENGTH, f->file);
}

static void plan_point(void *to, const struct point *p, const struct limited *l)
{
    struct plan_file *f = to;
    struct plan_row row = { .time = (double)(f->rows + 1) * f->frame,
                            .speed = p->feed,
                            .feed = l->feed,
                            .line = p->line,
                            .command = p->command,
                            .cause = (int32_t)l->by,
                            .axis = l->axis };

    memcpy(row.place, p->place, sizeof row.place);
    fwrite(&row, sizeof row, 1, f->file);
    f->rows++;
}

/* A library at rest, which is left where the program ends, that program, and a place for what
 * ended it. */
struct plan_rows {
    struct mcc *mcc;
    const struct source *source;
    char *said;
    size_t most; /* characters of it */
};

static const char *plan_fill(const void *from, FILE *file)
{
    const struct plan_rows *rows = from;
    const double frame = machine_dda_time(&rows->mcc->machine), most = PLAN_LONGEST / frame;
    struct plan_file f = { file, frame, 0 };

    plan_head(&f);
    const enum preview_end end =
        preview_run(rows->mcc, rows->source, (int64_t)most, plan_point, &f);
    plan_head(&f);
    if (end == PREVIEW_ERROR) {
        snprintf(rows->said, rows->most, "run-time error 0x%04X after line %d",
                 (unsigned)MCC_get_errcode(rows->mcc), (int)rows->mcc->written.line);
        return rows->said;
    }
    return end == PREVIEW_LONG ? "the program takes more than a day" : NULL;
}

#endif
