/* commanded_path - the path of the latest commanded points, and the point on it that is nearest to
 * the tool: what cross-coupled control measures the contour error from.
 *
 * Frames are numbered as the card takes them. Between two points the path is the circle through
 * them and their neighbours where these turn alike, else the straight line; so lines and circles
 * are exact at any speed, and corners stay corners.
 */
#ifndef COMMANDED_PATH_H
#define COMMANDED_PATH_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

enum {
    COMMANDED_PATH_SIZE = 512, /* frames: the FIFO and some 0.4 s behind it */
    COMMANDED_PATH_AHEAD = 2   /* frames by which the tool may be ahead of the one being put out */
};

/* The commanded point at the end of a frame. */
struct commanded_path_point {
    double place[3];    /* [mm] X Y Z, without compensation */
    double speed[AXES]; /* [pulses/s] during the frame, with compensation */
    int32_t added[3];   /* [pulses] compensation added since the path's start */
};

struct commanded_path {
    struct commanded_path_point point[COMMANDED_PATH_SIZE];
    int64_t frames; /* frames taken so far, which is the number of the latest point */
    int64_t first;  /* number of the oldest point still kept; 0 is the start */
    int64_t foot;   /* the nearest point lies between the point of this number and the next */
};

/* The point of the path nearest to the tool. */
struct commanded_path_foot {
    double error[3];   /* [mm] from the tool to the path, across it */
    double tangent[3]; /* unit tangent of the path there; 0 where it has no direction yet */
};

/* Begin a path, which has only its start [mm] yet. */
void commanded_path_start(struct commanded_path *t, const double place[3]);

/* Append the end of a frame that the card has taken. */
void commanded_path_push(struct commanded_path *t, const struct commanded_path_point *p);

/* The point of a frame, or the oldest one kept if that is gone. */
const struct commanded_path_point *commanded_path_at(const struct commanded_path *t, int64_t frame);

/* The point nearest to a place [mm] on the path, up to COMMANDED_PATH_AHEAD frames after `frame`.
 * It never goes back along the path; of equal distances the first counts. */
struct commanded_path_foot commanded_path_nearest(struct commanded_path *t, const double place[3],
                                                  int64_t frame);

#endif
