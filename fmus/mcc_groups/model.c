/* FMU of groups, several motion libraries on one PC with two cards (core groups): bus grid, inputs
 * from the cards, levels and mailboxes to them. */
#include <math.h>
#include <string.h>

#include "group.h"
#include "library_in_use.h"
#include "vars.h"

struct model {
    struct groups groups;
    int32_t index[GROUP_MAX];      /* index of group 1, 2 .. in the library; -1 none */
    int64_t bus;                   /* [ns] period of the bus grid */
    int64_t instant;               /* [ns] next instant of the grid, at which inputs are read */
    bool unpublished;              /* the outputs of the latest instant are shown at the next one */
    int32_t told_error[GROUP_MAX]; /* run-time error of each group that was reported last */
    double output[GROUP_CARDS][GROUP_DACS]; /* [V] inputs dac_output as read last */
};

#define MODEL_BLOB
#define GROUP_IN_USE(one) \
    FMU_WHEN(one.mcc, one.used, 1, 1) \
    MCC_IN_USE(one.mcc) \
    FMU_WHEN(one.servo, one.used, 1, 1) \
    FMU_WHEN(one.servo, one.voltage, 1, 1) \
    VOLTAGE_IN_USE(one.servo.voltage)
#define MODEL_IN_USE \
    GROUP_IN_USE(groups.group[0]) \
    GROUP_IN_USE(groups.group[1]) \
    GROUP_IN_USE(groups.group[2]) \
    GROUP_IN_USE(groups.group[3]) \
    GROUP_IN_USE(groups.group[4]) \
    GROUP_IN_USE(groups.group[5])
_Static_assert(GROUP_MAX == 6, "a row of each group's arrays");
#include "fmi_model.h"
#include "fmu_period.h"
#include "program_fault.h"
#include "dac_axes.h"

static double clocks(double seconds)
{
    return seconds * CLOCK_HZ;
}

/* Parameters of a group. */
struct wanted {
    const char *program;
    int32_t card;           /* number of its card, from 1 */
    const int32_t *channel; /* channel of each axis, from 1 */
};

static struct wanted wanted(const struct vars *v, int n)
{
    const struct wanted all[GROUP_MAX] = { { v->group1_program, v->group1_card, v->group1_channel },
                                           { v->group2_program, v->group2_card, v->group2_channel },
                                           { v->group3_program, v->group3_card, v->group3_channel },
                                           { v->group4_program, v->group4_card, v->group4_channel },
                                           { v->group5_program, v->group5_card, v->group5_channel },
                                           { v->group6_program, v->group6_card,
                                             v->group6_channel } };
    return all[n];
}

struct programs {
    struct program_file *of[GROUP_MAX];
};

static int model_open(struct fmu *f)
{
    struct programs *p = calloc(1, sizeof *p);

    f->blob = p;
    if (!p) {
        return fmu_fail(f, "no memory for the part programs");
    }
    for (int n = 0; n < GROUP_MAX; n++) {
        char name[] = "group1_program";
        name[5] = (char)('1' + n);
        if (open_program(f, name, wanted(&f->s.v, n).program, &p->of[n])) {
            return -1;
        }
    }
    return 0;
}

static void model_close(struct fmu *f)
{
    struct programs *p = f->blob;

    for (int n = 0; p && n < GROUP_MAX; n++) {
        program_close(p->of[n]);
    }
    free(p);
}

static int model_end(struct fmu *f)
{
    (void)f;
    return 0;
}

static struct source source_of_group(const struct fmu *f, int n)
{
    const struct programs *p = f->blob;
    return (struct source){ program_look, p->of[n] };
}

static int check_parameters(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const double bus = clocks(v->bus_period);

    if (!fmu_is_period(bus)) {
        return fmu_fail(f, "bus_period = %.17g s is not a whole number of %d ns clocks",
                        v->bus_period, CLOCK_NS);
    }
    if (v->min_stock + v->batch > PCL_FIFO) {
        return fmu_fail(f, "min_stock %d + batch %d: the FIFO of a card holds %d commands",
                        (int)v->min_stock, (int)v->batch, PCL_FIFO);
    }
    for (int n = 0; n < GROUP_MAX; n++) {
        if (v->feed[n] > v->max_feed[n]) {
            return fmu_fail(f, "feed[%d] %g mm/min is above max_feed %g mm/min", n + 1, v->feed[n],
                            v->max_feed[n]);
        }
    }
    return 0;
}

