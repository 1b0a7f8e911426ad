/* The card's end by itself: handshake, numbers, room, times. */
#include <string.h>

#include "check.h"
#include "session.h"

static const int64_t second = INT64_C(1000000000);

/* A server made by hand on the channel. */
struct peer {
    struct session card;
    struct net_channel server;
    struct net_hello hello;
    struct net_secret secret;
    int64_t now;
};

static void start(struct peer *p, uint8_t key)
{
    const struct session_config c = {
        .card = 5, .slots = 2, .axes = 4, .key = { key }, .seed = { 9 }
    };
    memset(p, 0, sizeof *p);
    session_start(&p->card, &c, 0);
}

/* What the server has queued goes to the card. */
static void carry(struct peer *p)
{
    uint8_t bytes[NET_OUT];
    size_t n;
    while ((n = net_channel_out(&p->server, bytes, sizeof bytes)) > 0)
        session_bytes(&p->card, bytes, n, p->now);
}

/* The next frame from the card; its type, 0 if there is none. */
static uint8_t hear(struct peer *p)
{
    uint8_t byte;
    if (p->server.whole)
        net_channel_drop(&p->server);
    while (!p->server.whole && session_out(&p->card, &byte, 1) == 1)
        net_channel_take(&p->server, &byte, 1);
    CHECK_EQ(p->server.fault, NET_FINE);
    return p->server.whole ? net_channel_type(&p->server) : 0;
}

static void connect_card(struct peer *p)
{
    const struct session_about about = { .credit = 16, .state = NET_READY, .job = { 3 } };
    net_channel_start(&p->server, false);
    session_connected(&p->card, &about, p->now);
    CHECK_EQ(hear(p), NET_HELLO);
    net_get_hello(net_channel_payload(&p->server), &p->hello);
}

/* Answer HELLO with this key and protocol. */
static void challenge(struct peer *p, uint8_t key, uint16_t protocol)
{
    struct net_challenge c = { .protocol = protocol, .nonce = { 4 } };
    uint8_t payload[NET_BYTES_challenge];
    p->secret = (struct net_secret){ .key = { key }, .card = p->hello.card, .protocol = protocol };
    memcpy(p->secret.card_nonce, p->hello.nonce, NET_NONCE);
    memcpy(p->secret.server_nonce, c.nonce, NET_NONCE);
    net_prove(&p->secret, NET_OF_SERVER, c.proof);
    net_put_challenge(payload, &c);
    net_channel_put(&p->server, NET_CHALLENGE, payload, sizeof payload);
    carry(p);
}

static void say(struct peer *p, uint8_t type, const void *payload, size_t n)
{
    CHECK(net_channel_put(&p->server, type, payload, n));
    carry(p);
}

static void say_number(struct peer *p, uint8_t type, uint32_t number)
{
    const struct net_command command = { number };
    uint8_t payload[NET_BYTES_command];
    net_put_command(payload, &command);
    say(p, type, payload, sizeof payload);
}

static void bring_up(struct peer *p, uint8_t key, uint16_t interval)
{
    const struct net_welcome welcome = { .interval = interval };
    uint8_t payload[NET_BYTES_welcome], proof[NET_SHA_BYTES];
    start(p, key);
    connect_card(p);
    challenge(p, key, NET_PROTOCOL);
    CHECK_EQ(hear(p), NET_AUTH);
    net_prove(&p->secret, NET_OF_CARD, proof);
    CHECK(memcmp(proof, net_channel_payload(&p->server), sizeof proof) == 0);
    net_prove(&p->secret, NET_OF_SESSION, proof);
    if (key)
        net_channel_key(&p->server, proof);
    net_put_welcome(payload, &welcome);
    say(p, NET_WELCOME, payload, sizeof payload);
    CHECK(session_up(&p->card));
}

/* Is a message for the card there? It is dropped. */
static uint8_t message(struct peer *p)
{
    struct session_message m;
    if (!session_next(&p->card, &m, p->now))
        return 0;
    session_drop(&p->card);
    return m.type;
}

