/* controller_text - files of the soft_controller FMU: it reads the program and the points, and
 * writes the points that were taught. Included after fmi_model.h. */
#ifndef CONTROLLER_TEXT_H
#define CONTROLLER_TEXT_H

#include "fmu_input.h"
#include "fmu_output.h"
#include "program_fault.h"

/* What is constant in a run: configuration, program, points. */
struct controller_blob {
    struct controller_config config;
    struct program_file *gcode;
    struct source source;
    bool has_job;
    struct robot_job_program job;
    struct robot_job_points points;
    uint64_t text;              /* digest of the jobs' text; 0 without jobs */
    char *file[ROBOT_JOB_JOBS]; /* names of the jobs' files: the program, then those beside it */
};

/* Name of the file that has a job. */
static const char *job_file_of(const struct controller_blob *b, int32_t job)
{
    return b->has_job ? b->file[b->job.job[job].text] : "";
}

static struct orders_text text_of(const struct controller_blob *b)
{
    return (struct orders_text){ b->gcode ? &b->source : NULL, b->has_job ? &b->job : NULL,
                                 &b->points };
}

/* Read a whole text file; the caller frees the text. NULL after fmu_fail(). */
static char *read_text(struct fmu *f, const char *parameter, const char *name, int64_t *length)
{
    FILE *file;
    const struct fmu_path path = fmu_path(f, name, FMU_READ);
    const char *why = path.good ? file_open(path.text, &file) : path.text;

    if (why) {
        fmu_fail(f, "%s: cannot read %s: %s", parameter, name, why);
        return NULL;
    }
    char *text = malloc(ROBOT_JOB_TEXT_MAX + 1);
    *length = text ? (int64_t)fread(text, 1, ROBOT_JOB_TEXT_MAX + 1, file) : 0;
    const bool bad = !text || ferror(file);
    fclose(file);
    if (bad) {
        free(text);
        fmu_fail(f, "%s: cannot read %s", parameter, name);
        return NULL;
    }
    return text;
}

/* Digest of a text behind another one (FNV-1a); two different texts have the same in one of 2^64
 * cases. */
static uint64_t digest_of(uint64_t sum, const char *text, int64_t length)
{
    for (int64_t i = 0; i < length; i++) {
        sum = (sum ^ (unsigned char)text[i]) * 0x100000001b3u;
    }
    return sum;
}

/* Report a reader's error with the file's name; returns -1. */
static int refuse_text(struct fmu *f, const char *name, const char *text,
                       const struct robot_job_report *r)
{
    char message[ROBOT_JOB_MESSAGE_MAX];

    robot_job_message(r, text, message);
    return fmu_fail(f, "%s: %s", name, message);
}

static int read_points(struct fmu *f, struct controller_blob *b)
{
    const char *name = f->s.v.points;
    struct robot_job_report r;
    int64_t length;

    const enum robot_job_outside outside = (enum robot_job_outside)b->config.robot.external.kind;

    robot_job_points_clear(&b->points, outside);
    if (!name[0]) {
        return 0;
    }
    char *text = read_text(f, "points", name, &length);
    if (!text) {
        return -1;
    }
    int code = robot_job_points_read(&b->points, outside, text, length, &r);
    code = code ? refuse_text(f, name, text, &r) : 0;
    free(text);
    return code;
}

/* Read one text of jobs, and keep it until all are read: a report may be of any of them. */
static int read_job_text(struct fmu *f, struct controller_blob *b, const char *name, char **text)
{
    struct robot_job_report r;
    int64_t length;
    const int32_t n = b->job.texts;

    text[n] = read_text(f, "program", name, &length);
    b->file[n] = text[n] ? malloc(strlen(name) + 1) : NULL;
    if (!b->file[n]) {
        return text[n] ? fmu_fail(f, "out of memory") : -1;
    }
    memcpy(b->file[n], name, strlen(name) + 1);
    b->text = digest_of(n ? b->text : 0xcbf29ce484222325u, text[n], length);
    return robot_job_read_text(&b->job, &b->points, text[n], length, &r)
               ? refuse_text(f, name, text[n], &r)
               : 0;
}

/* The name of a job's file beside the program, with the program's ending or a pendant's. False:
 * there is none. */
