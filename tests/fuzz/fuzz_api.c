/* Bytes as calls of the library in any order, with the task running between: a call that is
 * refused changes nothing, every point is within the limits, the axes come to rest when told, and
 * at rest the next command begins where they stand. */
#include "fuzz.h"
#include "reaction.h"

#include <stddef.h>

const int fuzz_count = 10000;

enum { CALLS = 200, REST_POINTS = 20000 };

static struct mcc m, before; /* 1.4 MB each: not on the stack */
static int64_t sum[AXES];    /* [pulses] of all frames since the start */
static double slowest;       /* [s] longest deceleration time so far */

/* Everything but the shape and the speed profile of curves, most of the bytes: nothing here turns
 * curves on, so they are zeros all the time, and a comparison of the whole would tell. */
static void remember(void)
{
    const size_t behind = offsetof(struct mcc, queue);
    memcpy(&before, &m, offsetof(struct mcc, curve_plan.shape));
    memcpy((char *)&before + behind, (const char *)&m + behind, sizeof m - behind);
}

/* What is left of the input. */
struct bytes {
    const uint8_t *at, *end;
};

static uint8_t byte(struct bytes *b)
{
    return b->at < b->end ? *b->at++ : 0;
}

/* A number: mostly a plain one, at times one that no call should take. */
static double number(struct bytes *b)
{
    static const double odd[] = { 0.0,   -0.0,   NAN,    INFINITY, -INFINITY,
                                  1e308, -1e308, 5e-324, 1e-9,     2147.4836475,
                                  -1e6,  1e6,    100.0,  200.0,    200.00000000000003,
                                  0.1 };
    const uint8_t low = byte(b), high = byte(b);
    const int16_t whole = (int16_t)(low | high << 8);
    return (whole & 0xf) == 0xf ? odd[(whole >> 4) & 0xf] : whole / 256.0;
}

static int32_t integer(struct bytes *b)
{
    static const int32_t odd[] = { 0, -1, 1, INT32_MAX, INT32_MIN, 4095, 4096, 65535, 65536 };
    const uint8_t i = byte(b);
    return i < 9 ? odd[i] : i * 16;
}

struct six {
    double x[AXES];
    int32_t n[AXES];
};

static struct six six(struct bytes *b)
{
    struct six s;
    for (int i = 0; i < AXES; i++) {
        s.x[i] = number(b);
        s.n[i] = fabs(s.x[i]) < 1e6 ? abs((int)s.x[i] * 64) : integer(b);
    }
    return s;
}

/* Calls by the kind of their arguments. */
static int (*const none[])(struct mcc *) = {
    MCC_set_abs,      MCC_set_inc,        MCC_enable_quit,    MCC_disable_quit, MCC_motion_hold,
    MCC_motion_conti, MCC_motion_abort,   MCC_clear_error,    MCC_close_motion, task_continue,
    MCC_MPG_disable,  MCC_enable_dry_run, MCC_disable_dry_run
};
static int (*const one[])(struct mcc *, double) = {
    MCC_line_x,       MCC_line_y,       MCC_line_z,       MCC_ptp_x,        MCC_ptp_y,
    MCC_ptp_z,        MCC_motion_delay, MCC_set_fspd,     MCC_set_ptp_spd,  MCC_set_acc_step,
    MCC_set_dec_step, MCC_set_dda,      MCC_set_over_spd, MCC_set_ptp_ospd, mcc_set_tolerance
};
static int (*const all[])(struct mcc *, const double *) = {
    MCC_line,         MCC_ptp, MCC_ptp_asyn, MCC_set_ptp_asyn_acc_step, MCC_set_ptp_asyn_dec_step,
    MCC_set_inpos_tol
};
static int (*const pulses[])(struct mcc *, const int32_t *) = { MCC_set_max_dda_spd, MCC_set_P_gain,
                                                                MCC_set_max_dda_acc };
static int (*const axes_of[])(struct mcc *, int) = { MCC_enable_in_pos, MCC_disable_in_pos };
static int (*const letters[])(struct mcc *, const char *) = { MCC_set_ptp_asyn_acc_type,
                                                              MCC_set_ptp_asyn_decc_type };
static int (*const arc[])(struct mcc *, double, double, double, double) = { MCC_arc_xy, MCC_arc_yz,
                                                                            MCC_arc_zx };
static int (*const circle[])(struct mcc *, double, double, int) = { MCC_circle_xy, MCC_circle_yz,
                                                                    MCC_circle_zx };
static int (*const arc_uvw[])(struct mcc *, const double *,
                              const double *) = { MCC_arc_xyuvw, MCC_arc_yzuvw, MCC_arc_zxuvw };
static int (*const circle_uvw[])(struct mcc *, const double *, int,
                                 const double *) = { MCC_circle_xyuvw, MCC_circle_yzuvw,
                                                     MCC_circle_zxuvw };
