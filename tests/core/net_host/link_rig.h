/* link_rig - for the tests: both ends of a network link, a store that programs one page per ms, and
 * two byte streams between the ends that can be slow, late and cut. */
#ifndef LINK_RIG_H
#define LINK_RIG_H

#include <string.h>

#include "check.h"
#include "net_crc.h"
#include "net_host.h"
#include "session.h"

#define RIG_MS INT64_C(1000000)
enum { RIG_PAGES = 64, RIG_CREDIT = 8, RIG_STREAM = 20000, RIG_NUMBERS = 64 };

/* The card that a session serves: its job, transfer and commands. */
struct rig_card {
    struct session session;
    uint8_t hash[NET_SHA_BYTES], flash[RIG_PAGES * NET_PAGE_BYTES];
    uint32_t pages, received, programmed; /* of the transfer: all pages, received, programmed */
    uint32_t crc;
    int64_t erased, committed; /* [ns] end of erasing, of committing; 0 none */
    uint8_t in_force[NET_SHA_BYTES];
    bool ended;
    int twice, refused;         /* number of pages received twice; refused as out of order */
    int done[RIG_NUMBERS];      /* how often each command number was done */
    uint8_t order[RIG_NUMBERS]; /* types of the commands in the order in which they were done */
    int orders;
    uint32_t late_number; /* a HOME whose result comes later */
    int64_t late;
};

/* A stream in one direction: bytes, each with the time of its arrival. */
struct rig_stream {
    uint8_t byte[RIG_STREAM];
    int64_t at[RIG_STREAM];
    int first, count;
    int64_t passed;    /* number of bytes since the start of the rig */
    int64_t cut_after; /* value of `passed` at which it is cut; -1 never */
};

struct rig {
    struct net_host host;
    struct rig_card card;
    struct rig_stream to_card, to_host;
    uint8_t job[RIG_PAGES * NET_PAGE_BYTES];
    uint32_t pages;
    int64_t now;
    bool connected;
    int cuts;
    uint64_t seed;
    int64_t delay_most; /* [ns] largest random delay */
    int piece_most;     /* [byte] most that is moved at a time */
};

static void rig_start(struct rig *r, uint32_t pages, bool keyed, uint64_t seed)
{
    struct net_host_config host = { .interval = 5 };
    struct session_config card = { .card = 42, .firmware = 7, .slots = 2, .axes = NET_AXES };
    memset(r, 0, sizeof *r);
    r->seed = seed;
    r->pages = pages;
    r->piece_most = NET_OUT;
    r->to_card.cut_after = r->to_host.cut_after = -1;
    for (size_t i = 0; i < pages * NET_PAGE_BYTES; i++)
        r->job[i] = (uint8_t)check_random(&r->seed, 0, 255);
    host.key[0] = card.key[0] = keyed;
    host.seed[0] = 1;
    card.seed[0] = 2;
    net_host_start(&r->host, &host);
    net_host_load(&r->host, r->job, pages * NET_PAGE_BYTES);
    session_start(&r->card.session, &card, 0);
}

static uint16_t rig_credit(const struct rig_card *c)
{
    return (uint16_t)(RIG_CREDIT - (c->received - c->programmed));
}

static uint16_t rig_missing(const struct rig_card *c)
{
    return c->received < c->pages ? (uint16_t)c->received : NET_NO_PAGE;
}

static void rig_begin(struct rig_card *c, const struct session_message *m, int64_t now)
{
    struct net_job_begin begin;
    net_get_job_begin(m->payload, &begin);
    if (memcmp(begin.hash, c->in_force, sizeof begin.hash) == 0) {
        session_job(&c->session, NET_DONE, 0, rig_credit(c), NET_NO_PAGE);
    } else if (c->pages > 0 && memcmp(begin.hash, c->hash, sizeof begin.hash) == 0) {
        if (c->erased == 0)
            session_job(&c->session, NET_DONE, 0, rig_credit(c), rig_missing(c));
    } else {
        memcpy(c->hash, begin.hash, sizeof c->hash);
        c->pages = begin.bytes / NET_PAGE_BYTES;
        c->crc = begin.crc;
        c->received = c->programmed = 0;
        c->erased = now + 2 * RIG_MS;
    }
}

static void rig_data(struct rig_card *c, const struct session_message *m)
{
    struct net_job_pages p;
    net_get_job_pages(m->payload, &p);
    if (p.page != c->received || p.page + p.count > c->pages || p.count > rig_credit(c)
        || c->erased != 0) {
        c->twice += p.page < c->received;
        c->refused++;
        session_nak(&c->session, m->sequence, NET_PAGE, p.page);
        return;
    }
    memcpy(c->flash + (size_t)p.page * NET_PAGE_BYTES, m->payload + NET_BYTES_job_pages,
           (size_t)p.count * NET_PAGE_BYTES);
    c->received += p.count;
}

