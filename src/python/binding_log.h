/* binding_log - logger callback for FMUs of FMI 2.0: the FMU calls it with a printf format and its
 * values, which a Python callback cannot take, so it makes the text and passes that on. */
#ifndef BINDING_LOG_H
#define BINDING_LOG_H

/* componentEnvironment of an instance; it must live as long as the instance. */
struct binding_log {
    void (*told)(int status, const char *text);
};

/* An fmi2CallbackLogger that passes the text to `told`; without an environment it does nothing. */
void binding_log(void *environment, const char *name, int status, const char *category,
                 const char *format, ...);

#endif
