/* Local I/O: edges of each input, change of source, gated outputs; a model bit by bit. */
#include "local_io.h"

#include <string.h>

#include "check.h"
#include "irq.h"

_Static_assert((int)LOCAL_IO_EVENT_LDI == (int)IRQ_LIO_LDI
                   && (int)LOCAL_IO_EVENT_DFI == (int)IRQ_LIO_DFI,
               "events are bits of the latch");

enum { INPUTS = LOCAL_IO_LDIS + LOCAL_IO_DFIS };

static bool bit(uint32_t bits, int i)
{
    return bits >> i & 1;
}

static void set_edge(struct local_io_control *set, int input, enum local_io_edge edge)
{
    if (input < 8)
        set->ldi_edge[input] = edge;
    else
        set->dfi_edge[input - 8] = edge;
}

static struct local_io_lines lines_of(uint32_t inputs)
{
    return (struct local_io_lines){ .ldi = inputs & 0xFF, .dfi = inputs >> 8 };
}

/* Each input, edge and pair of levels, the other inputs high or low; the others never fire. */
static void edges(void)
{
    for (int code = 0; code < INPUTS * 3 * 8; code++) {
        int input = code / 24, edge = code / 8 % 3;
        bool from = code & 1, to = code & 2;
        uint32_t rest = code & 4 ? 0x7FFFu & ~(1u << input) : 0;
        struct local_io_control set = { 0 };
        struct local_io io = { 0 };
        set_edge(&set, input, (enum local_io_edge)edge);
        struct local_io_lines lines = lines_of(rest | (uint32_t)from << input);
        CHECK_EQ(local_io_sample(&set, &io, &lines), 0); /* the first: nothing */
        CHECK_EQ(io.inputs, rest | (uint32_t)from << input);
        CHECK_EQ(local_io_sample(&set, &io, &lines), 0); /* no change */
        lines = lines_of(rest | (uint32_t)to << input);
        bool fires =
            (edge == 0 && !from && to) || (edge == 1 && from && !to) || (edge == 2 && from != to);
        CHECK_EQ(local_io_sample(&set, &io, &lines), (uint32_t)fires << input);
        CHECK_EQ(local_io_sample(&set, &io, &lines), 0);
        CHECK_EQ(io.inputs, rest | (uint32_t)to << input);
    }
}

static struct local_io_lines sources(int i, bool terminal, bool signal, bool down)
{
    struct local_io_lines lines = { .dfi = (uint32_t)terminal << i };
    if (i == 6)
        lines.stop = signal;
    else if (down)
        lines.down = (uint32_t)signal << i;
    else
        lines.up = (uint32_t)signal << i;
    return lines;
}

/* Each dual-function input, source before and after, levels of both sources before and after:
 * it fires exactly if the source it has now changed. */
static void change_of_source(void)
{
    for (int code = 0; code < 7 * 128; code++) {
        int i = code / 128;
        bool terminal[2] = { code & 1, code & 2 }, signal[2] = { code & 4, code & 8 };
        bool dedicated[2] = { code & 16, code & 32 }, down = code & 64;
        struct local_io_control set = { 0 };
        struct local_io io = { 0 };
        set.dfi_edge[i] = LOCAL_IO_BOTH;
        uint32_t got = 0;
        for (int k = 0; k < 2; k++) {
            struct local_io_lines lines = sources(i, terminal[k], signal[k], down);
            set.dedicated = (uint32_t)dedicated[k] << i;
            got = local_io_sample(&set, &io, &lines);
            bool level = dedicated[k] ? signal[k] : terminal[k];
            CHECK_EQ(io.inputs, (uint32_t)level << (8 + i));
        }
        bool fires = dedicated[1] ? signal[0] != signal[1] : terminal[0] != terminal[1];
        CHECK_EQ(got, (uint32_t)fires << (8 + i));
    }
}

