/* net_proof - proofs of the handshake, by which both ends of a network link show each other that
 * they have the card's key without sending it, the session key, and random bytes for nonces. */
#ifndef NET_PROOF_H
#define NET_PROOF_H

#include "net_message.h"

struct net_secret {
    uint8_t key[NET_SHA_BYTES]; /* the card's key; all 0: an open link, frames have a CRC only */
    uint8_t card_nonce[NET_NONCE], server_nonce[NET_NONCE];
    uint32_t card;     /* number of the card */
    uint16_t protocol; /* version of the protocol */
};

/* Purpose of a proof, which is its first byte. */
enum net_proof { NET_OF_SERVER = 'S', NET_OF_CARD = 'C', NET_OF_SESSION = 'K' };

/* HMAC-SHA256(key, first byte + card nonce + server nonce + card + protocol). That for the session
 * is the session key. */
void net_prove(const struct net_secret *s, enum net_proof of, uint8_t proof[NET_SHA_BYTES]);

/* Whether the key is all 0. */
bool net_is_open(const uint8_t key[NET_SHA_BYTES]);

/* Generator of random bytes from a seed: SHA-256(seed + number of the draw). */
struct net_random {
    uint8_t seed[NET_SHA_BYTES];
    uint64_t drawn; /* number of draws so far */
};

void net_random_start(struct net_random *r, const uint8_t seed[NET_SHA_BYTES]);
void net_random_draw(struct net_random *r, uint8_t *bytes, size_t n); /* n <= 32 */

#endif
