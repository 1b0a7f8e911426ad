/* One FMU's model without FMI: its own C files behind four plain functions.
 *
 * Compiled once per FMU with -DPART=<name>, its C file as MODEL and its folders in the include
 * path. <name>_open gives the variables at their start values; then <name>_start, <name>_step,
 * <name>_end. An error ends the program.
 */
#define _POSIX_C_SOURCE 200809L /* kinds of files, as in the FMU's own unit */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include MODEL
#include "vars.c"

#define JOIN_(a, b) a##_##b
#define JOIN(a, b)  JOIN_(a, b)

static int fmu_fail(struct fmu *f, const char *format, ...)
{
    (void)f;
    va_list list;
    va_start(list, format);
    vfprintf(stderr, format, list);
    va_end(list);
    fputc('\n', stderr);
    exit(2);
}

static void fmu_event(struct fmu *f, const char *format, ...)
{
    (void)f, (void)format;
}

static void fmu_warn(struct fmu *f, const char *format, ...)
{
    (void)f, (void)format;
}

static const char *fmu_resources(const struct fmu *f)
{
    (void)f;
    return "";
}

#include "fmi_path.inc"

static struct fmu part;

void *JOIN(PART, open)(void);
void *JOIN(PART, open)(void)
{
    part.s.v = vars_start;
    return &part.s.v;
}

void JOIN(PART, start)(void);
void JOIN(PART, start)(void)
{
    (void)fmu_resources(&part);
#ifdef MODEL_BLOB
    model_open(&part);
#endif
    model_start(&part);
    part.tuned = true;
}

void JOIN(PART, step)(int64_t t0, int64_t t1);
void JOIN(PART, step)(int64_t t0, int64_t t1)
{
    model_step(&part, t0, t1);
}

void JOIN(PART, end)(void);
void JOIN(PART, end)(void)
{
#ifdef MODEL_BLOB
    model_end(&part);
    model_close(&part);
#endif
}
