#include "resuming.h"

#include <string.h>

#include "cutter.h"
#include "gcode.h"

/* Forget commands that are made and not handed out, and what waits for later lines. */
static void forget(struct interpreter *in)
{
    cutter_drop(in);
    in->rounding.waits = in->rounding.fresh = false;
    in->nurbs.count = 0;
    in->nurbs.running = in->cycle.running = in->waits = false;
    in->words.spline = false;
    in->taken = in->count = 0;
    in->set = in->clear = in->analog.set = 0;
}

void resuming_end(struct interpreter *in, double feed)
{
    struct words *w = &in->words;

    forget(in);
    in->motion = GCODE_NO_MOTION;
    in->plane = PATH_XY;
    in->incremental = false;
    in->system = 0;
    in->cycle.code = 0;
    w->scaled = w->rotated = w->polar = false;
    in->feed = w->feed_mode == 940 ? in->feed : feed;
    w->feed_mode = 940;
    w->per_turn = 0.0;
}

void resuming_defaults(struct interpreter *in, double feed)
{
    resuming_end(in, feed);
    in->inch = in->absolute_centre = in->blend = false;
    in->tolerance = in->merge = 0.0;
    in->cycle.to_r = in->switches.by_radius = false;
    in->feed = feed;
}

void resuming_text(struct interpreter *in, int64_t offset, int32_t line)
{
    in->offset = offset;
    in->line = line;
    in->file = 0;
    in->ended = in->percent = false;
    flow_drop(in);
    memset(in->saved, 0, sizeof in->saved);
}

void resuming_place(struct interpreter *in, const double point[AXES])
{
    forget(in);
    memcpy(in->point, point, sizeof in->point);
}

bool resuming_held(const struct interpreter *in)
{
    return in->cutter.count > 0 || in->cutter.side != 0 || in->cutter.aside || in->rounding.waits
           || in->nurbs.count > 0;
}
