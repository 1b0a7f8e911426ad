#include "job_header.h"

#include <string.h>

#include "job_bytes.h"
#include "job_page.h"
#include "net_crc.h"

enum {
    ID_AT = 8,
    RATES_AT = 32,
    JERK_AT = 80,
    END_AT = 112,
    ORIGIN_AT = 128,
    EVENTS_AT = 160,
    EVENT_BYTES = 8,
    EVENTS_END = EVENTS_AT + JOB_EVENTS * EVENT_BYTES
};

bool job_page_whole(const uint8_t page[JOB_PAGE_BYTES])
{
    return net_crc(0, page, JOB_CRC_AT) == job_get32(page + JOB_CRC_AT);
}

void job_page_seal(uint8_t page[JOB_PAGE_BYTES])
{
    job_put(page + JOB_CRC_AT, net_crc(0, page, JOB_CRC_AT), 4);
}

int32_t job_command_max(uint32_t period_ns)
{
    const uint32_t half = period_ns / JOB_CLOCK_NS / 2;
    return half < JOB_COMMAND_MAX ? (int32_t)half : JOB_COMMAND_MAX;
}

static void get_rates(uint32_t rates[JOB_AXES], const uint8_t *at)
{
    for (int i = 0; i < JOB_AXES; i++)
        rates[i] = job_get32(at + 4 * i);
}

static enum job_fault read_events(struct job_header *h, const uint8_t page[JOB_PAGE_BYTES])
{
    for (uint32_t k = 0; k < JOB_EVENTS; k++) {
        const uint8_t *at = page + EVENTS_AT + EVENT_BYTES * k;
        const struct job_event e = { (uint16_t)job_get(at, 2), at[2], at[3], job_get32(at + 4) };
        const bool none = !e.pins && !e.mode && !e.level && !e.width_us;
        const bool good =
            e.mode <= 1 && e.level <= 1
            && (e.mode ? e.width_us >= 1 && e.width_us <= JOB_WIDTH_MAX_US : e.width_us == 0);
        if (k < h->events ? !good : !none)
            return JOB_EVENT;
        h->event[k] = e;
    }
    return JOB_GOOD;
}

static enum job_fault judge(const struct job_header *h)
{
    if (h->period_ns < JOB_PERIOD_MIN_NS || h->period_ns > JOB_PERIOD_MAX_NS
        || h->period_ns % JOB_CLOCK_NS)
        return JOB_PERIOD;
    if (h->axes == 0 || h->axes >> JOB_AXES)
        return JOB_MASK;
    if (h->pages == 0 || h->frames < h->pages || h->events > JOB_EVENTS
        || (h->frames - 1) / JOB_PAGE_FRAMES >= h->pages)
        return JOB_COUNT;
    return h->rest > h->events ? JOB_EVENT : JOB_GOOD;
}

static enum job_fault read_page(struct job_header *h, const uint8_t page[JOB_PAGE_BYTES])
{
    memset(h, 0, sizeof *h);
    if (memcmp(page, "MCJ1", 4))
        return JOB_MAGIC;
    if (!job_page_whole(page))
        return JOB_CRC;
    if (job_get(page + 4, 2) != JOB_VERSION || job_get(page + 6, 2) != JOB_PAGE_BYTES)
        return JOB_FORMAT;
    h->id = job_get32(page + ID_AT);
    h->period_ns = job_get32(page + 12);
    h->axes = page[16];
    h->rest = page[17];
    h->pages = job_get32(page + 20);
    h->frames = job_get32(page + 24);
    h->events = job_get32(page + 28);
    get_rates(h->pulses_per_m, page + RATES_AT);
    get_rates(h->speed_max, page + RATES_AT + 16);
    get_rates(h->acc_max, page + RATES_AT + 32);
    for (int i = 0; i < JOB_AXES; i++) {
        h->jerk_max[i] = job_get(page + JERK_AT + 8 * i, 8);
        h->end[i] = job_get_signed(page + END_AT + 4 * i);
    }
    memcpy(h->origin, page + ORIGIN_AT, JOB_ORIGIN_BYTES);
    if (memcmp(page + ID_AT, page + ORIGIN_AT, 4))
        return JOB_ID;
    if (job_get(page + 18, 2) || job_get32(page + EVENTS_END))
        return JOB_FILL;
    const enum job_fault fault = judge(h);
    return fault ? fault : read_events(h, page);
}

enum job_fault job_header_read(struct job_header *h, const uint8_t page[JOB_PAGE_BYTES])
{
    const enum job_fault fault = read_page(h, page);
    if (fault)
        memset(h, 0, sizeof *h);
    return fault;
}

void job_header_write(const struct job_header *h, uint8_t page[JOB_PAGE_BYTES])
{
    memset(page, 0, JOB_PAGE_BYTES);
    memcpy(page, "MCJ1", 4);
    job_put(page + 4, JOB_VERSION, 2);
    job_put(page + 6, JOB_PAGE_BYTES, 2);
    memcpy(page + ID_AT, h->origin, 4);
    job_put(page + 12, h->period_ns, 4);
    job_put(page + 16, h->axes, 1);
    job_put(page + 17, h->rest, 1);
    job_put(page + 20, h->pages, 4);
    job_put(page + 24, h->frames, 4);
    job_put(page + 28, h->events, 4);
    for (int i = 0; i < JOB_AXES; i++) {
        job_put(page + RATES_AT + 4 * i, h->pulses_per_m[i], 4);
        job_put(page + RATES_AT + 16 + 4 * i, h->speed_max[i], 4);
        job_put(page + RATES_AT + 32 + 4 * i, h->acc_max[i], 4);
        job_put(page + JERK_AT + 8 * i, h->jerk_max[i], 8);
        job_put(page + END_AT + 4 * i, (uint32_t)h->end[i], 4);
    }
    memcpy(page + ORIGIN_AT, h->origin, JOB_ORIGIN_BYTES);
    for (uint32_t k = 0; k < h->events && k < JOB_EVENTS; k++) {
        uint8_t *at = page + EVENTS_AT + EVENT_BYTES * k;
        job_put(at, h->event[k].pins, 2);
        at[2] = h->event[k].mode;
        at[3] = h->event[k].level;
        job_put(at + 4, h->event[k].width_us, 4);
    }
    job_page_seal(page);
}

/* A table of the texts themselves; pointers to them would need relocation in a shared library. */
#define ROW(name, text)  [name] = text,
#define FITS(name, text) _Static_assert(sizeof text <= sizeof TEXT[0], #name " is too long");
static const char TEXT[JOB_FAULTS][50] = { JOB_FAULT_TEXTS(ROW) };
JOB_FAULT_TEXTS(FITS)

const char *job_fault_text(enum job_fault fault)
{
    return (uint32_t)fault < JOB_FAULTS ? TEXT[fault] : "unknown";
}
