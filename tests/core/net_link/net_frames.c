/* A channel takes whole frames cut anywhere, and nothing else: what is damaged, forged, replayed or
 * out of order closes it, and no byte behind that is looked at. */
#include <string.h>

#include "byte_ring.h"
#include "check.h"
#include "net_alive.h"
#include "net_channel.h"
#include "net_crc.h"

static const uint8_t key[NET_SHA_BYTES] = { 1, 2, 3 };

/* Three frames of the server: a command, four pages, one of a type to come. */
static size_t three_frames(bool keyed, uint8_t *bytes, size_t most)
{
    struct net_channel server;
    uint8_t payload[NET_PAYLOAD];
    const struct net_job_pages pages = { 12, NET_PAGES };
    const struct net_command command = { 77 };
    net_channel_start(&server, false);
    if (keyed)
        net_channel_key(&server, key);
    memset(payload, 0x4D, sizeof payload);
    net_put_command(payload, &command);
    CHECK(net_channel_put(&server, NET_START, payload, NET_BYTES_command));
    net_put_job_pages(payload, &pages);
    CHECK(net_channel_put(&server, NET_JOB_DATA, payload, sizeof payload));
    CHECK(net_channel_put(&server, 200, payload, 0));
    return net_channel_out(&server, bytes, most);
}

static void card_of(struct net_channel *card, bool keyed)
{
    net_channel_start(card, true);
    if (keyed)
        net_channel_key(card, key);
}

/* Give bytes in pieces of at most so many; returns the frames that came whole. */
static int take_all(struct net_channel *card, const uint8_t *bytes, size_t n, size_t most)
{
    int frames = 0;
    for (size_t at = 0; at < n && card->fault == NET_FINE;) {
        const size_t part = n - at < most ? n - at : most;
        at += net_channel_take(card, bytes + at, part);
        frames += card->whole;
        if (card->whole)
            net_channel_drop(card);
    }
    return frames;
}

static void check_pieces(bool keyed)
{
    uint8_t bytes[2 * NET_FRAME];
    const size_t n = three_frames(keyed, bytes, sizeof bytes);
    struct net_channel card;
    CHECK_EQ(n, 3 * (12 + (keyed ? 8 : 4)) + 4 + NET_PAYLOAD);
    for (size_t most = 1; most <= n; most += most < 40 ? 1 : 97) {
        card_of(&card, keyed);
        CHECK_EQ(take_all(&card, bytes, n, most), 3);
    }
    /* Nothing behind a frame that waits is taken. */
    card_of(&card, keyed);
    const size_t first = net_channel_take(&card, bytes, n);
    CHECK_EQ(first, 12 + 4 + (keyed ? 8 : 4));
    CHECK_EQ(net_channel_take(&card, bytes + first, n - first), 0);
    CHECK_EQ(net_channel_type(&card), NET_START);
    CHECK_EQ(net_channel_sequence(&card), 1);
    CHECK_EQ(net_channel_payload(&card)[0], 77);
}

/* Each bit of three frames turned over: what was whole before it is taken, nothing from there
 * on. */
