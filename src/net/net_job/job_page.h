/* job_page - data page of a job file: a number of frames, each with the pulses of all axes in one
 * period. A page can be read and checked by itself.
 *
 *     0 u32 first frame   4 i32[4] position at its begin   20 u16 frames   22 u16 payload bytes
 *     24 payload, FF behind it   252 u32 CRC-32
 *
 * The payload has, frame by frame and for each axis of the mask, the difference of the command to
 * that of the frame before (in the first frame: to 0) as a zigzag varint. The number of the first
 * axis is shifted left once more; its bit 0 says that a byte with the number of an event follows
 * the axes. The event acts at the begin of its frame.
 */
#ifndef JOB_PAGE_H
#define JOB_PAGE_H

#include "job_header.h"

enum {
    JOB_PAYLOAD_AT = 24,
    JOB_PAYLOAD = JOB_CRC_AT - JOB_PAYLOAD_AT,
    JOB_PAGE_FRAMES = JOB_PAYLOAD,     /* most frames: those of one axis, a byte each */
    JOB_FRAME_BYTES = 3 * JOB_AXES + 1 /* most bytes of a frame: differences of 2 * 32767, event */
};

struct job_frame {
    int32_t command[JOB_AXES]; /* [pulses] */
    int32_t event;             /* number of an event, 1 .. events; 0 none */
};

struct job_page {
    uint32_t first;             /* number of its first frame in the job */
    int32_t position[JOB_AXES]; /* [pulses] at the begin of that frame */
    int32_t frames;             /* number of frames, 1 .. JOB_PAGE_FRAMES */
    struct job_frame frame[JOB_PAGE_FRAMES];
};

/* Read a data page of the job with this header. On a fault p->frames is 0. JOB_POSITION if
 * |position| reaches 2^31 at the begin or end of a frame. */
enum job_fault job_page_read(struct job_page *p, const struct job_header *h,
                             const uint8_t bytes[JOB_PAGE_BYTES]);

/* Encode a frame that follows `before` (NULL: it is the first of a page), with commands of at most
 * JOB_COMMAND_MAX. Returns the number of bytes. */
int32_t job_frame_pack(uint8_t bytes[JOB_FRAME_BYTES], const struct job_frame *frame,
                       const struct job_frame *before, uint32_t axes);

/* Add a frame's commands to a position [pulses]. False, and nothing added, if one would reach
 * +-2^31. */
bool job_frame_move(int32_t position[JOB_AXES], const struct job_frame *frame);

#endif
