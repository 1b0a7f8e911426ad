/* Bytes as a points file and a program, with a line of = between: both read, and a program found
 * good run under inputs made of the bytes, through a state that comes back as bytes. */
#include <math.h>

#include "holds.h"
#include "robot_job_run.h"

const int fuzz_count = 60000;

enum { BYTES = 1 << 15, CALLS = 300, MOST = 40 };

static struct robot_job_points points;
static struct robot_job_program program;

/* A report points into its line, and its message fits. */
static void check_report(const struct robot_job_report *r, const char *text, int64_t size)
{
    char message[ROBOT_JOB_MESSAGE_MAX];
    int32_t line = 1, column = 1;
    HOLDS(r->fault > ROBOT_JOB_OK && r->fault < ROBOT_JOB_BAD_STACK);
    HOLDS(r->offset >= 0 && r->length >= 0 && (int64_t)r->offset + r->length <= size);
    HOLDS(r->length <= ROBOT_JOB_LINE_MAX || r->fault == ROBOT_JOB_BAD_BYTE);
    for (int32_t i = 0; i < r->offset; i++) {
        line += text[i] == '\n';
        column = text[i] == '\n' ? 1 : column + 1;
    }
    HOLDS(r->fault == ROBOT_JOB_BAD_EMPTY || (r->line == line && r->column == column));
    robot_job_message(r, text, message);
    HOLDS(strlen(message) < ROBOT_JOB_MESSAGE_MAX && message[0]);
}

/* Every point that was read is written, and read again as the same bits of its line's decimals. */
static void write_points(void)
{
    static struct robot_job_points again;
    char text[ROBOT_JOB_POINT_TEXT];
    struct robot_job_report r;
    for (int32_t i = 0; i < ROBOT_JOB_POINTS; i++) {
        struct robot_job_point p = points.point[i];
        if (p.kind == ROBOT_JOB_NO_POINT) {
            continue;
        }
        p.tool = p.tool > 0 ? 0 : p.tool;
        p.user = p.user > 0 ? 0 : p.user;
        HOLDS(robot_job_point_write(i, &p, text) == 0);
        HOLDS(robot_job_points_read(&again, ROBOT_JOB_NO_AXIS, text, (int64_t)strlen(text), &r)
              == 0);
        for (int k = 0; k < 6; k++) {
            HOLDS(fabs(again.point[i].value[k] - p.value[k]) <= 0.5e-6 + 1e-10);
        }
        return; /* one is enough: it costs 100 kB */
    }
}

static enum robot_job_point_kind place_of(const struct robot_job_run *run, int32_t number)
{
    return robot_job_place(run, &program, &points, number)->kind;
}

static void check_move(const struct robot_job_request *r, const struct robot_job_run *run)
{
    const enum robot_job_point_kind kind = place_of(run, r->point);
    HOLDS(kind != ROBOT_JOB_NO_POINT);
    HOLDS(r->path != ROBOT_JOB_CIRCLE || place_of(run, r->via) != ROBOT_JOB_NO_POINT);
    HOLDS(r->increment == ROBOT_JOB_NOT_BY
          || (kind == ROBOT_JOB_POSE && r->increment >= ROBOT_JOB_BY_TOOL
              && r->increment < ROBOT_JOB_FRAMES && r->shift < 0));
    HOLDS(r->until >= -1 && r->until < ROBOT_JOB_SIGNALS);
}

/* What may be asked for. */
static void check_request(const struct robot_job_request *r, const struct robot_job_run *run,
                          int64_t moves)
{
    HOLDS(r->line > 0 && r->job >= 0 && r->job < program.jobs);
    HOLDS(r->after == run->moves
          || (run->early && r->after == run->moves - 1
              && (r->answer == ROBOT_JOB_DOUT || r->answer == ROBOT_JOB_AOUT
                  || r->answer == ROBOT_JOB_FAULT)));
    HOLDS(run->moves == moves + (r->answer == ROBOT_JOB_MOVE));
    if (r->answer == ROBOT_JOB_MOVE) {
        check_move(r, run);
        HOLDS(points.user[r->shift_user].defined);
        HOLDS((r->tag == ROBOT_JOB_VJ) == (r->path == ROBOT_JOB_JOINT) && r->speed > 0.0);
        HOLDS(r->level >= 0 && r->level <= ROBOT_JOB_LEVELS && r->corner >= 0.0);
        HOLDS(points.tool[r->tool].defined && points.user[r->user].defined);
    } else if (r->answer == ROBOT_JOB_DOUT) {
        const uint32_t all = (1u << r->count) - 1u;
        HOLDS(r->index >= 0 && r->index + r->count <= ROBOT_JOB_SIGNALS);
        HOLDS((r->count == 1 || r->count == ROBOT_JOB_GROUP) && ((uint32_t)r->on & ~all) == 0);
        HOLDS((run->out >> r->index & all) == (r->time > 0 ? 0u : (uint32_t)r->on));
        HOLDS(r->time == 0 || (r->on == 1 && r->count == 1));
    } else if (r->answer == ROBOT_JOB_AOUT) {
        HOLDS(r->index >= 0 && r->index < ROBOT_JOB_ANALOGS && fabs(r->volt) <= ROBOT_JOB_VOLT_MAX);
    } else if (r->answer == ROBOT_JOB_FAULT) {
        HOLDS(r->fault >= ROBOT_JOB_BAD_STACK && r->fault < ROBOT_JOB_FAULT_COUNT);
    }
}

