#include "binding_log.h"

#include <stdarg.h>
#include <stdio.h>

enum { TEXT_MAX = 4096 };

void binding_log(void *environment, const char *name, int status, const char *category,
                 const char *format, ...)
{
    const struct binding_log *to = environment;
    char text[TEXT_MAX];
    va_list values;

    (void)name;
    (void)category;
    if (!to || !format)
        return;
    va_start(values, format);
    vsnprintf(text, sizeof text, format, values);
    va_end(values);
    to->told(status, text);
}
