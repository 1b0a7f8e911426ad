/* net_sha - SHA-256 (FIPS 180-4) and HMAC-SHA256 (RFC 2104) of bytes that come in parts, for hashes
 * of jobs, proofs of the handshake and MACs of frames. */
#ifndef NET_SHA_H
#define NET_SHA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { NET_SHA_BYTES = 32, NET_SHA_BLOCK = 64 };

struct net_sha {
    uint32_t h[8];                /* hash of the complete blocks so far */
    uint64_t bytes;               /* number of bytes so far */
    uint8_t block[NET_SHA_BLOCK]; /* the last bytes % 64 of them */
};

void net_sha_start(struct net_sha *s);
void net_sha_add(struct net_sha *s, const uint8_t *bytes, size_t n);
void net_sha_end(struct net_sha *s, uint8_t hash[NET_SHA_BYTES]);

/* The hash of n bytes at once. */
void net_sha(const uint8_t *bytes, size_t n, uint8_t hash[NET_SHA_BYTES]);

struct net_hmac {
    struct net_sha inner;
    uint8_t key[NET_SHA_BLOCK];
};

/* Start with a key of n bytes; of one longer than 64 bytes the hash is used, as in the RFC. */
void net_hmac_start(struct net_hmac *m, const uint8_t *key, size_t n);
void net_hmac_add(struct net_hmac *m, const uint8_t *bytes, size_t n);
void net_hmac_end(struct net_hmac *m, uint8_t mac[NET_SHA_BYTES]);

/* Whether n bytes are equal, in a time that does not depend on where they differ. */
bool net_equal(const uint8_t *a, const uint8_t *b, size_t n);

#endif