#define PICK(from, i) (from)[(i) % (sizeof(from) / sizeof *(from))]

/* Axes moved by hand, also such as there are not. */
static int jog(struct bytes *b, uint8_t which)
{
    const int axis = (which >> 2) % 8 - 1;
    const double way = number(b), percent = number(b);
    const int32_t pulses = integer(b);
    switch (which & 3) {
    case 0:  return MCC_jog_c(&m, axis, (pulses & 3) - 1, percent);
    case 1:  return MCC_jog_i(&m, axis, way, percent);
    case 2:  return MCC_jog_s(&m, axis, pulses);
    default: return MCC_MPG_set(&m, axis, pulses % 11 - 1, percent);
    }
}

/* A parameter of the user's, then made effective; or a table of compensation. */
static int axes(struct bytes *b, uint8_t which)
{
    static struct comp_table table;
    MCC_MACH_PARAM *p = &m.epcio_axis_param[(which >> 3) % AXES];
    double *const real[] = { &p->RPM, &p->pitch, &p->gear_ratio, &m.cart_max_speed };
    if (which & 1) {
        table.interval = byte(b) * 16;
        table.home = (which >> 1 & 3) * 85;
        for (int i = 0; i < COMP_POINTS; i++) {
            table.forward[i] = (int8_t)byte(b);
            table.backward[i] = table.forward[i] + (which & 64 ? 5 : 0);
        }
        return MCC_set_comp(&m, (which >> 3) % 8 - 1, &table);
    }
    if (which & 2) {
        *real[which >> 2 & 3] = number(b);
    } else {
        p->type = which >> 6;
        p->pos2encoder_dir = byte(b) & 1;
        p->PPR = integer(b);
    }
    remember();
    const int code = MCC_update_param(&m);
    for (int i = 0; i < AXES && code == MCC_NO_ERR; i++) {
        sum[i] = m.trajectory.pulses[i] + m.comp[i].added; /* an axis may have been turned round */
    }
    return code;
}

static int home(struct bytes *b, uint8_t which)
{
    int32_t order[AXES];
    if (which & 1) {
        struct home_config config = { .mode = (enum home_mode)(which >> 1 & 7),
                                      .sensor_on = which & 16,
                                      .low_speed = 1.0,
                                      .search = 20.0,
                                      .index_way = 3.0 };
        config.direction = byte(b);
        config.high_speed = number(b);
        config.offset = number(b);
        return homing_set(&m, (which >> 5) - 1, &config, which & 16);
    }
    for (int i = 0; i < AXES; i++) {
        order[i] = (int)(byte(b) & 7) - 1; /* -1 is no order */
    }
    return MCC_go_home(&m, order);
}

/* The card has put out every pulse, for which it had a DDA time, and looks at its machine. */
static void look(void)
{
    const struct reaction_look l = { .clocks = machine_dda_clocks(&m.machine) };
    if (m.open) {
        manual_look(&m);
        homing_look(&m, l.clocks);
        reaction_look(&m, &l);
    }
    for (int i = 0; i < AXES && !m.dry_run; i++) {
        sum[i] =
            m.trajectory.pulses[i] + m.comp[i].added; /* homing, an emergency stop may set it */
    }
}

/* The card reports something else: an index has been latched, a switch closes, a wheel turns, the
 * emergency stop acts. */
static void signals(struct bytes *b)
{
    const uint8_t what = byte(b);
    m.signals.stop = what == 0xff;
    m.signals.home = byte(b);
    m.signals.upper = what & 1 ? byte(b) : 0;
    m.signals.lower = what & 2 ? byte(b) : 0;
    for (int i = 0; i < AXES; i++) {
        m.signals.enc[i] = what & 4 ? m.written.pulses[i] : integer(b);
        m.signals.latch[i] = (int32_t)((uint32_t)m.signals.enc[i] - (what >> 5));
        m.signals.err[i] = what & 64 ? integer(b) : 0;
        m.signals.pulses[i] += m.written.frame[i];
        m.signals.latched[i] += what >> 4 & 1;
    }
    for (int i = 0; i < 3; i++) {
        m.signals.enc_aux[i] += what & 8 ? (int8_t)byte(b) : 0;
    }
    look();
}

