#include "net_sha.h"

#include <string.h>

/* The first 32 fractional bits of the cube roots of the first 64 primes. */
static const uint32_t round_constant[64] = {
    0x428A2F98, 0x71374491, 0xB5C0FBCF, 0xE9B5DBA5, 0x3956C25B, 0x59F111F1, 0x923F82A4, 0xAB1C5ED5,
    0xD807AA98, 0x12835B01, 0x243185BE, 0x550C7DC3, 0x72BE5D74, 0x80DEB1FE, 0x9BDC06A7, 0xC19BF174,
    0xE49B69C1, 0xEFBE4786, 0x0FC19DC6, 0x240CA1CC, 0x2DE92C6F, 0x4A7484AA, 0x5CB0A9DC, 0x76F988DA,
    0x983E5152, 0xA831C66D, 0xB00327C8, 0xBF597FC7, 0xC6E00BF3, 0xD5A79147, 0x06CA6351, 0x14292967,
    0x27B70A85, 0x2E1B2138, 0x4D2C6DFC, 0x53380D13, 0x650A7354, 0x766A0ABB, 0x81C2C92E, 0x92722C85,
    0xA2BFE8A1, 0xA81A664B, 0xC24B8B70, 0xC76C51A3, 0xD192E819, 0xD6990624, 0xF40E3585, 0x106AA070,
    0x19A4C116, 0x1E376C08, 0x2748774C, 0x34B0BCB5, 0x391C0CB3, 0x4ED8AA4A, 0x5B9CCA4F, 0x682E6FF3,
    0x748F82EE, 0x78A5636F, 0x84C87814, 0x8CC70208, 0x90BEFFFA, 0xA4506CEB, 0xBEF9A3F7, 0xC67178F2,
};
/* The first 32 fractional bits of the square roots of the first eight primes. */
static const uint32_t first_hash[8] = {
    0x6A09E667, 0xBB67AE85, 0x3C6EF372, 0xA54FF53A, 0x510E527F, 0x9B05688C, 0x1F83D9AB, 0x5BE0CD19,
};

static uint32_t turn(uint32_t x, int n)
{
    return x >> n | x << (32 - n);
}

static uint32_t big_endian(const uint8_t *b)
{
    return (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
}

/* FIPS 180-4, 6.2.2: the message schedule of a block, then 64 rounds. */
static void compress(uint32_t hash[8], const uint8_t block[NET_SHA_BLOCK])
{
    uint32_t w[64], v[8];
    for (int t = 0; t < 16; t++)
        w[t] = big_endian(block + 4 * t);
    for (int t = 16; t < 64; t++) {
        const uint32_t s0 = turn(w[t - 15], 7) ^ turn(w[t - 15], 18) ^ w[t - 15] >> 3;
        const uint32_t s1 = turn(w[t - 2], 17) ^ turn(w[t - 2], 19) ^ w[t - 2] >> 10;
        w[t] = w[t - 16] + s0 + w[t - 7] + s1;
    }
    memcpy(v, hash, sizeof v);
    for (unsigned t = 0; t < 64; t++) {
        /* Instead of moving the eight variables each round, their indices turn: a is where h
         * was. */
        uint32_t *h = &v[(7 - t) % 8];
        const uint32_t a = v[-t % 8], b = v[(1 - t) % 8], c = v[(2 - t) % 8], e = v[(4 - t) % 8];
        const uint32_t s1 = turn(e, 6) ^ turn(e, 11) ^ turn(e, 25);
        const uint32_t choose = (e & v[(5 - t) % 8]) ^ (~e & v[(6 - t) % 8]);
        const uint32_t t1 = *h + s1 + choose + round_constant[t] + w[t];
        const uint32_t s0 = turn(a, 2) ^ turn(a, 13) ^ turn(a, 22);
        v[(3 - t) % 8] += t1;
        *h = t1 + s0 + ((a & b) ^ (a & c) ^ (b & c));
    }
    for (int i = 0; i < 8; i++)
        hash[i] += v[i];
}

void net_sha_start(struct net_sha *s)
{
    memset(s, 0, sizeof *s);
    memcpy(s->h, first_hash, sizeof s->h);
}

void net_sha_add(struct net_sha *s, const uint8_t *bytes, size_t n)
{
    size_t held = s->bytes % NET_SHA_BLOCK;
    s->bytes += n;
    while (n > 0) {
        const size_t room = NET_SHA_BLOCK - held, part = n < room ? n : room;
        memcpy(s->block + held, bytes, part);
        bytes += part;
        n -= part;
        held = (held + part) % NET_SHA_BLOCK;
        if (held == 0)
            compress(s->h, s->block);
    }
}

void net_sha_end(struct net_sha *s, uint8_t hash[NET_SHA_BYTES])
{
    enum { LENGTH_AT = NET_SHA_BLOCK - 8 }; /* place of the number of bits in the last block */
    const uint64_t bits = s->bytes * 8;
    const uint8_t one = 0x80, zero = 0;
    uint8_t length[8];
    for (int i = 0; i < 8; i++)
        length[i] = (uint8_t)(bits >> (56 - 8 * i));
    net_sha_add(s, &one, 1);
    while (s->bytes % NET_SHA_BLOCK != LENGTH_AT)
        net_sha_add(s, &zero, 1);
    net_sha_add(s, length, sizeof length);
    for (int i = 0; i < NET_SHA_BYTES; i++)
        hash[i] = (uint8_t)(s->h[i / 4] >> (24 - 8 * (i % 4)));
}

void net_sha(const uint8_t *bytes, size_t n, uint8_t hash[NET_SHA_BYTES])
{
    struct net_sha s;
    net_sha_start(&s);
    net_sha_add(&s, bytes, n);
    net_sha_end(&s, hash);
}

enum { INNER_PAD = 0x36, OUTER_PAD = 0x5C };

static void start_padded(struct net_sha *s, const uint8_t key[NET_SHA_BLOCK], uint8_t pad)
{
    uint8_t block[NET_SHA_BLOCK];
    for (int i = 0; i < NET_SHA_BLOCK; i++)
        block[i] = key[i] ^ pad;
    net_sha_start(s);
    net_sha_add(s, block, sizeof block);
}

void net_hmac_start(struct net_hmac *m, const uint8_t *key, size_t n)
{
    memset(m->key, 0, sizeof m->key);
    if (n > NET_SHA_BLOCK)
        net_sha(key, n, m->key);
    else
        memcpy(m->key, key, n);
    start_padded(&m->inner, m->key, INNER_PAD);
}

void net_hmac_add(struct net_hmac *m, const uint8_t *bytes, size_t n)
{
    net_sha_add(&m->inner, bytes, n);
}

void net_hmac_end(struct net_hmac *m, uint8_t mac[NET_SHA_BYTES])
{
    uint8_t hash[NET_SHA_BYTES];
    struct net_sha outer;
    net_sha_end(&m->inner, hash);
    start_padded(&outer, m->key, OUTER_PAD);
    net_sha_add(&outer, hash, sizeof hash);
    net_sha_end(&outer, mac);
}

bool net_equal(const uint8_t *a, const uint8_t *b, size_t n)
{
    volatile uint8_t different = 0;
    for (size_t i = 0; i < n; i++)
        different |= a[i] ^ b[i];
    return different == 0;
}
