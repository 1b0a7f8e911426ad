#include "port.h"

static const uint8_t FLAG[PORT_SOURCES] = { PORT_A_UP, PORT_A_DOWN, PORT_B_UP, PORT_B_DOWN,
                                            PORT_HOME };

/* Cycles of instructions. A constant of 1, 4 or 8 comes from the constant generator, which saves
 * the cycle for reading it from memory. */
enum { TEST_CYCLES = 4, LITERAL = 1, JUMP = 2, MEMORY = 4, RETI = 5 };

static bool generated(int constant)
{
    return constant == PORT_HOME || constant == PORT_A_UP || constant == PORT_A_DOWN;
}

static int bit_cycles(int constant)
{
    return TEST_CYCLES + (generated(constant) ? 0 : LITERAL);
}

/* Set the flag of a source; false if it was set already. */
static bool raise_flag(struct port *p, int source)
{
    const bool free = !(p->flags & FLAG[source]);
    p->flags |= FLAG[source];
    return free;
}

void port_edge(struct port *p, bool line_b, bool high, int way)
{
    const bool rises = !high; /* behind the 74HC14 */
    const int source = (line_b ? 2 : 0) + (rises ? 0 : 1);
    if (raise_flag(p, source))
        p->way[source] = (int8_t)way;
    else
        p->lost++;
}

void port_home(struct port *p)
{
    p->home_lost += !raise_flag(p, PORT_SOURCES - 1);
}

int port_begin(struct port *p)
{
    p->place = PORT_TEST;
    p->source = 0;
    return PORT_LATENCY + bit_cycles(FLAG[0]);
}

static int go_to(struct port *p, enum port_place place, int cycles)
{
    p->place = place;
    return cycles;
}

static int leave(struct port *p)
{
    return p->clear == PORT_CLEAR_ALL ? go_to(p, PORT_WIPE, MEMORY) : go_to(p, PORT_RETURN, RETI);
}

/* Begin to serve a source, after its flag was tested or cleared. */
static int serve(struct port *p)
{
    if (FLAG[p->source] == PORT_HOME)
        return go_to(p, PORT_ZERO, MEMORY);
    return go_to(p, PORT_LEVEL, bit_cycles(p->source < 2 ? PORT_B_UP : PORT_A_UP));
}

static int test(struct port *p)
{
    if (p->flags & FLAG[p->source]) {
        p->moved = p->way[p->source];
        if (p->clear == PORT_CLEAR_ONE)
            return JUMP + go_to(p, PORT_DROP, bit_cycles(FLAG[p->source]));
        return JUMP + serve(p);
    }
    if (++p->source < PORT_SOURCES)
        return JUMP + bit_cycles(FLAG[p->source]);
    p->source = -1;
    return JUMP + leave(p);
}

/* The listing's four decisions by the level of the other line. Where jz is not taken, a jmp
 * follows, except in the last one, which falls through into DECCounter. */
static int decode(struct port *p, bool line_a, bool line_b)
{
    static const int LOW[] = { 1, -1, -1, 1 };
    const bool high = p->source < 2 ? !line_b : !line_a;
    const int more = high && FLAG[p->source] != PORT_B_DOWN ? JUMP : 0;
    p->step = high ? -LOW[p->source] : LOW[p->source];
    return JUMP + more + go_to(p, PORT_COUNT, MEMORY);
}

static void wipe(struct port *p)
{
    const uint8_t others = p->source < 0 ? p->flags : p->flags & (uint8_t)~FLAG[p->source];
    for (int i = 0; i < PORT_SOURCES; i++)
        if (others & FLAG[i])
            ++*(FLAG[i] == PORT_HOME ? &p->home_lost : &p->lost);
    p->flags = 0;
}

int port_go(struct port *p, bool line_a, bool line_b)
{
    switch (p->place) {
    case PORT_TEST:  return test(p);
    case PORT_DROP:  p->flags &= (uint8_t)~FLAG[p->source]; return serve(p);
    case PORT_LEVEL: return decode(p, line_a, line_b);
    case PORT_COUNT:
        p->counter = (uint16_t)(p->counter + p->step);
        p->served++;
        p->latest = p->source + 1;
        p->turned += p->step != p->moved;
        return go_to(p, PORT_COUNT_2, MEMORY);
    case PORT_COUNT_2:
        p->counter_2 = (uint16_t)(p->counter_2 + p->step);
        return p->clear == PORT_CLEAR_ALL ? leave(p) : go_to(p, PORT_RETURN, RETI);
    case PORT_ZERO: p->counter = 0; return go_to(p, PORT_MARK, MEMORY);
    case PORT_MARK:
        p->zeroed++;
        p->latest = p->source + 1;
        return leave(p);
    case PORT_WIPE:   wipe(p); return go_to(p, PORT_RETURN, RETI);
    case PORT_RETURN:
    case PORT_IDLE:   break;
    }
    p->place = PORT_IDLE;
    return 0;
}