static void rig_command(struct rig_card *c, const struct session_message *m, int64_t now)
{
    struct net_command command;
    net_get_command(m->payload, &command);
    CHECK(command.number > 0 && command.number < RIG_NUMBERS);
    c->done[command.number % RIG_NUMBERS]++;
    c->order[c->orders++ % RIG_NUMBERS] = m->type;
    if (m->type == NET_HOME && c->late == 0) {
        c->late = now + 30 * RIG_MS;
        c->late_number = command.number;
    } else {
        session_result(&c->session, command.number, NET_DONE, NET_READY);
    }
}

static void rig_end(struct rig_card *c)
{
    if (memcmp(c->hash, c->in_force, sizeof c->hash) == 0 || c->received < c->pages)
        session_job(&c->session, NET_DONE, 0, rig_credit(c), rig_missing(c));
    else
        c->ended = true;
}

/* Let the store work up to the time `now`. */
static void rig_store(struct rig_card *c, int64_t now)
{
    struct session *s = &c->session;
    if (c->erased && now >= c->erased) {
        c->erased = 0;
        session_job(s, NET_DONE, 0, rig_credit(c), rig_missing(c));
    } else if (c->programmed < c->received) {
        c->programmed++;
        session_ack(s, rig_credit(c), rig_missing(c));
    } else if (c->ended && c->committed == 0) {
        c->committed = now + 3 * RIG_MS;
    } else if (c->committed && now >= c->committed) {
        const bool right = net_crc(0, c->flash, c->pages * NET_PAGE_BYTES) == c->crc;
        c->committed = 0;
        c->ended = false;
        if (right)
            memcpy(c->in_force, c->hash, sizeof c->hash);
        session_job(s, right ? NET_DONE : NET_BAD_JOB, 0, rig_credit(c), rig_missing(c));
    }
    if (c->late && now >= c->late) {
        c->late = 0;
        session_result(s, c->late_number, NET_DONE, NET_READY);
    }
}

static void rig_messages(struct rig_card *c, int64_t now)
{
    struct session_message m;
    while (session_next(&c->session, &m, now)) {
        if (m.type == NET_JOB_BEGIN)
            rig_begin(c, &m, now);
        else if (m.type == NET_JOB_DATA)
            rig_data(c, &m);
        else if (m.type == NET_JOB_END)
            rig_end(c);
        else
            rig_command(c, &m, now);
        session_drop(&c->session);
    }
}

static void rig_cut(struct rig *r)
{
    r->connected = false;
    r->to_card.count = r->to_host.count = 0;
    session_cut(&r->card.session, r->now);
    net_host_cut(&r->host);
}

static void rig_push(struct rig *r, struct rig_stream *s, const uint8_t *bytes, size_t n)
{
    int64_t at = r->now;
    if (r->delay_most > 0)
        at += check_random(&r->seed, 0, r->delay_most);
    if (s->count > 0) { /* order is kept */
        const int64_t last = s->at[(s->first + s->count - 1) % RIG_STREAM];
        at = at < last ? last : at;
    }
    for (size_t i = 0; i < n; i++) {
        const int to = (s->first + s->count) % RIG_STREAM;
        s->byte[to] = bytes[i];
        s->at[to] = at;
        s->count++;
    }
    CHECK(s->count <= RIG_STREAM);
}

/* Bytes that have arrived, up to a cut. Returns their number. */
static size_t rig_ready(const struct rig *r, const struct rig_stream *s, uint8_t *bytes,
                        size_t most)
{
    size_t n = 0;
    while (n < most && n < (size_t)s->count && s->at[(s->first + (int)n) % RIG_STREAM] <= r->now
           && (s->cut_after < 0 || s->passed + (int64_t)n < s->cut_after)) {
        bytes[n] = s->byte[(s->first + (int)n) % RIG_STREAM];
        n++;
    }
    return n;
}

static void rig_pop(struct rig_stream *s, size_t n)
{
    s->first = (s->first + (int)n) % RIG_STREAM;
    s->count -= (int)n;
    s->passed += (int64_t)n;
}

static size_t rig_piece(struct rig *r)
{
    return (size_t)(r->piece_most < NET_OUT ? check_random(&r->seed, 1, r->piece_most) : NET_OUT);
}

