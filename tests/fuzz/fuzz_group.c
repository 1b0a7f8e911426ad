/* Bytes as groups on two cards, with programs, operators and calls: a refused call changes nothing;
 * every frame is the sum of what its groups have; nothing is lost or doubled on the way; each group
 * comes to rest where its pulses are. */
#include "fuzz.h"
#include "group.h"

const int fuzz_count = 1500;

enum { PERIODS = 400, CALLS = 24, REST_SECONDS = 3, STOCK_MAX = PCL_FIFO };

struct bytes {
    const uint8_t *at, *end;
};

static int32_t byte(struct bytes *b)
{
    return b->at < b->end ? *b->at++ : 0;
}

/* A card: a FIFO of frames, at its DDA boundaries. */
struct card {
    int64_t dda, next; /* [clocks] */
    int32_t frame[STOCK_MAX][AXES];
    int32_t room;      /* commands it takes */
    int64_t out[AXES]; /* [pulses] put out and in stock */
    bool flag, coming; /* interrupt latch; a transaction on its way */
    struct pcl_card shows;
    int32_t ack_seq;
};

static struct groups s, before; /* 2 MB each: not on the stack */
static struct card card[GROUP_CARDS];
static struct group_panel panel[GROUP_MAX];
static struct source_text text[GROUP_MAX];
static struct source program[GROUP_MAX];
static int64_t now;

static void boundary(struct card *c, int32_t n)
{
    if (c->shows.stock == 0) {
        return;
    }
    memmove(c->frame[0], c->frame[1], sizeof c->frame - sizeof c->frame[0]);
    if (--c->shows.stock == n) {
        c->shows.irq_seq += !c->flag;
        c->shows.irq_clock = c->flag ? c->shows.irq_clock : c->next;
        c->flag = true;
        c->shows.irq_flags[0] = 63;
    }
}

/* Frames in order until one does not fit. */
static void take(struct card *c, const struct pcl *p)
{
    int32_t i = 0;
    for (; i < p->count && c->shows.stock < c->room; i++) {
        memcpy(c->frame[c->shows.stock++], p->frames[i], sizeof c->frame[0]);
        for (int k = 0; k < AXES; k++) {
            c->out[k] += p->frames[i][k];
        }
    }
    c->shows.frames_refused += p->count - i;
    c->shows.cmd_ack = p->seq;
    c->coming = false;
}

static void advance(struct card *c, const struct pcl *p, int64_t to)
{
    while (c->next <= to || (c->coming && p->clock <= to)) {
        if (c->coming && p->clock <= c->next) {
            take(c, p);
        } else {
            boundary(c, p->min_stock);
            c->next += c->dda;
        }
    }
}

/* What was published reaches the card. */
static void read_bus(struct card *c, const struct pcl *p)
{
    if (p->ack_seq != c->ack_seq) {
        c->ack_seq = p->ack_seq;
        c->flag = c->flag && !(p->ack_flags[0] & 63);
        c->shows.irq_flags[0] = c->flag ? 63 : 0;
    }
    c->coming = c->coming || (p->open && p->seq != c->shows.cmd_ack);
}

/* Pulses that the groups have given to a channel: of points that the card has acknowledged. */
static int64_t given(int k, int channel)
{
    int64_t sum = 0;
    for (int n = 0; n < GROUP_MAX; n++) {
        const struct group *g = &s.group[n];
        for (int i = 0; i < AXES && g->used && g->card == k; i++) {
            const int32_t total = g->mcc.written.pulses[i] + g->mcc.written.added[i];
            sum +=
                g->channel[i] == channel ? (g->mcc.machine.axis[i].inverted ? -total : total) : 0;
        }
    }
    return sum;
}

/* What is between: the card has taken it, the groups do not know yet. */
static void check(void)
{
    for (int k = 0; k < GROUP_CARDS; k++) {
        const struct pcl *p = &s.card[k].pcl;
        HOLDS(card[k].shows.stock >= 0 && card[k].shows.stock <= STOCK_MAX);
        HOLDS(p->count >= 0 && p->count <= PCL_FRAMES);
        for (int i = 0; i < AXES; i++) {
            HOLDS(s.card[k].machine.axis[i].used || card[k].out[i] == 0);
            if (!p->open) {
                HOLDS(card[k].out[i] == given(k, i));
            }
        }
    }
    for (int n = 0; n < GROUP_MAX; n++) {
        const struct group *g = &s.group[n];
        HOLDS(!g->used
              || (g->mcc.queue.count >= 0 && g->mcc.queue.count <= g->mcc.machine.queue_depth));
        HOLDS(!g->used || isfinite(g->mcc.written.feed));
        HOLDS(g->starved >= 0 && (g->mcc.commands > 0 || g->starved == 0));
    }
}

