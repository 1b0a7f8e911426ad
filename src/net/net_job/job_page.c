#include "job_page.h"

#include <string.h>

#include "job_bytes.h"

enum { VARINT_BYTES = 3 }; /* 4 * 32767 zigzagged twice over: below 2^21 */

/* The part of a payload that has not been read yet. */
struct stream {
    const uint8_t *at;
    int32_t left;
};

static bool read_varint(struct stream *s, uint32_t *value)
{
    *value = 0;
    for (int k = 0; k < VARINT_BYTES && k < s->left; k++) {
        const uint8_t byte = s->at[k];
        *value |= (uint32_t)(byte & 0x7f) << 7 * k;
        if (byte < 0x80) {
            s->at += k + 1;
            s->left -= k + 1;
            return byte || k == 0; /* a last byte of 0 is not the shortest encoding */
        }
    }
    return false;
}

static int32_t write_varint(uint8_t *at, uint32_t value)
{
    int32_t n = 0;
    for (; value >= 0x80; value >>= 7)
        at[n++] = (uint8_t)(value | 0x80);
    at[n++] = (uint8_t)value;
    return n;
}

/* Zigzag code: 0, -1, 1, -2 ... become 0, 1, 2, 3 ... */
static uint32_t zigzag(int32_t difference)
{
    return difference < 0 ? 2 * (uint32_t)-difference - 1 : 2 * (uint32_t)difference;
}

static int32_t from_zigzag(uint32_t number)
{
    return number & 1 ? -(int32_t)(number >> 1) - 1 : (int32_t)(number >> 1);
}

bool job_frame_move(int32_t position[JOB_AXES], const struct job_frame *frame)
{
    int32_t to[JOB_AXES];
    for (int i = 0; i < JOB_AXES; i++) {
        const int64_t sum = (int64_t)position[i] + frame->command[i];
        if (sum < -INT32_MAX || sum > INT32_MAX)
            return false;
        to[i] = (int32_t)sum;
    }
    memcpy(position, to, sizeof to);
    return true;
}

static enum job_fault read_frame(struct stream *s, const struct job_header *h, int32_t most,
                                 const struct job_frame *before, struct job_frame *frame)
{
    bool first = true, event = false;
    *frame = (struct job_frame){ 0 };
    for (int i = 0; i < JOB_AXES; i++) {
        uint32_t number;
        if (!(h->axes >> i & 1))
            continue;
        if (!read_varint(s, &number))
            return JOB_VARINT;
        if (first) {
            event = number & 1;
            number >>= 1;
        }
        first = false;
        const int32_t command = before->command[i] + from_zigzag(number);
        if (command < -most || command > most)
            return JOB_COMMAND;
        frame->command[i] = command;
    }
    if (!event)
        return JOB_GOOD;
    if (s->left < 1)
        return JOB_VARINT;
    frame->event = *s->at++;
    s->left--;
    return frame->event >= 1 && (uint32_t)frame->event <= h->events ? JOB_GOOD : JOB_EVENT;
}

static enum job_fault read_page(struct job_page *p, const struct job_header *h,
                                const uint8_t bytes[JOB_PAGE_BYTES])
{
    if (!job_page_whole(bytes))
        return JOB_CRC;
    const int32_t frames = (int32_t)job_get(bytes + 20, 2);
    const int32_t payload = (int32_t)job_get(bytes + 22, 2);
    p->first = job_get32(bytes);
    if (frames < 1 || frames > JOB_PAGE_FRAMES || p->first >= h->frames
        || (uint32_t)frames > h->frames - p->first)
        return JOB_FRAMES;
    if (payload > JOB_PAYLOAD)
        return JOB_VARINT;
    for (int32_t k = JOB_PAYLOAD_AT + payload; k < JOB_CRC_AT; k++)
        if (bytes[k] != 0xff)
            return JOB_FILL;
    int32_t position[JOB_AXES];
    for (int i = 0; i < JOB_AXES; i++) {
        position[i] = p->position[i] = job_get_signed(bytes + 4 + 4 * i);
        if (position[i] == INT32_MIN)
            return JOB_POSITION;
    }
    struct stream s = { bytes + JOB_PAYLOAD_AT, payload };
    struct job_frame before = { 0 };
    const int32_t most = job_command_max(h->period_ns);
    for (int32_t k = 0; k < frames; k++) {
        const enum job_fault fault = read_frame(&s, h, most, &before, &p->frame[k]);
        if (fault)
            return fault;
        before = p->frame[k];
        if (!job_frame_move(position, &before))
            return JOB_POSITION;
    }
    p->frames = frames;
    return s.left ? JOB_VARINT : JOB_GOOD;
}

enum job_fault job_page_read(struct job_page *p, const struct job_header *h,
                             const uint8_t bytes[JOB_PAGE_BYTES])
{
    const enum job_fault fault = read_page(p, h, bytes);
    if (fault)
        p->frames = 0;
    return fault;
}

int32_t job_frame_pack(uint8_t bytes[JOB_FRAME_BYTES], const struct job_frame *frame,
                       const struct job_frame *before, uint32_t axes)
{
    int32_t n = 0;
    for (int i = 0; i < JOB_AXES; i++) {
        if (!(axes >> i & 1))
            continue;
        uint32_t number = zigzag(frame->command[i] - (before ? before->command[i] : 0));
        if (n == 0)
            number = 2 * number + (frame->event != 0);
        n += write_varint(bytes + n, number);
    }
    if (frame->event)
        bytes[n++] = (uint8_t)frame->event;
    return n;
}
