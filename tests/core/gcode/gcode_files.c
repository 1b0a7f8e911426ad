/* Files that a program calls: a state that is restored elsewhere goes on in the same one. */
#include "gcode_reader.h"

static const struct {
    const char *name, *text;
} files[] = {
    { "a", "\xEF\xBB\xBFo<a> sub\nG1 X1\no<b> call [#1+1]\nG1 X3\no<a> endsub\n" },
    { "b", "\no<b> sub\no1 repeat [#1]\nG91 G1 Y1\no1 endrepeat\nG90\no<b> endsub\n" },
    { "7", "o7 sub\nG1 Z#1\nG1 Z9\nM2\n" },
    { "cut", "\n\no<cut> sub\nG41.1 D4 G1 X10\nG1 X11\no<cut> endsub\n" },
    { "drill", "\no<drill> sub\nG91 G81 X1 Z-1 R1 L2\no<drill> endsub\n" },
};
static const char text[] = "F600\no<a> call [2]\nG1 X5\no7 call [4]\no7 endsub\nG1 X6\n";

static int64_t look(void *context, const char *file, int64_t offset, const char **found)
{
    const struct reader *x = context;
    const char *all = file[0] ? NULL : x->text.text;
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        all = strcmp(file, files[i].name) ? all : files[i].text;
    }
    if (!all) {
        return SOURCE_NONE;
    }
    *found = all + offset;
    return (int64_t)strlen(all) - offset;
}

static void begin_files(struct reader *x, const char *program)
{
    begin(x, program);
    x->source = (struct source){ look, x };
}

/* What becomes of a line later is told there: of a motion when the next one is known, which may
 * stand in another text, and of a cycle, also in a state that was restored. */
static void told_in_the_file(void)
{
    struct reader x, y;

    begin_files(&x, "F600\no<cut> call\nG1 X10.2 Y5\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_CUTTER_SHORT);
    CHECK(strcmp(x.r.file, "cut") == 0 && x.r.line == 5 && x.r.length == 6);
    x.r.file[0] = '\0';
    begin_files(&x, "F600\nG0 X499\no<drill> call\n");
    for (int i = 0; i < 3; i++) {
        CHECK(next(&x) >= 0);
    }
    begin_files(&y, "");
    y.in = x.in;
    y.in.point[0] = 1e9;
    CHECK_EQ(next(&y), -2);
    CHECK(strcmp(y.r.file, "drill") == 0 && y.r.line == 3 && y.r.length == 20);
}

/* A file that cannot be read further is named. */
static bool gone;

static int64_t look_until(void *context, const char *file, int64_t offset, const char **found)
{
    return gone && !strcmp(file, "b") ? -1 : look(context, file, offset, found);
}

static void told_by_file(void)
{
    struct reader x;

    begin_files(&x, text);
    x.source = (struct source){ look_until, &x };
    CHECK(next(&x) >= 0); /* X1, in a */
    CHECK(next(&x) >= 0); /* Y1, in b */
    gone = true;
    while (next(&x) >= 0) {
    }
    CHECK_EQ(x.r.fault, FAULT_READ);
    CHECK(!strcmp(x.r.file, "b"));
    gone = false;
}

int main(void)
{
    told_by_file();
    static const double ends[][3] = { { 1, 0, 0 }, { 1, 1, 0 }, { 1, 2, 0 }, { 1, 3, 0 },
                                      { 3, 3, 0 }, { 5, 3, 0 }, { 5, 3, 4 }, { 5, 3, 9 } };
    static const int lines[] = { 2, 2, 2, 2, 2, 3, 4, 4 };
    const int count = sizeof lines / sizeof *lines;

    for (int from = 0; from <= count; from++) {
        struct reader x, y;
        begin_files(&x, text);
        begin_files(&y, text);
        for (int i = 0; i < count; i++) {
            if (i == from) {
                y.in = x.in;
            }
            struct reader *r = i < from ? &x : &y;
            CHECK(next(r) >= 0);
            expect_end(r, ends[i][0], ends[i][1], ends[i][2]);
            CHECK_EQ(r->c.line, lines[i]);
        }
        CHECK_EQ(next(from < count ? &y : &x), -1);
        CHECK_EQ(x.in.flow.files, (from > 0) + (from > 1) + (from > 6));
    }
    told_in_the_file();
    told_by_file();
    return check_result();
}
