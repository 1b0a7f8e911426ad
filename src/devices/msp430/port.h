/* port - the positioner's port 1 interrupt routine as in the article's listing, instruction by
 * instruction: quadrature decoding of the scale by four edge interrupts, and the home input.
 *
 * An instruction reads and writes in its last clock. An edge at clock c is visible to what is done
 * at c or later. README.md has the instructions with their cycles. */
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

enum { PORT_SOURCES = 5 }; /* tested in the order of the listing, then home */

enum port_clear {
    PORT_CLEAR_ALL = 0, /* as written: mov.b #0,&P1IFG before reti clears every flag */
    PORT_CLEAR_ONE = 1, /* repaired: bic.b of the served flag before the level is read */
};

/* Cycles from the acceptance of an interrupt to its first instruction. */
enum { PORT_LATENCY = 6 };

/* The next action of the routine. */
enum port_place {
    PORT_IDLE,    /* the routine is not in progress */
    PORT_TEST,    /* test the flag of a source */
    PORT_DROP,    /* clear this flag */
    PORT_LEVEL,   /* read the level of the other line, which gives the direction */
    PORT_COUNT,   /* change wMCounter */
    PORT_COUNT_2, /* change wSt */
    PORT_ZERO,    /* home: clear wMCounter */
    PORT_MARK,    /* home: set the mark for the timer */
    PORT_WIPE,    /* clear all flags */
    PORT_RETURN,  /* reti */
};

struct port {
    enum port_clear clear;
    uint8_t flags;            /* P1IFG */
    int8_t way[PORT_SOURCES]; /* true direction, +1 or -1, of the edge that set each flag */
    enum port_place place;    /* next action */
    int source;               /* source that is tested or served, 0 .. 4; -1 none was set */
    int step;                 /* +1 or -1, direction as decoded */
    int moved;                /* +1 or -1, true direction */
    uint16_t counter;         /* wMCounter [counts] */
    uint16_t counter_2;       /* wSt [counts] */
    int64_t served;           /* number of encoder edges counted, either way */
    int latest;               /* number of the latest source served, 1 .. 5; 0: none yet */
    int64_t lost;             /* number of edges whose flag was set already or cleared unserved */
    int64_t turned;           /* number of edges counted in the wrong direction */
    int64_t zeroed;           /* number of home edges served */
    int64_t home_lost;        /* number of home edges lost likewise */
};

/* The scale's line A or B has changed to `high` in the direction `way`, +1 or -1: the pin behind
 * the inverter sets the flag of its edge. */
void port_edge(struct port *p, bool line_b, bool high, int way);

/* The home input rises. */
void port_home(struct port *p);

/* The interrupt is accepted. Returns the cycles to the routine's first action. */
int port_begin(struct port *p);

/* Do the next action, with the present levels of the scale's lines. Returns the cycles to the one
 * after it; 0 after reti. */
int port_go(struct port *p, bool line_a, bool line_b);

#endif
