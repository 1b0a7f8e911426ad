#include "status.h"

#include "bus.h"

const char *card_status_text(enum epcio_status status)
{
    switch ((int)status) {
    case EPCIO_OK:
        return "ok";
    case EPCIO_FIFO_FULL:
        return "the FIFO holds 63 commands already";
    case EPCIO_FIFO_EMPTY:
        return "the FIFO is empty";
    case EPCIO_COMMAND_TOO_LARGE:
        return "the command is larger than the DDA length allows";
    case EPCIO_AXIS_UNUSED:
        return "the axis is not active";
    case EPCIO_DROPPED:
        return "an emergency stop caught the frame on its way";
    case EPCIO_STOPPED:
        return "the emergency stop is pressed or the watchdog has expired";
    case EPCIO_BAD_LENGTH:
        return "the DDA length is 10 to 15 bit";
    case EPCIO_BAD_DIVIDER:
        return "the DDA divider is 1 to 65535";
    case EPCIO_BAD_MINIMUM:
        return "the minimum stock is 0 to 62";
    case EPCIO_BAD_COUNT:
        return "a count is not negative, and a transaction has 16 frames at most";
    case EPCIO_STOCK_TOO_LARGE:
        return "a command in the FIFO is too large for the shorter DDA length";
    case EPCIO_BUS_FULL:
        return "eight transactions are on their way to the card already";
    case EPCIO_BAD_AXIS:
        return "there is no such axis, encoder, channel or set";
    case EPCIO_BAD_MASK:
        return "a mask has a bit beyond the last";
    case EPCIO_BAD_GAIN:
        return "the P gain is 0 to 65535";
    case EPCIO_BAD_SCALE:
        return "the scale of the position loop is 0 to 15";
    case EPCIO_BAD_LIMIT:
        return "the limit of the error counter is 1 to 32767";
    case EPCIO_BAD_TRIM:
        return "the gain of a DAC is 0.5 to 1.5, its offset -1 to 1 V";
    case EPCIO_BAD_VOLTS:
        return "a voltage is a number, of a DAC trigger within +-10 V";
    case EPCIO_BAD_PHASE:
        return "the phase is no number or beyond 2^50 line periods";
    case EPCIO_BAD_MODULE:
        return "the modules to reset are 1 to 10";
    case EPCIO_BAD_REGISTER:
        return "there is no register at this address";
    case EPCIO_BAD_VALUE:
        return "the value is no number, fractional or out of range";
    case EPCIO_NOT_FREE:
        return "the buffer holds a command already";
    case EPCIO_COMMAND_WAITS:
        return "the waiting command is too large for the shorter DDA length";
    default:
        return "unknown status";
    }
}

_Static_assert(BUS_FRAMES == 16 && BUS_DEPTH == 8, "the texts name these numbers");
