#include "expression.h"

#include <math.h>
#include <string.h>

#include "elementary.h"
#include "modes.h"

static const double EQUAL = 1e-6; /* EQ: values differ by less, as LinuxCNC documents it */
static const double DEGREE = 0.017453292519943295;
static const double BITS_MOST = 2147483647.5; /* numbers below it, rounded, have 32 bits */
enum { DEEPEST = 30 };                        /* brackets, signs and # within one another */

enum operation {
    POWER,
    TIMES,
    DIVIDED,
    MODULO,
    PLUS,
    MINUS,
    EQUALS,
    DIFFERS,
    GREATER,
    AT_LEAST,
    LESS,
    AT_MOST,
    AND,
    OR,
    XOR,
    NO_OPERATION
};

static bool of_fanuc(const struct reading *s)
{
    return s->program && s->program->fanuc;
}

/* Precedence of an operation: the higher one is applied first. */
static int rank(enum operation o, bool fanuc)
{
    const int logic = !fanuc ? 1 : o == AND ? 4 : 3;
    return o == POWER ? 5 : o <= MODULO ? 4 : o <= MINUS ? 3 : o <= AT_MOST ? 2 : logic;
}

/* Take the next operation. */
static enum operation operation(struct reading *s)
{
    static const struct {
        char word[4];
        enum operation is;
    } words[] = {
        { "**", POWER },   { "*", TIMES },     { "/", DIVIDED }, { "+", PLUS },
        { "-", MINUS },    { "MOD", MODULO },  { "EQ", EQUALS }, { "NE", DIFFERS },
        { "GT", GREATER }, { "GE", AT_LEAST }, { "LT", LESS },   { "LE", AT_MOST },
        { "AND", AND },    { "OR", OR },       { "XOR", XOR },
    };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        if (reading_word(s, words[i].word)) {
            return words[i].is;
        }
    }
    return NO_OPERATION;
}

/* Remainder of a / b that is never negative: 0 <= remainder < |b|. */
static double modulo(double a, double b)
{
    const double rest = fmod(a, b);
    return rest < 0.0 ? rest + fabs(b) : rest;
}

/* CCN 19: a case for each operation. */
static double apply(enum operation o, double a, double b)
{
    switch (o) {
    case POWER:        return el_pow(a, b);
    case TIMES:        return a * b;
    case DIVIDED:      return a / b;
    case MODULO:       return modulo(a, b);
    case PLUS:         return a + b;
    case MINUS:        return a - b;
    case EQUALS:       return fabs(a - b) < EQUAL;
    case DIFFERS:      return fabs(a - b) >= EQUAL;
    case GREATER:      return a > b;
    case AT_LEAST:     return a >= b;
    case LESS:         return a < b;
    case AT_MOST:      return a <= b;
    case AND:          return a != 0.0 && b != 0.0;
    case OR:           return a != 0.0 || b != 0.0;
    case XOR:          return (a != 0.0) != (b != 0.0);
    case NO_OPERATION: break;
    }
    return 0.0;
}

/* AND, OR, XOR of the bits of two values, rounded to whole numbers; false: one is too large. */
static bool apply_bits(enum operation o, double a, double b, double *value)
{
    if (!(fabs(a) < BITS_MOST && fabs(b) < BITS_MOST)) {
        return false;
    }
    const int32_t i = (int32_t)round(a), k = (int32_t)round(b);
    *value = o == AND ? i & k : o == OR ? i | k : i ^ k;
    return true;
}

/* Apply an operation to what stands left and right of it, into *value.
 * CCN 16: each operation refuses operands of its own: vacant ones, 0, negative ones, broken
 * ones. */
static enum fault join(struct reading *s, enum operation o, int32_t from, double right,
                       double *value)
{
    const bool vacant = parameters_vacant(*value), other = parameters_vacant(right);

    if ((o == EQUALS || o == DIFFERS) && (vacant || other)) {
        *value = (vacant && other) == (o == EQUALS);
        return FAULT_NONE;
    }
    const double left = parameters_number(*value);
    right = parameters_number(right);
    if ((o == DIVIDED || o == MODULO) && right == 0.0) {
        return reading_fault(s, FAULT_DIVISION, from);
    }
    if (o == POWER && left < 0.0 && right != floor(right)) {
        return reading_fault(s, FAULT_ARGUMENT, from);
    }
    if (o >= AND && of_fanuc(s)) {
        return apply_bits(o, left, right, value) ? FAULT_NONE
                                                 : reading_fault(s, FAULT_ARGUMENT, from);
    }
    *value = apply(o, left, right);
    return isfinite(*value) ? FAULT_NONE : reading_fault(s, FAULT_LARGE, from);
}

