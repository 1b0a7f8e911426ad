/* net_codes - what both ends of the link call a command's result and the card's state. */
#ifndef NET_CODES_H
#define NET_CODES_H

/* Result of a command, reason of a refusal. */
enum net_code {
    NET_DONE,
    NET_UNKNOWN,
    NET_BUSY,
    NET_STATE, /* not in this state */
    NET_NO_JOB,
    NET_TOO_LONG,
    NET_RANGE,
    NET_BAD_JOB, /* CRC, hash or format */
    NET_FLASH,
    NET_NOT_HOMED,
    NET_ALARM,
    NET_LIMIT,
    NET_PAGE, /* without credit, or outside of the job */
    NET_CODES
};

enum net_state {
    NET_EMPTY,
    NET_READY,
    NET_RUNNING,
    NET_PAUSING,
    NET_PAUSED,
    NET_STOPPING,
    NET_HOMING,
    NET_FAULT,
    NET_STATES
};

#endif
