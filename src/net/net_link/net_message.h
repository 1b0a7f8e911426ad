/* net_message - the messages between a network card and its server. Each is declared once, as a
 * list of type, name and elements of its members, which makes its struct, its bytes and its length.
 * Bytes are little-endian, members follow each other without gaps. Spare bytes are written 0 and
 * not read.
 *
 *     card -> server   HELLO            AUTH            ACK NAK RESULT CONFIG STATUS   PING PONG
 *     server -> card         CHALLENGE       WELCOME    JOB_* commands CONFIG_GET/SET  PING PONG
 */
#ifndef NET_MESSAGE_H
#define NET_MESSAGE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "net_codes.h"
#include "net_sha.h"

enum {
    NET_PROTOCOL = 1,     /* the only version of the protocol so far */
    NET_PAGE_BYTES = 256, /* page of a job file */
    NET_PAGES = 4,        /* most pages in a JOB_DATA */
    NET_NONCE = 16,       /* [byte] */
    NET_AXES = 4,
    NET_NO_PAGE = 0xFFFF,                         /* in ACK: no page is missing */
    NET_PAYLOAD = 4 + NET_PAGES * NET_PAGE_BYTES, /* longest payload [byte] */
};

enum net_type {
    NET_HELLO = 1,
    NET_CHALLENGE,
    NET_AUTH,
    NET_WELCOME,
    NET_JOB_BEGIN = 16,
    NET_JOB_DATA,
    NET_JOB_END,
    NET_ACK,
    NET_NAK,
    NET_START = 32,
    NET_PAUSE,
    NET_STOP,
    NET_HOME,
    NET_RESET,
    NET_OUTPUT,
    NET_RESULT = 48,
    NET_CONFIG_GET = 64,
    NET_CONFIG_SET,
    NET_CONFIG,
    NET_STATUS = 80,
    NET_PING = 96,
    NET_PONG,
};

#define NET_HELLO_LIST(X) \
    X(uint32_t, card, )   /* number of the card */ \
    X(uint16_t, oldest, ) /* oldest and newest protocol that it knows */ \
    X(uint16_t, newest, ) \
    X(uint8_t, nonce, [NET_NONCE]) \
    X(uint32_t, firmware, ) \
    X(uint8_t, slots, )              /* slots for jobs in the flash */ \
    X(uint8_t, axes, )               /* number of axes */ \
    X(uint16_t, credit, )            /* [pages] that it can take */ \
    X(uint32_t, last_command, )      /* highest command number taken since power-up */ \
    X(uint8_t, job, [NET_SHA_BYTES]) /* hash of the job in flash; 0 none */ \
    X(uint8_t, state, )              /* enum net_state */ \
    X(uint8_t, spare, ) \
    X(uint16_t, life, ) /* random number of this power-up; a new one: results are lost */
#define NET_CHALLENGE_LIST(X) \
    X(uint16_t, protocol, ) \
    X(uint16_t, spare, ) \
    X(uint8_t, nonce, [NET_NONCE]) \
    X(uint8_t, proof, [NET_SHA_BYTES])
#define NET_AUTH_LIST(X) X(uint8_t, proof, [NET_SHA_BYTES])
#define NET_WELCOME_LIST(X) \
    X(uint16_t, interval, ) /* [ms] between two STATUS; 0 none */ \
    X(uint16_t, spare, )
#define NET_JOB_BEGIN_LIST(X) \
    X(uint32_t, bytes, ) /* a multiple of 256 */ \
    X(uint8_t, hash, [NET_SHA_BYTES]) \
    X(uint32_t, crc, )
/* JOB_DATA: the number of the first page, the number of pages, and these pages. */
#define NET_JOB_PAGES_LIST(X) \
    X(uint16_t, page, ) \
    X(uint16_t, count, )
#define NET_JOB_END_LIST(X) X(uint32_t, crc, )
#define NET_ACK_LIST(X) \
    X(uint32_t, sequence, ) /* all frames up to it are taken */ \
    X(uint16_t, credit, )   /* [pages] that may come in frames behind it */ \
    X(uint16_t, missing, )  /* first missing page of the job, or NET_NO_PAGE */
#define NET_NAK_LIST(X) \
    X(uint32_t, sequence, ) \
    X(uint16_t, code, ) /* enum net_code */ \
    X(uint16_t, detail, )
