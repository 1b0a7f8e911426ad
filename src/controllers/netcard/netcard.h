/* netcard - a motion card on a network, of four axes: six tasks on a kernel, a job file in flash,
 * an FPGA that plays its frames, inputs and outputs, and a link to the PC.
 *
 *     link --bytes--> parser --job pages--> storage --> flash          (storage alone reads it)
 *                       | semaphores                      |
 *       home stop pause run <-------- pages -------------'
 *                        '--- frames, 5 words each ---> FIFO --> player --> direction and pulses
 *
 * Time is a whole number of ns since power first came; the FPGA's clock is 20 ns. Every event has
 * its time, and netcard_advance goes from one event to the next. At one time the hardware comes
 * first (player, deaf times of inputs, ends of output pulses, timers of the link), then the
 * processor. Tasks, interrupts and their costs are those of src/base/tasks/kernel.h.
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

/* Semaphores: those of the tasks, then those within the card. */
enum netcard_semaphore {
    NETCARD_GIVE_BYTES,   /* to the parser: bytes, a command, a timer of the link */
    NETCARD_GIVE_STORAGE, /* a page is wanted, or there is something to write */
    NETCARD_GIVE_HOME,
    NETCARD_GIVE_STOP,
    NETCARD_GIVE_PAUSE,
    NETCARD_GIVE_RUN,
    NETCARD_GIVE_FLASH, /* the chip has ended what it did */
    NETCARD_GIVE_PAGE,  /* the page is there */
    NETCARD_GIVE_FIFO   /* room in the FIFO, or the job is at its end or to be given up */
};

/* Interrupts: vectors 0 .. 6 of the inputs, then these. */
enum netcard_interrupt {
    NETCARD_FPGA = CARD_VECTORS,
    NETCARD_NETWORK,
    NETCARD_FLASH,
    NETCARD_SOFTWARE,
    NETCARD_INTERRUPTS
};

/* Entry KERNEL_MARK in the log of the kernel: a step of the task in `value`. */
enum { NETCARD_STEP };

/* Most commands of netcard_command that wait for the parser. */
enum { NETCARD_ORDERS = 16 };

struct netcard_order {
    uint8_t command; /* enum card_command */
    uint8_t axes;    /* of HOME, a bit each */
};

struct netcard_result {
    int32_t count;             /* number of commands answered so far */
    enum card_command command; /* the latest of them */
    enum net_code code;        /* and its answer */
};

/* Levels at the terminals of the axes, a bit each. */
struct netcard_axes {
    uint32_t origin, plus, minus, alarm;
    bool stop; /* emergency stop */
};

/* A page on its way from the flash to the task that wants it. */
struct netcard_page {
    bool wanted, good; /* a task waits for it; it has been read */
    uint32_t number;   /* of the page in the job file */
    uint8_t bytes[FLASH_PAGE];
};

/* Where the run task is with its job:
 *
 *     NONE --> READING --> PLAYING --> DRAINING --> PLAYED --> NONE
 *                 '------------------------^
 *
 * The frames of the approach take the same course, then READING comes again. A stop, homing or a
 * fault leads to CUT or OVER from any phase; run gives the job up when it has the processor. */
enum card_job_phase {
    JOB_NONE,
    JOB_READING,  /* the first frames go into the FIFO */
    JOB_PLAYING,  /* the player has been let go, more frames follow */
    JOB_DRAINING, /* all frames are in the FIFO */
    JOB_PLAYED,   /* the player has played all frames */
    JOB_CUT,      /* to be given up, from PLAYING: the frames in stock still count */
    JOB_OVER      /* to be given up, from another phase */
};

/* The approach to where a job begins: the tool's axes Z, U first, then X and Y. */
enum card_approach { APPROACH_NONE, APPROACH_TOOL, APPROACH_PLANE, APPROACH_THERE };

/* Where the home task is, from its command to its end. The search itself is in `home`. */
enum card_homing {
    HOMING_NONE,
    HOMING_BEGINS, /* it has lowered its priority and waits until the axes rest */
    HOMING_GIVES,  /* it writes frames into the FIFO */
    HOMING_GIVEN,  /* all frames are in the FIFO */
    HOMING_PLAYED, /* the player has played all frames */
    HOMING_STOPPED /* literal policy: the task is to give up */
};

/* Literal policy: the pause task holds the processor, or is to end that. */
enum card_hold { HOLD_NONE, HOLD_HOLDS, HOLD_RELEASED };

/* A RESET in an alarm: the drives get their error clear; then the alarm is gone or the time of that
 * is over, and the parser is to answer. */
enum card_clear { CLEAR_NONE, CLEAR_GIVEN, CLEAR_OVER };

struct netcard_config {
    struct card_settings settings;
    uint8_t key[NET_SHA_BYTES]; /* key of the link; all 0: an open link without MAC */
};