static void check_handshake(void)
{
    struct peer p;
    uint8_t nonce[NET_NONCE];
    for (uint8_t key = 0; key < 2; key++)
        bring_up(&p, key, 0);
    start(&p, 1);
    connect_card(&p);
    CHECK_EQ(p.hello.card, 5);
    CHECK_EQ(p.hello.credit, 16);
    CHECK_EQ(p.hello.job[0], 3);
    memcpy(nonce, p.hello.nonce, sizeof nonce);
    challenge(&p, 2, NET_PROTOCOL); /* a server without the key */
    CHECK(!session_wants(&p.card));
    CHECK_EQ(hear(&p), 0);
    p.now = p.card.due;
    session_tick(&p.card, p.now);
    CHECK(session_wants(&p.card));
    connect_card(&p);
    CHECK(memcmp(nonce, p.hello.nonce, sizeof nonce) != 0);
    memcpy(p.hello.nonce, nonce, sizeof nonce);
    challenge(&p, 1, NET_PROTOCOL); /* one that replays an earlier connection */
    CHECK(!session_wants(&p.card));
    start(&p, 1);
    connect_card(&p);
    challenge(&p, 1, 2); /* another protocol */
    CHECK(!session_wants(&p.card));
    start(&p, 1);
    connect_card(&p);
    say_number(&p, NET_START, 1); /* a command before the proof */
    CHECK(!session_wants(&p.card));
    CHECK_EQ(message(&p), 0);
}

static struct net_result heard_result(struct peer *p)
{
    struct net_result r = { 0 };
    CHECK_EQ(hear(p), NET_RESULT);
    if (p->server.whole)
        net_get_result(net_channel_payload(&p->server), &r);
    return r;
}

static void check_numbers(void)
{
    struct peer p;
    bring_up(&p, 1, 0);
    for (uint32_t number = 1; number <= 12; number++) {
        say_number(&p, NET_PAUSE, number);
        CHECK_EQ(message(&p), NET_PAUSE);
        session_result(&p.card, number, number % 2 ? NET_DONE : NET_STATE, NET_RUNNING);
        const struct net_result r = heard_result(&p);
        CHECK_EQ(r.number, number);
        CHECK_EQ(r.code, number % 2 ? NET_DONE : NET_STATE);
    }
    for (uint32_t number = 0; number <= 12; number++) { /* again: eight are known */
        say_number(&p, NET_PAUSE, number);
        CHECK_EQ(message(&p), 0);
        const struct net_result r = heard_result(&p);
        CHECK_EQ(r.number, number);
        CHECK_EQ(r.code, number < 5 ? NET_STATE : number % 2 ? NET_DONE : NET_STATE);
        CHECK_EQ(r.state, NET_RUNNING);
    }
    CHECK_EQ(p.card.repeats, 8);
    for (uint32_t number = 100; number < 108; number++) { /* eight without a result */
        say_number(&p, NET_HOME - 1, number);
        CHECK_EQ(message(&p), NET_STOP);
    }
    say_number(&p, NET_STOP, 108);
    CHECK_EQ(message(&p), 0);
    CHECK_EQ(heard_result(&p).code, NET_BUSY);
    say_number(&p, NET_STOP, 103); /* it is under way */
    CHECK_EQ(message(&p), 0);
    CHECK_EQ(hear(&p), 0);
    session_result(&p.card, 103, NET_ALARM, NET_FAULT);
    CHECK_EQ(heard_result(&p).number, 103);
    session_result(&p.card, 103, NET_DONE, NET_READY); /* told once */
    CHECK_EQ(hear(&p), 0);
    say_number(&p, NET_STOP, 108); /* was not taken before */
    CHECK_EQ(message(&p), NET_STOP);
    /* A result of a connection that is gone is told on the next. */
    session_cut(&p.card, p.now);
    session_result(&p.card, 108, NET_DONE, NET_READY);
    CHECK_EQ(hear(&p), 0);
}

