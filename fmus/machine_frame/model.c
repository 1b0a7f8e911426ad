/* Guides that are not square. X lies along its guide and the guide of Y in the plane XY; to the
 * first order in the angles, whose squares are 1e-8 on the worst of machines,
 *
 *     x = X - xy Y - zx Z,   y = Y - yz Z,   z = Z
 */
#include <string.h>

#include "vars.h"

struct model {
    bool unused; /* the tool is where the inputs say */
};

#include "fmi_model.h"

static int model_start(struct fmu *f)
{
    struct vars *v = &f->s.v;
    const double *a = v->axis_position;

    (void)fmu_fail; /* nothing here can fail */
    memcpy(v->tool_position, a, sizeof v->tool_position);
    v->tool_position[0] = a[0] - (v->squareness_xy * a[1] + v->squareness_zx * a[2]);
    v->tool_position[1] = a[1] - v->squareness_yz * a[2];
    return 0;
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    (void)t0;
    (void)t1;
    return model_start(f);
}
