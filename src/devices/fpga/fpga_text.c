#include "fpga.h"

const char *fpga_status_text(enum fpga_status s)
{
    switch (s) {
    case FPGA_OK:         return "taken";
    case FPGA_BAD_MEMORY: return "there are pulse memories 0 and 1";
    case FPGA_NO_SLOTS:   return "a memory has 1 to 128 slots";
    case FPGA_BAD_SLOT:   return "a byte is not the pulses of a slot";
    case FPGA_NOT_FREE:   return "the memory is full and waits";
    case FPGA_PLAYS:      return "the memory plays";
    case FPGA_STOPPED:    return "a stop acts";
    case FPGA_ON_THE_WAY: return "too many are on their way";
    }
    return "unknown";
}