/* The same levels under changing registers: no event at all. */
static void registers_fire_nothing(uint64_t seed)
{
    struct local_io_control set = { 0 };
    struct local_io io = { 0 };
    struct local_io_lines lines = { .ldi = 0x5A, .dfi = 0x2C, .up = 0x11, .stop = true };
    for (int n = 0; n < 500; n++) {
        set.dedicated = (uint32_t)check_random(&seed, 0, 127);
        for (int i = 0; i < 8; i++)
            set.ldi_edge[i] = (enum local_io_edge)check_random(&seed, 0, 2);
        for (int i = 0; i < 7; i++)
            set.dfi_edge[i] = (enum local_io_edge)check_random(&seed, 0, 2);
        CHECK_EQ(local_io_sample(&set, &io, &lines), 0);
    }
}

/* Every combination of the five conditions; nothing sampled yet means no field power. */
static void outputs(void)
{
    for (int code = 0; code < 32; code++) {
        bool off = code & 1, gate = code & 2, stop = code & 4, enable = code & 8, power = code & 16;
        struct local_io_control set = { .ldo = 0xA5,
                                        .servo_on = 0x2D,
                                        .position_ready = true,
                                        .stop_enable = enable,
                                        .gate = gate,
                                        .dedicated = 0x40 };
        struct local_io io = { 0 };
        struct local_io_lines lines = { .stop = stop, .power = power };
        CHECK(!local_io_stopped(&set, &io));
        CHECK_EQ(local_io_outputs(&set, &io, off).ldo, 0);
        local_io_sample(&set, &io, &lines);
        struct local_io_outputs out = local_io_outputs(&set, &io, off);
        bool through = !off && gate && power && !(stop && enable);
        CHECK_EQ(local_io_stopped(&set, &io), stop && enable);
        CHECK_EQ(out.ldo, through ? 0xA5 : 0);
        CHECK_EQ(out.servo_on, through ? 0x2D : 0);
        CHECK_EQ(out.position_ready, through);
        set.dedicated = 0; /* the stop acts whatever DFI6 is */
        CHECK_EQ(local_io_stopped(&set, &io), stop && enable);
        set.position_ready = false;
        CHECK(!local_io_outputs(&set, &io, off).position_ready);
    }
}

static void refusals(void)
{
    struct local_io_control set = { 0 }, bad, copy;
    CHECK_EQ(local_io_check_control(&set), LOCAL_IO_OK);
    for (int i = 0; i < INPUTS; i++) {
        set_edge(&set, i, LOCAL_IO_FALL);
        CHECK_EQ(local_io_check_control(&set), LOCAL_IO_OK);
        set_edge(&set, i, LOCAL_IO_BOTH);
        CHECK_EQ(local_io_check_control(&set), LOCAL_IO_OK);
        bad = set;
        set_edge(&bad, i, (enum local_io_edge)3);
        bad.dedicated = 128; /* the first of two is told */
        copy = bad;
        CHECK_EQ(local_io_check_control(&bad), LOCAL_IO_BAD_EDGE);
        CHECK_EQ(memcmp(&bad, &copy, sizeof bad), 0);
        set_edge(&bad, i, (enum local_io_edge) - 1);
        CHECK_EQ(local_io_check_control(&bad), LOCAL_IO_BAD_EDGE);
    }
    set.dedicated = 0x7F;
    set.ldo = 0xFF;
    set.servo_on = 0x3F;
    CHECK_EQ(local_io_check_control(&set), LOCAL_IO_OK);
    for (int i = 0; i < 32; i++) {
        bad = set;
        bad.dedicated |= 1u << i;
        CHECK_EQ(local_io_check_control(&bad), i > 6 ? LOCAL_IO_BAD_DEDICATED : LOCAL_IO_OK);
        bad = set;
        bad.ldo |= 1u << i;
        CHECK_EQ(local_io_check_control(&bad), i > 7 ? LOCAL_IO_BAD_LDO : LOCAL_IO_OK);
        bad = set;
        bad.servo_on |= 1u << i;
        CHECK_EQ(local_io_check_control(&bad), i > 5 ? LOCAL_IO_BAD_SERVO_ON : LOCAL_IO_OK);
    }
}

