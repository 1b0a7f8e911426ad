/* The folder of a recording: written under another name, shown in full at the end. Functions
 * return NULL, or words for what is wrong. */
#ifndef FMU_RECORDER_FOLDER_H
#define FMU_RECORDER_FOLDER_H

#include <dirent.h>
#include <stdbool.h>
#include <stdint.h>

#include "fmu_file.h"

#ifdef _WIN32
#include <direct.h>
#include <io.h>
#else
#include <unistd.h>
#endif

enum {
    RECORDER_PATH = 1100,                /* [byte] of a folder's name */
    RECORDER_FILE = RECORDER_PATH + 300, /* of a file's in it */
    RECORDER_WHY  = RECORDER_FILE + 200
};

struct recorder_folder {
    char name[RECORDER_PATH];
    char part[RECORDER_PATH]; /* where it is written; "" if there is none */
};

static inline int recorder_make(const char *folder)
{
#ifdef _WIN32
    return _mkdir(folder);
#else
    return mkdir(folder, 0777);
#endif
}

static inline int recorder_unmake(const char *folder)
{
#ifdef _WIN32
    return _rmdir(folder);
#else
    return rmdir(folder);
#endif
}

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

/* Name of the file of a signal while it is written. */
static inline const char *recorder_file(char name[RECORDER_FILE], const struct recorder_folder *f,
                                        const char *signal)
{
    snprintf(name, RECORDER_FILE, "%s/%s.npy", f->part, signal);
    return name;
}

/* A folder next to another, under a name that is nobody's yet. */
static inline const char *recorder_beside(char made[RECORDER_PATH], const char *name,
                                          const char *ending)
{
    enum { TRIES = 100 }; /* folders that killed runs have left, at most */
    for (int i = 1; i <= TRIES; i++) {
        snprintf(made, RECORDER_PATH, i == 1 ? "%s.%s" : "%s.%s%d", name, ending, i);
        if (recorder_make(made) == 0) {
            return NULL;
        }
        if (errno != EEXIST) {
            break;
        }
    }
    made[0] = '\0';
    return strerror(errno);
}

/* Is that an entry of a recording? */
static inline bool recorder_is_file(const char *entry)
{
    const size_t n = strlen(entry);
    return n > 4 && strcmp(entry + n - 4, ".npy") == 0;
}

/* Delete a recording. */
static inline void recorder_remove(const char *folder)
{
    DIR *d = opendir(folder);
    for (const struct dirent *e; d && (e = readdir(d));) {
        char file[RECORDER_FILE];
        if (recorder_is_file(e->d_name)) {
            snprintf(file, sizeof file, "%s/%s", folder, e->d_name);
            remove(file);
        }
    }
    if (d) {
        closedir(d);
    }
    recorder_unmake(folder);
}

/* May a recording take this name? A link is not replaced: it may be somebody's way elsewhere. */
static inline const char *recorder_folder_check(const char *folder)
{
    file_stat s;
    if (FILE_LSTAT(folder, &s) != 0) {
        return errno == ENOENT ? NULL : strerror(errno);
    }
    DIR *d = S_ISDIR(s.st_mode) ? opendir(folder) : NULL;
    if (!d) {
        return S_ISDIR(s.st_mode) ? strerror(errno) : "not a folder";
    }
    bool other = false, some = false, time = false;
    for (const struct dirent *e; (e = readdir(d));) {
        if (strcmp(e->d_name, ".") != 0 && strcmp(e->d_name, "..") != 0) {
            some = true;
            other = other || !recorder_is_file(e->d_name);
            time = time || strcmp(e->d_name, "time.npy") == 0;
        }
    }
    closedir(d);
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

/* The part, whose files are closed, gets the name; on an error what had it still has it. */
static inline const char *recorder_folder_show(struct recorder_folder *f)
{
    file_stat s;
    char old[RECORDER_PATH] = "";
    const char *why = recorder_folder_check(f->name);
    if (!why && FILE_LSTAT(f->name, &s) == 0) {
        why = recorder_beside(old, f->name, "old");
        recorder_unmake(old);
        why = why || rename(f->name, old) == 0 ? why : strerror(errno);
    }
    if (why) {
        return why;
    }
    if (rename(f->part, f->name) != 0) {
        why = strerror(errno);
        if (old[0]) {
            rename(old, f->name);
        }
        return why;
    }
    f->part[0] = '\0';
    if (old[0]) {
        recorder_remove(old);
    }
    return NULL;
}

/* What is left of it goes; its files are closed and removed. */
static inline void recorder_folder_drop(struct recorder_folder *f)
{
    if (f->part[0]) {
        recorder_unmake(f->part);
    }
}

#endif
