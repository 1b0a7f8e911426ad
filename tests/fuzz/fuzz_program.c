/* Bytes as a part program: checked whole, checked again through a window that shows no byte more
 * than it must, for the first fault and for all, and, if found good, interpreted and planned. */
#include "fuzz.h"
#include "waiting.h"

const int fuzz_count = 10000;

enum { POINTS = 2000, BYTES = 1 << 16 };

static struct mcc m; /* 160 kB: not on the stack */

/* A source that shows as little as it may, in a piece of memory of just that size. */
struct narrow {
    const uint8_t *text;
    int64_t length;
    char *shown;
};

static int64_t look(void *context, const char *file, int64_t offset, const char **text)
{
    if (file[0]) {
        return SOURCE_NONE;
    }
    struct narrow *n = context;
    const int64_t left = n->length - offset;
    const int64_t size = left < SOURCE_WINDOW ? left : SOURCE_WINDOW;
    HOLDS(offset >= 0 && left >= 0);
    free(n->shown);
    n->shown = malloc((size_t)size);
    HOLDS(n->shown || size == 0);
    if (size > 0) {
        memcpy(n->shown, n->text + offset, (size_t)size);
    }
    *text = n->shown;
    return size;
}

/* The report of a fault points into its line. */
static void check_report(const struct fault_report *r, const uint8_t *data, size_t size)
{
    int32_t line = 1;
    HOLDS(r->fault > FAULT_NONE && r->fault < FAULT_COUNT && fault_text(r->fault)[0]);
    HOLDS(r->offset >= 0 && (size_t)r->offset <= size);
    HOLDS(r->at >= 0 && r->length >= 0 && r->other_at >= 0 && r->other_length >= 0);
    HOLDS(r->offset + r->at + r->length <= (int64_t)size);
    HOLDS(r->offset + r->other_at + r->other_length <= (int64_t)size);
    for (int64_t i = 0; i < r->offset; i++) {
        line += data[i] == '\n';
    }
    HOLDS(line == r->line);
}

/* All faults and notes are in the text, no line is told twice, and the first is r. */
static void check_all(const struct source *s, const struct fault_report *r, const uint8_t *data,
                      size_t size)
{
    static struct fault_list all;

    task_check_all(&m, s, &all);
    HOLDS(all.count >= 0 && all.count <= FAULT_LIST && (!all.more || all.count == FAULT_LIST));
    HOLDS(all.notes >= 0 && all.notes <= FAULT_NOTES);
    HOLDS((all.count > 0 ? all.of[0].fault : FAULT_NONE) == r->fault);
    HOLDS(all.count == 0 || all.of[0].offset == r->offset);
    for (int i = 0; i < all.count; i++) {
        check_report(&all.of[i], data, size);
        HOLDS(all.of[i].fault < FAULT_NOTE_COMMENT);
        for (int j = 0; j < i; j++) {
            HOLDS(all.of[i].offset != all.of[j].offset);
        }
    }
    for (int i = 0; i < all.notes; i++) {
        check_report(&all.note[i], data, size);
        HOLDS(all.note[i].fault >= FAULT_NOTE_COMMENT);
    }
}

static enum fault check(const struct source *s, const uint8_t *data, size_t size)
{
    struct fault_report r, again;
    struct narrow narrow = { data, (int64_t)size, NULL };
    const struct source small = { look, &narrow };
    memset(&r, 0, sizeof r);
    memset(&again, 0, sizeof again);
    task_check(&m, s, &r);
    task_check(&m, &small, &again);
    check_all(s, &r, data, size);
    check_all(&small, &r, data, size);
    free(narrow.shown);
    HOLDS(r.fault == again.fault);
    if (r.fault != FAULT_NONE) {
        HOLDS(r.line == again.line && r.at == again.at && r.length == again.length);
        check_report(&r, data, size);
    }
    return r.fault;
}

/* The machine answers: inputs are 0, all pulses are out, nothing touches. */
static bool answer(const int64_t sum[AXES])
{
    const bool asked = waiting_now(&m.program);

    for (int i = 0; i < AXES; i++) {
        m.signals.pulses[i] = (int32_t)(uint32_t)sum[i];
    }
    inquiry_look(&m, (int64_t)86400 * CLOCK_HZ);
    return asked && !m.error;
}

/* A program found good runs to its end without any error but too many pulses at a time, unless it
 * has asked the machine, where the check answers otherwise, or is behind what a check reads. */
static void run(const struct source *s)
{
    int64_t sum[AXES] = { 0 };
    bool unknown = false;
    HOLDS(task_start(&m) == MCC_NO_ERR);
    for (int n = 0; n < POINTS;) {
        task_run(&m, s);
        const int points = fuzz_take(&m, sum);
        unknown = unknown || m.program.waits || m.program.flow.again > CHECK_AGAIN;
        HOLDS(m.error == 0 || m.error == MCC_ERROR_SPEED || unknown);
        if (points == 0 && !(m.running && answer(sum)) && task_continue(&m) != MCC_NO_ERR) {
            HOLDS(MCC_check_stop(&m) && task_status(&m) == TASK_STOPPED);
            break;
        }
        n += points + 1;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct machine machine = fuzz_machine();
    struct source_text text = { (const char *)data, (int64_t)size };
    const struct source source = source_of(&text);
    const struct mcc_dialect dialect = { .angles = size & 4,
                                         .fanuc = size & 8,
                                         .least_increment = size & 16 ? 0.001 : 0.0 };

    if (size > BYTES) {
        return 0;
    }
    HOLDS(MCC_init_motion(&m, &machine) == MCC_NO_ERR);
    task_set_switches(&m, size & 1, size & 2);
    task_set_dialect(&m, &dialect);
    if (check(&source, data, size) == FAULT_NONE) {
        run(&source);
    }
    return 0;
}
