/* fmu_recorder - records the signals of a run in a folder of .npy files, one per signal:
 * `<name>.npy` and `time.npy` [s], of shape (rows,) or (rows, count). Rows are collected in blocks
 * of memory, into which the caller puts them, and written a block at a time. The folder appears
 * complete at the end, where there was none, an empty one or an older recording. Or the rows stay
 * in the caller's memory, and there is no folder. Functions that return an int return 0, or -1
 * with the reason in recorder.why. */
#ifndef FMU_RECORDER_H
#define FMU_RECORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "fmu_recorder_folder.h"
#include "npy_head.h"

/* A signal to be recorded. */
struct recorder_column {
    const char *name; /* also that of its file */
    char kind;        /* 'd' double, 'i' int32_t, 'b' bool */
    int32_t count;    /* number of values; 1: the shape is (rows,) */
};

/* A column with its file. */
struct recorder_stream {
    int column; /* index of the column; -1: time */
    FILE *file;
    int64_t ahead; /* [byte] place in the file up to which room on the disk is reserved */
};

/* Columns whose rows have the same size: their blocks are full at the same time. Groups stand in
 * the order of that size. */
struct recorder_group {
    struct recorder_stream *streams;
    int count;
    size_t width;  /* [byte] size of a row */
    int64_t first; /* number of the row at the begin of the blocks */
    int64_t room;  /* number of rows that a block holds */
};

struct recorder {
    struct recorder_folder folder;
    const struct recorder_column *columns; /* the caller's, while it is open */
    struct recorder_stream *streams;       /* those of all columns and of time */
    struct recorder_group *groups;
    char **block;           /* of time and of each column: rows that are not in the file yet */
    char *blocks;           /* memory of all blocks; NULL: they are the caller's, for a whole run */
    int count, group_count; /* number of streams; of groups */
    double time, period;    /* [s] time of the row; from row to row */
    int64_t base;           /* number of the first row, 0 if the run begins at time 0 */
    int64_t row;            /* number of the next row */
    int64_t full;           /* number of rows before which no block is full */
    char why[RECORDER_WHY]; /* error, "" if none */
};

enum {
    RECORDER_PAGE = 4096,
    RECORDER_HEAD = RECORDER_PAGE, /* head of a file, so that data begin at a page */
    RECORDER_BLOCK = 64 * 1024,    /* [byte] largest block, in whole pages: half of it costs the
                                    * kernel half as much again, four times as much saves a tenth
                                    * but burdens the caches */
    RECORDER_AHEAD = 1024 * 1024,  /* [byte] most room on the disk that is reserved at once */
    RECORDER_LINE = 64             /* [byte] cache line between blocks: blocks a power of two apart
                                    * would compete for the same lines */
};

static inline size_t recorder_size(char kind)
{
    _Static_assert(sizeof(bool) == 1, "a Boolean of NumPy is a byte");
    return kind == 'd' ? sizeof(double) : kind == 'i' ? sizeof(int32_t) : sizeof(bool);
}

static inline struct recorder_column recorder_column_of(const struct recorder *r, int column)
{
    return column < 0 ? (struct recorder_column){ "time", 'd', 1 } : r->columns[column];
}

static inline int recorder_fail(struct recorder *r, const char *name, const char *error)
{
    snprintf(r->why, sizeof r->why, "cannot write %.*s/%s.npy: %s", RECORDER_PATH, r->folder.name,
             name, error);
    return -1;
}

/* Close a recorder. Files that recorder_end has not completed are deleted. */
static inline void recorder_close(struct recorder *r)
{
    if (!r) {
        return;
    }
    for (int k = 0; k < r->count; k++) {
        if (r->streams[k].file) {
            fclose(r->streams[k].file);
        }
        if (r->folder.part[0]) {
            char name[RECORDER_FILE];
            file_remove(
                recorder_file(name, &r->folder, recorder_column_of(r, r->streams[k].column).name));
        }
    }
    recorder_folder_drop(&r->folder);
    free(r->streams);
    free(r->groups);
    free(r->block);
    free(r->blocks);
    free(r);
}

