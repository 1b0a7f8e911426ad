/* net_host - the server's end of the network link to one motion card: handshake, upload of a job
 * file, commands, status. It has no socket and no clock: bytes go in and out, times are arguments
 * [ns].
 *
 * An upload survives a lost connection: only the pages that the card misses are sent again. So does
 * a command: it keeps its number, and the card does each number once. A card that has lost its
 * power meanwhile (HELLO has another `life`) has forgotten its numbers: commands without a result
 * are then lost, not repeated.
 */
#ifndef NET_HOST_H
#define NET_HOST_H

#include "net_alive.h"
#include "net_channel.h"
#include "net_proof.h"

#define NET_HOST_PROVE_NS INT64_C(5000000000) /* longest time of the handshake */
#define NET_HOST_AGAIN_NS INT64_C(1000000000) /* time until a busy card is asked again */
enum {
    NET_HOST_ORDERS = 16,  /* most commands that are kept */
    NET_HOST_OPEN = 8,     /* most commands sent without a result: as many as a card keeps */
    NET_HOST_FLIGHTS = 32, /* most JOB_DATA that are not acknowledged */
};

/* No connection; HELLO is expected; AUTH is expected; the link is up. */
enum net_host_phase { NET_HOST_DOWN, NET_HOST_GREETED, NET_HOST_CHALLENGED, NET_HOST_UP };

enum net_host_upload {
    NET_HOST_NO_JOB,
    NET_HOST_TO_BEGIN, /* JOB_BEGIN is to be sent */
    NET_HOST_BEGUN,    /* JOB_BEGIN waits for its answer */
    NET_HOST_SENDING,  /* pages are being sent */
    NET_HOST_ENDED,    /* JOB_END waits for its answer */
    NET_HOST_STORED,   /* the file is the card's job */
    NET_HOST_REFUSED   /* the card has refused the job */
};

enum net_host_stage {
    NET_HOST_FREE,     /* no command */
    NET_HOST_WAITING,  /* its time has not come, or the link is down */
    NET_HOST_SENT,     /* sent, without a result */
    NET_HOST_ANSWERED, /* its RESULT has come */
    NET_HOST_LOST,     /* the card has forgotten it in a power loss */
    NET_HOST_STAGES
};

/* A command with the time at which it is to be sent. */
struct net_host_order {
    int64_t at;          /* [ns] time at which it is sent, or later when the link is up */
    uint8_t type;        /* NET_START .. NET_OUTPUT */
    uint8_t axes;        /* HOME: a bit an axis */
    uint8_t mode, level; /* OUTPUT: as in net_message.h, */
    uint16_t pins;       /* a bit each, */
    uint32_t width;      /* [us] of a pulse */
    /* The members from here on are set by net_host. */
    uint8_t stage;           /* enum net_host_stage */
    bool again;              /* it is to be sent again on this connection */
    uint16_t code, state;    /* of its RESULT: enum net_code, enum net_state */
    uint32_t number;         /* number of the command */
    uint32_t times;          /* how often it was sent */
    int64_t first, answered; /* [ns] times at which it was sent first, answered */
};

struct net_host_config {
    uint16_t interval;           /* [ms] between two STATUS; 0 none */
    uint8_t key[NET_SHA_BYTES];  /* the card's key; all 0: an open link without MAC */
    uint8_t seed[NET_SHA_BYTES]; /* of the nonces; never the same twice except in a test */
};

/* Size and check sums of a job file, whose bytes are an argument. */
struct net_host_job {
    uint32_t bytes, crc;
    uint8_t hash[NET_SHA_BYTES]; /* SHA-256 */
};

/* A JOB_DATA that is not acknowledged: its frame's sequence and its number of pages. */
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
    bool refused;  /* this end wants the connection closed */
    uint8_t fault; /* enum net_fault of the latest connection that had one */
    bool met;      /* a card has been up; it had this life and number: */
    uint16_t life;
    uint32_t card;
    int64_t due;            /* [ns] time until which the handshake must be over */
    struct net_hello hello; /* HELLO of the latest connection */
    uint32_t last_number;   /* highest command number so far */
    struct net_host_job job;
    uint8_t upload;      /* enum net_host_upload */
    uint16_t code;       /* enum net_code of the latest NAK */
    int64_t again;       /* [ns] time before which a busy card is not asked again */
    uint32_t asked;      /* sequence of the JOB_BEGIN or JOB_END that waits for an answer */
    uint32_t page, high; /* next page to be sent; page behind the last one ever sent */
    bool lost_step;      /* a page was refused: ask the card which page is missing */
    uint32_t credit;     /* [pages] that the card can take behind the acknowledged ones */
    int32_t flights;     /* number of JOB_DATA on their way */
    struct net_host_flight flight[NET_HOST_FLIGHTS];
    struct net_host_order order[NET_HOST_ORDERS];
    struct net_status status;  /* the latest one */
    struct net_config setting; /* the latest one */
    /* Numbers of CONFIG, STATUS, connections, lost connections, NAK, pages sent, sent again. */
    uint32_t settings, statuses, connections, losses, naks, pages_sent, pages_again;
};

/* Start without a connection, a job or commands. */
void net_host_start(struct net_host *h, const struct net_host_config *c);

/* Upload this file as the card's job. `bytes` is a multiple of 256, more than 0. */
void net_host_load(struct net_host *h, const uint8_t *job, uint32_t bytes);

/* Queue a command, of which the members up to `width` count. False if NET_HOST_ORDERS commands wait
 * or have no result yet. */
bool net_host_give(struct net_host *h, const struct net_host_order *order);

/* The connection has been established; it has been lost. */
void net_host_connected(struct net_host *h, int64_t now);
void net_host_cut(struct net_host *h);

/* Close the connection from this end. */
void net_host_refuse(struct net_host *h);

/* False: this end wants the connection closed; call net_host_cut() when it is. */
bool net_host_accepts(const struct net_host *h);

/* Take n received bytes, always all of them. */
void net_host_bytes(struct net_host *h, const uint8_t *bytes, size_t n, int64_t now);

/* Move up to `most` bytes to be sent out. Returns their number. */
size_t net_host_out(struct net_host *h, uint8_t *bytes, size_t most);

/* Queue the messages that are due; `job` is the file. Call it after bytes in or out, and every few
 * ms. */
void net_host_tick(struct net_host *h, const uint8_t *job, int64_t now);

/* Ask for a setting of the card; false if the link is down or there is no room. */
bool net_host_ask(struct net_host *h, uint16_t id, uint16_t index);

#endif
