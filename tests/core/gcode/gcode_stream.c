/* A program is read through a window: any length, any place to go on from, at a known speed. */
#include <time.h>

#include "gcode_reader.h"

/* A source that shows no byte more than it must, in a buffer that the next call spoils. */
struct narrow {
    const char *text;
    int64_t length;
    int64_t fails_from; /* offset from which it cannot be read */
    char window[SOURCE_WINDOW];
};

static int64_t narrow_look(void *context, const char *file, int64_t offset, const char **text)
{
    if (file[0]) {
        return SOURCE_NONE;
    }
    struct narrow *n = context;
    const int64_t left = n->length - offset;
    const int64_t there = left < SOURCE_WINDOW ? left : SOURCE_WINDOW;

    memset(n->window, '$', sizeof n->window); /* no character of a program */
    if (offset + there > n->fails_from) {
        return -1;
    }
    memcpy(n->window, n->text + offset, (size_t)there);
    *text = n->window;
    return there;
}

static struct narrow narrow(struct reader *x, const char *text)
{
    begin(x, text);
    return (struct narrow){ text, (int64_t)strlen(text), INT64_MAX, { 0 } };
}

static const char part[] =
    "%\n( with all that streams )\r\nG10 L2 P1 X5\nG64 G1 X1 F600 M3 S100\r\n\n\nG3 X3 I1 P2 M0\n"
    "M62 P1\nG28 X1\nG92 X0\n"
    "(a line as long as a line may be:                                               "
    "                                                                                "
    "                                                                                "
    "               )\r\nG1 X7 Y1\n"
    "G4 P0.5\nM30";

/* The same commands come from a window as from memory, also from a copy of the state. */
static void windows(void)
{
    struct reader whole, x;
    struct narrow n = narrow(&x, part);
    const struct source s = { narrow_look, &n };

    begin(&whole, part);
    x.program.source = &s;
    int count = 0, want;
    do {
        const struct interpreter kept = x.in;
        struct command first;
        want = next(&whole);
        CHECK_EQ(next(&x), want);
        CHECK(want < 0 || !memcmp(&x.c, &whole.c, sizeof x.c));
        CHECK(!memcmp(&x.in, &whole.in, sizeof x.in));
        first = x.c;
        x.in = kept; /* once more from where the copy stands */
        CHECK_EQ(next(&x), want);
        CHECK(want < 0 || !memcmp(&x.c, &first, sizeof first));
        count++;
    } while (want >= 0);
    CHECK_EQ(want, -1);
    CHECK_EQ(count, 10);
    CHECK_EQ(x.in.line, 14);
}

/* 256 characters are a line whatever ends it, 257 are none; the line is named wherever it
 * stands. */
static void longest_line(void)
{
    static const char *const ends[] = { "\n", "\r\n", "", "\r" };
    for (int i = 0; i < 4; i++) {
        for (int length = 255; length <= 600; length += length < 259 ? 1 : 341) {
            char text[1000] = "G1 X1\nG1 X2\n";
            struct reader x;
            const size_t at = strlen(text);
            memset(text + at, ' ', (size_t)length);
            memcpy(text + at, "X3 ;", 4);
            strcpy(text + at + length, ends[i]);
            strcat(text, i < 2 ? "X4" : "");
            struct narrow n = narrow(&x, text);
            const struct source s = { narrow_look, &n };
            struct fault_report r;
            x.program.source = &s;
            interpreter_check(&x.in, &x.program, &r);
            CHECK_EQ(r.fault, length <= 256 ? FAULT_NONE : FAULT_LINE_LENGTH);
            CHECK(length <= 256 || (r.line == 3 && r.offset == (int64_t)at && r.length == 256));
        }
    }
}

/* A byte 0 is told with its line wherever it stands, in a comment or a line too long as well. */
static void zero_bytes(void)
{
    char text[] = "G1 X1\n(a comment) ; and another\nX2\n";
    const int64_t length = (int64_t)sizeof text - 1;
    for (int64_t i = 0, line = 1, start = 0; i < length; i++) {
        const char was = text[i];
        struct source_text bytes = { text, length };
        const struct source s = source_of(&bytes);
        struct reader x;
        struct fault_report r;
        text[i] = '\0';
        begin(&x, "");
        x.program.source = &s;
        interpreter_check(&x.in, &x.program, &r);
        CHECK(r.fault == FAULT_ZERO && r.line == line && r.offset == start);
        CHECK(r.at == 0 && r.length == i - start);
        text[i] = was;
        line += was == '\n';
        start = was == '\n' ? i + 1 : start;
    }
}

static void unreadable(void)
{
    struct reader x;
    struct narrow n = narrow(&x, "G1 X1\nX2\n");
    const struct source s = { narrow_look, &n };
    struct fault_report r;
    x.program.source = &s;
    CHECK_EQ(next(&x), COMMAND_LINE);
    n.fails_from = 8;
    interpreter_check(&x.in, &x.program, &r);
    CHECK(r.fault == FAULT_READ && r.line == 2);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_READ);
    CHECK_EQ(next(&x), -1);
    n.length = 0; /* nothing to read is the end */
    n.fails_from = INT64_MAX;
    interpreter_start(&x.in, origins[0], 10.0, origins);
    CHECK_EQ(next(&x), -1);
    CHECK_EQ(x.in.line, 0);
}

