/* net_proof - what both ends of a link compute to show each other that they have the key. */
#ifndef NET_PROOF_H
#define NET_PROOF_H

#include "net_message.h"

struct net_secret {
    uint8_t key[NET_SHA_BYTES]; /* of the card; all 0: open, frames have a CRC only */
    uint8_t card_nonce[NET_NONCE], server_nonce[NET_NONCE];
    uint32_t card;
    uint16_t protocol;
};

/* What a proof is for: its first byte. */
enum net_proof { NET_OF_SERVER = 'S', NET_OF_CARD = 'C', NET_OF_SESSION = 'K' };

/* HMAC-SHA256(key, first byte + card nonce + server nonce + card + protocol). That of the session
 * is its key. */
void net_prove(const struct net_secret *s, enum net_proof of, uint8_t proof[NET_SHA_BYTES]);

bool net_is_open(const uint8_t key[NET_SHA_BYTES]);

/* Random bytes from a seed: SHA-256(seed + number), a number for each draw. */
struct net_random {
    uint8_t seed[NET_SHA_BYTES];
    uint64_t drawn;
};

void net_random_start(struct net_random *r, const uint8_t seed[NET_SHA_BYTES]);
void net_random_draw(struct net_random *r, uint8_t *bytes, size_t n); /* n <= 32 */

#endif
