/* fmu_file - files and folders by names in UTF-8 on every system, for the files that an FMU reads
 * (fmu_input.h) and writes (fmu_output.h, fmu_recorder_folder.h). Windows would take such a name in
 * the user's code page and refuse 260 characters; so there names become UTF-16, and long ones
 * absolute with the prefix \\?\. Functions return like those of the C library and set errno. */
#ifndef FMU_FILE_H
#define FMU_FILE_H

#include <errno.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#ifdef _WIN32
#include <direct.h>
#include <fcntl.h>
#include <io.h>
#include <wchar.h>

#ifndef S_ISREG
#define S_ISREG(mode) (((mode) & _S_IFMT) == _S_IFREG)
#define S_ISDIR(mode) (((mode) & _S_IFMT) == _S_IFDIR)
#endif

typedef struct _stat64 file_stat;

/* A name in UTF-16. */
enum { FILE_WIDE = 4096, FILE_SHORT = 248 }; /* a folder of that length is too long already */
struct file_wide {
    wchar_t text[FILE_WIDE + 10];
}; /* with a head, and a pattern behind it */

/* Read the UTF-8 character at *p and move *p behind it; 0 at the end, UINT32_MAX if it is not
 * valid.
 * CCN 17: the ranges of UTF-8: of the first byte, of the others, and of the character. */
static inline uint32_t file_character(const char **p)
{
    const unsigned char *at = (const unsigned char *)*p;
    const uint32_t head = at[0];
    const int more = head < 0x80   ? 0
                     : head < 0xc2 ? -1
                     : head < 0xe0 ? 1
                     : head < 0xf0 ? 2
                     : head < 0xf5 ? 3
                                   : -1;
    uint32_t c = more <= 0 ? head : head & (0x3fu >> more);
    for (int i = 1; i <= more; i++) {
        if ((at[i] & 0xc0) != 0x80) {
            return UINT32_MAX;
        }
        c = c << 6 | (at[i] & 0x3fu);
    }
    const uint32_t least = more == 3 ? 0x10000 : more == 2 ? 0x800 : 0;
    if (more < 0 || c < least || c > 0x10ffff || (c >= 0xd800 && c < 0xe000)) {
        return UINT32_MAX;
    }
    *p += head ? more + 1 : 0;
    return c;
}

/* Convert a name to UTF-16. False, with errno, if it is not UTF-8 or too long. */
static inline bool file_utf16(struct file_wide *w, const char *name)
{
    size_t n = 0;
    for (uint32_t c; (c = file_character(&name)) != 0;) {
        if (c == UINT32_MAX || n + 2 >= FILE_WIDE) {
            errno = c == UINT32_MAX ? EILSEQ : ENAMETOOLONG;
            return false;
        }
        if (c >= 0x10000) {
            w->text[n++] = (wchar_t)(0xd800 + ((c - 0x10000) >> 10));
            c = 0xdc00 + (c & 0x3ff);
        }
        w->text[n++] = (wchar_t)c;
    }
    w->text[n] = L'\0';
    return true;
}

/* Convert a name to the form that Windows takes. */
static inline bool file_widen(struct file_wide *w, const char *name)
{
    struct file_wide whole; /* from the root on */
    if (!file_utf16(w, name)) {
        return false;
    }
    const bool known = _wfullpath(whole.text, w->text, FILE_WIDE) != NULL;
    if (!known || wcslen(whole.text) < FILE_SHORT || wcsncmp(whole.text, L"\\\\?\\", 4) == 0) {
        return true;
    }
    const bool share = wcsncmp(whole.text, L"\\\\", 2) == 0; /* \\?\UNC\server\share */
    wcscpy(w->text, share ? L"\\\\?\\UNC" : L"\\\\?\\");
    wcscat(w->text, whole.text + share);
    return true;
}

/* As stat(): links are followed. */
static inline int file_look(const char *name, file_stat *s)
{
    struct file_wide w;
    return file_widen(&w, name) ? _wstat64(w.text, s) : -1;
}

static inline int file_look_at_link(const char *name, file_stat *s)
{
    return file_look(name, s);
}

static inline FILE *file_read(const char *name)
{
    struct file_wide w;
    return file_widen(&w, name) ? _wfopen(w.text, L"rb") : NULL;
}

/* Create a file for writing; fails if it exists. */
static inline FILE *file_create(const char *name)
{
    struct file_wide w;
    const int fd = file_widen(&w, name) ? _wopen(w.text, _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY,
                                                 _S_IREAD | _S_IWRITE)
                                        : -1;
    FILE *file = fd >= 0 ? _fdopen(fd, "wb") : NULL;
    if (fd >= 0 && !file) {
        _close(fd);
    }
    return file;
}

static inline int file_remove(const char *name)
{
    struct file_wide w;
    return file_widen(&w, name) ? _wremove(w.text) : -1;
}