static void somewhere(const void *arm, struct robot_job_point here[2])
{
    (void)arm;
    here[0] = (struct robot_job_point){ .kind = ROBOT_JOB_PULSES };
    here[1] = (struct robot_job_point){ .kind = ROBOT_JOB_POSE };
}

static void seen(const void *arm, const struct robot_job_point *from, struct robot_job_point *pose)
{
    (void)arm;
    HOLDS(from->kind != ROBOT_JOB_NO_POINT);
    HOLDS(from->tool >= 0 && from->tool < ROBOT_JOB_FRAMES && points.tool[from->tool].defined);
    HOLDS(from->user >= 0 && from->user < ROBOT_JOB_FRAMES && points.user[from->user].defined);
    HOLDS(pose->tool >= 0 && pose->tool < ROBOT_JOB_FRAMES && points.tool[pose->tool].defined);
    HOLDS(pose->user >= 0 && pose->user < ROBOT_JOB_FRAMES && points.user[pose->user].defined);
    memcpy(pose->value, from->value, sizeof pose->value);
}

static void led(const void *arm, const struct robot_job_point *from,
                const struct robot_job_point *to, int32_t frame, double by[6])
{
    struct robot_job_point pose = *to;
    seen(arm, from, &pose);
    seen(arm, &pose, &pose);
    HOLDS(frame >= ROBOT_JOB_BY_TOOL && frame < ROBOT_JOB_FRAMES);
    memcpy(by, to->value, sizeof to->value);
}

static void run_program(const uint8_t *data, size_t size)
{
    static struct robot_job_run kept;
    struct robot_job_inputs in = { .here = somewhere, .convert = seen, .shift = led };
    const struct robot_job_start start = { .vj = 10.0, .v = 100.0, .vr = 20.0 };
    robot_job_begin(&kept, &program, &start);
    for (size_t n = 0; n < CALLS; n++) {
        struct robot_job_run run;
        struct robot_job_request r;
        const int64_t moves = kept.moves;
        memcpy(&run, &kept, sizeof run);
        const bool ends = kept.until && !kept.early && in.reached < moves;
        in.now += 100000;
        in.di = n % 7 ? in.di : data[n % size] * 0x01010101u;
        in.ai[n % ROBOT_JOB_ANALOGS] = data[n % size] / 12.5 - 10.0;
        in.reached = n % 3 ? in.reached : moves;
        robot_job_next(&run, &program, &points, &in, MOST, &r);
        check_request(&r, &run, moves);
        HOLDS(!ends || in.reached >= moves || r.answer == ROBOT_JOB_REACH
              || r.answer == ROBOT_JOB_FAULT);
        memcpy(&kept, &run, sizeof kept);
        if (r.answer == ROBOT_JOB_END || r.answer == ROBOT_JOB_FAULT) {
            break;
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char MARK[] = "=\n";
    struct robot_job_report r;
    size_t head = 0;

    if (size > BYTES || size == 0) {
        return 0;
    }
    while (head + 2 <= size && (memcmp(data + head, MARK, 2) || (head && data[head - 1] != '\n'))) {
        head++;
    }
    const size_t rest = head + 2 <= size ? head + 2 : size;
    const int64_t length = (int64_t)(size - rest);
    char *first = malloc(head + 1), *second = malloc((size_t)length + 1); /* of just that size */
    HOLDS(first && second);
    memcpy(first, data, head);
    memcpy(second, data + rest, (size_t)length);
    if (robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, first, (int64_t)head, &r)) {
        check_report(&r, first, (int64_t)head);
        robot_job_points_clear(&points, ROBOT_JOB_NO_AXIS);
    } else {
        write_points();
    }
    if (robot_job_read(&program, &points, second, length, &r)) {
        check_report(&r, second, length);
    } else {
        run_program(data, size);
    }
    free(first);
    free(second);
    return 0;
}
