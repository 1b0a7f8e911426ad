/* net_codes - numbers that both ends of the network link use for the result of a command and for
 * the state of a card. */
#ifndef NET_CODES_H
#define NET_CODES_H

/* Result of a command, or reason of a refusal. */
enum net_code {
    NET_DONE,      /* done */
    NET_UNKNOWN,   /* unknown message */
    NET_BUSY,      /* the card is busy: ask again later */
    NET_STATE,     /* not allowed in the card's state */
    NET_NO_JOB,    /* no job is stored */
    NET_TOO_LONG,  /* the job does not fit into the flash */
    NET_RANGE,     /* a value is out of range */
    NET_BAD_JOB,   /* the job's CRC, hash or format is wrong */
    NET_FLASH,     /* the flash failed */
    NET_NOT_HOMED, /* an axis is not homed, or homing failed */
    NET_ALARM,     /* a drive has an alarm, or the emergency stop acts */
    NET_LIMIT,     /* a limit switch or a soft limit */
    NET_PAGE,      /* a page without credit, or outside of the job */
    NET_CODES
};

enum net_state {
    NET_EMPTY,    /* no job is stored */
    NET_READY,    /* a job is stored and can be started */
    NET_RUNNING,  /* the job runs */
    NET_PAUSING,  /* the rate ramps to 0 for a pause */
    NET_PAUSED,   /* at rest within the job */
    NET_STOPPING, /* the motion is brought to rest, which ends it */
    NET_HOMING,   /* axes are homed */
    NET_FAULT,    /* a fault; RESET ends it */
    NET_STATES
};

#endif
