/* Remote I/O: exact clocks of scan, failure and safe state; a model that counts every clock. */
#include "remote_io.h"

#include <string.h>

#include "check.h"

enum {
    SLAVES = REMOTE_IO_SLAVES,
    PORTS = REMOTE_IO_PORTS,
    FAIL = 1 << REMOTE_IO_EVENT_FAIL,
    NOT_READY = 1 << REMOTE_IO_EVENT_NOT_READY,
};

/* A set with its surroundings. */
struct bench {
    struct remote_io_config c;
    struct remote_io_control set;
    struct remote_io_lines lines;
    struct remote_io io;
};

static struct bench bench(int32_t time, uint32_t enabled, int32_t retry_limit)
{
    return (struct bench){
        .c = { time },
        .set = { .on = true, .enabled = enabled, .retry_limit = retry_limit },
        .lines = { .connected = 7 },
    };
}

static void update(struct bench *b, int64_t clock)
{
    remote_io_update(&b->c, &b->set, &b->lines, &b->io, clock);
}

static uint32_t finish(struct bench *b)
{
    return remote_io_finish(&b->c, &b->set, &b->lines, &b->io);
}

/* Exchanges that end up to and including `clock`; all their events. */
static uint32_t run(struct bench *b, int64_t clock)
{
    uint32_t events = 0;
    while (remote_io_due(&b->io) <= clock)
        events |= finish(b);
    return events;
}

static uint16_t output(const struct bench *b, int slave, int port, int64_t clock)
{
    uint16_t out[PORTS];
    remote_io_outputs(&b->c, &b->io, clock, slave, out);
    return out[port];
}

static enum remote_io_status check(const struct remote_io_control *set)
{
    struct remote_io_control before = *set;
    enum remote_io_status status = remote_io_check_control(set);
    CHECK(memcmp(set, &before, sizeof before) == 0);
    return status;
}

/* Both ends of each range are taken, what is beyond is refused; the first that is wrong is said. */
static void settings(void)
{
    const struct remote_io_control low = { 0 };
    struct remote_io_control high = { .on = true, .enabled = 7, .retry_limit = 255 };
    for (int64_t time = -1; time < 2; time++) {
        const struct remote_io_config c = { (int32_t)time };
        CHECK_EQ(remote_io_check_config(&c), time < 1 ? REMOTE_IO_BAD_TIME : REMOTE_IO_OK);
    }
    for (int i = 0; i < 12; i++)
        high.edge[i / 4][i % 4] = REMOTE_IO_BOTH;
    CHECK_EQ(check(&low), REMOTE_IO_OK);
    CHECK_EQ(check(&high), REMOTE_IO_OK);
    for (int i = 0; i < 12; i++)
        for (int bad = 0; bad < 2; bad++) {
            struct remote_io_control set = bad ? high : low;
            set.edge[i / 4][i % 4] = (enum remote_io_edge)(bad ? 3 : -1);
            CHECK_EQ(check(&set), REMOTE_IO_BAD_EDGE);
            set.retry_limit = bad ? 256 : -1;
            CHECK_EQ(check(&set), REMOTE_IO_BAD_RETRY);
            set.enabled = bad ? 8 : 1u << 31;
            CHECK_EQ(check(&set), REMOTE_IO_BAD_ENABLED);
        }
    for (int i = REMOTE_IO_OK; i <= REMOTE_IO_BAD_EDGE; i++)
        CHECK(strcmp(remote_io_status_text((enum remote_io_status)i), "unknown status") != 0);
}

/* n slaves take n * time, ascending from the lowest; nothing enabled: nothing happens. */
static void scan(void)
{
    for (uint32_t enabled = 1; enabled < 8; enabled++)
        for (int32_t time = 1; time <= 3; time++) {
            struct bench b = bench(time, enabled, 0);
            update(&b, 100);
            int64_t due = 100;
            for (int round = 0; round < 3; round++)
                for (int i = 0; i < SLAVES; i++) {
                    if (!(enabled >> i & 1))
                        continue;
                    struct bench same = b;
                    update(&b, due + time / 2); /* written again: nothing changes */
                    CHECK(memcmp(&b, &same, sizeof b) == 0);
                    CHECK_EQ(b.io.slave, i);
                    due += time;
                    CHECK_EQ(remote_io_due(&b.io), due);
                    CHECK_EQ(b.io.ready >> i & 1, round > 0);
                    CHECK_EQ(finish(&b), 0);
                    CHECK_EQ(b.io.ready >> i & 1, 1);
                }
            CHECK_EQ(b.io.ready, enabled);
        }
    struct bench b = bench(5, 0, 0), same = b;
    update(&b, 40);
    CHECK_EQ(remote_io_due(&b.io), INT64_MAX);
    CHECK_EQ(finish(&b), 0);
    CHECK(memcmp(&b, &same, sizeof b) == 0);
}

