/* net_host - the server's end of the link to one card: handshake, upload, commands, status. It has
 * no socket and no clock: bytes in, bytes out, times are arguments [ns].
 *
 * An upload outlives connections: only pages that the card misses are sent again. So does a
 * command: its number stays, and the card does each number once. A card that has lost its power
 * meanwhile (HELLO has another life) has forgotten its numbers: what had no result then is lost,
 * not repeated.
 */
#ifndef NET_HOST_H
#define NET_HOST_H

#include "net_alive.h"
#include "net_channel.h"
#include "net_proof.h"

#define NET_HOST_PROVE_NS INT64_C(5000000000) /* for the handshake */
#define NET_HOST_AGAIN_NS INT64_C(1000000000) /* until a busy card is asked again */
enum {
    NET_HOST_ORDERS = 16,
    NET_HOST_OPEN = 8,     /* commands without a result at a time: as many as a card keeps */
    NET_HOST_FLIGHTS = 32, /* JOB_DATA that are not acknowledged */
};

enum net_host_phase { NET_HOST_DOWN, NET_HOST_GREETED, NET_HOST_CHALLENGED, NET_HOST_UP };

enum net_host_upload {
    NET_HOST_NO_JOB,
    NET_HOST_TO_BEGIN, /* JOB_BEGIN is to be sent */
    NET_HOST_BEGUN,    /* it waits for its answer */
    NET_HOST_SENDING,
    NET_HOST_ENDED,  /* JOB_END waits for its answer */
    NET_HOST_STORED, /* it is the card's job */
    NET_HOST_REFUSED
};

enum net_host_stage {
    NET_HOST_FREE,
    NET_HOST_WAITING,
    NET_HOST_SENT,
    NET_HOST_ANSWERED,
    NET_HOST_LOST,
    NET_HOST_STAGES
};

/* A command at a time. */
struct net_host_order {
    int64_t at;          /* [ns] it is sent then, or when the link is up again */
    uint8_t type;        /* NET_START .. NET_OUTPUT */
    uint8_t axes;        /* of HOME, bits */
    uint8_t mode, level; /* of OUTPUT */
    uint16_t pins;
    uint32_t width; /* [us] */
    /* What became of it. */
    uint8_t stage;        /* enum net_host_stage */
    bool again;           /* is to be sent on this connection too */
    uint16_t code, state; /* of its RESULT */
    uint32_t number;
    uint32_t times;          /* it was sent */
    int64_t first, answered; /* [ns] sent, answered */
};

struct net_host_config {
    uint16_t interval;           /* [ms] of STATUS; 0 none */
    uint8_t key[NET_SHA_BYTES];  /* 0: open */
    uint8_t seed[NET_SHA_BYTES]; /* of nonces: never the same twice but in a test */
};

/* What is known of the file of a job; its bytes are an argument. */
struct net_host_job {
    uint32_t bytes, crc;
    uint8_t hash[NET_SHA_BYTES];
};

struct net_host_flight {
    uint32_t sequence, pages;
};

struct net_host {
    struct net_host_config config;
    struct net_random random;
    struct net_secret secret;
    struct net_channel channel;
    struct net_alive alive;
    uint8_t phase; /* enum net_host_phase */
    bool refused;  /* this end closes the connection */
    uint8_t fault; /* enum net_fault of the latest connection that had one */
    bool met;      /* a card has been up: its number and life */
    uint16_t life;
    uint32_t card;
    int64_t due;            /* [ns] end of the handshake */
    struct net_hello hello; /* of the latest connection */
    uint32_t last_number;   /* of a command */
    struct net_host_job job;
    uint8_t upload;      /* enum net_host_upload */
    uint16_t code;       /* enum net_code of its refusal */
    int64_t again;       /* [ns] not before */
    uint32_t asked;      /* sequence of its JOB_BEGIN or JOB_END */
    uint32_t page, high; /* next one, behind the last one ever sent */
    bool lost_step;      /* a page was refused: ask the card where to go on */
    uint32_t credit;     /* [pages] */
    int32_t flights;
    struct net_host_flight flight[NET_HOST_FLIGHTS];
    struct net_host_order order[NET_HOST_ORDERS];
    struct net_status status;
    struct net_config setting; /* the latest told */
    uint32_t settings, statuses, connections, losses, naks, pages_sent, pages_again;
};

void net_host_start(struct net_host *h, const struct net_host_config *c);

/* This file shall be the card's job. bytes is a multiple of 256, more than 0. */
void net_host_load(struct net_host *h, const uint8_t *job, uint32_t bytes);

/* Give a command, of which the first six members count; false if sixteen are not done with. */
bool net_host_give(struct net_host *h, const struct net_host_order *order);

void net_host_connected(struct net_host *h, int64_t now);
void net_host_cut(struct net_host *h);

/* This end closes the connection. */
void net_host_refuse(struct net_host *h);

/* False: this end wants the connection closed; net_host_cut() when it is. */
bool net_host_accepts(const struct net_host *h);

/* Take bytes, always all of them. */
void net_host_bytes(struct net_host *h, const uint8_t *bytes, size_t n, int64_t now);

/* Move bytes out; returns how many. */
size_t net_host_out(struct net_host *h, uint8_t *bytes, size_t most);

/* Queue what is due; `job` is the file. Call it behind bytes in or out, and each few ms. */
void net_host_tick(struct net_host *h, const uint8_t *job, int64_t now);

/* Ask for a setting; false if there is no room. */
bool net_host_ask(struct net_host *h, uint16_t id, uint16_t index);

#endif