static struct net_ack heard_ack(struct peer *p)
{
    struct net_ack a = { 0 };
    CHECK_EQ(hear(p), NET_ACK);
    if (p->server.whole)
        net_get_ack(net_channel_payload(&p->server), &a);
    return a;
}

static void check_job_answers(void)
{
    struct peer p;
    uint8_t payload[NET_PAYLOAD] = { 0 };
    const struct net_job_pages pages = { 0, 1 };
    struct net_nak nak;
    bring_up(&p, 0, 0);
    say(&p, NET_JOB_BEGIN, payload, NET_BYTES_job_begin); /* sequence 3 */
    CHECK_EQ(message(&p), NET_JOB_BEGIN);
    say_number(&p, NET_STOP, 1); /* 4 */
    CHECK_EQ(message(&p), NET_STOP);
    session_ack(&p.card, 8, 0);
    CHECK_EQ(heard_ack(&p).sequence, 2);
    say(&p, NET_JOB_BEGIN, payload, NET_BYTES_job_begin); /* 5, one is under way */
    CHECK_EQ(message(&p), 0);
    CHECK_EQ(hear(&p), NET_NAK);
    net_get_nak(net_channel_payload(&p.server), &nak);
    CHECK_EQ(nak.sequence, 5);
    CHECK_EQ(nak.code, NET_BUSY);
    session_job(&p.card, NET_DONE, 0, 9, 7);
    const struct net_ack ack = heard_ack(&p);
    CHECK_EQ(ack.sequence, 5);
    CHECK_EQ(ack.credit, 9);
    CHECK_EQ(ack.missing, 7);
    net_put_job_pages(payload, &pages);
    say(&p, NET_JOB_DATA, payload, NET_BYTES_job_pages + NET_PAGE_BYTES);
    CHECK_EQ(message(&p), NET_JOB_DATA);
    session_ack(&p.card, 3, 8);
    CHECK_EQ(heard_ack(&p).sequence, 6);
    say(&p, NET_JOB_END, payload, NET_BYTES_job_end); /* 7 */
    CHECK_EQ(message(&p), NET_JOB_END);
    session_job(&p.card, NET_BAD_JOB, 2, 16, NET_NO_PAGE);
    CHECK_EQ(hear(&p), NET_NAK);
    net_get_nak(net_channel_payload(&p.server), &nak);
    CHECK_EQ(nak.sequence, 7);
    CHECK_EQ(nak.code, NET_BAD_JOB);
    CHECK_EQ(nak.detail, 2);
    CHECK_EQ(heard_ack(&p).sequence, 7);
    say(&p, 222, payload, 3); /* 8, of no type */
    CHECK_EQ(message(&p), 0);
    CHECK_EQ(hear(&p), NET_NAK);
    net_get_nak(net_channel_payload(&p.server), &nak);
    CHECK_EQ(nak.sequence, 8);
    CHECK_EQ(nak.code, NET_UNKNOWN);
    CHECK_EQ(nak.detail, 222);
    say(&p, NET_STATUS, payload, NET_BYTES_status); /* a server has no status */
    CHECK_EQ(message(&p), 0);
    CHECK_EQ(hear(&p), NET_NAK);
    say(&p, NET_PING, payload, NET_BYTES_token);
    CHECK_EQ(message(&p), 0);
    CHECK_EQ(hear(&p), NET_PONG);
}

