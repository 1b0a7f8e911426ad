/* session - the card's end of the link: bytes of a connection in, messages for the card out;
 * answers in, bytes out. It has no socket and no clock: times are arguments [ns], and
 * session_next_time() says when session_tick() has something to do.
 *
 *     IDLE --time--> CALLING --connected--> GREETING --CHALLENGE--> PROVING --WELCOME--> UP
 *       ^______________________ cut, fault, no answer in time ___________________________|
 *
 * A waiting message takes no byte behind it (the server is kept back), nor does one whose answers
 * would find no room. Handshake, PING and repeated commands are answered here. A command number is
 * taken once: the last eight results are kept and told again.
 */
#ifndef SESSION_H
#define SESSION_H

#include "net_alive.h"
#include "net_channel.h"
#include "net_proof.h"

#define SESSION_RETRY_NS   INT64_C(500000000)   /* first pause before a new connection */
#define SESSION_RETRY_MOST INT64_C(30000000000) /* it doubles up to here; each is +-25 % */
#define SESSION_CALL_NS    INT64_C(3000000000)  /* for a connection to come about */
#define SESSION_PROVE_NS   INT64_C(5000000000)  /* for the handshake */
enum { SESSION_KEPT = 8 };

enum session_phase { SESSION_IDLE, SESSION_CALLING, SESSION_GREETING, SESSION_PROVING, SESSION_UP };

struct session_config {
    uint32_t card;
    uint32_t firmware;
    uint8_t slots, axes;
    uint8_t key[NET_SHA_BYTES];  /* 0: open */
    uint8_t seed[NET_SHA_BYTES]; /* of nonces and pauses: never the same twice but in a test */
};

/* What HELLO says of the card at that moment. */
struct session_about {
    uint16_t credit;            /* [pages] */
    uint8_t state;              /* enum net_state */
    uint8_t job[NET_SHA_BYTES]; /* hash of the job in flash; 0 none */
};

struct session_kept {
    uint32_t number; /* of the command; 0 none */
    uint16_t code, state;
    bool open; /* taken, without a result yet */
};

struct session {
    struct session_config config;
    struct net_random random;
    struct net_secret secret;
    struct net_channel channel;
    struct net_alive alive;
    uint8_t phase;                /* enum session_phase */
    bool lost;                    /* was up, until session_lost() asks */
    bool offered;                 /* the channel's frame is a message for the card */
    int64_t due;                  /* [ns] end of the phase, but for UP */
    int32_t attempts;             /* since it was up */
    uint16_t life;                /* drawn at power-up */
    uint16_t state;               /* of the card, as told last */
    int64_t interval, status_due; /* [ns] of STATUS; 0 none */
    uint32_t last_command;        /* highest number taken */
    struct session_kept kept[SESSION_KEPT];
    uint32_t job_sequence;    /* of a JOB_BEGIN or JOB_END not answered yet; 0 none */
    uint32_t done;            /* sequence of the latest message dealt with */
    bool ack;                 /* one waits for room */
    uint16_t credit, missing; /* its content */
    uint32_t acked;
    uint32_t connections, losses, repeats, dropped; /* dropped: STATUS without room */
    uint8_t fault; /* enum net_fault of the latest connection that had one */
};

/* A message for the card; valid until session_drop(). */
struct session_message {
    uint8_t type; /* enum net_type */
    uint32_t sequence;
    const uint8_t *payload; /* of the length of its type */
    size_t length;
};

void session_start(struct session *s, const struct session_config *c, int64_t now);

/* Power is back: numbers and results are forgotten, what is random goes on. */
void session_power_up(struct session *s, int64_t now);

/* Does it want a connection, or to keep the one it has? */
bool session_wants(const struct session *s);
void session_connected(struct session *s, const struct session_about *a, int64_t now);
void session_cut(struct session *s, int64_t now);

bool session_up(const struct session *s);

/* Has it gone down from up since the last call? */
bool session_lost(struct session *s);

/* Take bytes; returns how many. */
size_t session_bytes(struct session *s, const uint8_t *bytes, size_t n, int64_t now);

/* Is there a message for the card? The same until it is dropped. */
bool session_next(struct session *s, struct session_message *m, int64_t now);
void session_drop(struct session *s);

/* Move bytes out; returns how many. */
size_t session_out(struct session *s, uint8_t *bytes, size_t most);

int64_t session_next_time(const struct session *s); /* [ns] INT64_MAX: never */
void session_tick(struct session *s, int64_t now);

/* Answers. While the link is down they go nowhere, but results are kept. A JOB_BEGIN or JOB_END is
 * answered once, by session_job(), at any time: until then no ACK goes up to its sequence. An ACK
 * tells of the messages dropped so far: session_ack() comes behind session_drop(). */
void session_result(struct session *s, uint32_t number, enum net_code code, uint8_t state);
void session_ack(struct session *s, uint16_t credit, uint16_t missing);
void session_job(struct session *s, enum net_code code, uint16_t detail, uint16_t credit,
                 uint16_t missing);
void session_nak(struct session *s, uint32_t sequence, enum net_code code, uint16_t detail);
void session_setting(struct session *s, const struct net_config *c);

/* When a STATUS is due [ns]; INT64_MAX: none is wanted. It is dropped if answers need the room. */
int64_t session_status_time(const struct session *s);
void session_status(struct session *s, const struct net_status *status, int64_t now);

#endif