/* Both directions: as of the start, effective at the end and not a clock before. */
static void start_and_end(void)
{
    struct bench b = bench(10, 2, 0);
    b.set.out[1][3] = 0x8001;
    b.lines.in[1][2] = 0x7FFE;
    update(&b, 50);
    b.set.out[1][3] = 0x1111;
    b.lines.in[1][2] = 0x2222;
    b.lines.connected = 0; /* it was connected at the start */
    CHECK_EQ(output(&b, 1, 3, 59), 0);
    CHECK_EQ(b.io.in[1][2], 0);
    CHECK_EQ(run(&b, 60), 0);
    CHECK_EQ(output(&b, 1, 3, 60), 0x8001);
    CHECK_EQ(b.io.in[1][2], 0x7FFE);
    b.lines.connected = 5u | 1u << 31; /* back, but not at the start */
    CHECK_EQ(run(&b, 70), FAIL);
    b.lines.connected = 2;
    CHECK_EQ(b.io.in[1][2], 0x7FFE);
    CHECK_EQ(run(&b, 80), 0); /* begun at 70 with the lines of then */
    CHECK_EQ(b.io.errors[1], 2);
    CHECK_EQ(run(&b, 90), 0);
    CHECK_EQ(b.io.in[1][2], 0x2222);
    CHECK_EQ(output(&b, 1, 3, 90), 0x1111);
}

/* Every input of every slave, every edge type; a change made while connected or while cut off. */
static void inputs(bool cut)
{
    for (int i = 0; i < SLAVES * 16; i++) {
        int slave = i / 16, bit = i % 16;
        for (int edge = REMOTE_IO_RISE; edge <= REMOTE_IO_BOTH; edge++) {
            struct bench b = bench(1, 7, 2);
            for (int k = 0; k < 4; k++)
                b.set.edge[slave][k] = (enum remote_io_edge)edge;
            memset(b.lines.in, 0xFF, sizeof b.lines.in); /* the first one fires nothing */
            update(&b, 0);
            CHECK_EQ(run(&b, 6), 0);
            for (int up = 0; up < 2; up++) {
                bool fires = bit < 4 && edge != (up ? REMOTE_IO_FALL : REMOTE_IO_RISE);
                uint32_t want = (uint32_t)fires << (4 * slave + bit % 4);
                b.lines.in[slave][0] = (uint16_t)(0xFFFF ^ (up ? 0 : 1u << bit));
                b.lines.in[slave][1 + i % 3] ^= 0xF; /* other ports do not interrupt */
                b.lines.connected = cut ? 0 : 7;
                CHECK_EQ(run(&b, 18 + 24 * up), cut ? FAIL : want);
                b.lines.connected = 7;
                CHECK_EQ(run(&b, 24 + 24 * up), cut ? want : 0);
            }
        }
    }
}

/* The events come with failure retry_limit + 1, exactly, and once. */
static void failures(int32_t limit)
{
    struct bench b = bench(4, 4, limit);
    b.lines.connected = 3;
    update(&b, 0);
    for (int n = 1; n <= limit + 5; n++) {
        CHECK_EQ(run(&b, 4 * n - 1), 0);
        CHECK_EQ(finish(&b), n == limit + 1 ? NOT_READY : 0);
        CHECK_EQ(b.io.errors[2], n);
        CHECK_EQ(b.io.in_a_row[2], n);
    }
    int32_t errors = limit + 5;
    for (int round = 0; round < 2; round++) {
        b.lines.connected = 4;
        CHECK_EQ(finish(&b), 0); /* begun while it was cut off */
        CHECK_EQ(finish(&b), 0);
        CHECK_EQ(b.io.ready, 4);
        CHECK_EQ(b.io.errors[2], ++errors);
        CHECK_EQ(b.io.in_a_row[2], 0);
        b.lines.connected = 0;
        CHECK_EQ(finish(&b), 0);
        for (int n = 1; n <= limit + 5; n++) {
            CHECK_EQ(finish(&b), n == limit + 1 ? FAIL : 0);
            CHECK_EQ(b.io.ready, n > limit ? 0 : 4);
            CHECK_EQ(b.io.errors[2], ++errors);
        }
    }
}

