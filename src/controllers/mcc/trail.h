/* trail - the commanded points of the latest frames, and the nearest point on the path they make.
 *
 * Frames are numbered as the card takes them. Between two points the path is the circle through
 * them and their neighbours where these turn alike, else the straight line; so lines and circles
 * are exact at any speed, and corners stay corners.
 */
#ifndef TRAIL_H
#define TRAIL_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

enum {
    TRAIL_SIZE = 512, /* frames: the FIFO and some 0.4 s behind it */
    TRAIL_AHEAD = 2   /* frames that the tool may be ahead of the one being put out */
};

/* The end of a frame. */
struct trail_point {
    double place[3];    /* [mm] X Y Z, without compensation */
    double speed[AXES]; /* [pulses/s] during the frame, with compensation */
    int32_t added[3];   /* [pulses] compensation since the start */
};

struct trail {
    struct trail_point point[TRAIL_SIZE];
    int64_t frames; /* taken so far; that number's end is the latest point */
    int64_t first;  /* the oldest whose point is there; 0 is the start */
    int64_t foot;   /* the nearest point lies between this one and the next */
};

/* Where the tool is nearest to the path. */
struct trail_foot {
    double error[3];   /* [mm] from the tool to the path, across it */
    double tangent[3]; /* of the path there; 0 where it has no direction yet */
};

/* A path that has only its start. */
void trail_start(struct trail *t, const double place[3]);

/* The card has taken one more frame. */
void trail_push(struct trail *t, const struct trail_point *p);

/* The point of a frame; the oldest, if it is gone. */
const struct trail_point *trail_at(const struct trail *t, int64_t frame);

/* Nearest point to a place [mm], on the path up to a frame and TRAIL_AHEAD more. It never goes
 * back along the path, and of equal distances the first counts. */
struct trail_foot trail_nearest(struct trail *t, const double place[3], int64_t frame);

#endif