/* While nobody takes what the card says it takes no more, and drops status before results. */
static void check_room(void)
{
    struct peer p;
    const struct net_status status = { .state = NET_READY };
    uint8_t bytes[NET_OUT], payload[NET_BYTES_command];
    uint32_t number = 0, taken = 0, results = 0;
    bring_up(&p, 1, 10);
    for (int i = 0; i < 200; i++) {
        const int64_t due = session_status_time(&p.card);
        CHECK_EQ(due, (int64_t)i * 10000000);
        session_status(&p.card, &status, due + 9999999);
    }
    CHECK(p.card.dropped > 100 && p.card.dropped < 180);
    CHECK(net_channel_room(&p.card.channel, NET_BYTES_auth, 0));
    size_t held = 0, at = 0;
    for (int i = 0; i < 400; i++) {
        while (net_channel_room(&p.server, sizeof payload, 0)) {
            const struct net_command command = { ++number };
            net_put_command(payload, &command);
            net_channel_put(&p.server, NET_START, payload, sizeof payload);
        }
        if (at == held) {
            held = net_channel_out(&p.server, bytes, sizeof bytes);
            at = 0;
        }
        at += session_bytes(&p.card, bytes + at, held - at, p.now);
        if (message(&p) != 0)
            session_result(&p.card, ++taken, NET_DONE, NET_READY);
        CHECK(p.card.channel.fault == NET_FINE);
    }
    CHECK(taken < 400 && at < held);
    session_ack(&p.card, 1, 2);
    session_ack(&p.card, 3, 4);
    int acks = 0;
    for (uint8_t type; (type = hear(&p)) != 0;) {
        struct net_result r;
        struct net_ack a;
        if (type == NET_RESULT) {
            net_get_result(net_channel_payload(&p.server), &r);
            CHECK_EQ(r.number, ++results);
        } else if (type == NET_ACK) {
            net_get_ack(net_channel_payload(&p.server), &a);
            CHECK_EQ(a.credit, 3);
            CHECK_EQ(a.missing, 4);
            acks++;
        }
    }
    CHECK_EQ(results, taken);
    CHECK_EQ(acks, 1);
    CHECK(message(&p) == NET_START); /* it goes on */
}

/* Silence: PING at 1, 2, 3 s, lost at 4 s; the next attempts 0.5 s doubling to 30 s, +-25 %. */
static void check_times(void)
{
    struct peer p;
    double sum = 0.0;
    bring_up(&p, 1, 0);
    for (int i = 1; i <= 3; i++) {
        CHECK_EQ(session_next_time(&p.card), i * second);
        session_tick(&p.card, i * second);
        CHECK_EQ(hear(&p), NET_PING);
        CHECK(!session_lost(&p.card));
    }
    session_tick(&p.card, 4 * second - 1);
    CHECK(session_up(&p.card));
    session_tick(&p.card, 4 * second);
    CHECK(!session_up(&p.card) && !session_wants(&p.card));
    CHECK(session_lost(&p.card) && !session_lost(&p.card));
    CHECK_EQ(p.card.losses, 1);
    int64_t now = 4 * second, want = second / 2;
    for (int i = 0; i < 60; i++) {
        const int64_t pause = session_next_time(&p.card) - now;
        CHECK(pause >= want - want / 4 && pause < want + want / 4);
        sum += i >= 10 ? (double)pause / 50.0 : 0.0;
        now += pause;
        session_tick(&p.card, now - 1);
        CHECK(!session_wants(&p.card));
        session_tick(&p.card, now);
        CHECK(session_wants(&p.card));
        CHECK_EQ(session_next_time(&p.card), now + SESSION_CALL_NS);
        now += i % 2 ? SESSION_CALL_NS : 5; /* nobody there, or refused at once */
        if (i % 2)
            session_tick(&p.card, now);
        else
            session_cut(&p.card, now);
        want = 2 * want < SESSION_RETRY_MOST ? 2 * want : SESSION_RETRY_MOST;
    }
    CHECK_NEAR(sum, 30e9, 2e9); /* uniform: 30 s +- 7.5 / sqrt(150) s, thrice */
    start(&p, 1);               /* a server that does not prove itself in 5 s */
    connect_card(&p);
    CHECK_EQ(session_next_time(&p.card), SESSION_PROVE_NS);
    session_tick(&p.card, SESSION_PROVE_NS);
    CHECK(!session_wants(&p.card) && !session_lost(&p.card));
}

int main(void)
{
    check_handshake();
    check_numbers();
    check_job_answers();
    check_room();
    check_times();
    return check_result();
}
