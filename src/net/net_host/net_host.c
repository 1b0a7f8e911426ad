#include "net_host.h"

#include <string.h>

#include "net_crc.h"

void net_host_start(struct net_host *h, const struct net_host_config *c)
{
    memset(h, 0, sizeof *h);
    h->config = *c;
    net_random_start(&h->random, c->seed);
    net_channel_start(&h->channel, false);
}

void net_host_load(struct net_host *h, const uint8_t *job, uint32_t bytes)
{
    h->job.bytes = bytes;
    h->job.crc = net_crc(0, job, bytes);
    net_sha(job, bytes, h->job.hash);
    h->upload = NET_HOST_TO_BEGIN;
    h->page = h->high = 0;
    h->lost_step = false;
    h->flights = 0;
    h->again = 0;
}

bool net_host_give(struct net_host *h, const struct net_host_order *order)
{
    for (int i = 0; i < NET_HOST_ORDERS; i++) {
        struct net_host_order *o = &h->order[i];
        if (o->stage == NET_HOST_WAITING || o->stage == NET_HOST_SENT)
            continue;
        *o = (struct net_host_order){
            .at = order->at,
            .type = order->type,
            .axes = order->axes,
            .mode = order->mode,
            .level = order->level,
            .pins = order->pins,
            .width = order->width,
            .stage = NET_HOST_WAITING,
        };
        return true;
    }
    return false;
}

void net_host_connected(struct net_host *h, int64_t now)
{
    net_channel_start(&h->channel, false);
    h->phase = NET_HOST_GREETED;
    h->refused = false;
    h->due = now + NET_HOST_PROVE_NS;
    h->connections++;
}

void net_host_cut(struct net_host *h)
{
    h->losses += h->phase == NET_HOST_UP;
    h->phase = NET_HOST_DOWN;
    h->refused = false;
    h->flights = 0;
    h->lost_step = false;
    if (h->upload > NET_HOST_TO_BEGIN && h->upload < NET_HOST_STORED)
        h->upload = NET_HOST_TO_BEGIN;
    net_channel_start(&h->channel, false);
}

void net_host_refuse(struct net_host *h)
{
    if (h->channel.fault != NET_FINE)
        h->fault = h->channel.fault;
    net_host_cut(h);
    h->refused = true;
}

bool net_host_accepts(const struct net_host *h)
{
    return !h->refused;
}

/* Mark the commands as lost that a card after a power loss will never answer. */
static void forget(struct net_host *h)
{
    for (int i = 0; i < NET_HOST_ORDERS; i++) {
        if (h->order[i].stage == NET_HOST_SENT)
            h->order[i].stage = NET_HOST_LOST;
    }
}

static bool greeted(struct net_host *h)
{
    struct net_challenge challenge = { .protocol = NET_PROTOCOL };
    uint8_t payload[NET_BYTES_challenge];
    net_get_hello(net_channel_payload(&h->channel), &h->hello);
    if (h->hello.oldest > NET_PROTOCOL || h->hello.newest < NET_PROTOCOL)
        return false;
    memcpy(h->secret.key, h->config.key, sizeof h->secret.key);
    memcpy(h->secret.card_nonce, h->hello.nonce, NET_NONCE);
    net_random_draw(&h->random, h->secret.server_nonce, NET_NONCE);
    h->secret.card = h->hello.card;
    h->secret.protocol = NET_PROTOCOL;
    memcpy(challenge.nonce, h->secret.server_nonce, NET_NONCE);
    net_prove(&h->secret, NET_OF_SERVER, challenge.proof);
    net_put_challenge(payload, &challenge);
    net_channel_put(&h->channel, NET_CHALLENGE, payload, sizeof payload);
    h->phase = NET_HOST_CHALLENGED;
    return true;
}

/* The card has proved that it has the key: the link is up. Commands without a result are sent
 * again, with their numbers. */
static bool proved(struct net_host *h, int64_t now)
{
    const struct net_welcome welcome = { .interval = h->config.interval };
    uint8_t proof[NET_SHA_BYTES], payload[NET_BYTES_welcome];
    struct net_auth auth;
    net_get_auth(net_channel_payload(&h->channel), &auth);
    net_prove(&h->secret, NET_OF_CARD, proof);
    if (!net_equal(proof, auth.proof, sizeof proof))
        return false;
    net_prove(&h->secret, NET_OF_SESSION, proof);
    if (!net_is_open(h->secret.key))
        net_channel_key(&h->channel, proof);
    net_put_welcome(payload, &welcome);
    net_channel_put(&h->channel, NET_WELCOME, payload, sizeof payload);
    net_alive_heard(&h->alive, now);
    h->phase = NET_HOST_UP;
    if (h->met && (h->hello.life != h->life || h->hello.card != h->card))
        forget(h);
    h->met = true;
    h->life = h->hello.life;
    h->card = h->hello.card;
    h->credit = h->hello.credit;
    if (h->last_number < h->hello.last_command)
        h->last_number = h->hello.last_command;
    for (int i = 0; i < NET_HOST_ORDERS; i++)
        h->order[i].again = h->order[i].stage == NET_HOST_SENT;
    if (h->upload == NET_HOST_TO_BEGIN && net_equal(h->hello.job, h->job.hash, sizeof h->job.hash))
        h->upload = NET_HOST_STORED;
    return true;
}

