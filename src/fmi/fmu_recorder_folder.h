/* fmu_recorder_folder - the folder of a recording (fmu_recorder.h): it is written as NAME.part and
 * renamed when it is complete. Functions return NULL, or a text for what is wrong. */
#ifndef FMU_RECORDER_FOLDER_H
#define FMU_RECORDER_FOLDER_H

#ifdef __linux__
#include <fcntl.h> /* fallocate */
#endif
#include <stdbool.h>
#include <stdint.h>

#include "fmu_file.h"

enum {
    RECORDER_PATH = 1100,                /* [byte] longest path of a folder */
    RECORDER_FILE = RECORDER_PATH + 300, /* [byte] longest path of a file in it */
    RECORDER_WHY = RECORDER_FILE + 200   /* [byte] longest text of an error */
};

struct recorder_folder {
    char name[RECORDER_PATH];
    char part[RECORDER_PATH]; /* name under which it is written; "" if it is not */
};

static inline int recorder_seek(FILE *file, int64_t at)
{
#ifdef _WIN32
    return _fseeki64(file, at, SEEK_SET);
#else
    return fseeko(file, (off_t)at, SEEK_SET);
#endif
}

static inline int recorder_cut(FILE *file, int64_t size)
{
#ifdef _WIN32
    return _chsize_s(_fileno(file), size);
#else
    return ftruncate(fileno(file), (off_t)size);
#endif
}

/* Reserve room on the disk from `at` on, beyond the file's end, if the system can: writing pages of
 * the file then takes two thirds of the time. Errors are ignored; a later write reports them. */
static inline void recorder_ahead(FILE *file, int64_t at, int64_t size)
{
#ifdef FALLOC_FL_KEEP_SIZE
    if (fallocate(fileno(file), FALLOC_FL_KEEP_SIZE, (off_t)at, (off_t)size) != 0) {
        errno = 0;
    }
#else
    (void)file, (void)at, (void)size;
#endif
}

/* Path of a signal's file while it is written. */
static inline const char *recorder_file(char name[RECORDER_FILE], const struct recorder_folder *f,
                                        const char *signal)
{
    snprintf(name, RECORDER_FILE, "%s/%s.npy", f->part, signal);
    return name;
}

/* Create a folder next to `name`, under a name that does not exist yet. */
static inline const char *recorder_beside(char made[RECORDER_PATH], const char *name,
                                          const char *ending)
{
    enum { TRIES = 100 }; /* most folders that killed runs may have left behind */
    for (int i = 1; i <= TRIES; i++) {
        snprintf(made, RECORDER_PATH, i == 1 ? "%s.%s" : "%s.%s%d", name, ending, i);
        if (file_make_folder(made) == 0) {
            return NULL;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    made[0] = '\0';
    return strerror(errno);
}

/* Whether an entry of a folder belongs to a recording: NAME.npy. */
static inline bool recorder_is_file(const char *entry)
{
    const size_t n = strlen(entry);
    return n > 4 && strcmp(entry + n - 4, ".npy") == 0;
}

/* Delete a recording. */
static inline void recorder_remove(const char *folder)
{
    struct file_folder f;
    if (file_folder_open(&f, folder)) {
        for (const char *entry; (entry = file_folder_next(&f)) != NULL;) {
            char file[RECORDER_FILE];
            if (recorder_is_file(entry)) {
                snprintf(file, sizeof file, "%s/%s", folder, entry);
                file_remove(file);
            }
        }
        file_folder_close(&f);
    }
    file_remove_folder(folder);
}

/* Check that a recording may replace what has this name: an empty folder or an older recording. A
 * link is not replaced, because it may lead elsewhere. */
static inline const char *recorder_folder_check(const char *folder)
{
    file_stat s;
    if (file_look_at_link(folder, &s) != 0) {
        return errno == ENOENT ? NULL : strerror(errno);
    }
    struct file_folder f;
    if (!S_ISDIR(s.st_mode)) {
        return "not a folder";
    }
    if (!file_folder_open(&f, folder)) {
        return strerror(errno);
    }
    bool other = false, some = false, time = false;
    for (const char *entry; (entry = file_folder_next(&f)) != NULL;) {
        if (strcmp(entry, ".") != 0 && strcmp(entry, "..") != 0) {
            some = true;
            other = other || !recorder_is_file(entry);
            time = time || strcmp(entry, "time.npy") == 0;
        }
    }
    file_folder_close(&f);
    return other || (some && !time) ? "it holds something else than an older recording" : NULL;
}

static inline const char *recorder_folder_begin(struct recorder_folder *f, const char *folder)
{
    size_t n = strlen(folder);
    while (n > 1 && folder[n - 1] == '/') {
        n--;
    }
    if (n == 0 || n > RECORDER_PATH - 16) {
        return n == 0 ? "a name wanted" : strerror(ENAMETOOLONG);
    }
    memcpy(f->name, folder, n);
    const char *why = recorder_folder_check(f->name);
    return why ? why : recorder_beside(f->part, f->name, "part");
}

/* Rename the part, whose files are closed, to the name; on an error the old folder keeps it. */
static inline const char *recorder_folder_show(struct recorder_folder *f)
{
    file_stat s;
    char old[RECORDER_PATH] = "";
    const char *why = recorder_folder_check(f->name);
    if (!why && file_look_at_link(f->name, &s) == 0) {
        why = recorder_beside(old, f->name, "old");
        file_remove_folder(old);
        why = why || file_rename(f->name, old) == 0 ? why : strerror(errno);
    }
    if (why) {
        return why;
    }
    if (file_rename(f->part, f->name) != 0) {
        why = strerror(errno);
        if (old[0]) {
            file_rename(old, f->name);
        }
        return why;
    }
    f->part[0] = '\0';
    if (old[0]) {
        recorder_remove(old);
    }
    return NULL;
}

/* Remove the part, if it is still there; its files must be closed and removed. */
static inline void recorder_folder_drop(struct recorder_folder *f)
{
    if (f->part[0]) {
        file_remove_folder(f->part);
    }
}

#endif