/* Write the head of a stream's file. */
static inline bool recorder_head(const struct recorder *r, const struct recorder_stream *s)
{
    const struct recorder_column c = recorder_column_of(r, s->column);
    char head[RECORDER_HEAD];
    npy_head(head, sizeof head,
             c.kind == 'd'   ? "f8"
             : c.kind == 'i' ? "i4"
                             : "b1",
             r->row - r->base, c.count == 1 ? -1 : c.count);
    return recorder_seek(s->file, 0) == 0 && fwrite(head, 1, sizeof head, s->file) == sizeof head;
}

static inline size_t recorder_width(const struct recorder *r, const struct recorder_stream *s)
{
    const struct recorder_column c = recorder_column_of(r, s->column);
    return recorder_size(c.kind) * (size_t)c.count;
}

/* Number of rows of `width` bytes in a block, so that it is whole pages. */
static inline int64_t recorder_room(size_t width)
{
    const size_t odd = width & (~width + 1); /* the largest power of two in it */
    const size_t step = odd < RECORDER_PAGE ? RECORDER_PAGE / odd : 1;
    const size_t steps = RECORDER_BLOCK / width / step;
    return (int64_t)(steps ? steps * step : step);
}

/* Order the streams by width and make the groups. Returns what their blocks take [byte]. */
static inline size_t recorder_group_streams(struct recorder *r)
{
    size_t bytes = 0;
    for (int k = 0; k < r->count; k++) {
        const struct recorder_stream s = { .column = k - 1 };
        const size_t width = recorder_width(r, &s);
        int place = k;
        for (; place > 0 && recorder_width(r, &r->streams[place - 1]) > width; place--) {
            r->streams[place] = r->streams[place - 1];
        }
        r->streams[place] = s;
        bytes += (size_t)recorder_room(width) * width + RECORDER_LINE;
    }
    for (int k = 0; k < r->count; k++) {
        const size_t width = recorder_width(r, &r->streams[k]);
        struct recorder_group *g = &r->groups[r->group_count - (r->group_count > 0)];
        if (g->width != width) {
            g = &r->groups[r->group_count++];
            *g = (struct recorder_group){ &r->streams[k], 0, width, 0, recorder_room(width) };
        }
        g->count++;
    }
    return bytes;
}

/* Place the blocks. */
static inline bool recorder_layout(struct recorder *r)
{
    char *at = r->blocks = malloc(recorder_group_streams(r));
    for (struct recorder_group *g = r->groups; at && g < r->groups + r->group_count; g++) {
        for (int k = 0; k < g->count; k++) {
            r->block[g->streams[k].column + 1] = at;
            at += (size_t)g->room * g->width + RECORDER_LINE;
        }
    }
    return r->blocks;
}

/* A recorder without blocks; NULL if there is no memory. */
static inline struct recorder *recorder_new(const struct recorder_column *columns, int count,
                                            double period)
{
    struct recorder *r = calloc(1, sizeof *r);
    if (!r) {
        return NULL;
    }
    r->columns = columns;
    r->period = period;
    r->streams = calloc((size_t)count + 1, sizeof *r->streams);
    r->groups = calloc((size_t)count + 1, sizeof *r->groups);
    r->block = calloc((size_t)count + 1, sizeof *r->block);
    r->count = r->streams ? count + 1 : 0;
    if (!r->streams || !r->groups || !r->block) {
        recorder_close(r);
        return NULL;
    }
    return r;
}

/* Open a recorder whose rows stay in the caller's memory: of time and of each column, in this
 * order, a place for `rows` rows and one more, whose row ends the recording. NULL: no memory. */
static inline struct recorder *recorder_in_memory(const struct recorder_column *columns, int count,
                                                  double period, char *const *place, int64_t rows)
{
    struct recorder *r = recorder_new(columns, count, period);
    if (!r) {
        return NULL;
    }
    recorder_group_streams(r);
    for (struct recorder_group *g = r->groups; g < r->groups + r->group_count; g++) {
        g->room = rows + 1;
    }
    memcpy(r->block, place, (size_t)r->count * sizeof *place);
    return r;
}

