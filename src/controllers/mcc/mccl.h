/* mccl - the library's calls in the spelling of its later releases (MCCL 5.10).
 *
 * A later program finds its names here: single values instead of arrays, the state first instead of
 * group and card numbers behind. Where a call means something else than there, its comment says so.
 * Every call returns an int code; there, the calls that set a speed return that speed.
 *
 * Left out, with what stands for it:
 *  - MCC_InitSystem, whose cards, groups and encoders are other than struct machine:
 *    MCC_init_motion.
 *  - MCC_AbortMotionEx, which is given a deceleration time: MCC_motion_abort uses that of the
 *    command.
 *  - MCC_GoHome with its tolerance and escape time: MCC_Home.
 *  - The hand wheel's calls for planes and several axes: MCC_MPG_set.
 *  - Axis masks of MCC_Line and MCC_PtP: the one-axis calls.
 *  - Groups, command modes and DAC outputs: the core groups.
 * What the document does not have is left out, too, from helices over custom motion to encoders
 * and I/O.
 */
#ifndef MCCL_H
#define MCCL_H

#include "task.h"

/* Calls that differ by the name alone. */
#define MCC_CloseSystem      MCC_close_motion /* refused before standstill */
#define MCC_ClearError       MCC_clear_error
#define MCC_GetErrorCode     MCC_get_errcode
#define MCC_SetAbsolute      MCC_set_abs
#define MCC_SetIncrease      MCC_set_inc
#define MCC_GetCoordType     MCC_get_pos_type
#define MCC_LineX            MCC_line_x
#define MCC_LineY            MCC_line_y
#define MCC_LineZ            MCC_line_z
#define MCC_PtPX             MCC_ptp_x
#define MCC_PtPY             MCC_ptp_y
#define MCC_PtPZ             MCC_ptp_z
#define MCC_ArcXY            MCC_arc_xy
#define MCC_ArcYZ            MCC_arc_yz
#define MCC_ArcZX            MCC_arc_zx
#define MCC_CircleXY         MCC_circle_xy
#define MCC_CircleYZ         MCC_circle_yz
#define MCC_CircleZX         MCC_circle_zx
#define MCC_DelayMotion      MCC_motion_delay
#define MCC_HoldMotion       MCC_motion_hold /* at once, never behind the current command */
#define MCC_ContiMotion      MCC_motion_conti
#define MCC_AbortMotion      MCC_motion_abort
#define MCC_SetFeedSpeed     MCC_set_fspd
#define MCC_SetPtPSpeed      MCC_set_ptp_spd
#define MCC_OverrideSpeed    MCC_set_over_spd
#define MCC_GetOverrideRate  MCC_get_over_spd
#define MCC_OverridePtPSpeed MCC_set_ptp_ospd
#define MCC_EnableBlend      MCC_enable_quit
#define MCC_DisableBlend     MCC_disable_quit
#define MCC_CheckBlend       MCC_check_quit
#define MCC_SetAccType       MCC_set_acc_type
#define MCC_GetAccType       MCC_get_acc_type
#define MCC_SetDecType       MCC_set_dec_type
#define MCC_GetDecType       MCC_get_dec_type
#define MCC_SetAccTime       MCC_set_acc_step
#define MCC_GetAccTime       MCC_get_acc_step
#define MCC_SetDecTime       MCC_set_dec_step
#define MCC_GetDecTime       MCC_get_dec_step
#define MCC_UpdateParam      MCC_update_param
#define MCC_EnableDryRun     MCC_enable_dry_run
#define MCC_DisableDryRun    MCC_disable_dry_run
#define MCC_CheckDryRun      MCC_check_dry_run
#define MCC_RunSingleBlock   task_continue
#define MCC_EnableInPos      MCC_enable_in_pos /* an axis mask, as there */
#define MCC_DisableInPos     MCC_disable_in_pos
#define MCC_GetGoHomeStatus  MCC_check_homef
#define MCC_AbortGoHome      MCC_motion_abort
#define MCC_DisableMpg       MCC_MPG_disable

/* Group status: 0 running, 1 stopped, 2 hold, 3 delay, 4 single block, 5 hand wheel;
 * MCC_check_stop tells 1 and 0. */
#define MCC_GetMotionStatus task_status

/* Six values to where the caller wants them. */
static inline void mccl_give(const double from[AXES], double *const to[AXES])
{
    for (int i = 0; i < AXES; i++) {
        *to[i] = from[i];
    }
}

static inline void mccl_give_int(const int32_t from[AXES], int32_t *const to[AXES])
{
    for (int i = 0; i < AXES; i++) {
        *to[i] = from[i];
    }
}

static inline void mccl_give_char(const char from[AXES], char *const to[AXES])
{
    for (int i = 0; i < AXES; i++) {
        *to[i] = from[i];
    }
}

static inline int MCC_Line(struct mcc *m, double x, double y, double z, double u, double v,
                           double w)
{
    const double target[AXES] = { x, y, z, u, v, w };
    return MCC_line(m, target);
}

/* All axes arrive together. */
static inline int MCC_SyncPtP(struct mcc *m, double x, double y, double z, double u, double v,
                              double w)
{
    const double target[AXES] = { x, y, z, u, v, w };
    return MCC_ptp(m, target);
}

/* Each axis for itself. */
static inline int MCC_PtP(struct mcc *m, double x, double y, double z, double u, double v, double w)
{
    const double target[AXES] = { x, y, z, u, v, w };
    return MCC_ptp_asyn(m, target);
}

