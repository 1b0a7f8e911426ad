#include "net_message.h"

/* Write n integers of `size` bytes each, low byte first, whatever the machine's byte order. */
static uint8_t *put(uint8_t *to, const void *from, size_t size, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        const uint8_t *at = (const uint8_t *)from + i * size;
        uint64_t value = size == 1   ? *at
                         : size == 2 ? *(const uint16_t *)(const void *)at
                         : size == 4 ? *(const uint32_t *)(const void *)at
                                     : *(const uint64_t *)(const void *)at;
        for (size_t b = 0; b < size; b++, value >>= 8)
            *to++ = (uint8_t)value;
    }
    return to;
}

static const uint8_t *get(const uint8_t *from, void *to, size_t size, size_t n)
{
    for (size_t i = 0; i < n; i++, from += size) {
        uint8_t *at = (uint8_t *)to + i * size;
        uint64_t value = 0;
        for (size_t b = size; b > 0; b--)
            value = value << 8 | from[b - 1];
        if (size == 1)
            *at = (uint8_t)value;
        else if (size == 2)
            *(uint16_t *)(void *)at = (uint16_t)value;
        else if (size == 4)
            *(uint32_t *)(void *)at = (uint32_t)value;
        else
            *(uint64_t *)(void *)at = value;
    }
    return from;
}

#define PUT(type, name, elements) \
    payload = put(payload, &m->name, sizeof(type), sizeof m->name / sizeof(type));
#define GET(type, name, elements) \
    payload = get(payload, &m->name, sizeof(type), sizeof m->name / sizeof(type));
#define DEFINE(name, list) \
    void net_put_##name(uint8_t *payload, const struct net_##name *m) \
    { \
        list(PUT) \
    } \
    void net_get_##name(const uint8_t *payload, struct net_##name *m) \
    { \
        list(GET) \
    }
NET_STRUCTS(DEFINE)

enum from { NOBODY, CARD, SERVER, BOTH };

struct kind {
    enum from from;
    size_t bytes;
};

/* CCN 23: a case for each message. */
static struct kind kind_of(uint8_t type)
{
    switch ((enum net_type)type) {
    case NET_HELLO:      return (struct kind){ CARD, NET_BYTES_hello };
    case NET_CHALLENGE:  return (struct kind){ SERVER, NET_BYTES_challenge };
    case NET_AUTH:       return (struct kind){ CARD, NET_BYTES_auth };
    case NET_WELCOME:    return (struct kind){ SERVER, NET_BYTES_welcome };
    case NET_JOB_BEGIN:  return (struct kind){ SERVER, NET_BYTES_job_begin };
    case NET_JOB_DATA:   return (struct kind){ SERVER, NET_BYTES_job_pages };
    case NET_JOB_END:    return (struct kind){ SERVER, NET_BYTES_job_end };
    case NET_ACK:        return (struct kind){ CARD, NET_BYTES_ack };
    case NET_NAK:        return (struct kind){ CARD, NET_BYTES_nak };
    case NET_START:
    case NET_PAUSE:
    case NET_STOP:
    case NET_RESET:      return (struct kind){ SERVER, NET_BYTES_command };
    case NET_HOME:       return (struct kind){ SERVER, NET_BYTES_home };
    case NET_OUTPUT:     return (struct kind){ SERVER, NET_BYTES_output };
    case NET_RESULT:     return (struct kind){ CARD, NET_BYTES_result };
    case NET_CONFIG_GET: return (struct kind){ SERVER, NET_BYTES_config_get };
    case NET_CONFIG_SET: return (struct kind){ SERVER, NET_BYTES_config_set };
    case NET_CONFIG:     return (struct kind){ CARD, NET_BYTES_config };
    case NET_STATUS:     return (struct kind){ CARD, NET_BYTES_status };
    case NET_PING:
    case NET_PONG:       return (struct kind){ BOTH, NET_BYTES_token };
    }
    return (struct kind){ NOBODY, 0 };
}

bool net_is_known(uint8_t type, bool from_card)
{
    const enum from from = kind_of(type).from;
    return from == BOTH || from == (from_card ? CARD : SERVER);
}

bool net_is_command(uint8_t type)
{
    return (type >= NET_START && type <= NET_OUTPUT) || type == NET_CONFIG_SET;
}

bool net_payload_fits(uint8_t type, const uint8_t *payload, size_t n)
{
    const struct kind kind = kind_of(type);
    struct net_job_pages pages;
    if (type != NET_JOB_DATA)
        return kind.from == NOBODY || n == kind.bytes;
    if (n < kind.bytes)
        return false;
    net_get_job_pages(payload, &pages);
    return pages.count >= 1 && pages.count <= NET_PAGES
           && n == kind.bytes + (size_t)pages.count * NET_PAGE_BYTES;
}
