/* net_channel - one end of a connection between a network card and its server: it makes frames of
 * messages, queues their bytes, and finds and checks the frames in the bytes that it receives.
 *
 *     0 magic  2 version  3 type  4 flags  6 sequence  10 length  12 payload ... check
 *
 * The check is the CRC-32 of all bytes before it or, if the channel is keyed, the first 8 bytes of
 * HMAC-SHA256(session key, direction + header + payload); bit 0 of the flags says which. Sequences
 * count 1, 2, 3 .. in each direction. A frame that is wrong closes the channel: a faulty byte
 * stream is never searched for a next frame.
 *
 * A complete frame stays until net_channel_drop(), and no byte behind it is taken before: so the
 * receiver sets the pace of the sender.
 */
#ifndef NET_CHANNEL_H
#define NET_CHANNEL_H

#include "net_message.h"

enum {
    NET_MAGIC = 0x434D,
    NET_VERSION = 1,
    NET_HEADER = 12,
    NET_CRC = 4,
    NET_MAC = 8,
    NET_FRAME = NET_HEADER + NET_PAYLOAD + NET_MAC, /* longest frame [byte] */
    NET_OUT = 4096,                                 /* queue of bytes to be sent [byte] */
};

/* Faults of a received byte stream, each with its text. */
#define NET_FAULT_TEXTS(X) \
    X(NET_FINE, "") \
    X(NET_BAD_MAGIC, "not a frame") \
    X(NET_BAD_VERSION, "a frame of another version") \
    X(NET_BAD_FLAGS, "a frame with another kind of check") \
    X(NET_BAD_SEQUENCE, "a frame out of sequence") \
    X(NET_BAD_LENGTH, "a frame too long") \
    X(NET_BAD_CHECK, "a frame whose CRC or MAC is wrong") \
    X(NET_BAD_PAYLOAD, "a message of a wrong length") /* not the length of its type */

#define NET_FAULT_ENTRY(name, text) name,
enum net_fault { NET_FAULT_TEXTS(NET_FAULT_ENTRY) NET_FAULTS };

struct net_channel {
    bool card;                    /* this end is the card's */
    bool keyed;                   /* frames have a MAC instead of a CRC */
    bool whole;                   /* `frame` is complete */
    uint8_t fault;                /* enum net_fault; once set, nothing is taken or written */
    uint8_t key[NET_SHA_BYTES];   /* session key */
    uint32_t sent, taken;         /* sequences of the latest frames sent, received */
    int32_t held;                 /* [byte] received of `frame` */
    int32_t out_first, out_count; /* ring `out`: first byte, number of bytes */
    uint8_t frame[NET_FRAME];     /* frame being received */
    uint8_t out[NET_OUT];         /* bytes to be sent */
};

/* Start a new connection, at the card's end or the server's. */
void net_channel_start(struct net_channel *c, bool card);

/* From now on frames of both directions have a MAC by this session key. */
void net_channel_key(struct net_channel *c, const uint8_t key[NET_SHA_BYTES]);

/* Take received bytes up to the end of a frame. Returns their number. */
size_t net_channel_take(struct net_channel *c, const uint8_t *bytes, size_t n);

/* The complete frame: its type, sequence, payload and payload length; done with it. */
uint8_t net_channel_type(const struct net_channel *c);
uint32_t net_channel_sequence(const struct net_channel *c);
const uint8_t *net_channel_payload(const struct net_channel *c);
size_t net_channel_length(const struct net_channel *c);
void net_channel_drop(struct net_channel *c);

/* Whether the queue has room for a frame with `payload` bytes of payload and for `left` bytes more.
 * False, too, if the channel is closed. */
bool net_channel_room(const struct net_channel *c, size_t payload, size_t left);

/* Queue a frame; false if there is no room or the channel is closed. */
bool net_channel_put(struct net_channel *c, uint8_t type, const uint8_t *payload, size_t n);

/* Move up to `most` queued bytes out. Returns their number. */
size_t net_channel_out(struct net_channel *c, uint8_t *bytes, size_t most);

/* Text for a fault, for messages. */
const char *net_fault_text(enum net_fault fault);

#endif
