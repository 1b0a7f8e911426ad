/* Commands from the standard input through the shaper; segments and marks to the standard output.
 *
 *   merge M | start X Y Z U V W | line TOLERANCE FEED X Y Z U V W |
 *   arc TOLERANCE FEED PLANE CCW TURNS CENTRE_A CENTRE_B X Y Z U V W |
 *   cubic TOLERANCE FEED six coordinates of the inner points, X Y Z U V W
 *
 * prints `curve LENGTH FEED REST`, its origin and 36 coordinates from there, `line` with start and
 * slope, `cubic` with from, start, end, inner points and length, `arc` with from and the path's
 * start, end, centre, radius, growth, angle, sweep, length and plane, `mark`,
 * and at the end `cost` with clock ticks per command. */
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "shape.h"

static struct shape shape;
static int quiet;

static void print_row(const double x[], int n)
{
    for (int i = 0; i < n; i++) {
        printf(" %.17g", x[i]);
    }
}

static void drain(void)
{
    const int32_t segments = shape_count(&shape), marks = shape_marks(&shape);

    for (int32_t k = 0; k < segments && !quiet; k++) {
        const struct segment *p = shape_segment(&shape, k);
        printf("%s %.17g %.17g %d",
               p->kind == SEGMENT_CURVE  ? "curve"
               : p->kind == SEGMENT_LINE ? "line"
               : p->kind == SEGMENT_ARC  ? "arc"
                                         : "cubic",
               p->length, p->feed, p->rest);
        if (p->kind == SEGMENT_CURVE) {
            print_row(p->origin, AXES);
            print_row(p->control[0], SEGMENT_POINTS * AXES);
        } else if (p->kind == SEGMENT_LINE) {
            print_row(p->start, AXES);
            print_row(p->slope, AXES);
        } else {
            print_row(&p->from, 1);
            print_row(p->path.start, AXES);
            print_row(p->path.end, AXES);
        }
        if (p->kind == SEGMENT_CUBIC) {
            print_row(p->path.bezier.inner[0], 6);
            print_row(&p->path.length, 1);
        } else if (p->kind == SEGMENT_ARC) {
            print_row(p->path.centre, 2);
            printf(" %.17g %.17g %.17g %.17g %.17g %d", p->path.radius, p->path.growth,
                   p->path.angle, p->path.sweep, p->path.length, (int)p->path.plane);
        }
        printf("\n");
    }
    for (int32_t k = 0; k < marks && !quiet; k++) {
        const struct shape_mark *m = shape_mark(&shape, k);
        printf("mark %.17g %d\n", m->at, (int)m->index);
    }
    shape_drop(&shape, segments);
    shape_drop_marks(&shape, marks);
}

int main(int argc, char **argv)
{
    double merge = 1e9, at[AXES], end[AXES], centre[2], inner[2][3], miss;
    char word[16];
    int32_t commands = 0;
    (void)argv;

    quiet = argc > 1;
    shape_start(&shape, merge);
    while (scanf("%15s", word) == 1) {
        struct command c;
        memset(&c, 0, sizeof c);
        c.ramp = (struct ramp_limits){ 1000.0, 1000.0, 0.0, 0.0 };
        c.index = ++commands;
        if (strcmp(word, "merge") == 0 && scanf("%lf", &merge) == 1) {
            shape_start(&shape, merge);
            commands--;
            continue;
        }
        int plane = 0, ccw = 0, turns = 0, n = 0;
        if (strcmp(word, "line") == 0 || strcmp(word, "arc") == 0 || strcmp(word, "cubic") == 0) {
            n += scanf("%lf %lf", &c.tolerance, &c.feed);
        }
        if (strcmp(word, "arc") == 0) {
            n += scanf("%d %d %d %lf %lf", &plane, &ccw, &turns, &centre[0], &centre[1]);
        }
        for (int i = 0; i < 6 && strcmp(word, "cubic") == 0; i++) {
            n += scanf("%lf", &inner[i / 3][i % 3]);
        }
        for (int i = 0; i < AXES; i++) {
            n += scanf("%lf", &end[i]);
        }
        if (n < AXES) {
            printf("numbers are missing\n");
            return 1;
        }
        c.cap = 2.0 * c.feed;
        if (strcmp(word, "start") == 0) {
            commands--;
            memcpy(at, end, sizeof at);
            continue;
        }
        c.type = COMMAND_LINE;
        path_line(&c.path, at, end);
        if (strcmp(word, "arc") == 0) {
            if (path_arc(&c.path, (enum path_plane)plane, at, end, centre, ccw, turns, &miss)
                != PATH_OK) {
                printf("no arc\n");
                return 1;
            }
            c.type = command_arc_type(&c.path);
        }
        if (strcmp(word, "cubic") == 0) {
            if (path_cubic(&c.path, at, end, (const double(*)[3])inner) != PATH_OK) {
                printf("no cubic\n");
                return 1;
            }
            c.type = c.path.cubic ? COMMAND_CUBIC : COMMAND_LINE;
        }
        memcpy(at, end, sizeof at);
        enum shape_status status;
        while ((status = shape_take(&shape, &c)) == SHAPE_FULL) {
            drain();
        }
        if (status != SHAPE_TAKEN) {
            printf("other %d\n", (int)commands);
        }
    }
    shape_end(&shape);
    for (int k = 0; k < 100; k++) {
        drain();
    }
    printf("commands %d made %lld left %d size %zu\n", (int)commands, (long long)shape.made,
           (int)shape.running, sizeof shape);
    return 0;
}