static void period(void)
{
    struct pcl_card seen[GROUP_CARDS];
    for (int k = 0; k < GROUP_CARDS; k++) {
        seen[k] = card[k].shows;
        read_bus(&card[k], &s.card[k].pcl);
    }
    groups_instant(&s, now, seen, panel, program);
    now += s.config.bus;
    for (int k = 0; k < GROUP_CARDS; k++) {
        advance(&card[k], &s.card[k].pcl, now);
    }
    check();
}

static struct machine machine_of(struct bytes *b)
{
    struct machine m = fuzz_machine();
    const int32_t odd = byte(b);
    for (int i = 0; i < AXES; i++) {
        m.axis[i].high_limit = 1e6;
        m.axis[i].inverted = odd >> 6 & i & 1;
        m.axis[i].ppr = 2000 * (1 + (i + odd) % 5);
    }
    m.acc_type = m.dec_type = odd & 1 ? 'S' : 'T';
    m.queue_depth = odd % 16 ? 1 + odd % 32 : 0;
    m.dda_time = odd % 11 ? 1e-3 : 0.3e-3;
    return m;
}

static void create(struct bytes *b)
{
    int32_t channel[AXES];
    const struct machine m = machine_of(b);
    for (int i = 0; i < AXES; i++) {
        const int32_t x = byte(b) % 32;
        channel[i] = x < AXES + 2 ? x - 1 : -1;
    }
    const int where = byte(b) % 8 < 7 ? (byte(b) & 1) : byte(b) % 4 - 1;
    const int n = group_create(&s, where, channel, &m);
    HOLDS(n < GROUP_MAX);
    for (int i = 0; n >= 0 && i < AXES; i++) {
        HOLDS(channel[i] < 0 || s.card[where].machine.axis[channel[i]].used);
    }
    HOLDS(n >= 0 || memcmp(&before, &s, sizeof s) == 0);
}

/* A channel is used if it is one group's. */
static void check_channels(void)
{
    for (int k = 0; k < GROUP_CARDS; k++) {
        for (int c = 0; c < AXES; c++) {
            int owners = 0;
            for (int n = 0; n < GROUP_MAX; n++) {
                for (int i = 0; i < AXES && s.group[n].used && s.group[n].card == k; i++) {
                    owners += s.group[n].channel[i] == c;
                }
            }
            HOLDS(owners == s.card[k].machine.axis[c].used);
        }
    }
}

static void set_up(struct bytes *b)
{
    struct machine m[GROUP_CARDS] = { machine_of(b), machine_of(b) };
    const struct group_config config = { .bus = 4000 * (1 + byte(b) % 4),
                                         .ipo = 10000 * (1 + byte(b) % 12),
                                         .latency = 400.0 * byte(b),
                                         .jitter = 400.0 * byte(b),
                                         .seed = byte(b),
                                         .min_stock = byte(b) % 8,
                                         .batch = 1 + byte(b) % PCL_FRAMES };
    groups_init(&s, &config, m);
    for (int n = byte(b) % 10; n > 0; n--) {
        before = s;
        const int kind = byte(b) % 8, group = byte(b) % (GROUP_MAX + 2) - 1;
        const int code = kind == 0  ? group_close(&s, group)
                         : kind < 3 ? group_program(&s, group, 40000 * byte(b))
                                    : 0;
        HOLDS(code == 0 || memcmp(&before, &s, sizeof s) == 0);
        if (kind >= 3) {
            create(b);
        }
        check_channels();
    }
}