static void cards_of(const struct vars *v, struct machine card[GROUP_CARDS])
{
    const double *lead[] = { v->card1_lead, v->card2_lead };
    const double *gear[] = { v->card1_gear_ratio, v->card2_gear_ratio };
    const double *rpm[] = { v->card1_max_rpm, v->card2_max_rpm };
    const int32_t *ppr[] = { v->card1_ppr, v->card2_ppr };
    const int32_t *gain[] = { v->card1_gain, v->card2_gain };

    for (int k = 0; k < GROUP_CARDS; k++) {
        card[k] = (struct machine){ .dda_time = v->dda_time, .dda_length = v->dda_length };
        for (int i = 0; i < AXES; i++) {
            card[k].axis[i] = (struct machine_axis){ .pitch = lead[k][i],
                                                     .gear_ratio = gear[k][i],
                                                     .ppr = ppr[k][i],
                                                     .rpm = rpm[k][i],
                                                     .p_gain = gain[k][i] };
        }
    }
}

static struct machine motion_of(const struct vars *v, int n)
{
    return (struct machine){ .queue_depth = v->queue_depth,
                             .feed = v->feed[n] / 60.0,
                             .max_feed = v->max_feed[n] / 60.0,
                             .acc_time = v->acc_time[n],
                             .dec_time = v->dec_time[n],
                             .acc_type = 'T',
                             .dec_type = 'T',
                             .jerk_share = 0.5 };
}

static int create(struct fmu *f, int n)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const struct wanted w = wanted(v, n);
    const struct machine motion = motion_of(v, n);
    const struct programs *programs = f->blob;
    int32_t channel[AXES];

    m->index[n] = -1;
    if (w.card == 0) {
        return programs->of[n] ? fmu_fail(f,
                                          "group%d_program: group%d_card is 0, there is no "
                                          "such group",
                                          n + 1, n + 1)
                               : 0;
    }
    for (int i = 0; i < AXES; i++) {
        channel[i] = w.channel[i] - 1;
    }
    const int code = v->voltage[n] ? group_create_voltage(&m->groups, w.card - 1, channel, &motion)
                                   : group_create(&m->groups, w.card - 1, channel, &motion);
    if (code == MCC_GROUP_PARAMETER || code == MCC_VOLTAGE_COMMAND_CHANNEL) {
        return refuse_channels(f, n, (int)w.card, v->voltage[n], code);
    }
    if (code < 0) {
        return fmu_fail(f, "group %d: the library refuses the machine parameters", n + 1);
    }
    m->index[n] = code;
    struct mcc *mcc = &m->groups.group[code].mcc;
    task_set_switches(mcc, v->block_delete, v->optional_stop);
    if (programs->of[n]) {
        const struct source source = source_of_group(f, n);
        struct fault_list all;
        char name[] = "group1_program";
        name[5] = (char)('1' + n);
        group_program(&m->groups, code,
                      (int64_t)ceil(clocks(v->start_delay[n]) - FMU_PERIOD_TOLERANCE));
        task_check_all(mcc, &source, &all);
        const struct named_program named = { name, w.program, "XYZUVW", &source };
        return judge_program(f, &named, &all);
    }
    return 0;
}

static void publish(struct fmu *f);

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    struct machine card[GROUP_CARDS];
    const struct group_config config = { .bus = (int64_t)round(clocks(v->bus_period)),
                                         .ipo = (int64_t)round(clocks(v->ipo_period)),
                                         .latency = clocks(v->irq_latency),
                                         .jitter = clocks(v->irq_jitter),
                                         .seed = v->seed,
                                         .min_stock = v->min_stock,
                                         .batch = v->batch };

    if (check_parameters(f)) {
        return -1;
    }
    cards_of(v, card);
    groups_init(&m->groups, &config, card);
    memset(m->output, 0, sizeof m->output);
    if (set_dacs(f)) {
        return -1;
    }
    for (int n = 0; n < GROUP_MAX; n++) {
        if (create(f, n)) {
            return -1;
        }
    }
    if (groups_start(&m->groups)) {
        return fmu_fail(f, "there is no group: every group*_card is 0");
    }
    if (put_out(f, true)) {
        return -1;
    }
    m->bus = config.bus * CLOCK_NS;
    publish(f);
    return 0;
}

/* Set the outputs to a card, whose names begin with card1_ or card2_. command_aux keeps its value
 * while no axis has the seventh error counter. */