/* START, PAUSE, STOP and RESET have only the command's number. */
#define NET_COMMAND_LIST(X) X(uint32_t, number, )
#define NET_HOME_LIST(X) \
    X(uint32_t, number, ) \
    X(uint8_t, axes, ) /* axes to be homed, a bit each */ \
    X(uint8_t, spare, [3])
#define NET_OUTPUT_LIST(X) \
    X(uint32_t, number, ) \
    X(uint16_t, pins, )  /* outputs, a bit each */ \
    X(uint8_t, mode, )   /* 0 level, 1 pulse */ \
    X(uint8_t, level, )  /* 1 active high */ \
    X(uint32_t, width, ) /* [us] of a pulse */
#define NET_RESULT_LIST(X) \
    X(uint32_t, number, ) \
    X(uint16_t, code, ) \
    X(uint16_t, state, )
#define NET_CONFIG_GET_LIST(X) \
    X(uint16_t, id, ) \
    X(uint16_t, index, )
#define NET_CONFIG_SET_LIST(X) \
    X(uint32_t, number, ) \
    X(uint16_t, id, ) \
    X(uint16_t, index, ) \
    X(int64_t, value, )
#define NET_CONFIG_LIST(X) \
    X(uint16_t, id, ) \
    X(uint16_t, index, ) \
    X(int64_t, value, )
#define NET_STATUS_LIST(X) \
    X(uint8_t, state, ) \
    X(uint8_t, error, ) \
    X(uint16_t, inputs, ) \
    X(uint16_t, outputs, ) \
    X(uint16_t, stock, )             /* [frames] in the FIFO */ \
    X(uint32_t, job, )               /* id of the job */ \
    X(uint32_t, frame, )             /* number of the frame that plays */ \
    X(int32_t, position, [NET_AXES]) /* [pulses] */ \
    X(uint32_t, underflows, ) \
    X(uint32_t, switches, ) /* bits of limit switches, home switches, alarms */ \
    X(uint16_t, load, [7])  /* [1/1000] processor load of six tasks and of interrupts */ \
    X(uint16_t, rate, )     /* [1/1000] rate at which the job is played */ \
    X(uint32_t, wear, )     /* most erases of a flash sector */
#define NET_TOKEN_LIST(X) X(uint32_t, token, )

/* X(struct, list of its members): each has the functions net_put_<struct> and net_get_<struct>. */
#define NET_STRUCTS(X) \
    X(hello, NET_HELLO_LIST) \
    X(challenge, NET_CHALLENGE_LIST) \
    X(auth, NET_AUTH_LIST) \
    X(welcome, NET_WELCOME_LIST) \
    X(job_begin, NET_JOB_BEGIN_LIST) \
    X(job_pages, NET_JOB_PAGES_LIST) \
    X(job_end, NET_JOB_END_LIST) \
    X(ack, NET_ACK_LIST) \
    X(nak, NET_NAK_LIST) \
    X(command, NET_COMMAND_LIST) \
    X(home, NET_HOME_LIST) \
    X(output, NET_OUTPUT_LIST) \
    X(result, NET_RESULT_LIST) \
    X(config_get, NET_CONFIG_GET_LIST) \
    X(config_set, NET_CONFIG_SET_LIST) \
    X(config, NET_CONFIG_LIST) \
    X(status, NET_STATUS_LIST) \
    X(token, NET_TOKEN_LIST)

#define NET_MEMBER(type, name, elements) type name elements;
#define NET_SIZE(type, name, elements)   +sizeof(type elements)
#define NET_DECLARE(name, list) \
    struct net_##name { \
        list(NET_MEMBER) \
    }; \
    enum { NET_BYTES_##name = 0 list(NET_SIZE) }; \
    void net_put_##name(uint8_t *payload, const struct net_##name *m); \
    void net_get_##name(const uint8_t *payload, struct net_##name *m);
/* net_put_x writes and net_get_x reads NET_BYTES_x bytes. */
NET_STRUCTS(NET_DECLARE)

/* Whether the payload has the length of its type; unknown types may have any. A JOB_DATA must have
 * as many pages as it says. */
bool net_payload_fits(uint8_t type, const uint8_t *payload, size_t n);

/* Whether a message of this type is sent by that end. */
bool net_is_known(uint8_t type, bool from_card);

/* Whether the type is a command: its first four bytes are its number, its answer is RESULT. */
bool net_is_command(uint8_t type);

#endif
