/* The variables of the four FMUs of the fused loop, each under its own name, and functions. */
#ifndef PARTS_H
#define PARTS_H

#include <stdint.h>

#define vars mcc_vars
#include "mcc/vars.h"
#include "undefine.h"
#define vars epcio_vars
#include "epcio/vars.h"
#include "undefine.h"
#define vars servo_drives_vars
#include "servo_drives/vars.h"
#include "undefine.h"
#define vars ball_screw_axes_vars
#include "ball_screw_axes/vars.h"
#include "undefine.h"

/* See part.c. Times in ns. */
#define DECLARE(part) \
    void *part##_open(void); \
    void part##_start(void); \
    void part##_step(int64_t, int64_t); \
    void part##_end(void);
DECLARE(mcc)
DECLARE(epcio)
DECLARE(servo_drives)
DECLARE(ball_screw_axes)

#endif