static int call(struct bytes *b)
{
    const uint8_t kind = byte(b), which = byte(b);
    const struct machine machine = fuzz_machine();
    struct six s;

    switch (kind % 16) {
    case 0: return PICK(none, which)(&m);
    case 1: return PICK(one, which)(&m, number(b));
    case 4: s = six(b); return PICK(all, which)(&m, s.x);
    case 5: s = six(b); return PICK(pulses, which)(&m, s.n);
    case 6: s = six(b); return PICK(arc, which)(&m, s.x[0], s.x[1], s.x[2], s.x[3]);
    case 7: s = six(b); return PICK(circle, which)(&m, s.x[0], s.x[1], integer(b));
    case 8: s = six(b); return PICK(arc_uvw, which)(&m, s.x, (double[]){ s.x[4], s.x[5], 1 });
    case 9: s = six(b); return PICK(circle_uvw, which)(&m, s.x, which & 1, s.x + 2);
    case 10:
        return which & 1 ? MCC_set_acc_type(&m, "TSX"[which % 3])
                         : MCC_set_dec_type(&m, "STX"[which % 3]);
    case 11: return PICK(letters, which)(&m, which & 16 ? "TSTSTS" : "TTSSXS");
    case 12: return jog(b, which);
    case 13: return home(b, which);
    case 14: signals(b); return 0;
    case 2:  return axes(b, which);
    case 3:
        if (which & 1) {
            return PICK(axes_of, which >> 1)(&m, byte(b));
        }
        return MCC_set_check_OT(&m, (int[]){ which >> 1 & 1, 0, which >> 2 & 1, 0, 1, 0 });
    default:
        if (m.open) {
            s = six(b);
            return task_set_origin(&m, which % 9, s.x);
        }
        memset(sum, 0, sizeof sum);
        return MCC_init_motion(&m, &machine);
    }
}

/* Everything that can be asked can be asked at any time. */
static void ask(void)
{
    double x[AXES];
    int32_t n[AXES];
    remember();
    MCC_get_cpos(&m, x);
    MCC_get_ppos(&m, n);
    MCC_get_errcnt(&m, n);
    MCC_get_max_dda_spd(&m, n);
    MCC_get_P_gain(&m, n);
    HOLDS(MCC_get_pos_type(&m) >= 0 && MCC_check_quit(&m) >= 0 && MCC_get_errcode(&m) >= 0);
    HOLDS(isfinite(MCC_get_acc_step(&m)) && isfinite(MCC_get_dec_step(&m)));
    HOLDS(isfinite(MCC_get_dda(&m)) && isfinite(MCC_get_over_spd(&m))
          && isfinite(MCC_get_ptp_ospd(&m)));
    HOLDS(task_status(&m) >= TASK_RUNNING && task_status(&m) <= TASK_WHEEL);
    HOLDS(MCC_check_homef(&m) <= 1);
    HOLDS(memcmp(&before, &m, sizeof m) == 0);
}

static double slowest_of(const struct machine *machine)
{
    double time = machine->dec_time;
    for (int i = 0; i < AXES; i++) {
        time = fmax(time, machine->asyn.dec_time[i]);
    }
    return time;
}

/* After an abort the axes rest: a ramp takes dec_time at the commanded feed, more above it; axes
 * moved by hand have ramps of their own. */
static void come_to_rest(void)
{
    const double seconds = slowest * 4.0 + 1.0;
    const double dda = machine_dda_time(&m.machine);
    const bool by_hand = trajectory_ordered(&m.trajectory);
    int64_t n = 0, cycles = 0;
    if (!m.open || seconds / dda > REST_POINTS) {
        return;
    }
    MCC_motion_abort(&m);
    m.signals = (struct signals){ 0 };
    do {
        look();
        if (m.error == MCC_ERROR_STOP) {
            MCC_clear_error(&m); /* until then no compensation is driven in */
        }
        task_run(&m, NULL);
        n += fuzz_take(&m, sum);
        HOLDS(cycles++ < REST_POINTS && (by_hand || (double)(n - 2) * dda <= seconds));
    } while (!MCC_check_stop(&m));
    HOLDS(m.trajectory.mix.count == 0 && m.ring.count == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const struct machine machine = fuzz_machine();
    struct bytes b = { data, data + size };

    memset(sum, 0, sizeof sum);
    slowest = slowest_of(&machine);
    HOLDS(MCC_init_motion(&m, &machine) == MCC_NO_ERR);
    for (int i = 0; i < CALLS && b.at < b.end; i++) {
        int cycles = *b.at & 0x30 ? 0 : *b.at >> 6;
        remember();
        if (call(&b) < 0) {
            HOLDS(memcmp(&before, &m, sizeof m) == 0);
        }
        for (int k = 0; k < AXES && m.open && MCC_check_stop(&m); k++) {
            HOLDS(fabs(m.end[k] - m.trajectory.rest[k]) < 1e-12); /* shorter lines are none */
        }
        slowest = fmax(slowest, slowest_of(&m.machine));
        if (!(slowest < REST_POINTS * machine_dda_time(&m.machine))) {
            continue; /* its ramps take too many points */
        }
        for (cycles *= cycles; cycles > 0; cycles--) {
            task_run(&m, NULL);
            fuzz_take(&m, sum);
        }
    }
    ask();
    come_to_rest();
    return 0;
}
