/* dac_axes - the voltage axes of the mcc_groups FMU, which are driven by the cards' DACs: their
 * parameters, their outputs, and messages about refused channels. Included by model.c after
 * fmi_model.h. */
#ifndef DAC_AXES_H
#define DAC_AXES_H

/* Read the parameters of card K, whose names begin with cardK_. */
#define READ_DACS(K) \
    do { \
        for (int i = 0; i < GROUP_DACS; i++) { \
            dac[K - 1][i] = (struct group_dac){ \
                .axis = { .pitch = v->card##K##_dac_lead[i], \
                          .gear_ratio = v->card##K##_dac_gear_ratio[i], \
                          .ppr = v->card##K##_dac_ppr[i], \
                          .rpm = v->card##K##_dac_max_rpm[i], \
                          .inverted = v->card##K##_dac_pos2encoder_dir[i] == 1, \
                          .track_limit = v->card##K##_dac_track_error_limit[i] }, \
                .encoder = v->card##K##_dac_encoder[i] - 1, \
                .position_gain = v->card##K##_dac_position_gain[i], \
                .speed_per_volt = v->card##K##_dac_speed_per_volt[i], \
                .feed_forward = v->card##K##_dac_velocity_ff[i], \
                .lag = v->card##K##_dac_command_lag[i] \
            }; \
        } \
        for (int i = 0; i < AXES; i++) { \
            mode[K - 1][i] = v->card##K##_loop[i] ? GROUP_COMMAND_VOLTAGE : GROUP_COMMAND_PULSE; \
        } \
    } while (0)

/* Give the library the parameters of the DACs, before any group is created. */
static int set_dacs(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct groups *groups = &f->s.m.groups;
    struct group_dac dac[GROUP_CARDS][GROUP_DACS];
    int mode[GROUP_CARDS][AXES];

    READ_DACS(1);
    READ_DACS(2);
    for (int k = 0; k < GROUP_CARDS; k++) {
        for (int i = 0; i < GROUP_DACS; i++) {
            if (groups_set_dac(groups, k, i, &dac[k][i])) {
                return fmu_fail(f, "card%d_dac_*[%d]: the library refuses the axis", k + 1, i + 1);
            }
        }
        for (int i = 0; i < AXES; i++) {
            groups_set_command_mode(groups, k, i, mode[k][i]);
        }
    }
    return 0;
}

/* Report why a group cannot have the channels of its axes; returns -1. */
static int refuse_channels(struct fmu *f, int n, int card, bool voltage, int code)
{
    if (code == MCC_VOLTAGE_COMMAND_CHANNEL) {
        return fmu_fail(f,
                        "group%d_channel: card%d_loop has the position loop of card %d at a DAC "
                        "that is the voltage of an axis",
                        n + 1, card, card);
    }
    if (voltage) {
        return fmu_fail(f,
                        "group%d_channel: no axis at all, or a DAC of card %d that is named "
                        "twice, belongs to another group, or whose counter (card%d_dac_encoder) "
                        "closes another loop",
                        n + 1, card, card);
    }
    return fmu_fail(f,
                    "group%d_channel: no axis at all, or a channel of card %d that it does not "
                    "have, is named twice, belongs to another group, or whose counter closes "
                    "another loop (card%d_loop)",
                    n + 1, card, card);
}

/* Set the voltages of DACs that are not of an axis. A DAC that is of an axis is an error at the
 * start and a warning later, given once. */
static int put_out(struct fmu *f, bool start)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const double *output[] = { v->card1_dac_output, v->card2_dac_output };

    for (int k = 0; k < GROUP_CARDS; k++) {
        for (int i = 0; i < GROUP_DACS; i++) {
            if (output[k][i] == m->output[k][i]) {
                continue;
            }
            m->output[k][i] = output[k][i];
            if (groups_set_dac_output(&m->groups, k, i, output[k][i]) == MCC_NO_ERR) {
                continue;
            }
            if (start) {
                return fmu_fail(f,
                                "card%d_dac_output[%d] = %g V: the DAC is the voltage command "
                                "of an axis",
                                k + 1, i + 1, output[k][i]);
            }
            fmu_warn(f, "card%d_dac_output[%d] = %g V: the DAC is the voltage command of an axis",
                     k + 1, i + 1, output[k][i]);
        }
    }
    return 0;
}

#define PUBLISH_DACS(K) \
    do { \
        const struct group_card *d = &m->groups.card[K - 1]; \
        memcpy(v->card##K##_dac_command, d->command, sizeof v->card##K##_dac_command); \
        memcpy(v->card##K##_dac_error, d->error, sizeof v->card##K##_dac_error); \
        v->card##K##_dac_command_7 = d->command[6]; \
        v->card##K##_dac_command_8 = d->command[7]; \
        v->card##K##_dac_error_7 = d->error[6]; \
        v->card##K##_dac_error_8 = d->error[7]; \
    } while (0)

#endif