#define SHOW_1(type, name, elements) LINK_CARRY(v->card1_##name, link.name)
#define SHOW_2(type, name, elements) LINK_CARRY(v->card2_##name, link.name)
#define PUBLISH_CARD(K) \
    do { \
        struct link_host link; \
        link.cmd_seq = v->card##K##_cmd_seq; \
        link.command_aux = v->card##K##_command_aux; \
        groups_publish(&m->groups, K - 1, &link); \
        LINK_LEVELS(SHOW_##K) \
        LINK_LEVELS_AUX(SHOW_##K) \
        if (link.cmd_seq != v->card##K##_cmd_seq) { \
            LINK_WRITE(SHOW_##K) \
        } \
        v->card##K##_services = m->groups.card[K - 1].pcl.services; \
        PUBLISH_DACS(K); \
    } while (0)

static void publish_group(struct fmu *f, int n)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;

    if (m->index[n] < 0) {
        v->status[n] = -1;
        return;
    }
    const struct group *g = &m->groups.group[m->index[n]];
    v->status[n] = task_status(&g->mcc);
    v->done[n] = group_done(&m->groups, m->index[n]);
    v->error[n] = MCC_get_errcode(&g->mcc);
    v->line[n] = g->mcc.written.line;
    v->path_feed[n] = g->mcc.written.feed;
    v->queue[n] = g->mcc.queue.count;
    v->starved[n] = g->starved;
    if (v->error[n] != m->told_error[n]) {
        m->told_error[n] = v->error[n];
        (v->error[n] != 0 ? fmu_warn : fmu_event)(f,
                                                  "group %d: run-time error 0x%04X after line %d",
                                                  n + 1, (unsigned)v->error[n], (int)v->line[n]);
    }
}

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;

    for (int n = 0; n < GROUP_MAX; n++) {
        publish_group(f, n);
    }
    PUBLISH_CARD(1);
    PUBLISH_CARD(2);
}

#define READ_1(type, name, elements) LINK_CARRY(link.name, v->card1_##name)
#define READ_2(type, name, elements) LINK_CARRY(link.name, v->card2_##name)
#define READ_CARD(K) \
    do { \
        struct link_card link; \
        LINK_SHOWN(READ_##K) \
        LINK_CARRY(link.pulse_count, v->card##K##_pulse_count) \
        card[K - 1] = card_of(&m->groups.card[K - 1].pcl, &link); \
        groups_counters(&m->groups, K - 1, &link); \
    } while (0)

/* Read the inputs at an instant of the bus grid and let the PC work. */
static void read_bus(struct fmu *f, int64_t at)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    struct pcl_card card[GROUP_CARDS];
    struct group_panel panel[GROUP_MAX] = { { .override = 1.0 } };
    struct source source[GROUP_MAX] = { { 0 } };

    READ_CARD(1);
    READ_CARD(2);
    put_out(f, false);
    for (int n = 0; n < GROUP_MAX; n++) {
        if (m->index[n] >= 0) {
            source[m->index[n]] = source_of_group(f, n);
            panel[m->index[n]] = (struct group_panel){ .hold = v->hold[n],
                                                       .abort = v->abort[n],
                                                       .cycle_start = v->cycle_start[n],
                                                       .override = v->override[n],
                                                       .probe = v->probe_in[n],
                                                       .digital = (uint32_t)v->digital_in[n] };
            memcpy(panel[m->index[n]].analog, v->analog_in[n], sizeof v->analog_in[n]);
        }
    }
    groups_instant(&m->groups, at / CLOCK_NS, card, panel, source);
}

static int refused_by_card(struct fmu *f, int card)
{
    return fmu_fail(f,
                    "card %d has refused every frame of %d transactions in a row: is every "
                    "channel of a group active on it?",
                    card + 1, PCL_REFUSALS);
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;

    (void)t0;
    if (!(fabs(v->card1_irq_clock) < FMU_TICKS_MAX && fabs(v->card2_irq_clock) < FMU_TICKS_MAX)) {
        return fmu_fail(f, "card1_irq_clock = %g, card2_irq_clock = %g: no clock",
                        v->card1_irq_clock, v->card2_irq_clock);
    }
    for (;;) {
        if (m->unpublished && m->instant <= t1) {
            publish(f);
            m->unpublished = false;
        }
        if (m->instant >= t1) {
            return 0;
        }
        read_bus(f, m->instant);
        for (int k = 0; k < GROUP_CARDS; k++) {
            if (m->groups.card[k].pcl.refusals >= PCL_REFUSALS) {
                return refused_by_card(f, k);
            }
        }
        m->instant += m->bus;
        m->unpublished = true;
    }
}