static enum fault value_of(struct reading *s, int32_t from, double *value, bool *whole);

/* Read value, operation, value, ... up to an operation whose precedence is below `least`. Without
 * brackets around it (`bare`) it also ends where no operation follows. */
static enum fault chain(struct reading *s, int least, bool bare, double *value)
{
    const int32_t from = s->at;
    bool whole;
    enum fault f = value_of(s, from - 1, value, &whole); /* from the [ or operation in front */

    while (f == FAULT_NONE && reading_peek(s) != ']' && s->at < s->end) {
        const int32_t at = s->at;
        const enum operation o = operation(s);
        double right;
        if (o == NO_OPERATION && bare) {
            s->at = at;
            return FAULT_NONE;
        }
        if (o == NO_OPERATION) {
            s->at += s->at < s->end;
            return reading_fault(s, FAULT_OPERATOR, at);
        }
        if (rank(o, of_fanuc(s)) < least) {
            s->at = at;
            return FAULT_NONE;
        }
        f = chain(s, rank(o, of_fanuc(s)) + 1, bare, &right);
        f = f == FAULT_NONE ? join(s, o, from, right, value) : f;
    }
    return f;
}

/* Read an expression in brackets; its value may be vacant. */
static enum fault brackets(struct reading *s, double *value)
{
    const int32_t from = s->at;

    if (!reading_take(s, '[')) {
        s->at += s->at < s->end;
        return reading_fault(s, FAULT_BRACKET, from);
    }
    if (s->depth == DEEPEST) {
        return reading_fault(s, FAULT_DEEP, from);
    }
    s->depth++;
    enum fault f = chain(s, 1, false, value);
    if (f == FAULT_NONE && !reading_take(s, ']')) {
        f = reading_fault(s, FAULT_BRACKET, from);
    }
    s->depth--;
    return f;
}

enum fault expression_brackets(struct reading *s, double *value)
{
    const enum fault f = brackets(s, value);
    *value = f == FAULT_NONE ? parameters_number(*value) : *value;
    return f;
}

enum fault expression_bare(struct reading *s, double *value)
{
    return chain(s, 1, true, value);
}

enum function {
    ABS,
    ACOS,
    ASIN,
    ATAN,
    COS,
    EXISTS,
    EXP,
    FIX,
    FUP,
    LN,
    ROUND,
    SIN,
    SQRT,
    TAN,
    NO_FUNCTION
};

static enum function function(struct reading *s)
{
    static const char words[NO_FUNCTION][8] = { "ABS",    "ACOS", "ASIN", "ATAN", "COS",
                                                "EXISTS", "EXP",  "FIX",  "FUP",  "LN",
                                                "ROUND",  "SIN",  "SQRT", "TAN" };
    int i = 0;
    while (i < NO_FUNCTION && !reading_word(s, words[i])) {
        i++;
    }
    return (enum function)i;
}

/* FIX and FUP of Fanuc's controls go towards 0 and away from it.
 * CCN 20: a case for each function. */
static double of(enum function f, double x, bool fanuc)
{
    switch (f) {
    case ABS:  return fabs(x);
    case ACOS: return el_acos(x) / DEGREE;
    case ASIN: return el_asin(x) / DEGREE;
    case COS:  return el_cos(x * DEGREE);
    case EXP:  return el_exp(x);
    case FIX: /* + 0.0 makes 0 of -0, which ATAN tells apart */
        return (fanuc && x < 0.0 ? ceil(x) : floor(x)) + 0.0;
    case FUP:         return (fanuc && x < 0.0 ? floor(x) : ceil(x)) + 0.0;
    case LN:          return el_log(x);
    case ROUND:       return round(x) + 0.0;
    case SIN:         return el_sin(x * DEGREE);
    case SQRT:        return sqrt(x);
    case TAN:         return el_tan(x * DEGREE);
    case ATAN:
    case EXISTS:
    case NO_FUNCTION: break;
    }
    return 0.0;
}

/* [#<name>]: 1 if it has been set. */
static enum fault exists(struct reading *s, int32_t from, double *value)
{
    struct parameter which;

    if (!reading_take(s, '[') || !reading_take(s, '#')) {
        return reading_fault(s, FAULT_EXISTS, from);
    }
    const enum fault f = expression_parameter(s, &which);
    if (f != FAULT_NONE) {
        return f;
    }
    if (which.number || !reading_take(s, ']')) {
        return reading_fault(s, FAULT_EXISTS, from);
    }
    *value = parameters_get(s->in, s->program, &which, value) == FAULT_NONE;
    return FAULT_NONE;
}

