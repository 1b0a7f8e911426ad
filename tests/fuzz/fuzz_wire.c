/* Bytes as what happens on a link between a card's session and a host: bytes carried, cut short,
 * changed or made up, frames of any content with a right check, cuts, times, answers. Every index
 * stays within its array; with a key only what the host sent is a message; a command number comes
 * to the card once. */
#include "byte_ring.h"
#include "holds.h"
#include "net_crc.h"
#include "net_host.h"
#include "session.h"

const int fuzz_count = 10000;

enum { JOB_PAGES = 24, RAW = 64, KNOWN = 256 };

struct bytes {
    const uint8_t *at, *end;
};

static struct session card;
static struct net_host host;
static uint8_t job[JOB_PAGES * NET_PAGE_BYTES];
static int64_t now;
static uint32_t latest;    /* command number that came to the card */
static bool keyed, forged; /* forged: bytes that no end sent are under way */

/* The host's frames as it sent them, whatever becomes of them on the way: CRC by sequence. */
static struct {
    uint8_t frame[NET_FRAME];
    size_t held;
    uint32_t crc[KNOWN];
} witness;

static void watch(const uint8_t *some, size_t n)
{
    const uint8_t *f = witness.frame;
    for (size_t i = 0; i < n; i++) {
        witness.frame[witness.held++] = some[i];
        const size_t length = (size_t)(f[10] | f[11] << 8);
        const size_t whole = NET_HEADER + length + (f[4] & 1 ? NET_MAC : NET_CRC);
        if (witness.held < NET_HEADER || witness.held < whole)
            continue;
        witness.crc[(f[6] | f[7] << 8) % KNOWN] = net_crc(f[3], f + NET_HEADER, length);
        witness.held = 0;
    }
}

static uint8_t byte(struct bytes *b)
{
    return b->at < b->end ? *b->at++ : 0;
}

static size_t fill(struct bytes *b, uint8_t *to, size_t most)
{
    size_t n = byte(b) % (most + 1);
    for (size_t i = 0; i < n; i++)
        to[i] = byte(b);
    return n;
}

static void cut(void)
{
    session_cut(&card, now);
    net_host_cut(&host);
    forged = false;
}

/* What the card's session has for the card. */
static void read_messages(struct bytes *b)
{
    struct session_message m;
    struct net_command command;
    while (session_next(&card, &m, now)) {
        HOLDS(net_is_known(m.type, false) && m.type >= NET_JOB_BEGIN);
        HOLDS(net_payload_fits(m.type, m.payload, m.length));
        HOLDS(!keyed || witness.crc[m.sequence % KNOWN] == net_crc(m.type, m.payload, m.length));
        if (net_is_command(m.type)) {
            net_get_command(m.payload, &command);
            HOLDS(command.number > latest);
            latest = command.number;
        }
        session_drop(&card);
        const uint8_t answer = byte(b);
        if (net_is_command(m.type) && answer & 1)
            session_result(&card, latest, (enum net_code)(answer % NET_CODES), answer);
        else if (m.type == NET_JOB_BEGIN || m.type == NET_JOB_END)
            session_job(&card, (enum net_code)(answer % NET_CODES), 0, answer, answer / 4);
        else if (m.type == NET_JOB_DATA && answer & 2)
            session_nak(&card, m.sequence, NET_PAGE, answer);
        else
            session_ack(&card, answer, answer / 8);
    }
}

/* Some bytes of one end reach the other, perhaps one of them changed. */
static void carry(struct bytes *b, bool to_card)
{
    uint8_t some[2 * NET_FRAME];
    const size_t most = 1 + 8 * (size_t)byte(b);
    const uint8_t change = byte(b);
    size_t n = to_card ? net_host_out(&host, some, most) : session_out(&card, some, most);
    if (to_card)
        watch(some, n);
    if (n > 0 && change < 8) {
        some[(size_t)byte(b) % n] ^= (uint8_t)(1 << change);
        forged = true;
    }
    if (!to_card) {
        net_host_bytes(&host, some, n, now);
        return;
    }
    for (size_t at = 0; at < n;) {
        const size_t taken = session_bytes(&card, some + at, n - at, now);
        HOLDS(taken <= n - at);
        read_messages(b);
        if (taken == 0) /* no room for answers: the rest is lost with the connection */
            cut();
        at += taken > 0 ? taken : n - at;
    }
}

