/* CRC-32, SHA-256 and HMAC against the vectors of their standards, and against the definitions. */
#include <string.h>

#include "check.h"
#include "net_crc.h"
#include "net_proof.h"
#include "net_sha.h"

static const uint8_t *bytes_of(const char *text)
{
    return (const uint8_t *)text;
}

static void check_hex(const uint8_t *got, const char *want, int line)
{
    char text[2 * NET_SHA_BYTES + 1];
    for (size_t i = 0; i < strlen(want) / 2; i++)
        snprintf(text + 2 * i, 3, "%02x", got[i]);
    if (strcmp(text, want) != 0) {
        check_failures++;
        printf("%s:%d: %s, want %s\n", __FILE__, line, text, want);
    }
}

/* The remainder of the polynomial, bit by bit. */
static uint32_t crc_by_bits(const uint8_t *bytes, size_t n)
{
    uint32_t crc = UINT32_MAX;
    for (size_t i = 0; i < n; i++) {
        crc ^= bytes[i];
        for (int b = 0; b < 8; b++)
            crc = crc & 1 ? crc >> 1 ^ 0xEDB88320 : crc >> 1;
    }
    return ~crc;
}

static void check_crc(void)
{
    uint8_t bytes[300];
    uint64_t seed = 1;
    for (size_t i = 0; i < sizeof bytes; i++)
        bytes[i] = (uint8_t)check_random(&seed, 0, 255);
    CHECK_EQ(net_crc(0, bytes_of("123456789"), 9), 0xCBF43926);
    for (size_t n = 0; n <= sizeof bytes; n++) {
        const size_t half = (size_t)check_random(&seed, 0, (int64_t)n);
        CHECK_EQ(net_crc(0, bytes, n), crc_by_bits(bytes, n));
        CHECK_EQ(net_crc(net_crc(0, bytes, half), bytes + half, n - half), crc_by_bits(bytes, n));
    }
    for (int i = 0; i < 256; i++) {
        const uint8_t one = (uint8_t)i;
        CHECK_EQ(net_crc(0, &one, 1), crc_by_bits(&one, 1));
    }
}

static void check_sha(const char *text, const char *want)
{
    uint8_t hash[NET_SHA_BYTES];
    struct net_sha s;
    net_sha(bytes_of(text), strlen(text), hash);
    check_hex(hash, want, __LINE__);
    for (size_t step = 1; step < 70; step += 7) {
        net_sha_start(&s);
        for (size_t at = 0; at < strlen(text); at += step)
            net_sha_add(&s, bytes_of(text) + at,
                        strlen(text + at) < step ? strlen(text + at) : step);
        net_sha_end(&s, hash);
        check_hex(hash, want, __LINE__);
    }
}