/* Open a recorder; the parent of `folder` must exist. `period` is the time from row to row [s].
 * Returns NULL with the reason in `why`, of `room` bytes, and leaves nothing behind, on an
 * error. */
static inline struct recorder *recorder_open(const char *folder,
                                             const struct recorder_column *columns, int count,
                                             double period, char *why, size_t room)
{
    struct recorder *r = recorder_new(columns, count, period);
    if (!r || !recorder_layout(r)) {
        snprintf(why, room, "no memory to record %s", folder);
        recorder_close(r);
        return NULL;
    }
    const char *error = recorder_folder_begin(&r->folder, folder);
    if (error) {
        snprintf(why, room, "cannot write %s: %s", folder, error);
        recorder_close(r);
        return NULL;
    }
    for (int k = 0; k < r->count; k++) {
        struct recorder_stream *s = &r->streams[k];
        char name[RECORDER_FILE];
        const char *own = recorder_column_of(r, s->column).name;
        s->file = file_create(recorder_file(name, &r->folder, own));
        if (s->file) {
            setvbuf(s->file, NULL, _IONBF, 0); /* whole blocks are written, which need no buffer */
        }
        if (!s->file || !recorder_head(r, s)) {
            recorder_fail(r, own, strerror(errno));
            snprintf(why, room, "%s", r->why);
            recorder_close(r);
            return NULL;
        }
    }
    return r;
}

/* Whether all bytes are 0. */
static inline bool recorder_empty(const char *block, size_t size)
{
    return size == 0 || (block[0] == 0 && memcmp(block, block + 1, size - 1) == 0);
}

/* Before a block at `at` [byte] is written: reserve room on the disk for as much again as the file
 * has. Before a block that stays a hole, give reserved room back. */
static inline void recorder_make_room(struct recorder_stream *s, int64_t at, size_t size,
                                      bool empty)
{
    const int64_t next = at + (int64_t)size, more = next < RECORDER_AHEAD ? next : RECORDER_AHEAD;
    if (empty && s->ahead > at) {
        recorder_cut(s->file, at);
        s->ahead = at;
    } else if (!empty && next > s->ahead) {
        recorder_ahead(s->file, at, (int64_t)size + more);
        s->ahead = next + more;
    }
}

/* Write the rows of a group that are not in the files yet. A block that is all 0 is skipped: the
 * hole in the file reads as 0. */
static inline int recorder_flush(struct recorder *r, struct recorder_group *g)
{
    if (!r->blocks) {
        snprintf(r->why, sizeof r->why, "more rows than there is memory for");
        return -1;
    }
    const size_t size = (size_t)(r->row - g->first) * g->width;
    const int64_t next = RECORDER_HEAD + (r->row - r->base) * (int64_t)g->width;
    for (int k = 0; k < g->count; k++) {
        struct recorder_stream *s = &g->streams[k];
        const char *block = r->block[s->column + 1];
        const bool empty = recorder_empty(block, size);
        if (r->row - g->first == g->room) {
            recorder_make_room(s, next - (int64_t)size, size, empty);
        }
        errno = 0;
        const bool good =
            empty ? recorder_seek(s->file, next) == 0 : fwrite(block, 1, size, s->file) == size;
        if (!good) {
            return recorder_fail(r, recorder_column_of(r, s->column).name,
                                 strerror(errno ? errno : EIO));
        }
    }
    g->first = r->row;
    return 0;
}

static inline int recorder_flush_all(struct recorder *r)
{
    for (int i = 0; i < r->group_count; i++) {
        if (recorder_flush(r, &r->groups[i]) != 0) {
            return -1;
        }
    }
    return 0;
}

