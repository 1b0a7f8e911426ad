#include "local_io.h"

static uint32_t low_bits(uint32_t bits, int count)
{
    return bits & ((1u << count) - 1);
}

static bool is_edge(enum local_io_edge edge)
{
    return edge == LOCAL_IO_RISE || edge == LOCAL_IO_FALL || edge == LOCAL_IO_BOTH;
}

const char *local_io_status_text(enum local_io_status status)
{
    switch (status) {
    case LOCAL_IO_BAD_EDGE:      return "an edge is rising (0), falling (1) or both (2)";
    case LOCAL_IO_BAD_DEDICATED: return "there are 7 dual-function inputs";
    case LOCAL_IO_BAD_LDO:       return "there are 8 local outputs";
    default:                     return "there are 6 servo-on outputs";
    }
}

enum local_io_status local_io_check_control(const struct local_io_control *set)
{
    for (int i = 0; i < LOCAL_IO_LDIS; i++)
        if (!is_edge(set->ldi_edge[i]))
            return LOCAL_IO_BAD_EDGE;
    for (int i = 0; i < LOCAL_IO_DFIS; i++)
        if (!is_edge(set->dfi_edge[i]))
            return LOCAL_IO_BAD_EDGE;
    if (set->dedicated >> LOCAL_IO_DFIS != 0)
        return LOCAL_IO_BAD_DEDICATED;
    if (set->ldo >> LOCAL_IO_LDOS != 0)
        return LOCAL_IO_BAD_LDO;
    return set->servo_on >> LOCAL_IO_AXES != 0 ? LOCAL_IO_BAD_SERVO_ON : LOCAL_IO_OK;
}

/* Copy member by member, so that the padding of the state does not change. */
static void keep(struct local_io_lines *seen, const struct local_io_lines *lines)
{
    seen->ldi = low_bits(lines->ldi, LOCAL_IO_LDIS);
    seen->dfi = low_bits(lines->dfi, LOCAL_IO_DFIS);
    seen->home = low_bits(lines->home, LOCAL_IO_AXES);
    seen->up = low_bits(lines->up, LOCAL_IO_AXES);
    seen->down = low_bits(lines->down, LOCAL_IO_AXES);
    seen->stop = lines->stop;
    seen->power = lines->power;
}

static uint32_t inputs_of(const struct local_io_lines *seen, uint32_t dedicated)
{
    uint32_t signals = seen->up | seen->down | (uint32_t)seen->stop << LOCAL_IO_DFI_STOP;
    uint32_t dfi = (seen->dfi & ~dedicated) | (signals & dedicated);
    return seen->ldi << LOCAL_IO_EVENT_LDI | dfi << LOCAL_IO_EVENT_DFI;
}

/* Mask of the inputs whose edge type lets them fire when they change to the level `to`. */
static uint32_t firing(const struct local_io_control *set, bool to)
{
    enum local_io_edge other = to ? LOCAL_IO_FALL : LOCAL_IO_RISE;
    uint32_t bits = 0;
    for (int i = 0; i < LOCAL_IO_LDIS; i++)
        bits |= (uint32_t)(set->ldi_edge[i] != other) << (LOCAL_IO_EVENT_LDI + i);
    for (int i = 0; i < LOCAL_IO_DFIS; i++)
        bits |= (uint32_t)(set->dfi_edge[i] != other) << (LOCAL_IO_EVENT_DFI + i);
    return bits;
}

uint32_t local_io_sample(const struct local_io_control *set, struct local_io *io,
                         const struct local_io_lines *lines)
{
    uint32_t before = inputs_of(&io->seen, set->dedicated);
    keep(&io->seen, lines);
    io->inputs = inputs_of(&io->seen, set->dedicated);
    bool first = !io->primed;
    io->primed = true;
    uint32_t changed = before ^ io->inputs;
    if (first || changed == 0)
        return 0;
    return (changed & io->inputs & firing(set, true)) | (changed & before & firing(set, false));
}

bool local_io_stopped(const struct local_io_control *set, const struct local_io *io)
{
    return set->stop_enable && io->seen.stop;
}

struct local_io_outputs local_io_outputs(const struct local_io_control *set,
                                         const struct local_io *io, bool off)
{
    struct local_io_outputs out = { 0 };
    if (off || !set->gate || !io->seen.power || local_io_stopped(set, io))
        return out;
    out.ldo = set->ldo;
    out.servo_on = set->servo_on;
    out.position_ready = set->position_ready;
    return out;
}
