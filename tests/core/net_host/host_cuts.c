/* The link is cut behind every byte of an upload with commands, either way, open and with a key. */
#include "link_rig.h"

enum { PAGES = 13, MOST_MS = 5000 };

/* Bytes that a run without a cut sends each way. */
static void whole_run(struct rig *r, bool keyed)
{
    rig_start(r, PAGES, keyed, 1);
    const int orders = rig_orders(r);
    CHECK(rig_run(r, MOST_MS));
    rig_check(r, orders);
    CHECK_EQ(r->host.pages_again, 0);
    CHECK_EQ(r->host.connections, 1);
    CHECK(r->host.statuses > 3);
}

static void cut_runs(struct rig *r, bool keyed, bool to_card, int64_t bytes)
{
    uint32_t again = 0, repeats = 0;
    const int before = check_failures;
    for (int64_t n = 0; n < bytes; n += CHECK_EACH) {
        rig_start(r, PAGES, keyed, 1);
        const int orders = rig_orders(r);
        (to_card ? &r->to_card : &r->to_host)->cut_after = n;
        CHECK(rig_run(r, MOST_MS));
        rig_check(r, orders);
        CHECK_EQ(r->cuts, 1);
        CHECK_EQ(r->host.connections, 2);
        /* What was on its way at most: the credit. */
        CHECK(r->host.pages_again <= RIG_CREDIT);
        again += r->host.pages_again;
        repeats += r->card.session.repeats;
        if (check_failures > before) {
            printf("cut behind byte %d %s\n", (int)n, to_card ? "to the card" : "to the host");
            return;
        }
    }
    CHECK_EQ(again > 0, to_card);
    printf("%s, %s: cut behind each of %d bytes: %u pages again, %u commands repeated\n",
           keyed ? "key" : "open", to_card ? "to the card" : "to the host", (int)bytes,
           (unsigned)again, (unsigned)repeats);
    CHECK(to_card || repeats > 0);
}

/* A connection that begins before anybody told the end of the one before it has none of its bytes:
 * neither half a frame that came nor what waited to go. */
static void anew_without_a_cut(void)
{
    static struct net_host host;
    struct net_channel card;
    const struct net_host_config config = { .seed = { 1 } };
    const struct net_command command = { 77 };
    uint8_t bytes[NET_OUT], payload[NET_PAYLOAD];

    net_host_start(&host, &config);
    net_host_connected(&host, 0);
    net_channel_start(&card, true);
    net_put_command(payload, &command);
    CHECK(net_channel_put(&card, NET_HELLO, payload, NET_BYTES_command));
    const size_t n = net_channel_out(&card, bytes, sizeof bytes);
    net_host_bytes(&host, bytes, n - 3, RIG_MS);
    CHECK_EQ(host.channel.held, n - 3);
    CHECK(net_channel_put(&host.channel, NET_START, payload, NET_BYTES_command));
    net_host_connected(&host, 2 * RIG_MS);
    CHECK_EQ(host.channel.held, 0);
    CHECK_EQ(net_host_out(&host, bytes, sizeof bytes), 0);
    CHECK_EQ(host.channel.sent, 0);
    CHECK_EQ(host.connections, 2);
}

int main(void)
{
    static struct rig r;
    anew_without_a_cut();
    for (int keyed = 0; keyed < 2; keyed++) {
        whole_run(&r, keyed);
        const int64_t to_card = r.to_card.passed, to_host = r.to_host.passed;
        cut_runs(&r, keyed, true, to_card);
        cut_runs(&r, keyed, false, to_host);
    }
    return check_result();
}