static void check_damage(bool keyed)
{
    uint8_t bytes[2 * NET_FRAME];
    const size_t n = three_frames(keyed, bytes, sizeof bytes);
    const size_t first = 12 + 4 + (keyed ? 8 : 4), second = first + NET_FRAME - (keyed ? 0 : 4);
    struct net_channel card;
    for (size_t bit = 0; bit < 8 * n; bit += bit < 8 * (first + 16) ? 1 : 3 * CHECK_EACH) {
        bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
        card_of(&card, keyed);
        const int frames = take_all(&card, bytes, n, n);
        CHECK_EQ(frames, (bit / 8 >= first) + (bit / 8 >= second));
        /* A length that became larger may wait for bytes that do not come. */
        CHECK(card.fault != NET_FINE || card.held > 0);
        if (card.fault != NET_FINE) {
            CHECK_EQ(net_channel_take(&card, bytes, n), 0);
            CHECK(!net_channel_put(&card, NET_PING, bytes, 4));
        }
        bytes[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
}

static void expect_fault(struct net_channel *card, const uint8_t *bytes, size_t n,
                         enum net_fault want)
{
    net_channel_take(card, bytes, n);
    CHECK(!card->whole);
    CHECK_EQ(card->fault, want);
    CHECK(net_fault_text(want)[0] != '\0');
}

/* Frames that are right by themselves and do not belong here. */
static void check_forged(void)
{
    uint8_t open[2 * NET_FRAME], keyed[2 * NET_FRAME];
    const size_t n = three_frames(false, open, sizeof open);
    const size_t first = 12 + 4 + 8;
    const uint8_t other[NET_SHA_BYTES] = { 9 };
    struct net_channel card;
    three_frames(true, keyed, sizeof keyed);
    card_of(&card, true); /* replayed */
    CHECK_EQ(net_channel_take(&card, keyed, first), first);
    net_channel_drop(&card);
    expect_fault(&card, keyed, first, NET_BAD_SEQUENCE);
    card_of(&card, true); /* reordered */
    expect_fault(&card, keyed + first, NET_FRAME, NET_BAD_SEQUENCE);
    card_of(&card, true); /* a CRC instead of a MAC, and the other way round */
    expect_fault(&card, open, n, NET_BAD_FLAGS);
    card_of(&card, false);
    expect_fault(&card, keyed, first, NET_BAD_FLAGS);
    net_channel_start(&card, true); /* another key */
    net_channel_key(&card, other);
    expect_fault(&card, keyed, first, NET_BAD_CHECK);
    net_channel_start(&card, false); /* sent back to its sender */
    net_channel_key(&card, key);
    expect_fault(&card, keyed, first, NET_BAD_CHECK);
}

/* Let a frame of this header and payload have a right CRC; returns its bytes. */
static size_t crc_frame(uint8_t *f, uint8_t type, size_t length, size_t payload)
{
    const uint8_t header[NET_HEADER] = {
        0x4D, 0x43, 1, type, 0, 0, 1, 0, 0, 0, (uint8_t)length, (uint8_t)(length >> 8)
    };
    memcpy(f, header, sizeof header);
    memset(f + NET_HEADER, 1, payload);
    const uint32_t crc = net_crc(0, f, NET_HEADER + payload);
    for (int i = 0; i < 4; i++)
        f[NET_HEADER + payload + (size_t)i] = (uint8_t)(crc >> 8 * i);
    return NET_HEADER + payload + 4;
}

static void check_wrong_lengths(void)
{
    uint8_t f[NET_FRAME + 8];
    struct net_channel card;
    net_channel_start(&card, true);
    expect_fault(&card, f, crc_frame(f, NET_START, 1029, 0), NET_BAD_LENGTH);
    net_channel_start(&card, true);
    expect_fault(&card, f, crc_frame(f, NET_START, 5, 5), NET_BAD_PAYLOAD);
    net_channel_start(&card, true);
    expect_fault(&card, f, crc_frame(f, NET_JOB_DATA, 4, 4), NET_BAD_PAYLOAD);
    net_channel_start(&card, true);
    const size_t n = crc_frame(f, 250, NET_PAYLOAD, NET_PAYLOAD);
    CHECK_EQ(net_channel_take(&card, f, n), n);
    CHECK(card.whole);
    f[2] = 2;
    net_channel_start(&card, true);
    expect_fault(&card, f, n, NET_BAD_VERSION);
}

/* Bytes at random are never a frame. */
static void check_noise(uint64_t *seed)
{
    for (int round = 0; round < 4000 / CHECK_EACH; round++) {
        uint8_t noise[200];
        struct net_channel card;
        card_of(&card, round & 1);
        for (size_t i = 0; i < sizeof noise; i++)
            noise[i] = (uint8_t)check_random(seed, 0, 255);
        if (round & 2) { /* a header that could be */
            const uint8_t like[6] = { 0x4D, 0x43, 1, NET_PING, round & 1, 0 };
            memcpy(noise, like, sizeof like);
            memcpy(noise + 6, (const uint8_t[]){ 1, 0, 0, 0, 4, 0 }, 6);
        }
        CHECK_EQ(take_all(&card, noise, sizeof noise, (size_t)check_random(seed, 1, 200)), 0);
        CHECK(card.fault != NET_FINE);
    }
}

/* What is queued comes out in order however it is taken; a full queue refuses. */
static void check_queue(uint64_t *seed)
{
    struct net_channel out, in;
    uint8_t payload[NET_PAYLOAD] = { 0 }, bytes[700];
    int put = 0, got = 0;
    net_channel_start(&out, false);
    net_channel_start(&in, true);
    for (int round = 0; round < 3000; round++) {
        const size_t n = (size_t)check_random(seed, 0, NET_PAYLOAD);
        const bool room = net_channel_room(&out, n, 0);
        CHECK_EQ(net_channel_put(&out, 201, payload, n), room);
        put += room;
        const size_t some = net_channel_out(&out, bytes, (size_t)check_random(seed, 0, 700));
        got += take_all(&in, bytes, some, sizeof bytes);
    }
    size_t rest;
    while ((rest = net_channel_out(&out, bytes, sizeof bytes)) > 0)
        got += take_all(&in, bytes, rest, sizeof bytes);
    CHECK_EQ(got, put);
    CHECK(put > 1000 && put < 3000);
    CHECK_EQ(in.fault, NET_FINE);
}

/* Streams through the ring, over the wrap of the counts. */
static void check_ring(uint64_t *seed)
{
    int32_t words[BYTE_RING_WORDS] = { 0 }, count = INT32_MAX - 3000, taken = count;
    uint8_t sent = 0, seen = 0, bytes[601];
    int64_t total = 0;
    for (int round = 0; round < 2000; round++) {
        const size_t n = (size_t)check_random(seed, 0, 600);
        const int32_t held = byte_ring_held(count, taken);
        for (size_t i = 0; i < n; i++)
            bytes[i] = (uint8_t)(sent + i);
        const size_t put = byte_ring_put(words, &count, taken, bytes, n);
        CHECK_EQ(put, n < (size_t)(512 - held) ? n : (size_t)(512 - held));
        sent = (uint8_t)(sent + put);
        for (size_t i = 0; i < sizeof bytes; i++)
            bytes[i] = (uint8_t) ~(seen + i);
        const size_t got =
            byte_ring_look(words, count, taken, bytes, (size_t)check_random(seed, 0, 600));
        for (size_t i = 0; i < got; i++)
            CHECK_EQ(bytes[i], (uint8_t)(seen + i));
        CHECK_EQ(bytes[got], (uint8_t) ~(seen + got)); /* nothing behind what it says */
        seen = (uint8_t)(seen + got);
        taken = byte_ring_on(taken, got);
        total += (int64_t)got;
    }
    CHECK(total > 100000 && count < 1000000000);
    CHECK_EQ(byte_ring_held(5, 6), -1);
    CHECK_EQ(byte_ring_held(513, 0), -1);
    CHECK_EQ(byte_ring_held(-1, 0), -1);
    CHECK_EQ(byte_ring_held(0, INT32_MAX), 1);
    CHECK_EQ(byte_ring_look(words, 513, 0, bytes, sizeof bytes), 0);
}

/* PING at 1, 2, 3 s of silence, gone at 4 s. */
static void check_alive(void)
{
    struct net_alive a;
    net_alive_heard(&a, 500);
    for (int64_t s = 1; s <= 3; s++) {
        CHECK_EQ(net_alive_tick(&a, s * NET_PING_NS + 499), NET_QUIET);
        CHECK_EQ(net_alive_tick(&a, s * NET_PING_NS + 500), NET_ASK);
    }
    CHECK_EQ(net_alive_tick(&a, 4 * NET_PING_NS + 499), NET_QUIET);
    CHECK_EQ(net_alive_tick(&a, 4 * NET_PING_NS + 500), NET_GONE);
    net_alive_heard(&a, 4 * NET_PING_NS + 501);
    CHECK_EQ(net_alive_tick(&a, 5 * NET_PING_NS), NET_QUIET);
}

int main(void)
{
    uint64_t seed = 5;
    for (int keyed = 0; keyed < 2; keyed++) {
        check_pieces(keyed);
        check_damage(keyed);
    }
    check_forged();
    check_wrong_lengths();
    check_noise(&seed);
    check_queue(&seed);
    check_ring(&seed);
    check_alive();
    return check_result();
}