/* Its library's calls; a program has it for itself. */
static int call(struct mcc *m, struct bytes *b)
{
    const int32_t kind = byte(b);
    double x[AXES] = { 0.0 };
    for (int i = 0; i < AXES; i++) {
        x[i] = m->machine.axis[i].used ? (byte(b) - 128) / 16.0 : m->end[i];
    }
    switch (kind % 10) {
    case 0:
    case 1:
    case 2:  return MCC_line(m, x);
    case 3:  return MCC_ptp(m, x);
    case 4:  return MCC_arc_xy(m, x[0], x[1], x[1], x[0]);
    case 5:  return MCC_motion_delay(m, kind);
    case 6:  return mcc_set_tolerance(m, kind / 255.0);
    case 7:  return kind & 16 ? MCC_enable_quit(m) : MCC_disable_quit(m);
    case 8:  return MCC_clear_error(m);
    default: return MCC_motion_abort(m);
    }
}

static void operate(struct bytes *b)
{
    const int kind = byte(b), n = kind % GROUP_MAX;
    struct group_panel *p = &panel[n];
    switch (kind >> 4 & 7) {
    case 0: p->hold = !p->hold; break;
    case 1: p->abort = !p->abort; break;
    case 2: p->cycle_start = !p->cycle_start; break;
    case 3: p->override = byte(b) / 128.0; break;
    case 4: card[kind & 1].room = byte(b) % STOCK_MAX + 1; break;
    default:
        if (s.group[n].used) {
            static struct mcc m;
            m = s.group[n].mcc;
            if (call(&s.group[n].mcc, b) < 0) {
                HOLDS(memcmp(&m, &s.group[n].mcc, sizeof m) == 0);
            }
        }
    }
}

/* After an abort, the card taking what it is given: every group at rest, every pulse out. */
static void come_to_rest(void)
{
    int left = GROUP_MAX;
    for (int k = 0; k < GROUP_CARDS; k++) {
        card[k].room = STOCK_MAX;
    }
    for (int n = 0; n < GROUP_MAX; n++) {
        panel[n] = (struct group_panel){ .override = 1.0 };
    }
    period();
    for (int n = 0; n < GROUP_MAX; n++) {
        panel[n].abort = true;
    }
    for (const int64_t end = now + (int64_t)REST_SECONDS * CLOCK_HZ; left > 0 && now < end;) {
        period();
        left = 0;
        for (int n = 0; n < GROUP_MAX; n++) {
            left += s.group[n].used && !MCC_check_stop(&s.group[n].mcc);
        }
    }
    HOLDS(left == 0);
    for (int n = 0; n < GROUP_MAX; n++) {
        const struct mcc *m = &s.group[n].mcc;
        for (int i = 0; i < AXES && s.group[n].used; i++) {
            HOLDS(m->written.pulses[i] == m->trajectory.pulses[i]
                  && m->end[i] == m->trajectory.rest[i]);
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const texts[] = { "G1 X3 F1200\nG2 X5 Y0 I1\n",
                                         "G64 P0.1\nG1 X1 F3000\nX2\nY2\nX0\nM30\n",
                                         "G91\nG0 X1\nM0\nX-1\n", "G64\nG1 X2 F6000\nY2\n" };
    struct bytes b = { data, data + size };

    set_up(&b);
    before = s;
    if (groups_start(&s) != MCC_NO_ERR) {
        HOLDS(memcmp(&before.group, &s.group, sizeof s.group) == 0 && !s.running);
        return 0;
    }
    now = 0;
    memset(card, 0, sizeof card);
    for (int k = 0; k < GROUP_CARDS; k++) {
        card[k].dda = card[k].next = machine_dda_clocks(&s.card[k].machine);
        card[k].room = STOCK_MAX;
    }
    for (int n = 0; n < GROUP_MAX; n++) {
        struct fault_report report;
        const char *chosen = texts[byte(&b) & 3];
        panel[n] = (struct group_panel){ .override = 1.0 };
        text[n] = (struct source_text){ chosen, (int64_t)strlen(chosen) };
        program[n] = source_of(&text[n]);
        if (s.group[n].program) {
            task_check(&s.group[n].mcc, &program[n], &report);
            s.group[n].program = report.fault == FAULT_NONE;
        }
    }
    for (int i = 0; i < CALLS && b.at < b.end; i++) {
        operate(&b);
        for (int n = byte(&b) * PERIODS / 4 / 256; n > 0; n--) {
            period();
        }
    }
    come_to_rest();
    return 0;
}
