/* Digital differential analyser (DDA): each channel spreads the pulses of its command evenly over a
 * DDA time, which all channels share.
 *
 * Its unit of time is the clock of the hardware, however long that is. A DDA time has `ticks` ticks
 * of `divider` clocks each. A card whose commands are `length` bits long has ticks = 2^length; a
 * card with a counter may have any number of ticks. */
#ifndef DDA_H
#define DDA_H

#include <stdbool.h>
#include <stdint.h>

enum { DDA_CHANNELS_MAX = 8 };

struct dda {
    int32_t channels;   /* 1 .. DDA_CHANNELS_MAX */
    int32_t ticks;      /* ticks of the DDA time in progress, 2 or more */
    int32_t divider;    /* [clocks per tick] of the DDA time in progress */
    int32_t next_ticks; /* ticks and divider of the DDA times from the next boundary on */
    int32_t next_divider;
    bool run;                          /* false: everything stands still */
    int64_t start;                     /* [clock] at which the DDA time in progress began */
    int64_t stop;                      /* [clock] at which run was switched off */
    int32_t command[DDA_CHANNELS_MAX]; /* [pulses] of the DDA time in progress */
    int64_t before[DDA_CHANNELS_MAX];  /* [pulses] put out by the DDA times before */
};

/* Length of a DDA time [clocks]. */
int64_t dda_time(int32_t ticks, int32_t divider);

/* Divider, within 1 .. largest, whose DDA time is nearest to the wanted one [clocks]. If two are as
 * near, that of the longer time, which asks less of the host. */
int32_t dda_divider(int32_t ticks, double wanted, int32_t largest);

/* Largest |command| [pulses]: ticks - 1. */
int32_t dda_largest(int32_t ticks);

/* Signed number of pulses that a command has put out after `tick` ticks of its DDA time. */
int64_t dda_pulses(int32_t command, int32_t ticks, int64_t tick);

/* Number of ticks after which the j-th pulse of a command comes, j = 1 .. |command|. */
int64_t dda_edge_tick(int32_t command, int32_t ticks, int32_t j);

/* Start at clock 0, running, at the beginning of a DDA time without commands. */
void dda_reset(struct dda *d, int32_t channels, int32_t ticks, int32_t divider);

/* Ask for another length of the DDA times, from the next boundary on. If all commands are 0 and
 * `clock` is the first clock of the DDA time (as after reset), it holds for this one already. */
void dda_set_time(struct dda *d, int32_t ticks, int32_t divider, int64_t clock);

/* Switch the divider on or off. Off, everything stands still; on, the DDA time goes on where it
 * stood. */
void dda_set_run(struct dda *d, bool run, int64_t clock);

/* Clock of the next boundary; INT64_MAX while stopped. */
int64_t dda_boundary(const struct dda *d);

/* At a boundary: end the DDA time and begin the next one with a command for each channel
 * [pulses]. */
void dda_begin(struct dda *d, const int32_t *command);

/* Signed number of pulses that each channel has put out since reset, up to and including `clock`,
 * which lies in the DDA time in progress. */
void dda_counts(const struct dda *d, int64_t clock, int64_t *counts);

/* Clock of the j-th pulse of the DDA time in progress; -1 if it has no such pulse or is stopped. */
int64_t dda_edge_clock(const struct dda *d, int channel, int32_t j);

#endif
