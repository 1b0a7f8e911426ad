#include "session.h"

#include <string.h>

/* Bytes of room that are kept for the answer to a message, and for each answer that may come
 * later. */
enum { ANSWER = NET_HEADER + NET_BYTES_auth + NET_MAC, LATER = NET_HEADER + 8 + NET_MAC };

enum { DOUBLINGS = 6 }; /* of the pause, 0.5 s to 30 s */

static bool queue(struct session *s, uint8_t type, const uint8_t *payload, size_t n)
{
    return net_channel_put(&s->channel, type, payload, n);
}

/* The connection is over or did not come about: pause before the next one. */
static void hang_up(struct session *s, int64_t now)
{
    int64_t pause = SESSION_RETRY_NS << s->attempts;
    uint8_t drawn[4];
    pause = pause < SESSION_RETRY_MOST ? pause : SESSION_RETRY_MOST;
    net_random_draw(&s->random, drawn, sizeof drawn);
    const uint32_t part = (uint32_t)drawn[0] << 16 | (uint32_t)drawn[1] << 8 | drawn[2];
    pause += (pause / 2 * part >> 24) - pause / 4;
    if (s->phase == SESSION_UP) {
        s->lost = true;
        s->losses++;
    }
    if (s->channel.fault != NET_FINE)
        s->fault = s->channel.fault;
    s->attempts += s->attempts < DOUBLINGS;
    s->phase = SESSION_IDLE;
    s->due = now + pause;
    s->interval = 0;
    s->job_sequence = 0;
    s->ack = false;
    s->offered = false;
    net_channel_start(&s->channel, true);
}

void session_power_up(struct session *s, int64_t now)
{
    uint8_t drawn[2];
    const struct session_config config = s->config;
    const struct net_random random = s->random;
    memset(s, 0, sizeof *s);
    s->config = config;
    s->random = random;
    net_random_draw(&s->random, drawn, sizeof drawn);
    s->life = (uint16_t)(drawn[0] | drawn[1] << 8);
    s->phase = SESSION_CALLING;
    s->due = now + SESSION_CALL_NS;
    net_channel_start(&s->channel, true);
}

void session_start(struct session *s, const struct session_config *c, int64_t now)
{
    memset(s, 0, sizeof *s);
    s->config = *c;
    net_random_start(&s->random, c->seed);
    session_power_up(s, now);
}

bool session_wants(const struct session *s)
{
    return s->phase != SESSION_IDLE;
}

bool session_up(const struct session *s)
{
    return s->phase == SESSION_UP;
}

bool session_lost(struct session *s)
{
    const bool lost = s->lost;
    s->lost = false;
    return lost;
}

void session_connected(struct session *s, const struct session_about *a, int64_t now)
{
    struct net_hello hello = {
        .card = s->config.card,
        .oldest = NET_PROTOCOL,
        .newest = NET_PROTOCOL,
        .firmware = s->config.firmware,
        .slots = s->config.slots,
        .axes = s->config.axes,
        .credit = a->credit,
        .last_command = s->last_command,
        .state = a->state,
        .life = s->life,
    };
    uint8_t payload[NET_BYTES_hello];
    if (s->phase != SESSION_CALLING)
        return;
    memcpy(s->secret.key, s->config.key, sizeof s->secret.key);
    s->secret.card = s->config.card;
    net_random_draw(&s->random, s->secret.card_nonce, NET_NONCE);
    memcpy(hello.nonce, s->secret.card_nonce, NET_NONCE);
    memcpy(hello.job, a->job, sizeof hello.job);
    net_put_hello(payload, &hello);
    queue(s, NET_HELLO, payload, sizeof payload);
    s->phase = SESSION_GREETING;
    s->due = now + SESSION_PROVE_NS;
    s->state = a->state;
    s->done = 0;
    s->connections++;
}

void session_cut(struct session *s, int64_t now)
{
    if (s->phase != SESSION_IDLE)
        hang_up(s, now);
}

static bool challenged(struct session *s)
{
    struct net_challenge challenge;
    struct net_auth auth;
    uint8_t proof[NET_SHA_BYTES], payload[NET_BYTES_auth];
    net_get_challenge(net_channel_payload(&s->channel), &challenge);
    if (challenge.protocol != NET_PROTOCOL)
        return false;
    s->secret.protocol = challenge.protocol;
    memcpy(s->secret.server_nonce, challenge.nonce, NET_NONCE);
    net_prove(&s->secret, NET_OF_SERVER, proof);
    if (!net_equal(proof, challenge.proof, sizeof proof))
        return false;
    net_prove(&s->secret, NET_OF_CARD, auth.proof);
    net_put_auth(payload, &auth);
    queue(s, NET_AUTH, payload, sizeof payload);
    net_prove(&s->secret, NET_OF_SESSION, proof);
    if (!net_is_open(s->secret.key))
        net_channel_key(&s->channel, proof);
    s->phase = SESSION_PROVING;
    return true;
}

