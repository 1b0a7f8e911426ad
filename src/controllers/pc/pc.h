/* pc - the computer on which the motion library runs: its four modules with their times on the
 * processor, the latency and jitter of interrupts, and the bus to card and panel.
 *
 * The PC meets the card and its panel on the bus grid k T_b. What it reads at instant k decides all
 * that happens before (k+2) T_b; it is published at (k+1) T_b, frames with the exact clock at which
 * they reach the card. A service due earlier than (k+1) T_b is late: it takes place at (k+1) T_b.
 *
 * The modules exchange data through the command ring and the point queue. A command, a point or a
 * transaction is handed over when its own time on the processor is over; so are the panel's wishes.
 * Each is made of what there is at that clock, but a transaction of the points there are when it
 * begins.
 */
#ifndef PC_H
#define PC_H

#include "card_view.h"
#include "cyclic.h"
#include "pcl.h"
#include "task.h"
#include "voltage.h"

enum pc_module {
    PC_INTERPRETER, /* part program to command ring; its unit is a command */
    PC_IPO,         /* command ring to point queue; its unit is a point */
    PC_PCL,         /* interrupts, point queue to card; unit: a frame; run: a page and its write */
    PC_PROCESS,     /* process control: program start, all of the panel; no unit */
    PC_MODULES
};

struct pc_config {
    int64_t bus;    /* [clocks] period T_b of the bus grid */
    int64_t ipo;    /* [clocks] cycle of the IPO task: see pc_ipo_cycle */
    bool ipo_event; /* the IPO also runs at once when a point can be made and none could before */
    int64_t interpreter, process; /* [clocks] their cycles; 0: they run in the IPO, on its time */
    int32_t priority[PC_MODULES]; /* the lowest number first */
    int64_t offset[PC_MODULES];   /* [clocks] start of the first cycle */
    int64_t time[PC_MODULES];     /* [clocks] processor time of a run, */
    int64_t unit[PC_MODULES];     /* [clocks] and of each unit in it */
    int32_t most[PC_MODULES];     /* most units of a run of interpreter or IPO; 0: no limit */
    int64_t start;                /* [clock] from which on the first cycle starts the program */
    double latency;               /* [clocks] least time from an interrupt to its service */
    double jitter;                /* [clocks] width of the uniform random addition to it */
    int32_t seed;                 /* of that random number */
    int32_t min_stock, batch;     /* [commands] n and N of pcl.h */
    struct isr_config isr;
    int32_t output_mode[AXES]; /* 0 pulses, 1 position loop of the card, 2 software voltage */
    struct law_config law;     /* control law of output mode 2; a gain of 0 takes the panel's;
                                * period, on and pulses_per_mm are filled in */
    bool block_delete, optional_stop; /* for task_set_switches, until there is a panel */
    struct home_config home[AXES];    /* how an axis is homed whose home_order is not 0 */
    int32_t home_order[AXES];         /* for MCC_go_home */
    bool home_first;                  /* home the axes before the program */
    double home_settle;               /* [s] for homing_set_settle */
    bool encoder_backward[AXES];      /* `inverted` of homing_set */
    bool dry_run;                     /* begin with a dry run */
    bool wait_start;                  /* the program begins with cycle_start only */
    bool no_panel; /* the panel's hold, single block, overrides and P gain do not act: calls set
                    * them */
};

/* The operator's panel, and what else is read on the bus grid. Homing starts when its key goes
 * down; jog and handwheel change when their values change. A wish that the library refuses is
 * forgotten. */
struct pc_panel {
    bool hold, abort, cycle_start, single_block, go_home, clear_error;
    bool block_delete, optional_stop;
    int32_t run_from;           /* line at which cycle_start begins the program; 0: the first */
    int32_t jog[AXES];          /* direction of a jog: -1, 0, +1 */
    double jog_step[AXES];      /* [mm] way of a jog; 0: until its direction is 0 */
    double jog_percent;         /* [%] of the safe motor speed */
    int32_t wheel_axis;         /* axis that follows the handwheel, from 1; 0: none */
    int32_t wheel_encoder;      /* encoder counter of the handwheel, from 1 */
    double wheel_ratio;         /* [pulses/count] */
    double override;            /* 0..2 */
    double rapid;               /* 0..1 share of it that rapids and axes by themselves get */
    double adaptive;            /* 0..1 share of the feed while a program lets it (M52) */
    double software_gain[AXES]; /* [V/count] gain of output mode 2 */
    int32_t p_gain[AXES];       /* gain of the card's position loops, for MCC_set_P_gain */
    struct signals signals;
};

/* State of the process control. */
struct pc_process {
    struct key abort, cycle_start, go_home, clear_error;
    int32_t jog[AXES], wheel_axis; /* the panel's values that were obeyed last */
    bool steps[AXES];              /* the latest jog of an axis was a step */
    bool started;                  /* the program has been started, or an abort has dropped it */
    bool anew;        /* an error has been cleared: cycle_start runs the program from its begin */
    int32_t refusals; /* how often cycle_start found the program not good to run, */
    struct fault_report refused; /* and why, the latest time */
};

/* The run of a module that is under way. */
struct pc_run {
    int32_t units; /* number of units begun in it */
    bool unit;     /* a unit is under way; of the PCL: a write */
};

struct pc {
    struct pc_config config;
    struct mcc mcc;
    struct pcl pcl;
    uint64_t random;
    struct cyclic modules;
    struct pc_run run[PC_MODULES];
    bool page;      /* the PCL has the rest of a page to serve after its write */
    bool point_due; /* a point could be made at the latest look of wake_ipo */
    bool program;   /* there is a part program */
    struct pc_process process;
    struct pc_panel panel; /* as the process control read it when its run began */
    int32_t loop_served;   /* services of the page ISR_LOOP_PAGE that have been looked at */
    struct voltage voltage;
    double volts[AXES];         /* [V] of the axes in output mode 2 */
    struct cyclic_report shown; /* times of the modules, as they were at (k+1) T_b */
    struct isr shown_isr;       /* order of service, likewise */
};

/* Start with everything at rest at clock 0. Returns MCC_NO_ERR or a code of the library. */
int pc_start(struct pc *pc, const struct machine *m, const struct pc_config *config, bool program);

/* One bus instant, at clock now = k T_b. Call it for k = 0, 1, 2, ... */
void pc_instant(struct pc *pc, int64_t now, const struct pcl_card *card,
                const struct pc_panel *panel, const struct source *program);

/* True if the program has ended without error and every point is in the card. */
bool pc_done(const struct pc *pc);

/* The document's rule for the cycle of the IPO: at least the time of a run that makes one point, at
 * most the DDA time. A longer cycle still works if the queue is deep enough, as a run makes points
 * until the queue is full; a shorter one misses deadlines. */
enum pc_cycle { PC_CYCLE_KEPT, PC_CYCLE_SHORT, PC_CYCLE_LONG };
enum pc_cycle pc_ipo_cycle(const struct pc *pc);

/* Write what the card is given to the link; the frames only if their transaction is new there. */
void pc_publish(const struct pc *pc, struct link_host *link);

#endif
