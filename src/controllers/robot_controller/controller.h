/* controller - a robot's motion controller that is all software on a PC, a soft controller: the
 * driver of an FPGA card that only plays pulses, and the user's program above it.
 *
 *     card's interrupt --wait--> [copy in | lines, points | copy out] mark      the driver's run
 *     t_k                                                             < t_k+1: or the pulses stop
 *
 * A run makes the pulses of the next memory: what interrupt k decides leaves the card from the
 * switch t_k+1 on. The PC reads the card on the bus grid k T_b, and what it works out from that
 * shows at (k+1) T_b with the clocks at which it reaches the card. So a run is known in time if two
 * T_b are no longer than the memory plays. Times are clocks of 25 ns.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "layers.h"
#include "orders.h"

enum {
    CONTROLLER_QUEUE = 64,
    CONTROLLER_OUTPUTS = 32,
    CONTROLLER_TAUGHT = 64,
    CONTROLLER_MOVES = 1024
};

struct controller_config {
    int64_t bus;   /* [clocks] T_b */
    int64_t slot;  /* [clocks] of the card */
    int32_t slots; /* of a memory, 1 .. FPGA_SLOTS */
    enum fpga_format format;
    struct layers_config layers;
    int64_t copy_in, copy_out; /* [clocks] of a run */
    int64_t line, point;       /* [clocks] of a line of the program, of a point's kinematics */
    double pitch;              /* [mm] between two points whose kinematics are computed */
    int32_t lines;             /* most of a run */
    bool user;                 /* the user program reads the lines at its polls, into a queue */
    int32_t depth;             /* lines of that queue, up to CONTROLLER_QUEUE */
    int64_t start;             /* [clock] the program starts at the first run from here on */
    double zero[OPW_JOINTS];   /* [rad] joints at clock 0 */
    uint32_t servo;            /* axes whose servo is on */
    int32_t seed;
    struct robot_config robot;
    struct orders_config orders;
};

/* The teach pendant, read on the bus grid; keys count when they go down, in the run that follows:
 * one that has no meaning then is forgotten. */
struct controller_panel {
    bool hold, abort, start, single, reset, teach, replay;
    double override; /* 0 .. 1 */
    double jog[6];   /* -1 .. 1 of each direction; all 0: none */
    enum robot_frame frame;
    double jog_speed, jog_way; /* share of the highest; [mm], [deg], 0 no end */
};

enum controller_status {
    CONTROLLER_IDLE,
    CONTROLLER_RUNNING,
    CONTROLLER_HOLD,
    CONTROLLER_WAITING,
    CONTROLLER_DELAY,
    CONTROLLER_PAUSED,
    CONTROLLER_JOG,
    CONTROLLER_ERROR,
    CONTROLLER_STOPPED
};

/* The program; from PROGRAM_RUNS on it is not over. */
enum controller_program {
    PROGRAM_NEW,     /* not started yet */
    PROGRAM_ENDED,   /* its last order is done */
    PROGRAM_DROPPED, /* it was given up */
    PROGRAM_RUNS,
    PROGRAM_DELAYS, /* until its time is over */
    PROGRAM_WAITS,  /* for an input, or a time of the job */
    PROGRAM_PAUSED  /* until the operator goes on */
};

/* Why the program was ended. */
enum controller_error {
    CONTROLLER_OK,
    CONTROLLER_MOVE,    /* a move is refused: status and refusal say why */
    CONTROLLER_PROGRAM, /* the program has stopped by a fault of its own: fault */
    CONTROLLER_LOST     /* out of reach on a path that was planned */
};

struct controller_trouble {
    enum controller_error error;
    int32_t line;
    enum robot_status status;
    struct robot_refusal refusal;
    enum robot_job_fault fault;
};

/* What the layers have taken so far; the driver's times in clocks. */
struct controller_report {
    int32_t runs, late;      /* of the driver; not done when their pulses were due */
    int64_t wait, wait_most; /* from interrupt to begin */
    int64_t run, run_most;   /* from interrupt to mark */
    int64_t spare;           /* from the mark to where its pulses are due */
    int64_t busy;            /* all runs */
    int32_t polls;
    int32_t lines, points;   /* in all */
    int32_t starved;         /* runs in which the queue was empty and the arm at rest */
    int64_t line, line_most; /* from the interrupt that executes moves to their first slot */
    int64_t told_most;       /* and from where the driver could have known the first */
};

struct controller_key {
    bool down, pressed;
};

struct controller_output {
    int64_t after;
    bool analog;
    uint32_t mask, value;
    int32_t index;
    double volt;
};

struct controller {
    struct robot robot;
    struct orders orders;
    struct layers layers;
    struct outbox outbox;
    struct controller_trouble trouble;
    struct controller_report report;

    /* the card */
    int32_t irq_seq, write_seq, memory; /* seen, written last */
    int64_t free;                       /* [clock] the driver has done its latest run */
    int64_t asked;             /* [clock] interrupt of the moves whose memory waits; -1 none */
    int64_t known;             /* [clock] the first of those; -1 none in the latest run */
    int32_t words[FPGA_WORDS]; /* of the latest write, */
    int64_t mark;              /* [clock] and when it is complete */
    double volt[FPGA_ANALOG];
    int32_t ao_seq;
    int32_t reset_seq;
    bool posts, posts_ao;      /* a new write, new analog outputs */
    bool stopped;              /* as the card was seen last */
    double joint[OPW_JOINTS];  /* [rad] at the end of all slots written */
    double origin[OPW_JOINTS]; /* [pulses] of the joints where the card's counters are 0 */

    /* the program */
    enum controller_program program;
    int32_t heads, count; /* queue of the user program */
    struct order queue[CONTROLLER_QUEUE];
    struct order next;                   /* taken, not yet done; ORDER_NONE: none */
    int64_t delay;                       /* [clocks] left */
    int64_t given, reached;              /* moves of the arm */
    int64_t first;                       /* of them before the program */
    int32_t move_line[CONTROLLER_MOVES]; /* line of move n at n mod CONTROLLER_MOVES */
    int32_t output_count;
    struct controller_output output[CONTROLLER_OUTPUTS];
    uint32_t out; /* digital outputs as programs have set them */

    /* the pendant */
    struct controller_key start, abort, reset, teach, replay;
    bool leave; /* single step: one move may begin */
    bool jogs;
    int32_t taught_count, replaying; /* points; the next one, -1 none */
    struct robot_target taught[CONTROLLER_TAUGHT];
};

/* At rest at clock 0. */
void controller_start(struct controller *s, const struct controller_config *c);

/* One instant of the bus grid, at clock now = k T_b, for k = 0, 1, 2, ... What it leads to is for
 * controller_post at the next one. */
void controller_instant(struct controller *s, const struct controller_config *c,
                        const struct orders_text *t, const struct fpga_shown *card,
                        const struct controller_panel *panel, int64_t now);

/* What the card is given. The mailboxes of *host keep what they had if there is nothing new. */
void controller_post(struct controller *s, const struct controller_config *c,
                     struct fpga_host *host);

enum controller_status controller_status(const struct controller *s,
                                         const struct controller_panel *panel);

/* A program has been started and is not over. */
bool controller_running(const struct controller *s);

/* The program is over and the arm at rest. */
bool controller_done(const struct controller *s);

/* Behind controller_start: try the moves of a part program one by one without time, each at rest at
 * its end, up to the first that is refused, which s->trouble then names. *s has to be started again
 * afterwards. A job cannot be rehearsed: its inputs decide what it does. */
void controller_rehearse(struct controller *s, const struct controller_config *c,
                         const struct orders_text *t);

#endif