static void welcomed(struct session *s, int64_t now)
{
    struct net_welcome welcome;
    net_get_welcome(net_channel_payload(&s->channel), &welcome);
    s->interval = INT64_C(1000000) * welcome.interval;
    s->status_due = now;
    s->phase = SESSION_UP;
    s->due = INT64_MAX;
    s->attempts = 0;
    net_alive_heard(&s->alive, now);
}

/* Answer a frame of the handshake, or end the connection. */
static void greet(struct session *s, int64_t now)
{
    const uint8_t type = net_channel_type(&s->channel);
    bool good = false;
    if (s->phase == SESSION_GREETING && type == NET_CHALLENGE) {
        good = challenged(s);
    } else if (s->phase == SESSION_PROVING && type == NET_WELCOME) {
        welcomed(s, now);
        good = true;
    }
    if (good)
        session_drop(s);
    else
        hang_up(s, now);
}

static void tell_result(struct session *s, const struct session_kept *k)
{
    const struct net_result result = { k->number, k->code, k->state };
    uint8_t payload[NET_BYTES_result];
    net_put_result(payload, &result);
    queue(s, NET_RESULT, payload, sizeof payload);
}

/* True if the command is new, so that the card is to do it. Others are answered here. */
static bool command_is_new(struct session *s)
{
    const uint8_t *p = net_channel_payload(&s->channel);
    struct net_command command;
    struct session_kept *oldest = s->kept;
    net_get_command(p, &command);
    for (int i = 0; i < SESSION_KEPT; i++) {
        struct session_kept *k = &s->kept[i];
        if (command.number != 0 && k->number == command.number) {
            s->repeats++;
            if (!k->open)
                tell_result(s, k);
            return false;
        }
        if (!k->open && (oldest->open || k->number < oldest->number))
            oldest = k;
    }
    const bool old = command.number <= s->last_command;
    if (old || oldest->open) {
        const struct session_kept refused = { command.number, old ? NET_STATE : NET_BUSY, s->state,
                                              false };
        tell_result(s, &refused);
        return false;
    }
    *oldest = (struct session_kept){ .number = command.number, .open = true };
    s->last_command = command.number;
    return true;
}

/* True if the frame that has come while the link is up is a message for the card. */
static bool for_the_card(struct session *s)
{
    const struct net_channel *c = &s->channel;
    const uint8_t type = net_channel_type(c);
    const bool job = type == NET_JOB_BEGIN || type == NET_JOB_END;
    if (type == NET_PING)
        queue(s, NET_PONG, net_channel_payload(c), NET_BYTES_token);
    else if (!net_is_known(type, false) || type < NET_JOB_BEGIN)
        session_nak(s, net_channel_sequence(c), NET_UNKNOWN, type);
    else if (job && s->job_sequence)
        session_nak(s, net_channel_sequence(c), NET_BUSY, 0);
    else
        return type != NET_PONG && (!net_is_command(type) || command_is_new(s));
    return false;
}

/* Room that answers may need: the answer to one more message, and all that are still to come. */
static size_t reserve(const struct session *s)
{
    size_t open = s->job_sequence != 0;
    for (int i = 0; i < SESSION_KEPT; i++)
        open += s->kept[i].open;
    return ANSWER + LATER * open;
}

static bool have_room(const struct session *s)
{
    return (size_t)s->channel.out_count + LATER + reserve(s) <= NET_OUT;
}

/* Deal with a whole frame, once there is room for its answers. A message for the card stays, marked
 * by `offered`. */
static void serve(struct session *s, int64_t now)
{
    const uint8_t type = net_channel_type(&s->channel);
    if (!s->channel.whole || s->offered || s->phase < SESSION_GREETING || !have_room(s))
        return;
    if (s->phase != SESSION_UP) {
        greet(s, now);
        return;
    }
    s->offered = for_the_card(s);
    if (!s->offered)
        session_drop(s);
    else if (type == NET_JOB_BEGIN || type == NET_JOB_END)
        s->job_sequence = net_channel_sequence(&s->channel);
}

size_t session_bytes(struct session *s, const uint8_t *bytes, size_t n, int64_t now)
{
    size_t taken = 0;
    if (s->phase < SESSION_GREETING)
        return n;
    if (n > 0 && s->phase == SESSION_UP)
        net_alive_heard(&s->alive, now);
    serve(s, now);
    while (taken < n && s->phase >= SESSION_GREETING && !s->channel.whole) {
        taken += net_channel_take(&s->channel, bytes + taken, n - taken);
        if (s->channel.fault != NET_FINE)
            hang_up(s, now);
        else
            serve(s, now);
    }
    return s->phase < SESSION_GREETING ? n : taken;
}

