/* Port 1 interrupt routine of the listing, instruction by instruction: quadrature decoding by four
 * edge interrupts, and the home input.
 *
 * What an instruction reads or writes it does in its last clock. An edge at clock c is seen by what
 * is done at c or later. README.md has the instructions with their cycles. */
#ifndef PORT_H
#define PORT_H

#include <stdbool.h>
#include <stdint.h>

/* Bits of P1IN, P1IE, P1IES and P1IFG. Both lines come through an inverting 74HC14. */
enum {
    PORT_HOME = 0x01,   /* P1.0, rising; not in the listing's P1IE of 0x3C */
    PORT_A_UP = 0x04,   /* P1.2; its level is PGA */
    PORT_A_DOWN = 0x08, /* P1.3 */
    PORT_B_UP = 0x10,   /* P1.4; its level is PGB */
    PORT_B_DOWN = 0x20, /* P1.5 */
};

enum { PORT_SOURCES = 5 }; /* in the order of the listing, home behind them */

enum port_clear {
    PORT_CLEAR_ALL = 0, /* mov.b #0,&P1IFG before reti, as written: every flag */
    PORT_CLEAR_ONE = 1, /* bic.b of the flag that is served, before the level is read */
};

/* Cycles from the acceptance of an interrupt to its first instruction. */
enum { PORT_LATENCY = 6 };

enum port_place {
    PORT_IDLE,
    PORT_TEST,
    PORT_DROP,
    PORT_LEVEL,
    PORT_COUNT,
    PORT_COUNT_2,
    PORT_ZERO,
    PORT_MARK,
    PORT_WIPE,
    PORT_RETURN,
};

struct port {
    enum port_clear clear;
    uint8_t flags;            /* P1IFG */
    int8_t way[PORT_SOURCES]; /* true direction of the edge behind each flag */
    enum port_place place;    /* what is done next */
    int source;               /* being tested or served */
    int step;                 /* +1 or -1, as decoded */
    int moved;                /* +1 or -1, what it should be */
    uint16_t counter;         /* wMCounter */
    uint16_t counter_2;       /* wSt */
    int64_t served;           /* encoder edges counted, either way */
    int latest;               /* number of the latest interrupt served, 1 .. 5; 0: none yet */
    int64_t lost;             /* edges whose flag was up already, or was cleared unserved */
    int64_t turned;           /* edges counted the wrong way round */
    int64_t zeroed;           /* home edges served */
    int64_t home_lost;        /* home edges whose flag was cleared unserved */
};

/* The scale's line A or B has changed to `high`, moving `way`: the pin behind the inverter sets the
 * flag of its edge. */
void port_edge(struct port *p, bool line_b, bool high, int way);

/* The home input rises. */
void port_home(struct port *p);

/* An interrupt is accepted; cycles to what is done first. */
int port_begin(struct port *p);

/* Do what is next, with the scale's lines as they are; cycles to the next, 0 after reti. */
int port_go(struct port *p, bool line_a, bool line_b);

#endif