static inline int file_rename(const char *from, const char *to)
{
    struct file_wide a, b;
    return file_widen(&a, from) && file_widen(&b, to) ? _wrename(a.text, b.text) : -1;
}

static inline int file_make_folder(const char *name)
{
    struct file_wide w;
    return file_widen(&w, name) ? _wmkdir(w.text) : -1;
}

static inline int file_remove_folder(const char *name)
{
    struct file_wide w;
    return file_widen(&w, name) ? _wrmdir(w.text) : -1;
}

/* BY_HANDLE_FILE_INFORMATION of windows.h, which is not included because its macros collide with
 * names of the cores. */
struct file_identity {
    unsigned long before[7], volume, between[3], number[2];
};
__declspec(dllimport) int __stdcall GetFileInformationByHandle(void *, struct file_identity *);

static inline bool file_identify(const char *name, struct file_identity *i)
{
    struct file_wide w;
    const int fd = file_widen(&w, name) ? _wopen(w.text, _O_RDONLY | _O_BINARY) : -1;
    const bool good = fd >= 0 && GetFileInformationByHandle((void *)_get_osfhandle(fd), i);
    if (fd >= 0) {
        _close(fd);
    }
    return good;
}

/* Whether both names are of the same file; false if one does not exist. */
static inline bool file_same(const char *a, const char *b)
{
    struct file_identity i, j;
    return file_identify(a, &i) && file_identify(b, &j) && i.volume == j.volume
           && memcmp(i.number, j.number, sizeof i.number) == 0;
}

/* The entries of a folder, one after the other. */
struct file_folder {
    intptr_t handle;
    bool first;
    struct _wfinddata64_t found;
    char name[4 * _MAX_PATH]; /* in UTF-8 */
};

static inline bool file_folder_open(struct file_folder *f, const char *name)
{
    struct file_wide w;
    f->first = true;
    f->handle = -1;
    if (file_widen(&w, name)) {
        wcscat(w.text, L"\\*");
        f->handle = _wfindfirst64(w.text, &f->found);
    }
    return f->handle != -1;
}

/* The next name, or NULL. */
static inline const char *file_folder_next(struct file_folder *f)
{
    if (!f->first && _wfindnext64(f->handle, &f->found) != 0) {
        return NULL;
    }
    f->first = false;
    char *out = f->name;
    for (const wchar_t *p = f->found.name; *p; p++) {
        const bool pair = (*p & 0xfc00) == 0xd800 && (p[1] & 0xfc00) == 0xdc00;
        const uint32_t c = pair ? 0x10000u + ((*p & 0x3ffu) << 10) + (p[1] & 0x3ffu) : *p;
        const int more = c < 0x80 ? 0 : c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
        *out++ = (char)(more == 0 ? c : (0xf0u << (3 - more) & 0xffu) | c >> 6 * more);
        for (int i = more - 1; i >= 0; i--) {
            *out++ = (char)(0x80 | (c >> 6 * i & 0x3f));
        }
        p += pair;
    }
    *out = '\0';
    return f->name;
}

static inline void file_folder_close(struct file_folder *f)
{
    _findclose(f->handle);
}
#else
#include <dirent.h>
#include <unistd.h>

typedef struct stat file_stat;

static inline int file_look(const char *name, file_stat *s)
{
    return stat(name, s);
}

static inline int file_look_at_link(const char *name, file_stat *s)
{
    return lstat(name, s);
}

static inline FILE *file_create(const char *name)
{
    return fopen(name, "wbx");
}

static inline int file_remove(const char *name)
{
    return remove(name);
}

static inline int file_rename(const char *from, const char *to)
{
    return rename(from, to);
}

static inline int file_make_folder(const char *name)
{
    return mkdir(name, 0777);
}

static inline int file_remove_folder(const char *name)
{
    return rmdir(name);
}

static inline bool file_same(const char *a, const char *b)
{
    file_stat s, t;
    return stat(a, &s) == 0 && stat(b, &t) == 0 && s.st_dev == t.st_dev && s.st_ino == t.st_ino;
}

struct file_folder {
    DIR *handle;
};

static inline bool file_folder_open(struct file_folder *f, const char *name)
{
    f->handle = opendir(name);
    return f->handle;
}

static inline const char *file_folder_next(struct file_folder *f)
{
    const struct dirent *e = readdir(f->handle);
    return e ? e->d_name : NULL;
}

static inline void file_folder_close(struct file_folder *f)
{
    closedir(f->handle);
}
#endif

/* NULL for a regular file, else a text for what it is. */
static inline const char *file_regular(const file_stat *s)
{
    return S_ISREG(s->st_mode)   ? NULL
           : S_ISDIR(s->st_mode) ? strerror(EISDIR)
                                 : "not a regular file";
}

#endif
