#include "active_codes.h"

#include <string.h>

#include "gcode.h"
#include "tools.h"

int32_t active_system(const struct interpreter *in)
{
    return in->system + 1;
}

_Static_assert(PATH_YZ == 0 && PATH_ZX == 1 && PATH_XY == 2, "G19, G18, G17");

static int32_t system_code(const struct interpreter *in)
{
    return in->system < 6                     ? 540 + 10 * in->system
           : in->system < INTERPRETER_SYSTEMS ? 585 + in->system
                                              : GCODE_MORE;
}

static int32_t cutter_code(const struct interpreter *in)
{
    return in->cutter.side > 0 ? 410 : in->cutter.side < 0 ? 420 : 400;
}

void active_codes(const struct interpreter *in, int32_t codes[ACTIVE_CODES])
{
    const struct words *w = &in->words;
    const int32_t found[ACTIVE_CODES] = {
        in->motion,
        190 - 10 * (int32_t)in->plane,
        in->incremental ? 910 : 900,
        in->absolute_centre ? 901 : 911,
        w->feed_mode,
        in->inch ? 200 : 210,
        cutter_code(in),
        tools_any_length(in) ? 430 : 490,
        system_code(in),
        in->blend ? 640 : 610,
        in->cycle.to_r ? 990 : 980,
        in->switches.by_radius ? 960 : 970,
        w->scaled ? 510 : 500,
        w->rotated ? 680 : 690,
        w->polar ? 160 : 150,
        in->shifted ? 920 : -1,
    };
    memcpy(codes, found, sizeof found);
}
