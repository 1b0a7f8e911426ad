/* binding - tables of the C structs that Python fills and reads: name, unit, type and place of each
 * member.
 *
 * The shared library of the Python bindings consists of the cores' own functions and these tables,
 * so Python repeats no layout: it finds a member by its name here.
 */
#ifndef BINDING_H
#define BINDING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A member of a struct. */
struct field {
    char name[24]; /* its name in Python */
    char unit[16]; /* its unit in Python; "": none */
    int32_t kind;  /* i int32, l int64, u uint32, B uint8, d double, ? bool, c char */
    int32_t offset, count, stride; /* place [byte]; elements; [byte] to the next one */
    int32_t times, over;           /* value of the member = value in Python * times / over */
};

/* Conversions (times, over) from Python to the member: none; mm/min to mm/s; seconds to clocks of
 * 25 ns; a bool inverted. */
#define SAME       1, 1
#define PER_MINUTE 1, 60
#define SECONDS    40000000, 1
#define OPPOSITE   (-1), 1

/* A struct; one without fields is only bytes for Python. */
struct table {
    const char *name;
    const struct field *field; /* its members */
    size_t bytes, size;        /* [byte] size of `field`; of the struct */
};
/* The structs of each binding; the last row has the name NULL. */
extern const struct table MCC_TABLES[], ROBOT_TABLES[], GCODE_TABLES[], PLAN_TABLES[],
    NETCARD_TABLES[];

enum { BINDING_REPORTS = 64 }; /* room for all faults and notes of a part program */
struct fault_list;
struct fault_report;

/* Copy the faults and then the notes of a list to r, BINDING_REPORTS at most. count is the number
 * of faults, the number of notes, and whether there are more faults. */
void binding_reports(const struct fault_list *all, struct fault_report *r, int32_t count[3]);

/* The letter of struct field.kind for a member, or for an array's elements. */
#define KIND(x) \
    _Generic((x), \
        int32_t: 'i', \
        int64_t: 'l', \
        uint32_t: 'u', \
        double: 'd', \
        bool: '?', \
        char: 'c', \
        uint8_t: 'B', \
        int32_t *: 'i', \
        int64_t *: 'l', \
        uint32_t *: 'u', \
        double *: 'd', \
        bool *: '?')
#define OFFSET(type, m) (int32_t) offsetof(struct type, m)
#define SIZE(type, m)   (int32_t)sizeof(((struct type *)0)->m)

/* Rows of struct field for a member (ONE) and for an array (ROW); _IN with a conversion. */
#define ONE_IN(type, m, name, unit, ...) \
    { name, unit, KIND(((struct type *)0)->m), OFFSET(type, m), 1, SIZE(type, m), __VA_ARGS__ }
#define ROW_IN(type, m, name, unit, ...) \
    { name, \
      unit, \
      KIND(((struct type *)0)->m[0]), \
      OFFSET(type, m), \
      SIZE(type, m) / SIZE(type, m[0]), \
      SIZE(type, m[0]), \
      __VA_ARGS__ }
#define ONE(type, m, name, unit) ONE_IN(type, m, name, unit, SAME)
#define ROW(type, m, name, unit) ROW_IN(type, m, name, unit, SAME)

#endif
