#include "net_proof.h"

#include <string.h>

void net_prove(const struct net_secret *s, enum net_proof of, uint8_t proof[NET_SHA_BYTES])
{
    const uint8_t first = (uint8_t)of;
    const uint8_t last[6] = {
        (uint8_t)s->card,         (uint8_t)(s->card >> 8), (uint8_t)(s->card >> 16),
        (uint8_t)(s->card >> 24), (uint8_t)s->protocol,    (uint8_t)(s->protocol >> 8),
    };
    struct net_hmac m;
    net_hmac_start(&m, s->key, sizeof s->key);
    net_hmac_add(&m, &first, 1);
    net_hmac_add(&m, s->card_nonce, sizeof s->card_nonce);
    net_hmac_add(&m, s->server_nonce, sizeof s->server_nonce);
    net_hmac_add(&m, last, sizeof last);
    net_hmac_end(&m, proof);
}

bool net_is_open(const uint8_t key[NET_SHA_BYTES])
{
    static const uint8_t zeros[NET_SHA_BYTES];
    return net_equal(key, zeros, sizeof zeros);
}

void net_random_start(struct net_random *r, const uint8_t seed[NET_SHA_BYTES])
{
    memcpy(r->seed, seed, sizeof r->seed);
    r->drawn = 0;
}

void net_random_draw(struct net_random *r, uint8_t *bytes, size_t n)
{
    uint8_t text[NET_SHA_BYTES + 8], hash[NET_SHA_BYTES];
    memcpy(text, r->seed, sizeof r->seed);
    for (int i = 0; i < 8; i++)
        text[NET_SHA_BYTES + i] = (uint8_t)(r->drawn >> (8 * i));
    r->drawn++;
    net_sha(text, sizeof text, hash);
    memcpy(bytes, hash, n < sizeof hash ? n : sizeof hash);
}
