/* job_header - first page of a job file (.mcj): period, axes, counts, limits and end position of
 * the job, with its table of output events; and the faults that a job file can have.
 *
 *     0 "MCJ1"   4 u16 version   6 u16 page bytes   8 u32 id   12 u32 period_ns   16 u8 axes
 *     17 u8 rest   20 u32 pages   24 u32 frames   28 u32 events   32 u32[4] pulses_per_m
 *     48 u32[4] speed_max
 *     64 u32[4] acc_max   80 u64[4] jerk_max   112 i32[4] end   128 u8[32] origin
 *     160 11 x {u16 pins, u8 mode, u8 level, u32 width_us}   252 u32 CRC-32 of the 252 before
 *
 * Numbers are little-endian, what is not named is 0.
 */
#ifndef JOB_HEADER_H
#define JOB_HEADER_H

#include <stdbool.h>
#include <stdint.h>

enum {
    JOB_AXES = 4,
    JOB_PAGE_BYTES = 256,
    JOB_CRC_AT = 252, /* place in each page of the CRC of the bytes before */
    JOB_EVENTS = 11,  /* size of the table of events */
    JOB_ORIGIN_BYTES = 32,
    JOB_VERSION = 1,
    JOB_CLOCK_NS = 20, /* clock of the card; a period is a whole number of clocks */
    JOB_PERIOD_MIN_NS = 250000,
    JOB_PERIOD_MAX_NS = 10000000,
    JOB_WIDTH_MAX_US = 1000000, /* longest pulse of an event */
    JOB_COMMAND_MAX = 32767,    /* [pulses] a frame has 16 bits per axis */
};

/* Faults of a job file, each with its text. */
#define JOB_FAULT_TEXTS(X) \
    X(JOB_GOOD, "whole") \
    /* no whole number of pages, or not as many as the header says */ \
    X(JOB_SIZE, "its size is not that of its pages") \
    X(JOB_CRC, "a page does not have its CRC") \
    X(JOB_MAGIC, "it does not begin with MCJ1") \
    X(JOB_FORMAT, "another version or page size") \
    X(JOB_ID, "its number is not that of its origin") \
    X(JOB_PERIOD, "the period is out of range") /* or no whole number of clocks */ \
    X(JOB_MASK, "the mask of axes is none")     /* or more than four axes */ \
    /* header: no page or frame, more frames than the pages hold, too many events */ \
    X(JOB_COUNT, "the counts of pages, frames and events do not fit") \
    /* an event with a bad member; a frame's or the rest's is not in the table */ \
    X(JOB_EVENT, "an event is bad or not in the table") \
    /* a byte without meaning is not 0 (header) or FF (behind a payload) */ \
    X(JOB_FILL, "a byte without meaning is set") \
    /* a page does not begin with the frame it should, or has none */ \
    X(JOB_FRAMES, "a frame number is not the next one") \
    /* a number that does not end, is not the shortest, or does not fill the page */ \
    X(JOB_VARINT, "a number in a page is bad") \
    /* a command above half the clocks of a period or above 32767 */ \
    X(JOB_COMMAND, "a command is out of range") \
    /* a page does not begin where the one before ended, or 2^31 or more */ \
    X(JOB_POSITION, "a position is not where the page before ended") \
    /* the first or the last command is above the start speed */ \
    X(JOB_REST, "it does not begin and end at rest") \
    /* the last frame is not the header's, or does not end where it says */ \
    X(JOB_END, "it does not end where its header says")

#define JOB_FAULT_ENTRY(name, text) name,
enum job_fault { JOB_FAULT_TEXTS(JOB_FAULT_ENTRY) JOB_FAULTS };

struct job_event {
    uint16_t pins;     /* a bit each */
    uint8_t mode;      /* 0 level, 1 pulse */
    uint8_t level;     /* 1: active high */
    uint32_t width_us; /* [us] of a pulse, 1 .. JOB_WIDTH_MAX_US; 0 for a level */
};

struct job_header {
    uint32_t id;        /* first four bytes of origin */
    uint32_t period_ns; /* [ns] of a frame */
    uint32_t axes;      /* bit mask of the axes that the frames contain */
    uint32_t rest;      /* event to be done when the job is aborted; 0 none */
    uint32_t pages;     /* number of data pages */
    uint32_t frames;    /* number of frames */
    uint32_t events;    /* number of events in the table, which are numbered 1 .. events */
    uint32_t pulses_per_m[JOB_AXES];  /* [pulses/m] scale */
    uint32_t speed_max[JOB_AXES];     /* [pulses/s] largest planned speed */
    uint32_t acc_max[JOB_AXES];       /* [pulses/s^2] limit for the card's own ramps */
    uint64_t jerk_max[JOB_AXES];      /* [pulses/s^3] limit for the card's own ramps */
    int32_t end[JOB_AXES];            /* [pulses] position after the last frame; it begins at 0 */
    uint8_t origin[JOB_ORIGIN_BYTES]; /* SHA-256 of the drawing and the settings */
    struct job_event event[JOB_EVENTS];
};

/* Read the header page. On a fault *h is all 0. */
enum job_fault job_header_read(struct job_header *h, const uint8_t page[JOB_PAGE_BYTES]);

/* Write the header page. The id is taken from the origin; the other members are written as they
 * are. */
void job_header_write(const struct job_header *h, uint8_t page[JOB_PAGE_BYTES]);

/* Largest command of an axis [pulses] in a frame: half the clocks of a period, at most
 * JOB_COMMAND_MAX. */
int32_t job_command_max(uint32_t period_ns);

/* Whether a page, of either kind, has the right CRC; write its CRC. */
bool job_page_whole(const uint8_t page[JOB_PAGE_BYTES]);
void job_page_seal(uint8_t page[JOB_PAGE_BYTES]);

/* Text for a fault, for messages. */
const char *job_fault_text(enum job_fault fault);

#endif