struct netcard {
    struct card_settings settings; /* a part that read one at power-up keeps it until the next */
    bool power;
    int64_t now;  /* [ns] up to which everything has happened */
    int64_t boot; /* [ns] of the latest power-up, clock 0 of the kernel */
    struct kernel kernel;
    struct job_store store;
    struct player player;
    struct card_inputs inputs;
    struct card_outputs outputs;
    struct home_cycle home;
    struct session session;
    struct card_load load;    /* load of the processor, for the STATUS message */
    struct netcard_axes axes; /* levels at the terminals */
    uint32_t input_levels;    /* of the programmable inputs, a bit each */

    enum net_state state;
    enum net_state resumes;   /* what goes on after a pause: RUNNING or HOMING */
    enum net_code error;      /* why the state is FAULT; NET_DONE: it is not */
    uint32_t homed;           /* axes that are homed, a bit each */
    int64_t clear_until;      /* [ns] until which the drives get their error clear */
    enum card_clear clear;    /* state of a RESET, */
    uint32_t clear_number;    /* which is answered with this number */
    int64_t loading;          /* [ns] for which power-up reads the flash */
    int64_t zero[CARD_AXES];  /* [pulses] count at which the position is 0 */
    uint32_t latched;         /* axes whose origin the FPGA has latched, a bit each, */
    int64_t latch[CARD_AXES]; /* [pulses] and the count at that edge */

    int32_t step[(int)NETCARD_TASKS + (int)NETCARD_INTERRUPTS]; /* where each goes on */
    uint32_t gives[NETCARD_INTERRUPTS]; /* semaphores an interrupt has still to give, a bit each */
    struct player_told told;            /* what the FPGA tells at its interrupt */
    int64_t served[NETCARD_INTERRUPTS]; /* number of interrupts so far */

    enum card_job_phase phase; /* of the job of the run task */
    bool works;                /* outputs of the job may be on: its rest event is owed */
    enum card_approach approach;
    struct home_motion way[CARD_AXES]; /* motion of the approach */
    enum card_hold hold;
    enum card_homing homing;
    bool deferred;           /* storage waits until the FIFO is full */
    int32_t jobs;            /* number of jobs begun so far */
    uint32_t played_id;      /* id of the latest job */
    struct player_job plays; /* that job as the FPGA knows it */
    struct job_place place;  /* that job in the flash */
    struct job_reader reader;
    int64_t origin[CARD_AXES]; /* [pulses] position at which the job began */
    uint32_t home_axes;        /* axes of the latest HOME, a bit each */
    struct netcard_page page;
    uint16_t credit; /* [pages] that the PC was told last it may send */
    bool asked;      /* a JOB_BEGIN waits until it is known which pages are missing */

    struct netcard_order order[NETCARD_ORDERS]; /* ring of commands that wait for the parser */
    int32_t first, orders;                      /* the oldest of them; how many */
    struct netcard_result result;
    int32_t least;   /* [frames] smallest stock while a job played that was not all read */
    int32_t dropped; /* number of semaphores taken that had no use in the state */

    struct flash_chip flash; /* last, as it is large and clears itself */
};

/* Power on, with the flash erased or with a job in slot 0. The settings must be good. Returns
 * NET_DONE, or why the job was not taken, and then there is none: NET_TOO_LONG, NET_BAD_JOB (see
 * store.fault). */
enum net_code netcard_start(struct netcard *c, const struct netcard_config *config,
                            const uint8_t *job, uint32_t bytes);

/* Let all happen up to and including this time [ns], which is not before c->now. */
void netcard_advance(struct netcard *c, int64_t until);

/* Set the levels at the inputs, or at the terminals of the axes, from now on. */
void netcard_set_inputs(struct netcard *c, uint32_t levels);
void netcard_set_axes(struct netcard *c, const struct netcard_axes *axes);

/* Power goes: an operation of the flash is broken off, and all else loses its state but settings
 * and pulse counts. Power comes: the card starts. */
void netcard_set_power(struct netcard *c, bool on);

/* Give a command without the link, as if it had come to the parser; `axes` is that of HOME. False:
 * too many commands wait. */
bool netcard_command(struct netcard *c, enum card_command command, uint8_t axes);

/* The link. netcard_receive takes bytes of the connection and returns how many; netcard_send moves
 * out at most so many bytes to be sent and returns how many. netcard_connected says whether the
 * connection stands or is cut, netcard_wants_connection whether the card wants one. */
size_t netcard_receive(struct netcard *c, const uint8_t *bytes, size_t n);
size_t netcard_send(struct netcard *c, uint8_t *bytes, size_t most);
void netcard_connected(struct netcard *c, bool yes);
bool netcard_wants_connection(const struct netcard *c);

/* Position of an axis at c->now [pulses]. */
int64_t netcard_position(const struct netcard *c, int axis);

/* Number of frames of the job that the player has begun so far. */
int64_t netcard_frames(const struct netcard *c);

#endif
