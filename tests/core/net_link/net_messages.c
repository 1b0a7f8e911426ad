/* Every message: its bytes against the layout written out here once more, round trip, lengths. */
#include <string.h>

#include "check.h"
#include "net_message.h"

/* The members of each message in bytes, as the protocol's table has them. */
struct layout {
    const char *name, *sizes; /* a digit a number; x: a spare byte; s: 16, h: 32 bytes */
    size_t bytes;
};

static size_t bytes_of(const char *sizes)
{
    size_t n = 0;
    for (; *sizes; sizes++)
        n += *sizes == 'x' ? 1 : *sizes == 's' ? 16 : *sizes == 'h' ? 32 : (size_t)(*sizes - '0');
    return n;
}

static void check_layouts(void)
{
    static const struct layout all[] = {
        { "hello",
          "422s411"
          "24h1x2",
          NET_BYTES_hello },
        { "challenge", "2xxsh", NET_BYTES_challenge },
        { "auth", "h", NET_BYTES_auth },
        { "welcome", "2xx", NET_BYTES_welcome },
        { "job_begin", "4h4", NET_BYTES_job_begin },
        { "job_pages", "22", NET_BYTES_job_pages },
        { "job_end", "4", NET_BYTES_job_end },
        { "ack", "422", NET_BYTES_ack },
        { "nak", "422", NET_BYTES_nak },
        { "command", "4", NET_BYTES_command },
        { "home", "41xxx", NET_BYTES_home },
        { "output", "42114", NET_BYTES_output },
        { "result", "422", NET_BYTES_result },
        { "config_get", "22", NET_BYTES_config_get },
        { "config_set", "4228", NET_BYTES_config_set },
        { "config", "228", NET_BYTES_config },
        { "status",
          "112224444444"
          "42222222"
          "24",
          NET_BYTES_status },
        { "token", "4", NET_BYTES_token },
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        if (bytes_of(all[i].sizes) != all[i].bytes)
            printf("%s\n", all[i].name);
        CHECK_EQ(bytes_of(all[i].sizes), all[i].bytes);
    }
}

/* Bytes at random become a struct and the same bytes again; not one behind them is touched. */
#define CHECK_BOTH_WAYS(name, list) \
    for (int round = 0; round < 50; round++) { \
        uint8_t bytes[NET_BYTES_##name + 1], again[NET_BYTES_##name + 1]; \
        struct net_##name m; \
        for (size_t i = 0; i < sizeof bytes; i++) \
            bytes[i] = (uint8_t)check_random(seed, 0, 255); \
        memset(again, 0x5A, sizeof again); \
        net_get_##name(bytes, &m); \
        net_put_##name(again, &m); \
        CHECK(memcmp(bytes, again, NET_BYTES_##name) == 0); \
        CHECK_EQ(again[NET_BYTES_##name], 0x5A); \
    }

static void check_round_trips(uint64_t *seed)
{
    NET_STRUCTS(CHECK_BOTH_WAYS)
}

/* Numbers stand where they belong, low byte first, signs kept. */
static void check_places(void)
{
    const struct net_status status = {
        .state = NET_FAULT,
        .error = 9,
        .inputs = 0x1234,
        .stock = 512,
        .job = 0xA1B2C3D4,
        .position = { -1, INT32_MIN, INT32_MAX, 2 },
        .load = { 1, 2, 3, 4, 5, 6, 1000 },
        .rate = 999,
        .wear = 100000,
    };
    const struct net_config_set set = { 7, 258, 3, -2 };
    const struct net_hello hello = {
        .card = 0x01020304,
        .newest = 1,
        .nonce = { 0xAA },
        .last_command = 5,
        .job = { 0xBB },
        .state = 6,
        .life = 0x0708,
    };
    uint8_t b[NET_PAYLOAD];
    net_put_status(b, &status);
    CHECK_EQ(b[0], 7);
    CHECK_EQ(b[2], 0x34);
    CHECK_EQ(b[3], 0x12);
    CHECK_EQ(b[7], 2);
    CHECK_EQ(b[8], 0xD4);
    CHECK_EQ(b[16], 0xFF);
    CHECK_EQ(b[23], 0x80);
    CHECK_EQ(b[27], 0x7F);
    CHECK_EQ(b[40 + 12] + 256 * b[40 + 13], 1000);
    CHECK_EQ(b[54] + 256 * b[55], 999);
    CHECK_EQ(b[56] + 256 * b[57] + 65536 * b[58], 100000);
    net_put_config_set(b, &set);
    CHECK_EQ(b[4], 2);
    CHECK_EQ(b[5], 1);
    CHECK_EQ(b[8], 0xFE);
    CHECK_EQ(b[15], 0xFF);
    net_put_hello(b, &hello);
    CHECK_EQ(b[0], 4);
    CHECK_EQ(b[3], 1);
    CHECK_EQ(b[8], 0xAA);
    CHECK_EQ(b[32], 5);
    CHECK_EQ(b[36], 0xBB);
    CHECK_EQ(b[68], 6);
    CHECK_EQ(b[70], 8);
    CHECK_EQ(b[71], 7);
}

/* A type that is known has one length, JOB_DATA that of its pages, others any. */
static void check_lengths(void)
{
    enum { KINDS = 22 };
    uint8_t payload[NET_PAYLOAD + 1] = { 0 };
    int known = 0, commands = 0;
    for (int type = 0; type < 256; type++) {
        const bool of_card = net_is_known((uint8_t)type, true);
        const bool of_server = net_is_known((uint8_t)type, false);
        int fits = 0;
        for (size_t n = 0; n <= NET_PAYLOAD && type != NET_JOB_DATA; n++)
            fits += net_payload_fits((uint8_t)type, payload, n);
        known += of_card || of_server;
        commands += net_is_command((uint8_t)type);
        CHECK_EQ(of_card && of_server, type == NET_PING || type == NET_PONG);
        if (type != NET_JOB_DATA)
            CHECK_EQ(fits, of_card || of_server ? 1 : NET_PAYLOAD + 1);
    }
    CHECK_EQ(known, KINDS);
    CHECK_EQ(commands, 7);
    for (int count = 0; count < 7; count++) {
        const struct net_job_pages pages = { 0, (uint16_t)count };
        net_put_job_pages(payload, &pages);
        for (size_t n = 0; n <= sizeof payload; n++) {
            const bool right = count >= 1 && count <= 4 && n == 4 + 256 * (size_t)count;
            CHECK_EQ(net_payload_fits(NET_JOB_DATA, payload, n), right);
        }
    }
}

int main(void)
{
    uint64_t seed = 3;
    check_layouts();
    check_round_trips(&seed);
    check_places();
    check_lengths();
    return check_result();
}
