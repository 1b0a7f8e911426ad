/* fmu_input - opening a file that an FMU reads. It must be a regular file: a pipe or a device could
 * block the importer. */
#ifndef FMU_INPUT_H
#define FMU_INPUT_H

#include "fmu_file.h"

#ifndef _WIN32
#include <fcntl.h>
#include <unistd.h>
#endif

/* Open a regular file for reading, without waiting for a pipe's writer. Returns NULL, or what is
 * wrong. */
static const char *file_open(const char *name, FILE **file)
{
    file_stat s;
    *file = NULL;
#ifdef _WIN32
    const char *why = file_look(name, &s) ? strerror(errno) : file_regular(&s);
    *file = why ? NULL : file_read(name);
    return why || *file ? why : strerror(errno);
#else
    const int fd = open(name, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0) {
        return strerror(errno);
    }
    const char *why = fstat(fd, &s) ? strerror(errno) : file_regular(&s);
    *file = why ? NULL : fdopen(fd, "rb");
    if (!*file) {
        why = why ? why : strerror(errno);
        close(fd);
    }
    return why;
#endif
}

#endif
