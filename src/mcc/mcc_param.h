/* mcc_param - the axes as the source document's library is told of them.
 *
 * The user fills epcio_axis_param[] and cart_max_speed, and MCC_update_param makes them effective.
 * Names and meaning are the document's; numbers of the types, and units not given here, are ours.
 */
#ifndef MCC_PARAM_H
#define MCC_PARAM_H

#include <stdint.h>

/* Kind of an axis. A rotary one has degrees for mm. A spindle takes no part in the motion, so it
 * gets no pulses, as an unused axis. */
enum mcc_axis_type { MCC_LINEAR, MCC_ROTARY, MCC_SPINDLE, MCC_UNUSED };

typedef struct {
    int32_t type;               /* enum mcc_axis_type */
    int32_t pos2encoder_dir;    /* 0: encoder counts up when the position grows; 1: down, and the
                                 * pulses of the card are inverted likewise */
    int32_t PPR;                /* pulses of the motor per turn that reach the position loop */
    double  RPM;                /* [rpm] highest safe motor speed */
    double  pitch;              /* [mm] lead of the screw */
    double  gear_ratio;         /* motor turns per screw turn */
    double  high_limit;         /* [mm] from the logical origin to the positive limit switch */
    double  low_limit;          /* [mm] to the negative one */
    double  HOT_offset;         /* [mm] software limit, positive end */
    double  LOT_offset;         /* [mm] negative end */
    int32_t sensor_on;          /* logic state of the home sensor when ON, 0 or 1 */
    int32_t index_on;           /* of the index; 1 at the start */
    int32_t home_dir;           /* bits 0, 1, 2: direction in phases 1, 2, 3; 0 positive,
                                 * 1 negative */
} MCC_MACH_PARAM;

#endif