static bool file_beside(const struct fmu *f, const char *job, char *name, size_t size)
{
    const char *program = f->s.v.program;
    int folder = 0; /* [byte] of the program's name before that of its file: a path, resource: */
    for (int i = 0; program[i]; i++) {
        folder = strchr("/\\:", program[i]) ? i + 1 : folder;
    }
    const char *dot = strrchr(program + folder, '.');
    const char *endings[] = { dot ? dot : ".JBI", ".JBI", ".jbi", ".job" };

    for (size_t i = 0; i < sizeof endings / sizeof endings[0]; i++) {
        FILE *file;
        const int length = snprintf(name, size, "%.*s%s%s", folder, program, job, endings[i]);
        const struct fmu_path path = fmu_path(f, name, FMU_READ);
        if (length > 0 && (size_t)length < size && path.good && !file_open(path.text, &file)) {
            fclose(file);
            return true;
        }
    }
    return false;
}

/* Read the program and, beside it, the jobs that are called and not in it. */
static int read_all_jobs(struct fmu *f, struct controller_blob *b, char **text)
{
    struct robot_job_report r;
    char name[FMU_PATH_MAX];

    robot_job_begin_reading(&b->job);
    if (read_job_text(f, b, f->s.v.program, text)) {
        return -1;
    }
    for (int32_t i = 0; i < b->job.callees; i++) {
        if (robot_job_wanted(&b->job, i) && b->job.texts < ROBOT_JOB_JOBS
            && file_beside(f, b->job.callee[i].name, name, sizeof name)
            && read_job_text(f, b, name, text)) {
            return -1;
        }
    }
    return robot_job_end_reading(&b->job, &r) ? refuse_text(f, b->file[r.text], text[r.text], &r)
                                              : 0;
}

static int read_jobs(struct fmu *f, struct controller_blob *b)
{
    const char *job = f->s.v.job;
    char *text[ROBOT_JOB_JOBS] = { NULL };

    int code = read_all_jobs(f, b, text);
    for (int32_t i = 0; i < ROBOT_JOB_JOBS; i++) {
        free(text[i]);
    }
    if (code == 0 && job[0]) {
        b->config.orders.start.job = robot_job_find(&b->job, job);
        code = b->config.orders.start.job < 0
                   ? fmu_fail(f, "job = \"%s\": no such job in %s", job, f->s.v.program)
                   : 0;
    }
    b->has_job = code == 0;
    return code;
}

/* The program's language: by the parameter `language`, or by the ending of the program's name. */
static int language_of(struct fmu *f, bool *gcode)
{
    const struct vars *v = &f->s.v;
    const char *dot = strrchr(v->program, '.');

    if (strcmp(v->language, "auto") == 0) {
        *gcode = !dot
                 || (strcmp(dot, ".job") != 0 && strcmp(dot, ".jbi") != 0
                     && strcmp(dot, ".JOB") != 0 && strcmp(dot, ".JBI") != 0);
        return 0;
    }
    *gcode = strcmp(v->language, "gcode") == 0;
    return *gcode || strcmp(v->language, "inform") == 0
               ? 0
               : fmu_fail(f, "language = \"%s\": auto, inform or gcode is wanted", v->language);
}

static int read_files(struct fmu *f, struct controller_blob *b)
{
    const struct vars *v = &f->s.v;
    bool gcode = false;

    if (language_of(f, &gcode) || read_points(f, b)) {
        return -1;
    }
    if (!gcode) {
        return v->program[0] ? read_jobs(f, b) : 0;
    }
    const int code = open_program(f, "program", v->program, &b->gcode);
    b->source = (struct source){ program_look, b->gcode };
    return code;
}

enum { CONTROLLER_INPUTS = 2 };
struct controller_inputs {
    struct output_input of[CONTROLLER_INPUTS];
};

/* Files that are read and that teach_file must not replace. */
static struct controller_inputs inputs_of(const struct fmu *f)
{
    return (
        struct controller_inputs){ { { fmu_path(f, f->s.v.program, FMU_READ), "it is program" },
                                     { fmu_path(f, f->s.v.points, FMU_READ), "it is points" } } };
}

/* Write the points as joint angles, which are unambiguous whatever the tool, and also in the wrist
 * singularity, where axes 4 and 6 are in line. */
static const char *put_points(const void *fmu, FILE *file)
{
    const struct fmu *f = fmu;
    const struct controller *s = &f->s.m.controller;
    const struct controller_blob *b = f->blob;

    for (int n = 0; n < s->taught_count; n++) {
        char line[ROBOT_JOB_POINT_TEXT];
        if (controller_taught(s, &b->config, n, line) == 0) {
            fprintf(file, "%s\n", line);
        }
    }
    return NULL;
}

/* Write teach_file. Returns NULL, or why it cannot be written. */
static const char *write_points(const struct fmu *f)
{
    const struct controller_inputs in = inputs_of(f);
    const struct fmu_path path = fmu_path(f, f->s.v.teach_file, FMU_WRITTEN);

    return output_write(path.text, in.of, CONTROLLER_INPUTS, put_points, f);
}

#endif