bool session_next(struct session *s, struct session_message *m, int64_t now)
{
    serve(s, now);
    if (!s->offered)
        return false;
    m->type = net_channel_type(&s->channel);
    m->sequence = net_channel_sequence(&s->channel);
    m->payload = net_channel_payload(&s->channel);
    m->length = net_channel_length(&s->channel);
    return true;
}

void session_drop(struct session *s)
{
    if (!s->channel.whole)
        return;
    s->done = net_channel_sequence(&s->channel);
    s->offered = false;
    net_channel_drop(&s->channel);
}

/* Send the ACK that waits, if answers leave room for it. */
static void flush(struct session *s)
{
    const struct net_ack ack = { s->acked, s->credit, s->missing };
    uint8_t payload[NET_BYTES_ack];
    if (!s->ack || s->phase != SESSION_UP
        || !net_channel_room(&s->channel, sizeof payload, reserve(s)))
        return;
    net_put_ack(payload, &ack);
    queue(s, NET_ACK, payload, sizeof payload);
    s->ack = false;
}

size_t session_out(struct session *s, uint8_t *bytes, size_t most)
{
    const size_t n = net_channel_out(&s->channel, bytes, most);
    flush(s);
    return n + net_channel_out(&s->channel, bytes + n, most - n);
}

int64_t session_next_time(const struct session *s)
{
    return s->phase == SESSION_UP ? s->alive.due : s->due;
}

static void tick_up(struct session *s, int64_t now)
{
    enum net_alive_event event;
    uint8_t payload[NET_BYTES_token];
    while ((event = net_alive_tick(&s->alive, now)) == NET_ASK) {
        const struct net_token token = { (uint32_t)s->alive.pings };
        net_put_token(payload, &token);
        if (net_channel_room(&s->channel, sizeof payload, reserve(s)))
            queue(s, NET_PING, payload, sizeof payload);
    }
    if (event == NET_GONE)
        hang_up(s, now);
}

void session_tick(struct session *s, int64_t now)
{
    if (s->phase == SESSION_UP) {
        tick_up(s, now);
    } else if (now >= s->due && s->phase == SESSION_IDLE) {
        s->phase = SESSION_CALLING;
        s->due = now + SESSION_CALL_NS;
    } else if (now >= s->due) {
        hang_up(s, now);
    }
}

void session_result(struct session *s, uint32_t number, enum net_code code, uint8_t state)
{
    s->state = state;
    for (int i = 0; i < SESSION_KEPT; i++) {
        struct session_kept *k = &s->kept[i];
        if (k->number != number || !k->open)
            continue;
        *k = (struct session_kept){ number, (uint16_t)code, state, false };
        if (s->phase == SESSION_UP)
            tell_result(s, k);
    }
}

void session_ack(struct session *s, uint16_t credit, uint16_t missing)
{
    s->ack = true;
    s->acked = s->job_sequence && s->done >= s->job_sequence ? s->job_sequence - 1 : s->done;
    s->credit = credit;
    s->missing = missing;
    flush(s);
}

void session_nak(struct session *s, uint32_t sequence, enum net_code code, uint16_t detail)
{
    const struct net_nak nak = { sequence, (uint16_t)code, detail };
    uint8_t payload[NET_BYTES_nak];
    net_put_nak(payload, &nak);
    if (s->phase == SESSION_UP)
        queue(s, NET_NAK, payload, sizeof payload);
}

void session_job(struct session *s, enum net_code code, uint16_t detail, uint16_t credit,
                 uint16_t missing)
{
    const uint32_t sequence = s->job_sequence;
    s->job_sequence = 0;
    s->done = s->done > sequence ? s->done : sequence;
    if (code != NET_DONE && sequence)
        session_nak(s, sequence, code, detail);
    session_ack(s, credit, missing);
}

void session_setting(struct session *s, const struct net_config *c)
{
    uint8_t payload[NET_BYTES_config];
    net_put_config(payload, c);
    if (s->phase == SESSION_UP)
        queue(s, NET_CONFIG, payload, sizeof payload);
}

int64_t session_status_time(const struct session *s)
{
    return s->phase == SESSION_UP && s->interval > 0 ? s->status_due : INT64_MAX;
}

void session_status(struct session *s, const struct net_status *status, int64_t now)
{
    uint8_t payload[NET_BYTES_status];
    s->state = status->state;
    if (s->phase != SESSION_UP || s->interval <= 0)
        return;
    s->status_due += ((now - s->status_due) / s->interval + 1) * s->interval;
    net_put_status(payload, status);
    if (net_channel_room(&s->channel, sizeof payload, reserve(s)))
        queue(s, NET_STATUS, payload, sizeof payload);
    else
        s->dropped++;
}