/* Direction -1, +1; 0 stops. */
static inline int MCC_JogConti(struct mcc *m, int direction, double percent, int axis)
{
    return MCC_jog_c(m, axis, direction, percent);
}

static inline int MCC_JogSpace(struct mcc *m, double offset, double percent, int axis)
{
    return MCC_jog_i(m, axis, offset, percent);
}

static inline int MCC_JogPulse(struct mcc *m, int pulses, int axis)
{
    return MCC_jog_s(m, axis, pulses);
}

/* Homing: axes of order 1 together, then those of order 2, and so on; 0: the axis is not homed. */
static inline int MCC_Home(struct mcc *m, int x, int y, int z, int u, int v, int w)
{
    const int32_t order[AXES] = { x, y, z, u, v, w };
    return MCC_go_home(m, order);
}

/* The table takes effect at once; there, with MCC_UpdateCompParam. */
static inline int MCC_SetCompParam(struct mcc *m, const struct comp_table *table, int axis)
{
    return MCC_set_comp(m, axis, table);
}

static inline int MCC_EnableSingleBlock(struct mcc *m)
{
    return task_set_single_block(m, true);
}

static inline int MCC_DisableSingleBlock(struct mcc *m)
{
    return task_set_single_block(m, false);
}

/* An arc through (ra, rb) to (a, b), or a circle about (ca, cb), while U V W follow. */
#define MCCL_TURNS(plane, lower) \
    static inline int MCC_Arc##plane##UVW(struct mcc *m, double ra, double rb, double a, double b, \
                                          double u, double v, double w) \
    { \
        const double points[4] = { ra, rb, a, b }; \
        const double uvw[3] = { u, v, w }; \
        return MCC_arc_##lower##uvw(m, points, uvw); \
    } \
    static inline int MCC_Circle##plane##UVW(struct mcc *m, double ca, double cb, double u, \
                                             double v, double w, int direction) \
    { \
        const double centre[2] = { ca, cb }; \
        const double uvw[3] = { u, v, w }; \
        return MCC_circle_##lower##uvw(m, centre, direction, uvw); \
    }

MCCL_TURNS(XY, xy)
MCCL_TURNS(YZ, yz)
MCCL_TURNS(ZX, zx)
#undef MCCL_TURNS

/* Six values to set and to get, under the names of the later releases. */
#define MCCL_SIX(type, give, set, get, set_six, get_six) \
    static inline int set(struct mcc *m, type x, type y, type z, type u, type v, type w) \
    { \
        const type six[AXES] = { x, y, z, u, v, w }; \
        return set_six(m, six); \
    } \
    MCCL_GET(type, give, get, get_six)

#define MCCL_GET(type, give, get, get_six) \
    static inline int get(const struct mcc *m, type *x, type *y, type *z, type *u, type *v, \
                          type *w) \
    { \
        type six[AXES] = { 0 }; \
        type *const to[AXES] = { x, y, z, u, v, w }; \
        const int code = get_six(m, six); \
        give(six, to); \
        return code; \
    }

/* The most pulses of an axis in a DDA time; there, in an interpolation period. */
MCCL_SIX(int32_t, mccl_give_int, MCC_SetMaxPulseSpeed, MCC_GetMaxPulseSpeed, MCC_set_max_dda_spd,
         MCC_get_max_dda_spd)
MCCL_SIX(int32_t, mccl_give_int, MCC_SetPGain, MCC_GetPGain, MCC_set_P_gain, MCC_get_P_gain)

/* The largest change of that between DDA times; there, between interpolation periods. */
MCCL_SIX(int32_t, mccl_give_int, MCC_SetMaxPulseAcc, MCC_GetMaxPulseAcc, MCC_set_max_dda_acc,
         MCC_get_max_dda_acc)
MCCL_SIX(int, mccl_give_int, MCC_SetOverTravelCheck, MCC_GetOverTravelCheck, MCC_set_check_OT,
         MCC_get_check_OT)
MCCL_SIX(double, mccl_give, MCC_SetInPosToleranceEx, MCC_GetInPosToleranceEx, MCC_set_inpos_tol,
         MCC_get_inpos_tol)
MCCL_GET(int, mccl_give_int, MCC_GetInPosStatus, MCC_check_in_pos)

/* Ramps of axes that move by themselves. */
MCCL_SIX(char, mccl_give_char, MCC_SetPtPAccType, MCC_GetPtPAccType, MCC_set_ptp_asyn_acc_type,
         MCC_get_ptp_asyn_acc_type)
MCCL_SIX(char, mccl_give_char, MCC_SetPtPDecType, MCC_GetPtPDecType, MCC_set_ptp_asyn_decc_type,
         MCC_get_ptp_asyn_dec_type)
MCCL_SIX(double, mccl_give, MCC_SetPtPAccTime, MCC_GetPtPAccTime, MCC_set_ptp_asyn_acc_step,
         MCC_get_ptp_asyn_acc_step)
MCCL_SIX(double, mccl_give, MCC_SetPtPDecTime, MCC_GetPtPDecTime, MCC_set_ptp_asyn_dec_step,
         MCC_get_ptp_asyn_dec_step)

/* Positions of the latest point that the card has taken. */
MCCL_GET(double, mccl_give, MCC_GetCurPos, MCC_get_cpos)
MCCL_GET(int32_t, mccl_give_int, MCC_GetPulsePos, MCC_get_ppos)
MCCL_GET(int32_t, mccl_give_int, MCC_GetErrorCount, MCC_get_errcnt)
#undef MCCL_SIX
#undef MCCL_GET

#endif
