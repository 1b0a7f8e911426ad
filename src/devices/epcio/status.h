/* status - statuses that the functions of the card return, why a call is refused, with a text for
 * each. */
#ifndef STATUS_H
#define STATUS_H

#include <stdint.h>

/* Each status of the card itself with its text. */
#define EPCIO_STATUS_TEXTS(X) \
    X(EPCIO_OK, "ok") \
    X(EPCIO_FIFO_FULL, "the FIFO holds 63 commands already") \
    X(EPCIO_FIFO_EMPTY, "the FIFO is empty") \
    /* |command| > 2^length - 1 */ \
    X(EPCIO_COMMAND_TOO_LARGE, "the command is larger than the DDA length allows") \
    X(EPCIO_AXIS_UNUSED, "the axis is not active") \
    X(EPCIO_DROPPED, "an emergency stop caught the frame on its way") \
    X(EPCIO_STOPPED, "the emergency stop is pressed or the watchdog has expired") \
    X(EPCIO_BAD_LENGTH, "the DDA length is 10 to 15 bit") \
    X(EPCIO_BAD_DIVIDER, "the DDA divider is 1 to 65535") \
    X(EPCIO_BAD_MINIMUM, "the minimum stock is 0 to 62") \
    X(EPCIO_BAD_COUNT, "a count is not negative, and a transaction has 16 frames at most") \
    X(EPCIO_STOCK_TOO_LARGE, "a command in the FIFO is too large for the shorter DDA length") \
    X(EPCIO_BUS_FULL, "eight transactions are on their way to the card already") \
    X(EPCIO_BAD_AXIS, "there is no such axis, encoder, channel or set") \
    X(EPCIO_BAD_MASK, "a mask has a bit beyond the last") \
    X(EPCIO_BAD_GAIN, "the P gain is 0 to 65535") \
    X(EPCIO_BAD_SCALE, "the scale of the position loop is 0 to 15") \
    X(EPCIO_BAD_LIMIT, "the limit of the error counter is 1 to 32767") \
    X(EPCIO_BAD_TRIM, "the gain of a DAC is 0.5 to 1.5, its offset -1 to 1 V") \
    X(EPCIO_BAD_VOLTS, "a voltage is a number, of a DAC trigger within +-10 V") \
    X(EPCIO_BAD_PHASE, "the phase is no number or beyond 2^50 line periods") \
    X(EPCIO_BAD_MODULE, "the modules to reset are 1 to 10") \
    X(EPCIO_BAD_REGISTER, "there is no register at this address") \
    X(EPCIO_BAD_VALUE, "the value is no number, fractional or out of range") \
    /* single buffer: it holds a command already */ \
    X(EPCIO_NOT_FREE, "the buffer holds a command already") \
    /* single buffer: its command does not fit the shorter length */ \
    X(EPCIO_COMMAND_WAITS, "the waiting command is too large for the shorter DDA length")

#define EPCIO_STATUS_ENTRY(name, text) name,

/* A status of one of the card's blocks is the block's own enum added to its base, for example
 * EPCIO_ENCODER + ENCODER_BAD_RATE. */
enum epcio_status {
    EPCIO_STATUS_TEXTS(EPCIO_STATUS_ENTRY) EPCIO_STATUS_COUNT,
    EPCIO_PULSE = 0x100,
    EPCIO_ENCODER = 0x200,
    EPCIO_ADC = 0x300,
    EPCIO_LOCAL_IO = 0x400,
    EPCIO_REMOTE_IO = 0x500,
    EPCIO_TIMER = 0x600,
    EPCIO_STATUS_LAST = 0x6ff /* largest value, so that the enum holds every sum */
};

/* The latest frame that was refused: why, and which command of it. */
struct epcio_refusal {
    enum epcio_status status;
    int32_t axis;    /* 0 .. 5 */
    int32_t command; /* [pulses] */
};

/* Text for a status of the card itself, for messages; "unknown status" for one of a block. */
const char *card_status_text(enum epcio_status status);

#endif