/* Outputs fall (limit + 1) * 3 * time clocks after the latest good exchange, with its limit; cut
 * off (0), disabled (1) or the set off (2). */
static void safe_state(int32_t time, int32_t limit, uint32_t enabled, int how)
{
    struct bench b = bench(time, enabled, limit);
    b.set.out[0][0] = 0xABCD;
    update(&b, 7);
    int64_t heard = 7 + time, silence = (limit + 1) * INT64_C(3) * time;
    b.lines.connected = how == 0 ? 0 : 7;
    run(&b, heard);
    b.set.enabled = how == 1 ? 6 : 7;
    b.set.on = how != 2;
    b.set.retry_limit = 255 - limit; /* the slave does not hear of it */
    update(&b, heard);
    run(&b, heard + time);
    CHECK_EQ(output(&b, 0, 0, heard), 0xABCD);
    CHECK_EQ(output(&b, 0, 0, heard + silence - 1), 0xABCD);
    CHECK_EQ(output(&b, 0, 0, heard + silence), 0);
    run(&b, heard + 2 * silence);
    b.set.on = true;
    b.set.enabled = 1;
    b.lines.connected = 1;
    update(&b, heard + 2 * silence);
    finish(&b); /* may have begun in the cut */
    finish(&b);
    CHECK_EQ(output(&b, 0, 0, b.io.due - time), 0xABCD);
}

/* In a full scan the outputs fall at the very clock of FAIL. */
static void fall_together(int32_t time, int32_t limit)
{
    struct bench b = bench(time, 7, limit);
    memset(b.set.out, 0xFF, sizeof b.set.out);
    update(&b, 0);
    run(&b, 9 * time);
    b.lines.connected = 5;
    int64_t clock = (8 + 3 * (limit + 1)) * time; /* its latest good one ended at 8 * time */
    CHECK_EQ(run(&b, clock - 1), 0);
    CHECK_EQ(run(&b, clock), FAIL);
    CHECK_EQ(output(&b, 1, 2, clock - 1), 0xFFFF);
    CHECK_EQ(output(&b, 1, 2, clock), 0);
}

/* Leaving the scan in the middle of an exchange drops it; coming back resets the counts. */
static void leave_and_return(void)
{
    struct bench b = bench(10, 7, 3);
    update(&b, 0);
    b.lines.connected = 6;
    run(&b, 45); /* slave 0 failed at 40; slave 1 since then */
    b.lines.in[2][0] = 1;
    b.set.enabled = 5;
    update(&b, 47);
    CHECK_EQ(b.io.ready, 5); /* at once */
    CHECK_EQ(b.io.exchanges, 4);
    CHECK_EQ(b.io.slave, 2);
    CHECK_EQ(remote_io_due(&b.io), 57);
    CHECK_EQ(run(&b, 57), 1 << 8);
    b.set.enabled = 6;
    update(&b, 60); /* drops slave 0's, begun at 57 */
    CHECK_EQ(b.io.slave, 1);
    CHECK_EQ(b.io.errors[0] + 10 * b.io.in_a_row[0], 11); /* stay to be read */
    b.set.enabled = 7;
    b.lines.in[1][0] = 2;
    update(&b, 60);
    CHECK_EQ(b.io.errors[0] + b.io.in_a_row[0], 0);
    CHECK_EQ(remote_io_due(&b.io), 70);
    b.set.on = false; /* off at the clock of an end, which is first */
    run(&b, 70);
    update(&b, 70);
    CHECK_EQ(b.io.exchanges, 6);
    CHECK_EQ(remote_io_due(&b.io), INT64_MAX);
    b.set.on = true;
    update(&b, 90);
    CHECK_EQ(b.io.slave, 0);
    CHECK_EQ(remote_io_due(&b.io), 100);
}