/* Carry bytes from each end to the other; cut the connection when a stream has passed its bytes. */
static void rig_carry(struct rig *r)
{
    uint8_t bytes[NET_OUT];
    if (r->to_card.count < RIG_STREAM / 2)
        rig_push(r, &r->to_card, bytes, net_host_out(&r->host, bytes, rig_piece(r)));
    if (r->to_host.count < RIG_STREAM / 2)
        rig_push(r, &r->to_host, bytes, session_out(&r->card.session, bytes, rig_piece(r)));
    for (int i = 0; i < 50; i++) {
        size_t n = rig_ready(r, &r->to_card, bytes, rig_piece(r));
        n = session_bytes(&r->card.session, bytes, n, r->now);
        rig_pop(&r->to_card, n);
        rig_messages(&r->card, r->now);
        if (n == 0)
            break;
    }
    const size_t n = rig_ready(r, &r->to_host, bytes, rig_piece(r));
    net_host_bytes(&r->host, bytes, n, r->now);
    rig_pop(&r->to_host, n);
    struct rig_stream *both[2] = { &r->to_card, &r->to_host };
    for (int i = 0; i < 2; i++) {
        if (both[i]->cut_after >= 0 && both[i]->passed >= both[i]->cut_after && r->connected) {
            both[i]->cut_after = -1;
            r->cuts++;
            rig_cut(r);
        }
    }
}

static void rig_connect(struct rig *r)
{
    struct rig_card *c = &r->card;
    const struct rig_card *k = c;
    struct session_about about = { .credit = rig_credit(k), .state = NET_READY };
    memcpy(about.job, c->in_force, sizeof about.job);
    r->connected = true;
    session_connected(&c->session, &about, r->now);
    net_host_connected(&r->host, r->now);
}

static void rig_step(struct rig *r)
{
    struct session *s = &r->card.session;
    struct net_status status = { .state = NET_READY };
    r->now += RIG_MS;
    rig_store(&r->card, r->now);
    if (session_next_time(s) <= r->now)
        session_tick(s, r->now);
    if (session_status_time(s) <= r->now)
        session_status(s, &status, r->now);
    net_host_tick(&r->host, r->job, r->now);
    if (r->connected && (!session_wants(s) || !net_host_accepts(&r->host)))
        rig_cut(r);
    if (!r->connected && session_wants(s) && s->phase == SESSION_CALLING)
        rig_connect(r);
    if (r->connected)
        rig_carry(r);
}

/* Whether all commands have a result and the card has its job. */
static bool rig_is_done(const struct rig *r)
{
    for (int i = 0; i < NET_HOST_ORDERS; i++) {
        if (r->host.order[i].stage == NET_HOST_WAITING || r->host.order[i].stage == NET_HOST_SENT)
            return false;
    }
    return r->host.upload == NET_HOST_STORED;
}

/* Run until rig_is_done; false if that takes more than `most` ms. */
static inline bool rig_run(struct rig *r, int64_t most)
{
    for (int64_t i = 0; i < most && !rig_is_done(r); i++)
        rig_step(r);
    return rig_is_done(r);
}

/* Give commands during the upload and after it, among them a HOME whose result comes late. Returns
 * their number. */
static int rig_orders(struct rig *r)
{
    static const uint8_t type[] = {
        NET_START, NET_HOME, NET_PAUSE, NET_OUTPUT, NET_START, NET_STOP
    };
    enum { ORDERS = sizeof type };
    for (int i = 0; i < ORDERS; i++) {
        const struct net_host_order order = { .at = (3 + 4 * i) * RIG_MS,
                                              .type = type[i],
                                              .axes = 3 };
        CHECK(net_host_give(&r->host, &order));
    }
    return ORDERS;
}

/* Check the properties: the job is the one that was sent, no page was sent that the card had, each
 * command was done once and in order. */
static void rig_check(const struct rig *r, int orders)
{
    const struct rig_card *c = &r->card;
    const struct net_host *h = &r->host;
    CHECK(memcmp(c->flash, r->job, r->pages * NET_PAGE_BYTES) == 0);
    CHECK(memcmp(c->in_force, h->job.hash, sizeof c->in_force) == 0);
    CHECK_EQ(c->twice, 0);
    CHECK_EQ(c->refused, 0);
    CHECK_EQ(h->pages_sent - h->pages_again, r->pages);
    CHECK_EQ(c->orders, orders);
    for (int i = 0; i < orders; i++) {
        const struct net_host_order *o = &h->order[i];
        CHECK_EQ(o->stage, NET_HOST_ANSWERED);
        CHECK_EQ(o->code, NET_DONE);
        CHECK_EQ(c->done[o->number % RIG_NUMBERS], 1);
        CHECK_EQ(c->order[i], o->type);
    }
}

#endif
