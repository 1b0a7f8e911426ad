/* Kinds of files, for what an FMU reads (fmu_input.h) and writes (fmu_output.h). */
#ifndef FMU_FILE_H
#define FMU_FILE_H

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#ifdef _WIN32
#define FILE_STAT   _stat64
#define FILE_LSTAT  _stat64 /* links are followed */
#define S_ISREG(m)  (((m) & _S_IFMT) == _S_IFREG)
#define S_ISDIR(m)  (((m) & _S_IFMT) == _S_IFDIR)
typedef struct __stat64 file_stat;
#else
#define FILE_STAT   stat
#define FILE_LSTAT  lstat
typedef struct stat file_stat;
#endif

static inline const char *file_regular(const file_stat *s)
{
    return S_ISREG(s->st_mode) ? NULL
           : S_ISDIR(s->st_mode) ? strerror(EISDIR) : "not a regular file";
}

#endif