static bool greet(struct net_host *h, int64_t now)
{
    const uint8_t type = net_channel_type(&h->channel);
    if (h->phase == NET_HOST_GREETED && type == NET_HELLO)
        return greeted(h);
    return h->phase == NET_HOST_CHALLENGED && type == NET_AUTH && proved(h, now);
}

/* The card has taken all frames up to this sequence: their JOB_DATA are no longer on their way. */
static void land(struct net_host *h, uint32_t sequence)
{
    int32_t gone = 0;
    while (gone < h->flights && h->flight[gone].sequence <= sequence)
        gone++;
    h->flights -= gone;
    memmove(h->flight, h->flight + gone, (size_t)h->flights * sizeof h->flight[0]);
}

static void acknowledged(struct net_host *h)
{
    const uint32_t pages = h->job.bytes / NET_PAGE_BYTES;
    struct net_ack ack;
    net_get_ack(net_channel_payload(&h->channel), &ack);
    land(h, ack.sequence);
    h->credit = ack.credit;
    if ((h->upload != NET_HOST_BEGUN && h->upload != NET_HOST_ENDED) || ack.sequence < h->asked)
        return;
    if (ack.missing == NET_NO_PAGE && h->upload == NET_HOST_ENDED) {
        h->upload = NET_HOST_STORED;
        return;
    }
    h->page = ack.missing < pages ? ack.missing : pages;
    h->upload = NET_HOST_SENDING;
}

/* NAK: a busy card is asked again later; one that refuses a page is asked which one it misses after
 * the pages behind it have been answered, too. */
static void not_taken(struct net_host *h, int64_t now)
{
    struct net_nak nak;
    net_get_nak(net_channel_payload(&h->channel), &nak);
    h->naks++;
    const bool asked =
        (h->upload == NET_HOST_BEGUN || h->upload == NET_HOST_ENDED) && nak.sequence == h->asked;
    if (asked && (nak.code == NET_BUSY || nak.code == NET_STATE)) {
        h->upload = NET_HOST_TO_BEGIN;
        h->again = now + NET_HOST_AGAIN_NS;
    } else if (asked) {
        h->upload = NET_HOST_REFUSED;
    } else if (h->upload == NET_HOST_SENDING) {
        h->lost_step = true;
    }
    land(h, nak.sequence);
    h->code = nak.code;
}

static void answered(struct net_host *h, int64_t now)
{
    struct net_result result;
    net_get_result(net_channel_payload(&h->channel), &result);
    for (int i = 0; i < NET_HOST_ORDERS; i++) {
        struct net_host_order *o = &h->order[i];
        if (o->stage != NET_HOST_SENT || o->number != result.number)
            continue;
        o->stage = NET_HOST_ANSWERED;
        o->code = result.code;
        o->state = result.state;
        o->answered = now;
    }
}

static void hear(struct net_host *h, int64_t now)
{
    const struct net_channel *c = &h->channel;
    switch ((enum net_type)net_channel_type(c)) {
    case NET_ACK:    acknowledged(h); break;
    case NET_NAK:    not_taken(h, now); break;
    case NET_RESULT: answered(h, now); break;
    case NET_STATUS:
        net_get_status(net_channel_payload(c), &h->status);
        h->statuses++;
        break;
    case NET_CONFIG:
        net_get_config(net_channel_payload(c), &h->setting);
        h->settings++;
        break;
    case NET_PING:
        net_channel_put(&h->channel, NET_PONG, net_channel_payload(c), net_channel_length(c));
        break;
    default: break;
    }
}

void net_host_bytes(struct net_host *h, const uint8_t *bytes, size_t n, int64_t now)
{
    size_t taken = 0;
    if (n > 0)
        net_alive_heard(&h->alive, now);
    while (taken < n && h->phase != NET_HOST_DOWN) {
        taken += net_channel_take(&h->channel, bytes + taken, n - taken);
        bool good = h->channel.fault == NET_FINE;
        if (good && h->channel.whole && h->phase == NET_HOST_UP)
            hear(h, now);
        else if (good && h->channel.whole)
            good = greet(h, now);
        if (h->channel.whole)
            net_channel_drop(&h->channel);
        if (!good)
            net_host_refuse(h);
    }
}

size_t net_host_out(struct net_host *h, uint8_t *bytes, size_t most)
{
    return net_channel_out(&h->channel, bytes, most);
}
