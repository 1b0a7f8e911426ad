/* commanded_path - the commanded points of the latest frames, and the point nearest to the tool on
 * the path that they make.
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
    COMMANDED_PATH_AHEAD = 2   /* frames that the tool may be ahead of the one being put out */
};

/* The end of a frame. */
struct commanded_path_point {
    double place[3];    /* [mm] X Y Z, without compensation */
    double speed[AXES]; /* [pulses/s] during the frame, with compensation */
    int32_t added[3];   /* [pulses] compensation since the start */
};

struct commanded_path {
    struct commanded_path_point point[COMMANDED_PATH_SIZE];
    int64_t frames; /* taken so far; that number's end is the latest point */
    int64_t first;  /* the oldest whose point is there; 0 is the start */
    int64_t foot;   /* the nearest point lies between this one and the next */
};

/* Where the tool is nearest to the path. */
struct commanded_path_foot {
    double error[3];   /* [mm] from the tool to the path, across it */
    double tangent[3]; /* of the path there; 0 where it has no direction yet */
};

/* A path that has only its start. */
void commanded_path_start(struct commanded_path *t, const double place[3]);

/* The card has taken one more frame. */
void commanded_path_push(struct commanded_path *t, const struct commanded_path_point *p);

/* The point of a frame; the oldest, if it is gone. */
const struct commanded_path_point *commanded_path_at(const struct commanded_path *t, int64_t frame);

/* The point nearest to a place [mm] on the path, up to COMMANDED_PATH_AHEAD frames after `frame`.
 * It never goes back along the path; of equal distances the first counts. */
struct commanded_path_foot commanded_path_nearest(struct commanded_path *t, const double place[3],
                                                  int64_t frame);

#endif