enum { LINES = 1000000, LINE = 24 };

/* A program of LINES lines to X = n mod 1000 / 1000, Y = 7 n mod 1000, n from 0; a line is made
 * when it is looked at, so that the text needs no memory. */
struct endless {
    const char *form; /* of a line; # and @ are the digits of X and Y */
    const char *last; /* the last line */
    int64_t from;     /* the window begins with this line; -1: it is empty */
    char window[1024 * LINE];
};

static void write_line(const struct endless *e, char *to, int64_t n)
{
    int x = (int)(n % 1000), y = (int)(n * 7 % 1000);

    memcpy(to, n == LINES - 1 ? e->last : e->form, LINE);
    for (int i = LINE - 1; i >= 0; i--) {
        if (to[i] == '#') {
            to[i] = (char)('0' + x % 10);
            x /= 10;
        } else if (to[i] == '@') {
            to[i] = (char)('0' + y % 10);
            y /= 10;
        }
    }
}

static int64_t endless_look(void *context, const char *file, int64_t offset, const char **text)
{
    if (file[0]) {
        return SOURCE_NONE;
    }
    struct endless *e = context;
    const int64_t room = (int64_t)sizeof e->window, all = (int64_t)LINES * LINE;
    if (e->from < 0 || offset < e->from * LINE || offset + SOURCE_WINDOW > e->from * LINE + room) {
        e->from = offset / LINE;
        for (int64_t i = 0; i < room / LINE; i++) {
            write_line(e, e->window + i * LINE, e->from + i);
        }
    }
    const int64_t behind = e->from * LINE + room;
    *text = e->window + (offset - e->from * LINE);
    return (behind < all ? behind : all) - offset;
}

static struct source endless(struct endless *e, struct reader *x, const char *form,
                             const char *last)
{
    CHECK(strlen(form) == LINE && strlen(last) == LINE);
    begin(x, "");
    e->form = form;
    e->last = last;
    e->from = -1;
    return (struct source){ endless_look, e };
}

static const char form[] = "G1 X0000.### Y@@@.00000\n";

/* The check reads a million lines to the last. The bound of its speed is a third of what a slow
 * machine does. [lines/s of processor time] */
static void million_checked(void)
{
    static struct endless e;
    struct reader x;
    struct fault_report r;
    const struct source s = endless(&e, &x, form, "G1 X0 (the last) Y1 E3 \n");
    x.program.source = &s;
    const clock_t start = clock();
    interpreter_check(&x.in, &x.program, &r);
    const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    CHECK_EQ(r.fault, FAULT_UNUSED);
    CHECK_EQ(r.line, LINES);
    CHECK_EQ(r.offset, (int64_t)(LINES - 1) * LINE);
    CHECK(r.at == 20 && r.length == 2);
    printf("%.0f lines/s, state %zu bytes\n", LINES / seconds, sizeof x.in);
#if !defined(__SANITIZE_ADDRESS__) && defined(__OPTIMIZE__)
    CHECK(LINES / seconds > 500000.0);
#endif
}

/* A million lines become commands, each once. The state is of one size and holds numbers only: a
 * program that says the same in other words leaves the same bytes. */
static void million_interpreted(void)
{
    static struct endless e, other;
    struct reader x, y;
    const struct source s = endless(&e, &x, form, form);
    const struct source t = endless(&other, &y, "g1y@@@(G1 X0000)x.### ;\n", form);
    double sum_x = 0.0, sum_y = 0.0;
    int64_t commands = 0;

    x.program.source = &s;
    y.program.source = &t;
    while (next(&x) == COMMAND_LINE && next(&y) == COMMAND_LINE) {
        commands++;
        sum_x += x.c.path.end[0];
        sum_y += x.c.path.end[1];
        CHECK(commands % 1024 || !memcmp(&x.in, &y.in, sizeof x.in));
    }
    CHECK_EQ(next(&x), -1);
    CHECK_EQ(next(&y), -1);
    CHECK(!memcmp(&x.in, &y.in, sizeof x.in));
    CHECK_EQ(commands, LINES - 1); /* the first leads to where the axes are */
    CHECK_EQ(x.in.line, LINES);
    CHECK_EQ(x.in.offset, (int64_t)LINES * LINE);
    CHECK_NEAR(sum_x, LINES * 0.4995, 1e-5); /* 0 .. 999 a thousand times */
    CHECK_NEAR(sum_y, LINES * 499.5, 1e-2);
    CHECK(sizeof x.in < 110000); /* of any program */
}

int main(void)
{
    windows();
    longest_line();
    unreadable();
    zero_bytes();
    million_checked();
    million_interpreted();
    return check_result();
}
