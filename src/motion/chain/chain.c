#include "chain.h"

#include <string.h>

#include "vector3.h"

/* Axes and rotations of a description have so many digits. */
static const double UNIT_LENGTH = 1e-9;

static bool is_rotation(const double m[3][3])
{
    double across[3];

    vector3_cross(m[0], m[1], across);
    bool good = true;
    for (int i = 0; i < 3; i++) {
        good = good && fabs(across[i] - m[2][i]) <= UNIT_LENGTH;
        good = good && fabs(vector3_length(m[i]) - 1.0) <= UNIT_LENGTH;
    }
    return good && fabs(vector3_dot(m[0], m[1])) <= UNIT_LENGTH;
}

bool chain_good(const struct chain *c)
{
    bool good = c->joints >= 1 && c->joints <= CHAIN_JOINTS;

    for (int i = 0; good && i < c->joints; i++) {
        const struct chain_joint *j = &c->joint[i];
        good = isfinite(vector3_dot(j->origin, j->origin))
               && fabs(vector3_length(j->axis) - 1.0) <= UNIT_LENGTH && j->level >= 0
               && j->level <= i;
    }
    return good && isfinite(vector3_dot(c->flange.at, c->flange.at)) && is_rotation(c->flange.turn);
}

void chain_axes_at(const struct chain *c, const double joint[CHAIN_JOINTS], struct chain_axes *s,
                   struct chain_pose *pose)
{
    /* Rotation behind so many joints. */
    double turned[CHAIN_JOINTS + 1][3][3] = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } };
    double at[3] = { 0.0, 0.0, 0.0 }, way[3];

    for (int i = 0; i < c->joints; i++) {
        const struct chain_joint *j = &c->joint[i];
        const double(*before)[3] = (const double(*)[3])turned[i];
        vector3_by(before, j->origin, way);
        vector3_add(at, 1.0, way, at);
        before = (const double(*)[3])turned[i - j->level];
        vector3_by(before, j->axis, s->axis[i]);
        memcpy(s->origin[i], at, sizeof at);
        if (j->slides) {
            vector3_add(at, joint[i], s->axis[i], at);
            memcpy(turned[i + 1], before, sizeof turned[0]);
        } else {
            double own[3][3];
            vector3_matrix(j->axis, el_sincos(joint[i]), own);
            vector3_product(before, (const double(*)[3])own, turned[i + 1]);
        }
    }
    const double(*last)[3] = (const double(*)[3])turned[c->joints];
    vector3_by(last, c->flange.at, way);
    vector3_add(at, 1.0, way, pose->at);
    vector3_product(last, c->flange.turn, pose->turn);
}

void chain_forward(const struct chain *c, const double joint[CHAIN_JOINTS], struct chain_pose *pose)
{
    struct chain_axes s;

    chain_axes_at(c, joint, &s, pose);
}

int chain_levelled(const struct chain *c, int k)
{
    for (int i = k + 1; i < c->joints; i++) {
        if (i - c->joint[i].level <= k) {
            return i;
        }
    }
    return -1;
}

void chain_column(const struct chain *c, const struct chain_axes *axes, int k, const double at[3],
                  double column[6])
{
    const int pivot = chain_levelled(c, k);
    double arm[3];

    memset(column, 0, 6 * sizeof *column);
    if (c->joint[k].slides) {
        memcpy(column, axes->axis[k], sizeof arm);
        return;
    }
    vector3_add(pivot < 0 ? at : axes->origin[pivot], -1.0, axes->origin[k], arm);
    vector3_cross(axes->axis[k], arm, column);
    if (pivot < 0) {
        memcpy(column + 3, axes->axis[k], sizeof arm);
    }
}

void chain_jacobian(const struct chain *c, const double joint[CHAIN_JOINTS],
                    struct chain_pose *pose, double column[CHAIN_JOINTS][6])
{
    struct chain_axes s;

    chain_axes_at(c, joint, &s, pose);
    for (int k = 0; k < c->joints; k++) {
        chain_column(c, &s, k, pose->at, column[k]);
    }
}
