#include "preview.h"

#include "task.h"
#include "waiting.h"

/* Make the points that can be made and take them; returns their number. */
static int64_t make(struct mcc *m, const struct source *s, int64_t most, preview_point *told,
                    void *to)
{
    const struct mechanism machine = machine_mechanism(&m->machine);
    const struct trajectory_beside beside = mcc_beside(m);
    int64_t made = 0;

    while (made < most && !m->error && task_can_point(m)) {
        task_point(m, s);
        if (m->queue.count == 0) {
            break;
        }
        m->written = *queue_peek(&m->queue, 0);
        queue_drop(&m->queue, 1);
        const struct limited l = trajectory_limited(&m->trajectory, &beside, &machine);
        told(to, &m->written, &l);
        made++;
    }
    return made;
}

/* Answer what the program waits for at rest; false: nothing. */
static bool answer(struct mcc *m)
{
    if (m->trajectory.confirming) {
        m->trajectory.confirming = false;
        return true;
    }
    if (trajectory_waits(&m->trajectory, &m->ring)) {
        return task_continue(m) == MCC_NO_ERR;
    }
    if (m->running && waiting_now(&m->program)) {
        waiting_pass(&m->program);
        return true;
    }
    return false;
}

enum preview_end preview_run(struct mcc *m, const struct source *s, int64_t most,
                             preview_point *told, void *to)
{
    if (task_start(m) != MCC_NO_ERR) {
        return PREVIEW_ERROR;
    }
    for (;;) {
        const int read = task_read_all(m, s);
        const int64_t made = make(m, s, most, told, to);
        most -= made;
        if (m->error) {
            return PREVIEW_ERROR;
        }
        if (most <= 0) {
            return PREVIEW_LONG;
        }
        if (made == 0 && read == 0 && !answer(m)) {
            task_settle(m);
            return MCC_check_stop(m) ? PREVIEW_DONE : PREVIEW_ERROR;
        }
    }
}
