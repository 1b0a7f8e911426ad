/* job_page - a data page: some frames, each the pulses of a period.
 *
 *     0 u32 first frame   4 i32[4] position at its begin   20 u16 frames   22 u16 payload bytes
 *     24 payload, FF behind it   252 u32 CRC-32
 *
 * The payload has, frame by frame, for each axis of the mask the difference of its command to that
 * of the frame before (of the first frame: to 0) as zigzag varint. The number of the first axis is
 * shifted left once more; its bit 0 says that a byte with the number of an event follows behind
 * the axes. The event acts at the begin of its frame.
 */
#ifndef JOB_PAGE_H
#define JOB_PAGE_H

#include "job_header.h"

enum {
    JOB_PAYLOAD_AT = 24,
    JOB_PAYLOAD = JOB_CRC_AT - JOB_PAYLOAD_AT,
    JOB_PAGE_FRAMES = JOB_PAYLOAD,     /* at most: one axis, a byte each */
    JOB_FRAME_BYTES = 3 * JOB_AXES + 1 /* at most: differences of 2 * 32767, an event */
};

struct job_frame {
    int32_t command[JOB_AXES]; /* [pulses] */
    int32_t event;             /* 1 .. events; 0 none */
};

struct job_page {
    uint32_t first;             /* frame number */
    int32_t position[JOB_AXES]; /* [pulses] at its begin */
    int32_t frames;             /* 1 .. JOB_PAGE_FRAMES */
    struct job_frame frame[JOB_PAGE_FRAMES];
};

/* Read a page of the job of this header. Not good: p->frames is 0. Positions at the begins and ends
 * of its frames are below 2^31. */
enum job_fault job_page_read(struct job_page *p, const struct job_header *h,
                             const uint8_t bytes[JOB_PAGE_BYTES]);

/* Write a frame behind another (NULL: the first of a page). Returns its bytes. Commands are at
 * most JOB_COMMAND_MAX. */
int32_t job_frame_pack(uint8_t bytes[JOB_FRAME_BYTES], const struct job_frame *frame,
                       const struct job_frame *before, uint32_t axes);

/* Add a frame's command to a position. False: 2^31 or more, nothing is added. */
bool job_frame_move(int32_t position[JOB_AXES], const struct job_frame *frame);

#endif
