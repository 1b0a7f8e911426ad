/* binding_log - the logger that an FMU of FMI 2 is given.
 *
 * It gets a format and values for it, which Python cannot take.
 */
#ifndef BINDING_LOG_H
#define BINDING_LOG_H

/* The environment of an instance; it lives as long as that. */
struct binding_log {
    void (*told)(int status, const char *text);
};

/* fmi2CallbackLogger: makes the text and tells it; an FMU without an environment tells nothing. */
void binding_log(void *environment, const char *name, int status, const char *category,
                 const char *format, ...);

#endif