/* Counters at their end, and the longest hold: 256 * 3 * (2^31 - 1) clocks, 11.5 h. */
static void ends_of_ranges(void)
{
    struct bench b = bench(1, 1, 255);
    update(&b, 0);
    finish(&b);
    b.lines.connected = 0;
    finish(&b);
    b.io.errors[0] = b.io.in_a_row[0] = b.io.exchanges = INT32_MAX - 1;
    CHECK_EQ(finish(&b), FAIL);
    CHECK_EQ(finish(&b), 0);
    CHECK_EQ(b.io.exchanges, 0);
    CHECK_EQ(b.io.errors[0], INT32_MAX);
    CHECK_EQ(b.io.in_a_row[0], INT32_MAX);
    b = bench(INT32_MAX, 7, 255);
    b.set.out[0][0] = 9;
    update(&b, INT64_C(1) << 60);
    finish(&b);
    int64_t heard = (INT64_C(1) << 60) + INT32_MAX, hold = 768 * (int64_t)INT32_MAX;
    CHECK_EQ(remote_io_due(&b.io), heard + INT32_MAX);
    CHECK_EQ(output(&b, 0, 0, heard + hold - 1), 9);
    CHECK_EQ(output(&b, 0, 0, heard + hold), 0);
}

/* The model: it counts clocks and writes out what the header promises in the plainest way. */
enum life { OUT, NEW, NEW_TOLD, READY, LOST };

struct model {
    struct {
        enum life life;
        int32_t errors, row;
        uint16_t in[PORTS], terminal[PORTS];
        int64_t quiet, patience; /* [clocks] */
    } slave[SLAVES];
    int turn;     /* -1: idle */
    int64_t left; /* [clocks] of the exchange to go */
    bool good;
    uint16_t in[PORTS], out[PORTS];
    int64_t patience;
    int32_t exchanges;
};

static void model_turn(const struct bench *b, struct model *m, int after)
{
    m->turn = -1;
    for (int n = SLAVES; n >= 1; n--)
        if (m->slave[(after + n) % SLAVES].life != OUT)
            m->turn = (after + n) % SLAVES;
    if (m->turn < 0)
        return;
    m->left = b->c.time;
    m->good = (b->lines.connected & 1u << m->turn) != 0;
    m->patience = 3 * b->c.time * (b->set.retry_limit + 1);
    memcpy(m->in, b->lines.in[m->turn], sizeof m->in);
    memcpy(m->out, b->set.out[m->turn], sizeof m->out);
}

static void model_write(const struct bench *b, struct model *m)
{
    for (int i = 0; i < SLAVES; i++) {
        bool in = b->set.on && (b->set.enabled & 1u << i) != 0;
        if (in && m->slave[i].life == OUT) {
            m->slave[i].life = NEW;
            m->slave[i].errors = m->slave[i].row = 0;
        }
        if (!in)
            m->slave[i].life = OUT;
    }
    if (m->turn < 0)
        model_turn(b, m, SLAVES - 1);
    else if (m->slave[m->turn].life == OUT)
        model_turn(b, m, m->turn);
}

static uint32_t model_good(const struct bench *b, struct model *m)
{
    int i = m->turn;
    uint32_t events = 0;
    for (int k = 0; k < 4; k++) {
        bool was = (m->slave[i].in[0] & 1 << k) != 0, is = (m->in[0] & 1 << k) != 0;
        enum remote_io_edge edge = b->set.edge[i][k];
        if ((edge != REMOTE_IO_FALL && !was && is) || (edge != REMOTE_IO_RISE && was && !is))
            events += 1u << (4 * i + k);
    }
    if (m->slave[i].life == NEW || m->slave[i].life == NEW_TOLD)
        events = 0;
    memcpy(m->slave[i].in, m->in, sizeof m->in);
    memcpy(m->slave[i].terminal, m->out, sizeof m->out);
    m->slave[i].life = READY;
    m->slave[i].row = 0;
    m->slave[i].quiet = 0;
    m->slave[i].patience = m->patience;
    return events;
}

static uint32_t model_bad(const struct bench *b, struct model *m)
{
    enum life *life = &m->slave[m->turn].life;
    m->slave[m->turn].errors++;
    if (++m->slave[m->turn].row <= b->set.retry_limit)
        return 0;
    if (*life != READY && *life != NEW)
        return 0;
    bool lost = *life == READY;
    *life = lost ? LOST : NEW_TOLD;
    return lost ? FAIL : NOT_READY;
}

/* One clock passes. */
static uint32_t model_tick(const struct bench *b, struct model *m)
{
    for (int i = 0; i < SLAVES; i++)
        if (++m->slave[i].quiet >= m->slave[i].patience)
            memset(m->slave[i].terminal, 0, sizeof m->slave[i].terminal);
    if (m->turn < 0 || --m->left > 0)
        return 0;
    m->exchanges++;
    uint32_t events = m->good ? model_good(b, m) : model_bad(b, m);
    model_turn(b, m, m->turn);
    return events;
}

