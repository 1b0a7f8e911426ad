/* fmi_model - contract between a model, fmus/<name>/model.c, and the FMI layer, which makes FMI 2.0
 * and 3.0 of it: the functions that each gives the other.
 *
 * model.c reads:
 *     #include "vars.h"           generated from the description: struct vars, FMU_* constants
 *     struct model { ... };       all other state; plain data, no pointers
 *     #define MODEL_BLOB          only if it keeps something beside the state (files, buffers)
 *     #define MODEL_IN_USE ...    only if it has large arrays: rows of fmu_in_use.h
 *     #include "fmi_model.h"
 * and then defines the functions declared below. The layer is compiled into the same unit; its own
 * names start with fmi, FMI, var_, VAR_, CAUSE_ and VARY_.
 *
 * What a model can rely on: numbers are finite and within the limits of the description, strings
 * end; fixed parameters do not change after model_start; no function is called out of order.
 */
#ifndef FMI_MODEL_H
#define FMI_MODEL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* Kind of printf formats that the compiler checks; Windows has two. */
#ifdef __MINGW_PRINTF_FORMAT
#define FMU_PRINTF __MINGW_PRINTF_FORMAT
#else
#define FMU_PRINTF __printf__
#endif

#include "fmu_in_use.h"

/* Everything that getFMUState saves, except what MODEL_IN_USE leaves out. */
struct state {
    struct vars v;  /* every variable of the description, by its name */
    struct model m; /* all other state of the model */
    int64_t now;    /* [ns] time since startTime */
};

struct fmu {
    struct state s;
    void *blob; /* files and buffers that model_open made; NULL without MODEL_BLOB */
    bool tuned; /* parameters may have changed since model_step last began; the layer sets it, and a
                 * model that keeps what it makes of them clears it */
};

/* The model's own functions. They return 0, or -1 after fmu_fail(). */

/* Check the parameters, set f->s.m and all outputs for time 0. May be called again: it must start
 * from f->s.v alone and leave parameters and inputs as they are. f->s.m and the outputs come
 * cleared to 0. */
static int model_start(struct fmu *f);

/* Advance from t0 to t1 [ns], t1 > t0, both whole multiples of FMU_TICK_NS, inputs held.
 * Any split of an interval into steps must give the same outputs at the common points. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1);

#ifdef MODEL_BLOB
/* Make f->blob from the fixed parameters in f->s.v, nothing else; before model_start. When an FMU
 * state is restored, f->s is replaced and the blob stays if its fixed parameters are the same. */
static int model_open(struct fmu *f);

/* The run ended well: write files, all or none. */
static int model_end(struct fmu *f);

/* Free f->blob and delete half-written files. It follows every model_open, also one that failed, so
 * f->blob may be NULL. */
static void model_close(struct fmu *f);
#endif

/* The functions that the layer gives the model. */

/* Report a status of Error to the importer; printf format; returns -1. */
#if defined(__GNUC__)
__attribute__((format(FMU_PRINTF, 2, 3)))
#endif
static int
fmu_fail(struct fmu *f, const char *format, ...);

/* Send the importer a message; printf format; categories logEvents and logStatusWarning. */
#if defined(__GNUC__)
__attribute__((format(FMU_PRINTF, 2, 3), unused))
#endif
static void
fmu_event(struct fmu *f, const char *format, ...);
#if defined(__GNUC__)
__attribute__((format(FMU_PRINTF, 2, 3), unused))
#endif
static void
fmu_warn(struct fmu *f, const char *format, ...);

/* Folder of the unpacked FMU's resources, ending in a separator, or "" if unknown. */
#if defined(__GNUC__)
__attribute__((unused))
#endif
static const char *
fmu_resources(const struct fmu *f);

/* Path of a file, or if not `good` the reason why there is none. */
enum { FMU_PATH_MAX = 4096 };
struct fmu_path {
    bool good;
    char text[FMU_PATH_MAX];
};

enum fmu_use { FMU_READ, FMU_WRITTEN };

/* Path of the file that a parameter names: by a path, a file:// URI with percent-encoded UTF-8, or
 * as resource:NAME, which is NAME in the resources and can only be read. A missing resource gives a
 * text that lists the existing ones; any other name gives a path, whether there is a file or
 * not. */
#if defined(__GNUC__)
__attribute__((unused))
#endif
static struct fmu_path
fmu_path(const struct fmu *f, const char *given, enum fmu_use use);

#endif
