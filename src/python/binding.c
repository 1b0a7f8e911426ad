#include "binding.h"

#include <string.h>

/* Fields of the struct with the name `of`, their number and the struct's size in bytes. NULL and
 * *count = -1 if there is no such struct; NULL also for a struct without fields. */
const struct field *binding_fields(const char *of, int32_t *count, int64_t *size)
{
    const struct table *const all[] = { MCC_TABLES, ROBOT_TABLES, GCODE_TABLES, PLAN_TABLES,
                                        NETCARD_TABLES };

    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        for (const struct table *t = all[i]; t->name; t++) {
            if (strcmp(of, t->name) == 0) {
                *count = (int32_t)(t->bytes / sizeof(struct field));
                *size = (int64_t)t->size;
                return t->field;
            }
        }
    }
    *count = -1;
    return NULL;
}