/* How often each thing happened in all scenarios: they must not be idle. */
static int64_t edges, fails, not_readies, dropped, safe, late;

static void same(const struct bench *b, const struct model *m, int64_t clock)
{
    CHECK_EQ(remote_io_due(&b->io), m->turn < 0 ? INT64_MAX : clock + m->left);
    CHECK_EQ(b->io.exchanges, m->exchanges);
    for (int i = 0; i < SLAVES; i++) {
        uint16_t out[PORTS];
        remote_io_outputs(&b->c, &b->io, clock, i, out);
        CHECK(memcmp(out, m->slave[i].terminal, sizeof out) == 0);
        CHECK(memcmp(b->io.in[i], m->slave[i].in, sizeof out) == 0);
        CHECK_EQ(b->io.ready >> i & 1, m->slave[i].life == READY);
        CHECK_EQ(b->io.errors[i], m->slave[i].errors);
        CHECK_EQ(b->io.in_a_row[i], m->slave[i].row);
        safe += out[0] == 0 && m->slave[i].quiet == m->slave[i].patience;
    }
    CHECK_EQ(b->io.ready >> SLAVES, 0);
}

/* The host changes one register. */
static void change(uint64_t *seed, struct remote_io_control *set)
{
    int i = (int)check_random(seed, 0, SLAVES - 1), k = (int)check_random(seed, 0, 3);
    int what = (int)check_random(seed, 0, 9);
    if (what == 0)
        set->on = check_random(seed, 0, 3) > 0;
    else if (what < 3)
        set->enabled ^= 1u << i;
    else if (what == 3)
        set->retry_limit = (int32_t)check_random(seed, 0, 4);
    else if (what < 6)
        set->edge[i][k] = (enum remote_io_edge)check_random(seed, 0, 2);
    else
        set->out[i][k] = (uint16_t)check_random(seed, 0, UINT16_MAX);
}

static void field(uint64_t *seed, struct remote_io_lines *lines)
{
    int64_t i = check_random(seed, 0, SLAVES - 1), what = check_random(seed, 0, 19);
    if (what < 10)
        lines->in[i][0] ^= (uint16_t)(1u << check_random(seed, 0, 7));
    else if (what < 13)
        lines->in[i][check_random(seed, 1, 3)] = (uint16_t)check_random(seed, 0, UINT16_MAX);
    else if (what == 13)
        lines->connected ^= 1u << check_random(seed, 0, 3); /* bit 3: no such slave */
}

static void scenario(uint64_t seed)
{
    struct bench b = bench((int32_t)check_random(&seed, 1, 7), 7, 1);
    struct model m = { .turn = -1 };
    for (int64_t clock = 0; clock < 1200; clock++) {
        int32_t row = m.turn >= 0 ? m.slave[m.turn].row : 0;
        uint32_t want = clock > 0 ? model_tick(&b, &m) : 0;
        CHECK_EQ(remote_io_due(&b.io) == clock ? finish(&b) : 0, want);
        edges += (want & 0xFFF) != 0;
        late += (want & 0xFFF) != 0 && row > b.set.retry_limit;
        fails += (want & FAIL) != 0;
        not_readies += (want & NOT_READY) != 0;
        field(&seed, &b.lines);
        if (check_random(&seed, 0, 19) == 0)
            change(&seed, &b.set);
        if (check_random(&seed, 0, 29) == 0) { /* until then the scan is the old one */
            int turn = m.turn;
            update(&b, clock);
            model_write(&b, &m);
            dropped += turn >= 0 && m.slave[turn].life == OUT;
        }
        same(&b, &m, clock);
    }
}

int main(void)
{
    settings();
    scan();
    start_and_end();
    inputs(false);
    inputs(true);
    const int32_t limits[] = { 0, 1, 3, 255 };
    for (int i = 0; i < 4; i++) {
        failures(limits[i]);
        fall_together(1 + 4 * i, limits[i]);
        for (int k = 0; k < 12; k++)
            safe_state(1 + 6 * i, limits[i], 1 + 2 * (uint32_t)(k / 3), k % 3);
    }
    leave_and_return();
    ends_of_ranges();
    for (uint64_t seed = 1; seed <= 600; seed++)
        scenario(seed * 7919);
    CHECK(edges > 9000 && late > 1000 && fails > 2000 && not_readies > 700);
    CHECK(dropped > 1000 && safe > 4000);
    return check_result();
}
