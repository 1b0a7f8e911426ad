/* binding - where the members of the structs lie that Python fills and reads.
 *
 * The shared library of the Python bindings is the cores' own functions and these tables, so Python
 * repeats no layout: a member is found under the name, type and unit given here.
 */
#ifndef BINDING_H
#define BINDING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct field {
    char name[24];
    char unit[16]; /* empty: none */
    int32_t kind;  /* i int32, l int64, u uint32, B uint8, d double, ? bool, c char */
    int32_t offset, count, stride; /* [byte], elements, [byte] from one to the next */
    int32_t times, over;           /* the member is what Python is given * times / over */
};

/* How a member counts what Python gives it: the same; mm/s for mm/min; clocks of 25 ns for seconds;
 * a bool the other way round. */
#define SAME       1, 1
#define PER_MINUTE 1, 60
#define SECONDS    40000000, 1
#define OPPOSITE   (-1), 1

/* A struct; without fields Python only keeps its bytes. */
struct table {
    const char *name;
    const struct field *field;
    size_t bytes, size; /* of the fields, of the struct */
};
/* Each up to a name NULL. */
extern const struct table MCC_TABLES[], ROBOT_TABLES[], GCODE_TABLES[], PLAN_TABLES[],
    NETCARD_TABLES[];

enum { BINDING_REPORTS = 64 }; /* room for all faults and notes of a part program */
struct fault_list;
struct fault_report;

/* All faults, then all notes, up to BINDING_REPORTS; how many of each, and whether there are
 * more faults. */
void binding_reports(const struct fault_list *all, struct fault_report *r, int32_t count[3]);

/* Of a member or of an array's elements. */
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

/* A member; an array. */
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