/* Two levels of every DFI, one of every LDI, each looked at by itself. */
struct model {
    bool primed, ldi[8], terminal[7], signal[7];
};

static bool model_fires(enum local_io_edge edge, bool before, bool now)
{
    switch (edge) {
    case LOCAL_IO_RISE: return !before && now;
    case LOCAL_IO_FALL: return before && !now;
    default:            return before != now;
    }
}

static uint32_t model_sample(const struct local_io_control *set, struct model *m,
                             const struct local_io_lines *lines, uint32_t *inputs)
{
    uint32_t events = 0;
    *inputs = 0;
    for (int i = 0; i < 8; i++) {
        bool now = bit(lines->ldi, i);
        if (m->primed && model_fires(set->ldi_edge[i], m->ldi[i], now))
            events |= 1u << i;
        if (now)
            *inputs |= 1u << i;
        m->ldi[i] = now;
    }
    for (int i = 0; i < 7; i++) {
        bool terminal = bit(lines->dfi, i);
        bool signal = i == 6 ? lines->stop : bit(lines->up, i) || bit(lines->down, i);
        bool chosen = bit(set->dedicated, i);
        bool before = chosen ? m->signal[i] : m->terminal[i], now = chosen ? signal : terminal;
        if (m->primed && model_fires(set->dfi_edge[i], before, now))
            events |= 1u << (8 + i);
        if (now)
            *inputs |= 1u << (8 + i);
        m->terminal[i] = terminal;
        m->signal[i] = signal;
    }
    m->primed = true;
    return events;
}

static void toggle(uint32_t *bits, uint64_t *seed)
{
    if (check_random(seed, 0, 2) == 0)
        *bits ^= 1u << check_random(seed, 0, 31); /* beyond the last bit too: ignored */
    else
        *bits ^= (uint32_t)check_random(seed, 0, 255);
}

static void move_lines(struct local_io_lines *lines, uint64_t *seed)
{
    uint32_t *groups[] = { &lines->ldi, &lines->dfi, &lines->home, &lines->up, &lines->down };
    for (int i = 0; i < 5; i++)
        if (check_random(seed, 0, 3) == 0)
            toggle(groups[i], seed);
    lines->stop ^= check_random(seed, 0, 3) == 0;
    lines->power ^= check_random(seed, 0, 9) == 0;
}

static void against_model(uint64_t seed, uint32_t *fired)
{
    struct local_io_control set = { 0 };
    struct local_io io = { 0 };
    struct local_io_lines lines = { 0 };
    struct model m = { 0 };
    uint32_t inputs;
    for (int n = 0; n < 2000; n++) {
        move_lines(&lines, &seed);
        if (check_random(&seed, 0, 4) == 0)
            set.dedicated ^= 1u << check_random(&seed, 0, 6);
        if (check_random(&seed, 0, 4) == 0)
            set_edge(&set, (int)check_random(&seed, 0, 14),
                     (enum local_io_edge)check_random(&seed, 0, 2));
        uint32_t want = model_sample(&set, &m, &lines, &inputs);
        CHECK_EQ(local_io_sample(&set, &io, &lines), want);
        CHECK_EQ(io.inputs, inputs);
        CHECK_EQ(io.seen.home, lines.home & 0x3F);
        CHECK_EQ(io.seen.up, lines.up & 0x3F);
        CHECK_EQ(io.seen.down, lines.down & 0x3F);
        CHECK_EQ(io.seen.power, lines.power);
        *fired |= want;
    }
}

int main(void)
{
    uint32_t fired = 0;
    edges();
    change_of_source();
    registers_fire_nothing(86028121);
    outputs();
    refusals();
    for (uint64_t seed = 1; seed <= 50; seed++)
        against_model(seed * 32452843, &fired);
    CHECK_EQ(fired, 0x7FFF);
    return check_result();
}
