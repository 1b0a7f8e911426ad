/* Messages that the server's end sends by itself: commands, pages, PING. */
#include "net_host.h"

static size_t order_bytes(const struct net_host_order *o, uint8_t payload[NET_BYTES_output])
{
    const struct net_command command = { o->number };
    const struct net_home home = { .number = o->number, .axes = o->axes };
    const struct net_output output = { o->number, o->pins, o->mode, o->level, o->width };
    if (o->type == NET_HOME) {
        net_put_home(payload, &home);
        return NET_BYTES_home;
    }
    if (o->type == NET_OUTPUT) {
        net_put_output(payload, &output);
        return NET_BYTES_output;
    }
    net_put_command(payload, &command);
    return NET_BYTES_command;
}

static bool send_order(struct net_host *h, struct net_host_order *o, int64_t now)
{
    uint8_t payload[NET_BYTES_output];
    if (!net_channel_room(&h->channel, sizeof payload, 0))
        return false;
    if (o->stage == NET_HOST_WAITING) {
        o->number = ++h->last_number;
        o->first = now;
        o->stage = NET_HOST_SENT;
    }
    o->again = false;
    o->times++;
    return net_channel_put(&h->channel, o->type, payload, order_bytes(o, payload));
}

/* The command to be sent next: first those to be sent again, by number; then the earliest that is
 * due, with NET_HOST_OPEN without a result at most. NULL if there is none. */
static struct net_host_order *next_order(struct net_host *h, int64_t now)
{
    struct net_host_order *again = NULL, *due = NULL;
    int open = 0;
    for (int i = 0; i < NET_HOST_ORDERS; i++) {
        struct net_host_order *o = &h->order[i];
        open += o->stage == NET_HOST_SENT;
        if (o->stage == NET_HOST_SENT && o->again && (!again || o->number < again->number))
            again = o;
        if (o->stage == NET_HOST_WAITING && o->at <= now && (!due || o->at < due->at))
            due = o;
    }
    return again ? again : open < NET_HOST_OPEN ? due : NULL;
}

static void send_begin(struct net_host *h)
{
    struct net_job_begin begin = { .bytes = h->job.bytes, .crc = h->job.crc };
    uint8_t payload[NET_BYTES_job_begin];
    for (int i = 0; i < NET_SHA_BYTES; i++)
        begin.hash[i] = h->job.hash[i];
    net_put_job_begin(payload, &begin);
    if (net_channel_put(&h->channel, NET_JOB_BEGIN, payload, sizeof payload)) {
        h->upload = NET_HOST_BEGUN;
        h->asked = h->channel.sent;
        h->flights = 0;
    }
}

static void send_end(struct net_host *h)
{
    const struct net_job_end end = { h->job.crc };
    uint8_t payload[NET_BYTES_job_end];
    net_put_job_end(payload, &end);
    if (net_channel_put(&h->channel, NET_JOB_END, payload, sizeof payload)) {
        h->upload = NET_HOST_ENDED;
        h->asked = h->channel.sent;
    }
}

/* Send up to four pages, as many as the card's credit allows behind those on their way. False if it
 * sends none. */
static bool send_pages(struct net_host *h, const uint8_t *job)
{
    const uint32_t left = h->job.bytes / NET_PAGE_BYTES - h->page;
    uint8_t payload[NET_PAYLOAD];
    uint32_t flying = 0, count = left < NET_PAGES ? left : NET_PAGES;
    for (int i = 0; i < h->flights; i++)
        flying += h->flight[i].pages;
    const uint32_t free = h->credit > flying ? h->credit - flying : 0;
    count = count < free ? count : free;
    const struct net_job_pages pages = { (uint16_t)h->page, (uint16_t)count };
    const size_t bytes = (size_t)count * NET_PAGE_BYTES;
    if (count == 0 || h->flights == NET_HOST_FLIGHTS
        || !net_channel_room(&h->channel, NET_BYTES_job_pages + bytes, 0))
        return false;
    net_put_job_pages(payload, &pages);
    for (size_t i = 0; i < bytes; i++)
        payload[NET_BYTES_job_pages + i] = job[(size_t)h->page * NET_PAGE_BYTES + i];
    net_channel_put(&h->channel, NET_JOB_DATA, payload, NET_BYTES_job_pages + bytes);
    h->flight[h->flights++] = (struct net_host_flight){ h->channel.sent, count };
    h->pages_sent += count;
    for (uint32_t p = h->page; p < h->page + count; p++)
        h->pages_again += p < h->high;
    h->page += count;
    h->high = h->page > h->high ? h->page : h->high;
    return true;
}

static void send_job(struct net_host *h, const uint8_t *job, int64_t now)
{
    if (h->upload == NET_HOST_SENDING && h->lost_step && h->flights == 0) {
        h->upload = NET_HOST_TO_BEGIN;
        h->lost_step = false;
    }
    if (h->upload == NET_HOST_TO_BEGIN && now >= h->again)
        send_begin(h);
    if (h->upload != NET_HOST_SENDING || h->lost_step)
        return;
    while (send_pages(h, job))
        continue;
    if (h->page == h->job.bytes / NET_PAGE_BYTES)
        send_end(h);
}

bool net_host_ask(struct net_host *h, uint16_t id, uint16_t index)
{
    const struct net_config_get get = { id, index };
    uint8_t payload[NET_BYTES_config_get];
    net_put_config_get(payload, &get);
    return h->phase == NET_HOST_UP
           && net_channel_put(&h->channel, NET_CONFIG_GET, payload, sizeof payload);
}

void net_host_tick(struct net_host *h, const uint8_t *job, int64_t now)
{
    enum net_alive_event event;
    struct net_host_order *o;
    uint8_t payload[NET_BYTES_token];
    if (h->phase != NET_HOST_DOWN && h->phase != NET_HOST_UP && now >= h->due)
        net_host_refuse(h);
    if (h->phase != NET_HOST_UP)
        return;
    while ((event = net_alive_tick(&h->alive, now)) == NET_ASK) {
        const struct net_token token = { (uint32_t)h->alive.pings };
        net_put_token(payload, &token);
        net_channel_put(&h->channel, NET_PING, payload, sizeof payload);
    }
    if (event == NET_GONE) {
        net_host_refuse(h);
        return;
    }
    while ((o = next_order(h, now)) && send_order(h, o, now))
        continue;
    send_job(h, job, now);
}
