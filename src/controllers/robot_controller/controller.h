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
    CONTROLLER_MOVES = 512 /* more than the arm knows (ARM_MOVES_SIZE) */
};

struct controller_config {
    int64_t bus;   /* [clocks] T_b */
    int64_t slot;  /* [clocks] of the card */
    int32_t slots; /* of a memory, 1 .. FPGA_SLOTS */
    enum fpga_format format;
    struct layers_config layers;
    int64_t copy_in, copy_out; /* [clocks] of a run of the driver */
    int64_t line, point;       /* [clocks] that a line of the program, a point's kinematics take */
    double pitch;              /* [mm] between two points whose kinematics are computed */
    int32_t lines;             /* most lines of the program that a run carries out */
    bool user;                 /* the user program reads lines into a queue at its polls */
    int32_t depth;             /* room of that queue in lines, up to CONTROLLER_QUEUE */
    int64_t start;             /* [clock] the program starts at the first run from here on */
    double zero[OPW_JOINTS];   /* [rad] joints at clock 0 */
    double zero_external;      /* [m] [rad] the external axis there */
    uint32_t servo;            /* axes whose servo is on */
    int32_t seed;
    struct robot_config robot;
    struct orders_config orders;
};

/* The teach pendant, read on the bus grid. A key counts when it goes down, in the driver's next
 * run; one that has no meaning then is forgotten. */
struct controller_panel {
    bool hold, abort, start, single, reset, teach, replay;
    double override; /* 0 .. 1 */
    double jog[6];   /* -1 .. 1 for each direction; all 0: no jog */
    enum robot_frame frame;
    double jog_speed; /* 0..1 share of the highest speed */
    double jog_way;   /* [mm] or [deg] length of an increment; 0: no end */
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

/* Where the program is; from PROGRAM_RUNS on it is not over. */
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
    int32_t job; /* number of the job that has it */
    enum robot_status status;
    struct robot_refusal refusal;
    enum robot_job_fault fault;
};

/* Times that the layers have needed so far. Those of the driver are in clocks. */
struct controller_report {
    int32_t runs, late;      /* runs of the driver; of these, not done when their pulses were due */
    int64_t wait, wait_most; /* from the interrupt to the begin of a run: latest, longest */
    int64_t run, run_most;   /* from the interrupt to the mark: latest, longest */
    int64_t spare;           /* from the latest mark to where its pulses are due */
    int64_t busy;            /* sum over all runs */
    int32_t polls;
    int32_t lines, points;   /* carried out, computed */
    int32_t starved;         /* runs in which the queue was empty and the arm at rest */
    int64_t line, line_most; /* from the interrupt that executes moves to their first slot */
    int64_t told_most;       /* longest from where the driver could have known the first move */
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
    int64_t pulse; /* [clocks] after which the outputs go off; 0: they stay */
};

struct controller {
    struct robot robot;
    struct orders orders;
    struct layers layers;
    struct outbox outbox;
    struct controller_trouble trouble;
    struct controller_report report;

    /* the card */
    int32_t irq_seq, write_seq, memory; /* seen last; number and memory written last */
    int64_t free;                       /* [clock] end of the driver's latest run */
    int64_t asked; /* [clock] interrupt that executed moves not played yet; -1: none */
    int64_t known; /* [clock] when the first of them could be known; -1: none in that run */
    int32_t words[FPGA_WORDS]; /* latest write to the card */
    int64_t mark;              /* [clock] at which that write is complete */
    double volt[FPGA_ANALOG];
    int32_t ao_seq;
    int32_t reset_seq;
    bool posts, posts_ao;      /* there is a new write, there are new analog outputs */
    bool stopped;              /* as the card was seen last */
    double joint[OPW_JOINTS];  /* [rad] at the end of all slots written */
    double origin[OPW_JOINTS]; /* [pulses] of the joints where the card's counters are 0 */
    double external;           /* [m] [rad] the external axis at the end of all slots written */
    double external_origin;    /* [pulses] of it where the card's counter is 0 */

    /* the program */
    enum controller_program program;
    int32_t heads, count; /* queue of the user program */
    struct order queue[CONTROLLER_QUEUE];
    struct order next;      /* order taken, not yet done; ORDER_NONE: none */
    int64_t delay;          /* [clocks] left of a delay */
    int64_t given, reached; /* moves given to the arm; moves that have reached their points */
    int64_t first;          /* number of moves given before the program began */
    int64_t until_move;     /* number of the move that an input ends; 0: none does */
    int32_t until;          /* that input, 1 or more */
    bool until_on;
    int32_t move_line[CONTROLLER_MOVES]; /* line of move n at n mod CONTROLLER_MOVES */
    float move_feed[CONTROLLER_MOVES];   /* [mm/s] its feed as asked for; 0 of joints */
    int32_t output_count;
    struct controller_output output[CONTROLLER_OUTPUTS];
    uint32_t out;                         /* digital outputs as programs have set them */
    uint32_t pulsed;                      /* those that are on for a time */
    int64_t pulse_end[ROBOT_JOB_SIGNALS]; /* [clock] when they go off */

    /* the pendant */
    struct controller_key start, abort, reset, teach, replay;
    bool leave; /* single step: one move may begin */
    bool jogs;
    int32_t taught_count, replaying; /* taught points; the next one that replay goes to, -1: none */
    struct robot_target taught[CONTROLLER_TAUGHT];
};

/* At rest at clock 0. */
void controller_start(struct controller *s, const struct controller_config *c);

/* One instant of the bus grid, at clock now = k T_b, for k = 0, 1, 2, ... What it leads to is
 * posted by controller_post at the next instant. */
void controller_instant(struct controller *s, const struct controller_config *c,
                        const struct orders_text *t, const struct fpga_shown *card,
                        const struct controller_panel *panel, int64_t now);

/* Post to the card what is new; mailboxes of *host without news keep what they had. */
void controller_post(struct controller *s, const struct controller_config *c,
                     struct fpga_host *host);

enum controller_status controller_status(const struct controller *s,
                                         const struct controller_panel *panel);

/* What keeps the program from being faster, and its feed [mm/s]; by 0 while none runs. */
struct limited controller_limited(struct controller *s, const struct controller_config *c,
                                  const struct controller_panel *panel);

/* Whether a program has been started and is not over. */
bool controller_running(const struct controller *s);

/* Whether the program is over and the arm at rest. */
bool controller_done(const struct controller *s);

/* Whether the program was given up for an error and the arm is at rest. */
bool controller_failed(const struct controller *s);

/* Behind controller_start: try the moves of a part program one by one without time, each at rest at
 * its end, up to the first that is refused, which s->trouble then names. *s has to be started again
 * afterwards. A job cannot be rehearsed: its inputs decide what it does. */
void controller_rehearse(struct controller *s, const struct controller_config *c,
                         const struct orders_text *t);

#endif