/* CCN 16: EXISTS and ATAN have brackets of their own, and each function its arguments. */
static enum fault call(struct reading *s, int32_t from, double *value)
{
    const int32_t at = s->at;
    const enum function g = function(s);
    double x, y = 0.0;

    if (g == NO_FUNCTION) {
        return reading_fault(s, FAULT_NUMBER, from);
    }
    if (g == EXISTS) {
        return exists(s, at, value);
    }
    enum fault f = expression_brackets(s, &x);
    if (f == FAULT_NONE && g == ATAN) {
        if (!reading_take(s, '/')) {
            return reading_fault(s, FAULT_ATAN, at);
        }
        f = expression_brackets(s, &y);
    }
    if (f != FAULT_NONE) {
        return f;
    }
    if (((g == ACOS || g == ASIN) && fabs(x) > 1.0) || (g == SQRT && x < 0.0)
        || (g == LN && x <= 0.0)) {
        return reading_fault(s, FAULT_ARGUMENT, at);
    }
    *value = g == ATAN ? el_atan2(x, y) / DEGREE : of(g, x, of_fanuc(s));
    return isfinite(*value) ? FAULT_NONE : reading_fault(s, FAULT_LARGE, at);
}

enum fault expression_parameter(struct reading *s, struct parameter *which)
{
    const int32_t from = s->at - 1;
    double number;
    bool whole;

    which->number = 0;
    if (!s->in) {
        return reading_fault(s, FAULT_PARAMETER, from);
    }
    if (reading_take(s, '<')) {
        return reading_name(s, from, which->name);
    }
    const enum fault f = expression_value(s, from, &number, &whole);
    if (f != FAULT_NONE) {
        return f;
    }
    const bool good = reading_integer(number, &which->number);
    if (good && which->number == 0 && of_fanuc(s)) {
        which->number = PARAMETERS_ZERO;
        return FAULT_NONE;
    }
    return good && which->number > 0 ? FAULT_NONE : reading_fault(s, FAULT_PARAMETER, from);
}

/* Read a sign and the value behind it, which is no number. */
static enum fault signed_value(struct reading *s, int32_t from, double *value, bool *whole)
{
    const bool minus = reading_peek(s) == '-';

    if (s->depth == DEEPEST) {
        return reading_fault(s, FAULT_DEEP, from);
    }
    s->at++;
    s->depth++;
    const enum fault f = value_of(s, from, value, whole);
    s->depth--;
    *value = f == FAULT_NONE && minus ? -parameters_number(*value) : *value;
    return f;
}

/* Whether a parameter, brackets, a function or another sign stands behind the sign at s. */
static bool sign_of_value(const struct reading *s)
{
    int32_t i = s->at + 1;

    while (i < s->end && reading_blank(s->text[i])) {
        i++;
    }
    return i < s->end
           && (s->text[i] == '#' || s->text[i] == '[' || s->text[i] == '-' || s->text[i] == '+'
               || reading_letter(s->text[i]));
}

/* Read a value, which may be vacant. */
static enum fault value_of(struct reading *s, int32_t from, double *value, bool *whole)
{
    const char c = reading_peek(s);
    const int32_t at = s->at;

    if (reading_digit(c) || c == '.') {
        return reading_number(s, from, value, whole);
    }
    *whole = false;
    *value = 0.0;
    if ((c == '+' || c == '-') && !sign_of_value(s)) {
        return reading_number(s, from, value, whole);
    }
    if (c == '+' || c == '-') {
        return signed_value(s, from, value, whole);
    }
    if (c == '[') {
        return brackets(s, value);
    }
    if (c == '#') {
        struct parameter which;
        if (s->depth == DEEPEST) {
            return reading_fault(s, FAULT_DEEP, from);
        }
        s->at++;
        s->depth++;
        enum fault f = expression_parameter(s, &which);
        s->depth--;
        if (f == FAULT_NONE) {
            f = parameters_get(s->in, s->program, &which, value);
            f = f != FAULT_NONE ? reading_fault(s, f, at) : f;
        }
        return f;
    }
    return reading_letter(c) ? call(s, from, value) : reading_number(s, from, value, whole);
}

enum fault expression_or_vacant(struct reading *s, int32_t from, double *value, bool *whole)
{
    return value_of(s, from, value, whole);
}

enum fault expression_value(struct reading *s, int32_t from, double *value, bool *whole)
{
    const enum fault f = value_of(s, from, value, whole);
    *value = f == FAULT_NONE ? parameters_number(*value) : *value;
    return f;
}