static void check_hashes(void)
{
    uint8_t hash[NET_SHA_BYTES], part[1000];
    struct net_sha s;
    /* NIST's examples. */
    check_sha("abc", "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    check_sha("", "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    check_sha("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq",
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    check_sha("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmn"
              "hijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu",
              "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
    memset(part, 'a', sizeof part);
    net_sha_start(&s);
    for (int i = 0; i < 1000; i++)
        net_sha_add(&s, part, sizeof part);
    net_sha_end(&s, hash);
    check_hex(hash, "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0", __LINE__);
}

static void check_hmac(const uint8_t *key, size_t key_bytes, const uint8_t *data, size_t n,
                       const char *want)
{
    uint8_t mac[NET_SHA_BYTES];
    struct net_hmac m;
    net_hmac_start(&m, key, key_bytes);
    net_hmac_add(&m, data, n / 3);
    net_hmac_add(&m, data + n / 3, n - n / 3);
    net_hmac_end(&m, mac);
    check_hex(mac, want, __LINE__);
}

/* RFC 4231, cases 1 to 7. */
static void check_rfc(void)
{
    const char *first = "Test Using Larger Than Block-Size Key - Hash Key First";
    const char *larger = "This is a test using a larger than block-size key and a larger than "
                         "block-size data. The key needs to be hashed before being used by the "
                         "HMAC algorithm.";
    uint8_t key[131], data[50];
    memset(key, 0x0b, 20);
    check_hmac(key, 20, bytes_of("Hi There"), 8,
               "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
    check_hmac(bytes_of("Jefe"), 4, bytes_of("what do ya want for nothing?"), 28,
               "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
    memset(key, 0xaa, sizeof key);
    memset(data, 0xdd, sizeof data);
    check_hmac(key, 20, data, sizeof data,
               "773ea91e36800e46854db8ebd09181a72959098b3ef8c122d9635514ced565fe");
    check_hmac(key, 131, bytes_of(first), strlen(first),
               "60e431591ee0b67f0d8a26aacbf5b77f8e0bc6213728c5140546040f0ee37f54");
    check_hmac(key, 131, bytes_of(larger), strlen(larger),
               "9b09ffa71b942fcb27635fbcd5b0e944bfdc63644f0713938a7f51535c3a35e2");
    for (uint8_t i = 0; i < 25; i++)
        key[i] = i + 1;
    memset(data, 0xcd, sizeof data);
    check_hmac(key, 25, data, sizeof data,
               "82558a389a443c0ea4cc819899f2083a85f0faa3e578f8077a2e3ff46729665b");
    memset(key, 0x0c, 20);
    check_hmac(key, 20, bytes_of("Test With Truncation"), 20, "a3b6167473100ee06e0c796c2955552b");
}

/* Of numbers all of whose bytes differ, by Python's hmac: the smaller byte of a number is first. */
static void check_proofs(void)
{
    struct net_secret s = { .card = 0xa1b2c3d4, .protocol = 0xe5f6 };
    uint8_t proof[NET_SHA_BYTES];
    for (int i = 0; i < NET_SHA_BYTES; i++)
        s.key[i] = (uint8_t)i;
    for (int i = 0; i < NET_NONCE; i++) {
        s.card_nonce[i] = (uint8_t)(0x40 + i);
        s.server_nonce[i] = (uint8_t)(0x80 + i);
    }
    net_prove(&s, NET_OF_SERVER, proof);
    check_hex(proof, "4f9b5b3c9eab3496fd41973e2188306541f42abd03963707d5c20ce6fbbf6f3c", __LINE__);
    net_prove(&s, NET_OF_CARD, proof);
    check_hex(proof, "b4d15579d7cf7fd3bb63be9ff9549290c446a915dda4f22752ff09d2b4549b86", __LINE__);
    net_prove(&s, NET_OF_SESSION, proof);
    check_hex(proof, "6e4edb8a799d0e4aa6d963fa600fd641346b7f6d01a529af6f7f6b9b9312fafa", __LINE__);
}

static void check_equal(void)
{
    uint8_t a[40] = { 0 }, b[40] = { 0 };
    for (int i = 0; i < 40; i++) {
        CHECK(net_equal(a, b, sizeof a));
        b[i] = (uint8_t)(1 << i % 8);
        CHECK(!net_equal(a, b, sizeof a));
        CHECK(net_equal(a, b, (size_t)i));
        b[i] = 0;
    }
}

/* Draws differ from each other and with the seed, and are the same again. */
static void check_random_bytes(void)
{
    uint8_t seed[NET_SHA_BYTES] = { 7 }, drawn[3][NET_NONCE], again[NET_NONCE];
    struct net_random r;
    net_random_start(&r, seed);
    net_random_draw(&r, drawn[0], NET_NONCE);
    net_random_draw(&r, drawn[1], NET_NONCE);
    net_random_start(&r, seed);
    net_random_draw(&r, again, NET_NONCE);
    seed[31] = 1;
    net_random_start(&r, seed);
    net_random_draw(&r, drawn[2], NET_NONCE);
    CHECK(memcmp(drawn[0], again, NET_NONCE) == 0);
    CHECK(memcmp(drawn[0], drawn[1], NET_NONCE) != 0);
    CHECK(memcmp(drawn[0], drawn[2], NET_NONCE) != 0);
}

int main(void)
{
    check_crc();
    check_hashes();
    check_rfc();
    check_proofs();
    check_equal();
    check_random_bytes();
    return check_result();
}
