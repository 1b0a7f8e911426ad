/* netcard - a motion card on a network: six tasks on a kernel, a job in flash, an FPGA that plays
 * it, inputs and outputs, a link to the PC.
 *
 *     link --bytes--> parser --job pages--> storage --> flash          (storage alone reads it)
 *                       | semaphores                      |
 *       home stop pause run <-------- pages -------------'
 *                        '--- frames, 5 words each ---> FIFO --> player --> direction and pulses
 *
 * Time is ns since power came first, a whole number; the FPGA's clock is 20 ns of it. All that
 * happens has its clock: netcard_advance goes from one to the next. At one clock the hardware comes
 * first (player, deaf times of inputs, ends of output pulses, timers of the link), then the
 * processor. Tasks, interrupts and what they cost are those of src/base/tasks/kernel.h.
 */
#ifndef NETCARD_H
#define NETCARD_H

#include "card_inputs.h"
#include "card_load.h"
#include "card_outputs.h"
#include "card_settings.h"
#include "card_state.h"
#include "flash_chip.h"
#include "home_cycle.h"
#include "home_motion.h"
#include "job_reader.h"
#include "job_store.h"
#include "kernel.h"
#include "player.h"
#include "session.h"

/* Tasks, in the order of the status message's loads. */
enum netcard_task {
    NETCARD_PARSER,
    NETCARD_STORAGE,
    NETCARD_HOME,
    NETCARD_STOP,
    NETCARD_PAUSE,
    NETCARD_RUN,
    NETCARD_TASKS
};

/* Semaphores: the first five a command each, the others within the card. */
enum netcard_semaphore {
    NETCARD_GIVE_BYTES,   /* to the parser: bytes, a command, a timer of the link */
    NETCARD_GIVE_STORAGE, /* a page is wanted, or there is something to write */
    NETCARD_GIVE_HOME,
    NETCARD_GIVE_STOP,
    NETCARD_GIVE_PAUSE,
    NETCARD_GIVE_RUN,
    NETCARD_GIVE_FLASH, /* the chip has ended what it did */
    NETCARD_GIVE_PAGE,  /* the page is there */
    NETCARD_GIVE_FIFO   /* room in the FIFO, the job's end, or it is given up */
};

/* Interrupts: inputs 0 .. 6 by their vector, then these. */
enum netcard_interrupt {
    NETCARD_FPGA = CARD_VECTORS,
    NETCARD_NETWORK,
    NETCARD_FLASH,
    NETCARD_SOFTWARE,
    NETCARD_INTERRUPTS
};

/* What the log of the kernel has as KERNEL_MARK, of the task in `value`: a step of it. */
enum { NETCARD_STEP };

/* Commands without a link wait here. */
enum { NETCARD_ORDERS = 16 };

struct netcard_order {
    uint8_t command;
    uint8_t axes;
};

struct netcard_result {
    int32_t count;             /* commands answered so far */
    enum card_command command; /* the latest */
    enum net_code code;
};

/* Levels at the terminals of the axes, a bit each. */
struct netcard_axes {
    uint32_t origin, plus, minus, alarm;
    bool stop; /* emergency stop */
};

/* A page on its way from flash to the one who asked. */
struct netcard_page {
    bool wanted, good;
    uint32_t number; /* of the job's file */
    uint8_t bytes[FLASH_PAGE];
};

/* The job of the run task, from its start to where run has left it:
 *
 *     NONE --> READING --> PLAYING --> DRAINING --> PLAYED --> NONE
 *                 '------------------------^
 *
 * The same for the frames of the approach, then READING again. A stop, homing or a fault leads to
 * CUT or OVER from anywhere; run gives the job up when it has the processor. */
enum card_job_phase {
    JOB_NONE,
    JOB_READING,  /* the first frames go into the FIFO */
    JOB_PLAYING,  /* the player has been let go, more frames follow */
    JOB_DRAINING, /* all are in the FIFO */
    JOB_PLAYED,   /* and out of it */
    JOB_CUT,      /* to be given up, from PLAYING: what is in stock still counts */
    JOB_OVER      /* to be given up, from another phase */
};

/* The way to where a job begins: the tool's axes first, then X and Y. */
enum card_approach { APPROACH_NONE, APPROACH_TOOL, APPROACH_PLANE, APPROACH_THERE };

/* The home task, from the command to its end. What the axes search is in `home`. */
enum card_homing {
    HOMING_NONE,
    HOMING_BEGINS, /* it has lowered its priority and waits for rest */
    HOMING_GIVES,  /* frames */
    HOMING_GIVEN,  /* all are in the FIFO */
    HOMING_PLAYED, /* and out of it */
    HOMING_STOPPED /* literal: it is to give up */
};

