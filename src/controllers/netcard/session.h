/* session - the card's end of the link to the PC. It turns the bytes of a connection into messages
 * for the card, and the card's answers into bytes. It has no socket and no clock: times are
 * arguments [ns], and session_next_time() says when session_tick() has something to do.
 *
 *     IDLE --time--> CALLING --connected--> GREETING --CHALLENGE--> PROVING --WELCOME--> UP
 *       ^______________________ cut, fault, no answer in time ___________________________|
 *
 * While a message waits for the card, or room for its answers, no byte after it is taken, which
 * keeps the server back. Handshake, PING and repeated commands are answered here. The number of a
 * command is taken once: the last eight results are kept and told again.
 */
#ifndef SESSION_H
#define SESSION_H

#include "net_alive.h"
#include "net_channel.h"
#include "net_proof.h"

#define SESSION_RETRY_NS   INT64_C(500000000)   /* first pause before a new connection */
#define SESSION_RETRY_MOST INT64_C(30000000000) /* pauses double up to this; each +-25 % */
#define SESSION_CALL_NS    INT64_C(3000000000)  /* for a connection to come about */
#define SESSION_PROVE_NS   INT64_C(5000000000)  /* for the handshake */
enum { SESSION_KEPT = 8 };

enum session_phase { SESSION_IDLE, SESSION_CALLING, SESSION_GREETING, SESSION_PROVING, SESSION_UP };

struct session_config {
    uint32_t card;
    uint32_t firmware;
    uint8_t slots, axes;
    uint8_t key[NET_SHA_BYTES];  /* the card's key; all 0: an open link without MAC */
    uint8_t seed[NET_SHA_BYTES]; /* of nonces and pauses: never the same twice except in tests */
};

/* What HELLO says of the card when the connection comes about. */
struct session_about {
    uint16_t credit;            /* [pages] */
    uint8_t state;              /* enum net_state */
    uint8_t job[NET_SHA_BYTES]; /* hash of the job in flash; all 0: none */
};

/* A command and its result, kept for repetition. */
struct session_kept {
    uint32_t number;      /* of the command; 0: none */
    uint16_t code, state; /* the result, and the card's state then */
    bool open;            /* the command has been taken and has no result yet */
};

struct session {
    struct session_config config;
    struct net_random random;
    struct net_secret secret;
    struct net_channel channel;
    struct net_alive alive;
    uint8_t phase;                /* enum session_phase */
    bool lost;                    /* the link has gone down from UP since session_lost() */
    bool offered;                 /* the frame in the channel is a message for the card */
    int64_t due;                  /* [ns] end of the phase, unless it is UP */
    int32_t attempts;             /* connections tried since the link was up */
    uint16_t life;                /* number drawn at power-up */
    uint16_t state;               /* state of the card, as it was told last */
    int64_t interval, status_due; /* [ns] between STATUS, 0: none; when the next is due */
    uint32_t last_command;        /* highest number of a command taken */
    struct session_kept kept[SESSION_KEPT];
    uint32_t job_sequence;    /* of a JOB_BEGIN or JOB_END that is not answered yet; 0: none */
    uint32_t done;            /* sequence of the latest message that was dealt with */
    bool ack;                 /* an ACK waits for room, */
    uint16_t credit, missing; /* with this content */
    uint32_t acked;           /* and for the messages up to this sequence */
    uint32_t connections, losses, repeats, dropped; /* counts; dropped: STATUS without room */
    uint8_t fault; /* enum net_fault of the latest connection that had one */
};

/* A message for the card; valid until session_drop(). */
struct session_message {
    uint8_t type; /* enum net_type */
    uint32_t sequence;
    const uint8_t *payload; /* of the length that its type has */
    size_t length;
};

void session_start(struct session *s, const struct session_config *c, int64_t now);

/* Power is back: numbers and results are forgotten, random numbers go on. */
void session_power_up(struct session *s, int64_t now);

/* True if the session wants a connection, or wants to keep the one it has. */
bool session_wants(const struct session *s);
void session_connected(struct session *s, const struct session_about *a, int64_t now);
void session_cut(struct session *s, int64_t now);

bool session_up(const struct session *s);

/* True if the link has gone down from UP since the last call. */
bool session_lost(struct session *s);

/* Take bytes of the connection. Returns how many. */
size_t session_bytes(struct session *s, const uint8_t *bytes, size_t n, int64_t now);

/* True if there is a message for the card, which stays the same until session_drop(). */
bool session_next(struct session *s, struct session_message *m, int64_t now);
void session_drop(struct session *s);

/* Move out at most so many bytes that are to be sent. Returns how many. */
size_t session_out(struct session *s, uint8_t *bytes, size_t most);

int64_t session_next_time(const struct session *s); /* [ns] of the next tick; INT64_MAX: never */
void session_tick(struct session *s, int64_t now);

/* Answers. While the link is down they are lost, but results are kept. A JOB_BEGIN or JOB_END is
 * answered once, by session_job(), at any time; until then no ACK covers its sequence. An ACK
 * covers the messages dropped so far, so call session_ack() after session_drop(). */
void session_result(struct session *s, uint32_t number, enum net_code code, uint8_t state);
void session_ack(struct session *s, uint16_t credit, uint16_t missing);
void session_job(struct session *s, enum net_code code, uint16_t detail, uint16_t credit,
                 uint16_t missing);
void session_nak(struct session *s, uint32_t sequence, enum net_code code, uint16_t detail);
void session_setting(struct session *s, const struct net_config *c);

/* When a STATUS is due [ns]; INT64_MAX: none is wanted. session_status drops it if answers need the
 * room. */
int64_t session_status_time(const struct session *s);
void session_status(struct session *s, const struct net_status *status, int64_t now);

#endif