static void raw(struct bytes *b, bool to_card)
{
    uint8_t some[RAW];
    const size_t n = fill(b, some, sizeof some);
    forged = forged || n > 0;
    if (to_card)
        session_bytes(&card, some, n, now);
    else
        net_host_bytes(&host, some, n, now);
    read_messages(b);
}

/* A frame of any content that has a right check. */
static void frame(struct bytes *b, bool of_host)
{
    uint8_t payload[NET_PAYLOAD] = { 0 };
    const uint8_t type = byte(b);
    size_t n = fill(b, payload, RAW);
    n = type == NET_JOB_DATA ? NET_BYTES_job_pages + NET_PAGE_BYTES : n;
    net_channel_put(of_host ? &host.channel : &card.channel, type, payload, n);
}

static void connect_both(void)
{
    const struct session_about about = { .credit = 12, .state = NET_READY };
    if (!session_wants(&card) || card.phase != SESSION_CALLING)
        return;
    net_host_cut(&host);
    session_connected(&card, &about, now);
    net_host_connected(&host, now);
    forged = false;
    memset(&witness, 0, sizeof witness);
}

static void order(struct bytes *b)
{
    const struct net_host_order o = { .at = now, .type = (uint8_t)(NET_START + byte(b) % 6) };
    net_host_give(&host, &o);
}

static void ring(struct bytes *b)
{
    int32_t words[BYTE_RING_WORDS] = { 0 }, count = byte(b) << 23 | byte(b);
    const int32_t taken = count - (byte(b) << 2) + byte(b);
    uint8_t some[BYTE_RING_BYTES], back[BYTE_RING_BYTES];
    const int32_t before = byte_ring_held(count, taken);
    const size_t n = fill(b, some, 255);
    const size_t put = byte_ring_put(words, &count, taken, some, n);
    HOLDS(put <= n && (before >= 0 || put == 0));
    if (before < 0)
        return;
    HOLDS(byte_ring_held(count, taken) == before + (int32_t)put);
    HOLDS(byte_ring_look(words, count, taken, back, sizeof back) == (size_t)before + put);
    HOLDS(put == 0 || memcmp(back + before, some, put) == 0);
}

static void one(struct bytes *b)
{
    const struct net_status status = { .state = NET_RUNNING };
    switch (byte(b) % 14) {
    case 0:
    case 1:  carry(b, true); break;
    case 2:
    case 3:  carry(b, false); break;
    case 4:  raw(b, true); break;
    case 5:  raw(b, false); break;
    case 6:  frame(b, true); break;
    case 7:  frame(b, false); break;
    case 8:  connect_both(); break;
    case 9:  order(b); break;
    case 10: now += (int64_t)byte(b) << byte(b) % 28; break;
    case 11: session_status(&card, &status, now); break;
    case 12: ring(b); break;
    default:
        if (byte(b) % 8 == 0) {
            session_power_up(&card, now);
            net_host_cut(&host);
            latest = 0;
        } else if (byte(b) % 8 == 0) {
            cut();
        } else {
            session_result(&card, latest, NET_DONE, NET_READY);
        }
    }
    if (session_next_time(&card) <= now)
        session_tick(&card, now);
    net_host_tick(&host, job, now);
    HOLDS(card.channel.taken <= host.channel.sent || forged || host.phase == NET_HOST_DOWN);
    HOLDS(!keyed || card.phase != SESSION_UP || card.channel.keyed);
    HOLDS(host.pages_sent - host.pages_again <= JOB_PAGES);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct bytes b = { data, data + size };
    keyed = byte(&b) & 1;
    const struct session_config c = { .card = 3, .key = { keyed }, .seed = { 1 } };
    const struct net_host_config h = { .interval = byte(&b), .key = { keyed }, .seed = { 2 } };
    now = 0;
    latest = 0;
    session_start(&card, &c, 0);
    net_host_start(&host, &h);
    net_host_load(&host, job, sizeof job);
    connect_both();
    while (b.at < b.end)
        one(&b);
    return 0;
}