/* Literal: pause has the processor; it is to end. */
enum card_hold { HOLD_NONE, HOLD_HOLDS, HOLD_RELEASED };

/* A RESET in an alarm: the drives have their error clear; it has helped, or its time is over, and
 * the parser is to answer. */
enum card_clear { CLEAR_NONE, CLEAR_GIVEN, CLEAR_OVER };

struct netcard_config {
    struct card_settings settings;
    uint8_t key[NET_SHA_BYTES]; /* of the link; 0: open */
};

struct netcard {
    struct card_settings settings; /* what a part took at power-up acts from the next one on */
    bool power;
    int64_t now;  /* [ns] all up to here is done */
    int64_t boot; /* [ns] clock 0 of the kernel */
    struct kernel kernel;
    struct job_store store;
    struct player player;
    struct card_inputs inputs;
    struct card_outputs outputs;
    struct home_cycle home;
    struct session session;
    struct card_load load;    /* of the processor, as told */
    struct netcard_axes axes; /* levels */
    uint32_t input_levels;

    enum net_state state;
    enum net_state resumes;   /* what goes on behind a pause: RUNNING or HOMING */
    enum net_code error;      /* why FAULT; NET_DONE none */
    uint32_t homed;           /* axes */
    int64_t clear_until;      /* [ns] the drives' error clear is given */
    enum card_clear clear;    /* of a RESET, */
    uint32_t clear_number;    /* answered with this number */
    int64_t loading;          /* [ns] that power-up reads the flash */
    int64_t zero[CARD_AXES];  /* [pulses] count at which the position is 0 */
    uint32_t latched;         /* origins that a latch of the FPGA has seen, */
    int64_t latch[CARD_AXES]; /* [pulses] and where */

    int32_t step[(int)NETCARD_TASKS + (int)NETCARD_INTERRUPTS];
    uint32_t gives[NETCARD_INTERRUPTS]; /* semaphores an interrupt has still to give, a bit each */
    struct player_told told;            /* by the FPGA, for its interrupt */
    int64_t served[NETCARD_INTERRUPTS]; /* interrupts so far */

    enum card_job_phase phase; /* of the job of run */
    bool works;                /* its outputs may be on: its rest event is owed */
    enum card_approach approach;
    struct home_motion way[CARD_AXES]; /* of it, so far */
    enum card_hold hold;
    enum card_homing homing;
    bool deferred;           /* storage waits for a full FIFO */
    int32_t jobs;            /* begun so far */
    uint32_t played_id;      /* of the latest */
    struct player_job plays; /* as the FPGA knows it */
    struct job_place place;  /* of that job */
    struct job_reader reader;
    int64_t origin[CARD_AXES]; /* [pulses] position at which it began */
    uint32_t home_axes;        /* of the latest HOME */
    struct netcard_page page;
    uint16_t credit; /* [pages] as told last */
    bool asked;      /* a JOB_BEGIN waits for what is missing */

    struct netcard_order order[NETCARD_ORDERS];
    int32_t first, orders;
    struct netcard_result result;
    int32_t least;   /* [frames] smallest stock while a job played, not all read */
    int32_t dropped; /* semaphores taken that the state did not want */

    struct flash_chip flash; /* the last: it clears itself */
};

/* Power on, flash erased or with a job in slot 0. The settings must be good. NET_DONE, or why the
 * job was not taken: NET_TOO_LONG, NET_BAD_JOB (store.fault); then there is none. */
enum net_code netcard_start(struct netcard *c, const struct netcard_config *config,
                            const uint8_t *job, uint32_t bytes);

/* All events up to and including this time [ns], not before c->now. */
void netcard_advance(struct netcard *c, int64_t until);

/* Levels from now on. */
void netcard_set_inputs(struct netcard *c, uint32_t levels);
void netcard_set_axes(struct netcard *c, const struct netcard_axes *axes);

/* Power goes: the flash loses what is under way, all else its state but settings and the counts of
 * pulses. It comes: the card starts. */
void netcard_set_power(struct netcard *c, bool on);

/* A command without a link, as if the parser got it. False: too many wait. `axes`: of HOME. */
bool netcard_command(struct netcard *c, enum card_command command, uint8_t axes);

/* The link: bytes of the connection, returns how many are taken; bytes to send, taken out; the
 * connection stands or is cut; whether the card wants one. */
size_t netcard_receive(struct netcard *c, const uint8_t *bytes, size_t n);
size_t netcard_send(struct netcard *c, uint8_t *bytes, size_t most);
void netcard_connected(struct netcard *c, bool yes);
bool netcard_wants_connection(const struct netcard *c);

/* Position of an axis at c->now [pulses]. */
int64_t netcard_position(const struct netcard *c, int axis);

/* Frames of the job begun so far. */
int64_t netcard_frames(const struct netcard *c);

#endif
