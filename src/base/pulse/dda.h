/* Digital differential analyser: channels spread their pulses over one shared DDA time.
 *
 * Its unit of time is the clock of the hardware, however long that is. A DDA time has `ticks` ticks
 * of `divider` clocks each: 2^length ticks where the command has a length in bits, any other number
 * where the hardware counts to it. */
#ifndef DDA_H
#define DDA_H

#include <stdbool.h>
#include <stdint.h>

enum { DDA_CHANNELS_MAX = 8 };

struct dda {
    int32_t channels;   /* 1 .. DDA_CHANNELS_MAX */
    int32_t ticks;      /* of the DDA time in progress, 2 or more */
    int32_t divider;    /* [clocks per tick] of the DDA time in progress */
    int32_t next_ticks; /* from the next boundary on */
    int32_t next_divider;
    bool run;
    int64_t start;                     /* [clock] the DDA time in progress began */
    int64_t stop;                      /* [clock] at which run was switched off */
    int32_t command[DDA_CHANNELS_MAX]; /* [pulses] of the DDA time in progress */
    int64_t before[DDA_CHANNELS_MAX];  /* [pulses] put out by the DDA times before */
};

/* One DDA time [clocks]. */
int64_t dda_time(int32_t ticks, int32_t divider);

/* Divider whose DDA time is nearest to the wanted one [clocks], within 1 .. largest; the longer
 * time if two are as near, which asks less of the host. dda_time() of it is what the hardware can
 * do. */
int32_t dda_divider(int32_t ticks, double wanted, int32_t largest);

/* Largest command: a pulse less than there are ticks, forward or backward [pulses]. */
int32_t dda_largest(int32_t ticks);

/* Pulses that `command` has put out after `tick` of its ticks, signed [pulses]. */
int64_t dda_pulses(int32_t command, int32_t ticks, int64_t tick);

/* Tick of the j-th pulse, j = 1 .. |command|. */
int64_t dda_edge_tick(int32_t command, int32_t ticks, int32_t j);

/* Stand at clock 0, running, at the beginning of an idle DDA time. */
void dda_reset(struct dda *d, int32_t channels, int32_t ticks, int32_t divider);

/* Ask for another DDA time. It holds from the next boundary on; at the very clock at which an idle
 * DDA time begins (as after reset) it holds for that one already. */
void dda_set_time(struct dda *d, int32_t ticks, int32_t divider, int64_t clock);

/* Switch the divider: off, everything stands still; on, the DDA time goes on where it stood. */
void dda_set_run(struct dda *d, bool run, int64_t clock);

/* Clock of the next boundary; INT64_MAX while stopped. */
int64_t dda_boundary(const struct dda *d);

/* At the boundary: end this DDA time and begin the next with a command for each channel. */
void dda_begin(struct dda *d, const int32_t *command);

/* Pulses of each channel, put out up to and including `clock` of the DDA time in progress, since
 * reset [pulses]. */
void dda_counts(const struct dda *d, int64_t clock, int64_t *counts);

/* Clock of the j-th pulse of the DDA time in progress; -1 if it has no such pulse or is stopped. */
int64_t dda_edge_clock(const struct dda *d, int channel, int32_t j);

#endif
