/* What a refused call of the card says. */
#ifndef STATUS_H
#define STATUS_H

#include <stdint.h>

/* The status of a block is its own enum on top of the block's base: EPCIO_ENCODER +
 * ENCODER_BAD_RATE. */
enum epcio_status {
    EPCIO_OK,
    EPCIO_FIFO_FULL,            /* a FIFO holds 63 commands already */
    EPCIO_FIFO_EMPTY,           /* there is no command to shift out */
    EPCIO_COMMAND_TOO_LARGE,    /* |command| > 2^length - 1 */
    EPCIO_AXIS_UNUSED,          /* pulses for an axis that is not active */
    EPCIO_DROPPED,              /* an emergency stop caught the frame on its way */
    EPCIO_STOPPED,              /* the emergency stop is pressed, or the watchdog has expired */
    EPCIO_BAD_LENGTH,           /* not 10 .. 15 bit */
    EPCIO_BAD_DIVIDER,          /* not 1 .. 65535 */
    EPCIO_BAD_MINIMUM,          /* minimum stock not 0 .. 62 */
    EPCIO_BAD_COUNT,            /* less than none, or more than 16 frames */
    EPCIO_STOCK_TOO_LARGE,      /* a command in stock does not fit the shorter length */
    EPCIO_BUS_FULL,             /* eight transactions are on their way */
    EPCIO_BAD_AXIS,             /* no such axis, encoder, channel or set */
    EPCIO_BAD_MASK,             /* a bit beyond the last */
    EPCIO_BAD_GAIN,             /* P gain not 0 .. 65535 */
    EPCIO_BAD_SCALE,            /* scale of the position loop not 0 .. 15 */
    EPCIO_BAD_LIMIT,            /* limit of the error counter not 1 .. 32767 */
    EPCIO_BAD_TRIM,             /* DAC gain not 0.5 .. 1.5, offset not -1 .. 1 V */
    EPCIO_BAD_VOLTS,            /* a voltage is no number, or a trigger beyond +-10 V */
    EPCIO_BAD_PHASE,            /* an encoder phase is no number or beyond 2^50 lines */
    EPCIO_BAD_MODULE,           /* no such module to reset */
    EPCIO_BAD_REGISTER,         /* no register at that address */
    EPCIO_BAD_VALUE,            /* a register value that is no number, fractional or out of range */
    EPCIO_NOT_FREE,             /* single buffer: it holds a command already */
    EPCIO_COMMAND_WAITS,        /* single buffer: its command does not fit the shorter length */
    EPCIO_PULSE = 0x100,
    EPCIO_ENCODER = 0x200,
    EPCIO_ADC = 0x300,
    EPCIO_LOCAL_IO = 0x400,
    EPCIO_REMOTE_IO = 0x500,
    EPCIO_TIMER = 0x600,
    EPCIO_STATUS_LAST = 0x6ff   /* behind a block's number comes its own status */
};

/* Why the latest refused frame was refused. */
struct epcio_refusal {
    enum epcio_status status;
    int32_t axis;                   /* 0 .. 5 */
    int32_t command;                /* [pulses] */
};

/* What a status of the card itself, of no block, means, for messages. */
const char *card_status_text(enum epcio_status status);

#endif