static inline int recorder_flush_full(struct recorder *r)
{
    r->full = INT64_MAX;
    for (struct recorder_group *g = r->groups; g < r->groups + r->group_count; g++) {
        if (r->row - g->first == g->room && recorder_flush(r, g) != 0) {
            return -1;
        }
        r->full = r->full < g->first + g->room ? r->full : g->first + g->room;
    }
    return 0;
}

/* A row is recorded in three steps: recorder_row sets `time`; the caller copies the values of each
 * group's columns, time among them, to recorder_place in their blocks; recorder_row_end counts the
 * row. */
static inline int recorder_row(struct recorder *r)
{
    r->time = (double)r->row * r->period;
    return r->why[0] ? -1 : 0;
}

/* Place of the next row in the blocks of a group [byte]. */
static inline size_t recorder_place(const struct recorder *r, const struct recorder_group *g)
{
    return (size_t)(r->row - g->first) * g->width;
}

static inline int recorder_row_end(struct recorder *r)
{
    return ++r->row < r->full ? 0 : recorder_flush_full(r);
}

/* Before the first row: its number, if the run does not begin at time 0. */
static inline void recorder_begin(struct recorder *r, int64_t row)
{
    for (struct recorder_group *g = r->groups; g < r->groups + r->group_count; g++) {
        g->first = row;
    }
    r->base = r->row = row;
    r->full = 0;
}

/* Set the number of the next row where rows are in memory; those jumped over are 0. */
static inline int recorder_jump(struct recorder *r, int64_t row)
{
    for (struct recorder_group *g = r->groups; g < r->groups + r->group_count && row > r->row;
         g++) {
        if (row - g->first >= g->room) {
            return recorder_flush(r, g);
        }
        for (int k = 0; k < g->count; k++) {
            memset(r->block[g->streams[k].column + 1] + recorder_place(r, g), 0,
                   (size_t)(row - r->row) * g->width);
        }
    }
    r->row = row;
    return 0;
}

/* Set the number of the next row, as after a state was restored: later rows are dropped, and rows
 * that were never recorded are 0. */
static inline int recorder_at(struct recorder *r, int64_t row)
{
    if (row == r->row) {
        return 0;
    }
    if (row < r->base) {
        snprintf(r->why, sizeof r->why, "a row before the first one");
    }
    if (!r->why[0] && !r->blocks) {
        return recorder_jump(r, row);
    }
    if (r->why[0] || recorder_flush_all(r) != 0) {
        return -1;
    }
    for (struct recorder_group *g = r->groups; g < r->groups + r->group_count; g++) {
        const int64_t at = RECORDER_HEAD + (row - r->base) * (int64_t)g->width;
        for (int k = 0; k < g->count; k++) {
            struct recorder_stream *s = &g->streams[k];
            s->ahead = at;
            if (recorder_cut(s->file, at) != 0 || recorder_seek(s->file, at) != 0) {
                return recorder_fail(r, recorder_column_of(r, s->column).name, strerror(errno));
            }
        }
        g->first = row;
    }
    r->row = row;
    r->full = 0;
    return 0;
}

/* Complete the files and let the folder appear. After it, and after an error, only recorder_close
 * may be called. */
static inline int recorder_end(struct recorder *r)
{
    if (r->why[0] || !r->blocks) {
        return r->why[0] ? -1 : 0;
    }
    if (recorder_flush_all(r) != 0) {
        return -1;
    }
    for (int k = 0; k < r->count; k++) {
        struct recorder_stream *s = &r->streams[k];
        const int64_t size = RECORDER_HEAD + (r->row - r->base) * (int64_t)recorder_width(r, s);
        errno = 0;
        const bool whole = recorder_head(r, s) && recorder_cut(s->file, size) == 0;
        const bool good = fclose(s->file) == 0 && whole;
        s->file = NULL;
        if (!good) {
            return recorder_fail(r, recorder_column_of(r, s->column).name,
                                 strerror(errno ? errno : EIO));
        }
    }
    const char *error = recorder_folder_show(&r->folder);
    if (error) {
        snprintf(r->why, sizeof r->why, "cannot write %s: %s", r->folder.name, error);
        return -1;
    }
    return 0;
}

#endif
