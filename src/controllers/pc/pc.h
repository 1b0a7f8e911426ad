/* pc - the computer the library runs on: its four modules, interrupt latency and jitter, bus.
 *
 * The PC meets the card and its panel on the bus grid k T_b. What it reads at instant k decides all
 * that happens before (k+2) T_b; it is published at (k+1) T_b, frames with the exact clock at which
 * they reach the card. A service due earlier than (k+1) T_b is late: it takes place at (k+1) T_b.
 *
 * The modules exchange data through the command ring and the point queue. A command, a point, a
 * transaction, what the panel asks for: each is handed over when its own time of the processor is
 * over, and is made of what there is then. A transaction takes the points there are when it begins.
 */
#ifndef PC_H
#define PC_H

#include "card_view.h"
#include "cyclic.h"
#include "pcl.h"
#include "task.h"
#include "voltage.h"

enum pc_module {
    PC_INTERPRETER, /* program to command ring; unit: a command */
    PC_IPO,         /* command ring to point queue; unit: a point */
    PC_PCL,         /* interrupts, point queue to card; unit: a frame; a run: a page, a write */
    PC_PROCESS,     /* program start, all of the panel; no unit */
    PC_MODULES
};

struct pc_config {
    int64_t bus;    /* [clocks] T_b */
    int64_t ipo;    /* [clocks] cycle of the IPO task: see pc_ipo_cycle */
    bool ipo_event; /* it runs at once too when there is a point to make and was none */
    int64_t interpreter, process; /* [clocks] their cycles; 0: within the IPO, on its time */
    int32_t priority[PC_MODULES]; /* the lowest number first */
    int64_t offset[PC_MODULES];   /* [clocks] of the first cycle */
    int64_t time[PC_MODULES];     /* [clocks] of a run, */
    int64_t unit[PC_MODULES];     /* [clocks] and for each unit more */
    int32_t most[PC_MODULES];     /* units of a run of interpreter or IPO; 0: no limit */
    int64_t start;                /* [clocks] the program starts at the first cycle from here on */
    double latency;               /* [clocks] from interrupt to write */
    double jitter;                /* [clocks] width of the uniform random addition */
    int32_t seed;
    int32_t min_stock, batch;
    struct isr_config isr;
    int32_t output_mode[AXES]; /* 0 pulses, 1 position loop of the card, 2 software voltage */
    struct law_config law;     /* of output mode 2; gain 0: the panel's, filled in: period, on,
                                * pulses_per_mm */
    bool block_delete, optional_stop; /* as of task_set_switches */
    struct home_config home[AXES];    /* not valid: the axis is not homed */
    int32_t home_order[AXES];         /* as of MCC_go_home */
    bool home_first;                  /* home before the program */
    double home_settle;               /* [s] as of homing_set_settle */
    bool encoder_backward[AXES];      /* as of homing_set */
    bool dry_run;                     /* from the start on */
    bool no_panel; /* hold, override and P gain are calls of the API, not the panel's */
};

/* The operator's panel and what else is read on the bus grid. Homing starts at a rising edge, jog
 * and hand wheel change when their values do; what is refused is forgotten. */
struct pc_panel {
    bool hold, abort, cycle_start, single_block, go_home, clear_error;
    int32_t jog[AXES]; /* direction: -1, 0, +1 */
    double jog_percent;
    int32_t wheel_axis;         /* that follows the hand wheel, from 1; 0 none */
    int32_t wheel_encoder;      /* from 1 */
    double wheel_ratio;         /* [pulses/count] */
    double override;            /* 0..2 */
    double adaptive;            /* 0..1 share of the feed while a program lets it (M52) */
    double software_gain[AXES]; /* [V/count] of output mode 2 */
    int32_t p_gain[AXES];
    struct signals signals;
};

/* The process control. */
struct pc_process {
    struct key abort, cycle_start, go_home, clear_error;
    int32_t jog[AXES], wheel_axis; /* obeyed last */
    bool started;                  /* the program has been, or was dropped by an abort */
    bool anew; /* an error has been cleared: cycle_start runs it from its begin */
};

/* A run of a module. */
struct pc_run {
    int32_t units; /* that it has begun */
    bool unit;     /* the latest is under way; of the PCL: a write */
};

struct pc {
    struct pc_config config;
    struct mcc mcc;
    struct pcl pcl;
    uint64_t random;
    struct cyclic modules;
    struct pc_run run[PC_MODULES];
    bool page;      /* the PCL has the rest of a page to serve */
    bool point_due; /* there was a point to make when it was last looked */
    bool program;   /* there is one */
    struct pc_process process;
    struct pc_panel panel; /* as a run of the process control read it when it began */
    int32_t loop_served;   /* services of the position loops' page seen */
    struct voltage voltage;
    double volts[AXES];         /* [V] software control law */
    struct cyclic_report shown; /* what was so at (k+1) T_b */
    struct isr shown_isr;
};

/* Everything at rest at clock 0. Returns a library code. */
int pc_start(struct pc *pc, const struct machine *m, const struct pc_config *config, bool program);

/* One bus instant, at clock now = k T_b; call for k = 0, 1, 2, ... */
void pc_instant(struct pc *pc, int64_t now, const struct pcl_card *card,
                const struct pc_panel *panel, const struct source *program);

/* The program has ended without error and every point is in the card. */
bool pc_done(const struct pc *pc);

/* The document's rule for the cycle of the IPO: at least the time of a run that makes one point, at
 * most the DDA time. A longer one still works while the queue is deep enough, as all points there
 * is room for are made in a run; a shorter one misses deadlines. */
enum pc_cycle { PC_CYCLE_KEPT, PC_CYCLE_SHORT, PC_CYCLE_LONG };
enum pc_cycle pc_ipo_cycle(const struct pc *pc);

/* What the card is given, on the link; frames if they are new there. */
void pc_publish(const struct pc *pc, struct link_host *link);

#endif
