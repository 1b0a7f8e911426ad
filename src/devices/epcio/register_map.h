/* register_map - the card's registers by address, for a host that has only bus writes; registers.h
 * has the same as functions. The addresses are ours, because the chip's register map is not public.
 * Each register takes one value, an integer except where it is a voltage. */
#ifndef REGISTER_MAP_H
#define REGISTER_MAP_H

#include "epcio.h"

/* X(address of the first register, name, number of registers): meaning of the value. */
#define EPCIO_REGISTERS(X) \
    X(0x010, FIFO_ERASE, 6)         /* number of the newest commands to be taken back */ \
    X(0x018, FIFO_SHIFT_OUT, 6)     /* any value: shift the oldest command out */ \
    X(0x100, ENC_FORMAT, 9)         /* 0 A/B, 1 CW/CCW, 2 pulse/direction, 3 none */ \
    X(0x110, ENC_RATE, 9)           /* 0, 1, 2, 4 */ \
    X(0x120, ENC_WIRING, 9)         /* bits: 1 A, 2 B inverted, 4 swapped, 8 C inverted */ \
    X(0x130, ENC_FILTER, 9)         /* [clocks] */ \
    X(0x140, ENC_CLEAR, 9)          /* any value: counter to zero */ \
    X(0x150, ENC_COMPARE, 9)        /* [counts] */ \
    X(0x160, ENC_COMPARE_ON, 9)     /* 0, 1 */ \
    X(0x170, ENC_LATCH_LAST, 9)     /* 0 first trigger only, 1 every trigger */ \
    X(0x180, ENC_LATCH, 9)          /* source bits (latch.h); arms the latch */ \
    X(0x200, PCL_CLEAR, 7)          /* any value: error counter to zero */ \
    X(0x300, DAC_TRIGGER_VOLTS, 8)  /* [V] */ \
    X(0x310, DAC_TRIGGER, 8)        /* source bits (analog.h); arms; 0 gives the channel back */ \
    X(0x400, ADC_MODE, 1)           /* 0 single, 1 free run */ \
    X(0x401, ADC_CHANNEL, 1)        /* of single mode, 0 .. 7 */ \
    X(0x402, ADC_ENABLED, 1)        /* channel bits of free run */ \
    X(0x403, ADC_COMPARE_ON, 1)     /* channel bits */ \
    X(0x404, ADC_IGNORED_BITS, 1)   /* 0 .. 3 */ \
    X(0x405, ADC_TAGGED, 1)         /* channel bits */ \
    X(0x406, ADC_RUN, 1)            /* 1 starts, 0 stops */ \
    X(0x410, ADC_RANGE, 8)          /* 0 bipolar, 1 unipolar */ \
    X(0x420, ADC_COMPARE, 8)        /* 0 rising, 1 falling, 2 both */ \
    X(0x430, ADC_COMPARE_VOLTS, 8)  /* [V] */ \
    X(0x500, LIO_OUTPUTS, 1)        /* LDO bits */ \
    X(0x501, LIO_SERVO_ON, 1)       /* axis bits */ \
    X(0x502, LIO_POSITION_READY, 1) /* 0, 1 */ \
    X(0x503, LIO_STOP_ENABLE, 1)    /* 0, 1: the emergency stop input acts */ \
    X(0x504, LIO_GATE, 1)           /* 0, 1: outputs are let through */ \
    X(0x505, LIO_DEDICATED, 1)      /* bits of the dual-function inputs */ \
    X(0x510, LIO_LDI_EDGE, 8)       /* 0 rising, 1 falling, 2 both */ \
    X(0x520, LIO_DFI_EDGE, 7)       /* the same */ \
    X(0x540, TIMER_PERIOD, 1)       /* [clocks]; 0 off */ \
    X(0x541, WATCHDOG_RESET, 1)     /* [clocks] length of the reset */ \
    X(0x542, WATCHDOG_VALUE, 1)     /* [timer periods]; 0 off */ \
    X(0x543, WATCHDOG_REFRESH, 1)   /* any value */ \
    X(0x600, RIO_RETRY, 2)          /* retry limit of a set */ \
    X(0x602, RIO_ENABLED, 2)        /* slave bits of a set; 0 switches it off */ \
    X(0x610, RIO_EDGE, 24)          /* set, slave, input: 0 rising, 1 falling, 2 both */ \
    X(0x630, RIO_OUT, 24)           /* set, slave, port: 16 bits */ \
    X(0x700, MODULE_RESET, 1)       /* enum epcio_module */

enum epcio_register {
#define EPCIO_REGISTER(address, name, count) REG_##name = address,
    EPCIO_REGISTERS(EPCIO_REGISTER)
#undef EPCIO_REGISTER
};

/* Write a register of the map. EPCIO_BAD_REGISTER if there is none at that address, EPCIO_BAD_VALUE
 * if the value is not a number, fractional or too large, else the status of the block. */
enum epcio_status epcio_write(struct epcio *card, int32_t address, double value);

#endif
