/* job_file - parameters that the FMUs at both ends of a network card's link read: a job file, kept
 * beside the state, and the key of the link. Include it after fmi_model.h. */
#ifndef JOB_FILE_H
#define JOB_FILE_H

#include <stdint.h>
#include "fmu_input.h"

enum { JOB_FILE_MOST = 1 << 21, JOB_KEY_BYTES = 32 };

/* The file's bytes; one byte more than the flash has reveals a file that is too long. */
struct job_file {
    uint32_t bytes; /* number of bytes; 0: no job */
    uint8_t byte[JOB_FILE_MOST + 1];
};

static int model_open(struct fmu *f)
{
    const char *name = f->s.v.job;
    struct job_file *b = f->blob = calloc(1, sizeof *b);
    FILE *file;

    if (!b) {
        return fmu_fail(f, "no memory for the job");
    }
    if (!name[0]) {
        return 0;
    }
    const struct fmu_path path = fmu_path(f, name, FMU_READ);
    const char *why = path.good ? file_open(path.text, &file) : path.text;
    if (why) {
        return fmu_fail(f, "job: cannot read %s: %s", name, why);
    }
    b->bytes = (uint32_t)fread(b->byte, 1, sizeof b->byte, file);
    const bool bad = ferror(file) != 0;
    fclose(file);
    if (bad) {
        return fmu_fail(f, "job: cannot read %s", name);
    }
    return b->bytes > 0 ? 0 : fmu_fail(f, "job: %s is empty", name);
}

static void model_close(struct fmu *f)
{
    free(f->blob);
}

static int model_end(struct fmu *f)
{
    (void)f;
    return 0;
}

static int job_key_digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* Read the parameter `key`, 64 hexadecimal digits; without one the key is all 0. */
static int job_key(struct fmu *f, uint8_t key[JOB_KEY_BYTES])
{
    const char *text = f->s.v.key;
    const size_t n = strlen(text);

    memset(key, 0, JOB_KEY_BYTES);
    if (n != 0 && n != (size_t)2 * JOB_KEY_BYTES) {
        return fmu_fail(f, "key: %d characters, not 64 hexadecimal digits", (int)n);
    }
    for (size_t i = 0; i < n; i++) {
        const int digit = job_key_digit(text[i]);
        if (digit < 0) {
            return fmu_fail(f, "key: character %d is not a hexadecimal digit", (int)i + 1);
        }
        key[i / 2] = (uint8_t)(key[i / 2] << 4 | digit);
    }
    return 0;
}

#endif
