#include "net_channel.h"

#include <string.h>

#include "net_crc.h"

enum { MAGIC_AT = 0, VERSION_AT = 2, TYPE_AT = 3, FLAGS_AT = 4, SEQUENCE_AT = 6, LENGTH_AT = 10 };
enum { FLAG_MAC = 1 };
enum direction { CARD_TO_SERVER, SERVER_TO_CARD };

static uint32_t number(const uint8_t *bytes, int n)
{
    uint32_t value = 0;
    for (int i = n; i > 0; i--)
        value = value << 8 | bytes[i - 1];
    return value;
}

static void set_number(uint8_t *bytes, int n, uint32_t value)
{
    for (int i = 0; i < n; i++, value >>= 8)
        bytes[i] = (uint8_t)value;
}

static size_t check_bytes(const struct net_channel *c)
{
    return c->keyed ? NET_MAC : NET_CRC;
}

/* CRC or MAC of the n bytes of a frame in this direction. */
static void check_of(const struct net_channel *c, enum direction way, const uint8_t *bytes,
                     size_t n, uint8_t check[NET_MAC])
{
    const uint8_t first = (uint8_t)way;
    uint8_t mac[NET_SHA_BYTES];
    struct net_hmac m;
    if (!c->keyed) {
        set_number(check, NET_CRC, net_crc(0, bytes, n));
        return;
    }
    net_hmac_start(&m, c->key, sizeof c->key);
    net_hmac_add(&m, &first, 1);
    net_hmac_add(&m, bytes, n);
    net_hmac_end(&m, mac);
    memcpy(check, mac, NET_MAC);
}

void net_channel_start(struct net_channel *c, bool card)
{
    memset(c, 0, sizeof *c);
    c->card = card;
}

void net_channel_key(struct net_channel *c, const uint8_t key[NET_SHA_BYTES])
{
    memcpy(c->key, key, sizeof c->key);
    c->keyed = true;
}

static enum net_fault header_fault(const struct net_channel *c)
{
    const uint8_t *f = c->frame;
    if (number(f + MAGIC_AT, 2) != NET_MAGIC)
        return NET_BAD_MAGIC;
    if (f[VERSION_AT] != NET_VERSION)
        return NET_BAD_VERSION;
    if (number(f + FLAGS_AT, 2) != (c->keyed ? FLAG_MAC : 0))
        return NET_BAD_FLAGS;
    if (c->taken == UINT32_MAX || number(f + SEQUENCE_AT, 4) != c->taken + 1)
        return NET_BAD_SEQUENCE;
    return net_channel_length(c) > NET_PAYLOAD ? NET_BAD_LENGTH : NET_FINE;
}

static enum net_fault frame_fault(const struct net_channel *c)
{
    const size_t bytes = NET_HEADER + net_channel_length(c);
    uint8_t check[NET_MAC];
    check_of(c, c->card ? SERVER_TO_CARD : CARD_TO_SERVER, c->frame, bytes, check);
    if (!net_equal(check, c->frame + bytes, check_bytes(c)))
        return NET_BAD_CHECK;
    return net_payload_fits(net_channel_type(c), net_channel_payload(c), net_channel_length(c))
               ? NET_FINE
               : NET_BAD_PAYLOAD;
}

size_t net_channel_take(struct net_channel *c, const uint8_t *bytes, size_t n)
{
    size_t taken = 0;
    while (taken < n && !c->whole && c->fault == NET_FINE) {
        const size_t held = (size_t)c->held;
        const size_t want =
            held < NET_HEADER ? NET_HEADER : NET_HEADER + net_channel_length(c) + check_bytes(c);
        const size_t part = n - taken < want - held ? n - taken : want - held;
        memcpy(c->frame + held, bytes + taken, part);
        taken += part;
        c->held += (int32_t)part;
        if (held + part < want)
            continue;
        c->fault = (uint8_t)(want == NET_HEADER ? header_fault(c) : frame_fault(c));
        if (want > NET_HEADER && c->fault == NET_FINE) {
            c->whole = true;
            c->taken++;
        }
    }
    return taken;
}

uint8_t net_channel_type(const struct net_channel *c)
{
    return c->frame[TYPE_AT];
}

uint32_t net_channel_sequence(const struct net_channel *c)
{
    return number(c->frame + SEQUENCE_AT, 4);
}

const uint8_t *net_channel_payload(const struct net_channel *c)
{
    return c->frame + NET_HEADER;
}

size_t net_channel_length(const struct net_channel *c)
{
    return number(c->frame + LENGTH_AT, 2);
}

void net_channel_drop(struct net_channel *c)
{
    c->whole = false;
    c->held = 0;
}

bool net_channel_room(const struct net_channel *c, size_t payload, size_t left)
{
    return c->fault == NET_FINE && c->sent < UINT32_MAX
           && (size_t)c->out_count + NET_HEADER + payload + check_bytes(c) + left <= NET_OUT;
}

bool net_channel_put(struct net_channel *c, uint8_t type, const uint8_t *payload, size_t n)
{
    uint8_t frame[NET_FRAME];
    if (n > NET_PAYLOAD || !net_channel_room(c, n, 0))
        return false;
    set_number(frame + MAGIC_AT, 2, NET_MAGIC);
    frame[VERSION_AT] = NET_VERSION;
    frame[TYPE_AT] = type;
    set_number(frame + FLAGS_AT, 2, c->keyed ? FLAG_MAC : 0);
    set_number(frame + SEQUENCE_AT, 4, ++c->sent);
    set_number(frame + LENGTH_AT, 2, (uint32_t)n);
    if (n > 0)
        memcpy(frame + NET_HEADER, payload, n);
    check_of(c, c->card ? CARD_TO_SERVER : SERVER_TO_CARD, frame, NET_HEADER + n,
             frame + NET_HEADER + n);
    n += NET_HEADER + check_bytes(c);
    for (size_t i = 0; i < n; i++)
        c->out[((size_t)c->out_first + (size_t)c->out_count + i) % NET_OUT] = frame[i];
    c->out_count += (int32_t)n;
    return true;
}

size_t net_channel_out(struct net_channel *c, uint8_t *bytes, size_t most)
{
    const size_t n = most < (size_t)c->out_count ? most : (size_t)c->out_count;
    for (size_t i = 0; i < n; i++)
        bytes[i] = c->out[((size_t)c->out_first + i) % NET_OUT];
    c->out_first = (int32_t)(((size_t)c->out_first + n) % NET_OUT);
    c->out_count -= (int32_t)n;
    return n;
}

/* A table of the texts themselves; pointers to them would need relocation in a shared library. */
#define ROW(name, text)  [name] = text,
#define FITS(name, text) _Static_assert(sizeof text <= sizeof TEXT[0], #name " is too long");
static const char TEXT[NET_FAULTS][35] = { NET_FAULT_TEXTS(ROW) };
NET_FAULT_TEXTS(FITS)

const char *net_fault_text(enum net_fault fault)
{
    return (uint32_t)fault < NET_FAULTS ? TEXT[fault] : "";
}
