/* Arms of each kind for the tests of chain. */
#ifndef CHAIN_RIG_H
#define CHAIN_RIG_H

#include <stdbool.h>
#include <string.h>

#include "chain_inverse.h"
#include "check.h"

struct rig {
    const char *name;
    int joints, held;
    enum chain_kind kind;
    bool reversed;
    double origin[CHAIN_JOINTS][3]; /* [m] */
    double axis[CHAIN_JOINTS][3];   /* of any length */
    unsigned slides;                /* a bit each */
    int level;                      /* of the last joint */
    double flange[3];               /* [m] */
    int fore;                       /* level of joint 3 of a palletizer */
};

#define X { 1, 0, 0 }
#define Y { 0, 1, 0 }
#define Z { 0, 0, 1 }
#define O { 0, 0, 0 }

static const struct rig RIGS[] = {
    { "IRB 2600",
      6,
      CHAIN_NONE,
      CHAIN_WRIST_PARALLEL,
      false,
      { { 0, 0, .445 },
        { .15, 0, 0 },
        { 0, 0, .7 },
        { 0, 0, .115 },
        { .795, 0, 0 },
        { .085, 0, 0 } },
      { Z, Y, Y, X, Y, X },
      0,
      0,
      O,
      0 },
    { "UR5e",
      6,
      CHAIN_NONE,
      CHAIN_THREE_PARALLEL,
      false,
      { { 0, 0, .1625 },
        O,
        { -.425, 0, 0 },
        { -.3922, -.1333, 0 },
        { 0, 0, -.0997 },
        { 0, -.0996, 0 } },
      { Z, { 0, -1, 0 }, { 0, -1, 0 }, { 0, -1, 0 }, { 0, 0, -1 }, { 0, -1, 0 } },
      0,
      0,
      O,
      0 },
    { "UR5e backwards",
      6,
      CHAIN_NONE,
      CHAIN_THREE_PARALLEL,
      true,
      { O, { 0, .0996, 0 }, { 0, 0, .0997 }, { .3922, .1333, 0 }, { .425, 0, 0 }, O },
      { Y, Z, Y, Y, { 0, -1, 0 }, Z },
      0,
      0,
      { 0, 0, .1625 },
      0 },
    { "axes 1 and 2 meet",
      6,
      CHAIN_NONE,
      CHAIN_WRIST_SHOULDER,
      false,
      { { 0, 0, .4 }, O, { .1, .05, .5 }, { .4, .1, .1 }, O, O },
      { Z, { 1, 2, .3 }, { -1, 2, .4 }, X, Y, X },
      0,
      0,
      { .1, 0, .02 },
      0 },
    { "axes 2 and 3 meet",
      6,
      CHAIN_NONE,
      CHAIN_WRIST_ELBOW,
      false,
      { { 0, 0, .4 }, { .3, .1, .1 }, O, { .2, .1, .5 }, O, O },
      { Z, Y, { 1, .2, .3 }, X, Y, X },
      0,
      0,
      { .1, 0, .02 },
      0 },
    { "axes 1 and 2 in parallel",
      6,
      CHAIN_NONE,
      CHAIN_WRIST_COLUMN,
      false,
      { { 0, 0, .4 }, { .4, .1, .1 }, { .3, 0, .1 }, { .2, .1, .3 }, O, O },
      { Z, Z, { 1, .2, .1 }, X, Y, X },
      0,
      0,
      { .1, 0, .02 },
      0 },
    { "a slanted wrist",
      6,
      CHAIN_NONE,
      CHAIN_WRIST_PARALLEL,
      false,
      { { 0, 0, .445 },
        { .15, 0, 0 },
        { 0, 0, .7 },
        { 0, 0, .115 },
        { .795, 0, 0 },
        { .085, 0, 0 } },
      { Z, Y, Y, X, { 1, 1.3, 0 }, X },
      0,
      0,
      { .1, 0, 0 },
      0 },
    { "a shoulder of three axes",
      6,
      CHAIN_NONE,
      CHAIN_WRIST_PARALLEL,
      true,
      { { 0, 0, .3 }, O, O, { 0, .02, .5 }, { 0, 0, .4 }, { .1, 0, .1 } },
      { Z, Y, Z, Y, Y, Z },
      0,
      0,
      { 0, 0, .1 },
      0 },
    { "SCARA",
      4,
      CHAIN_NONE,
      CHAIN_SCARA,
      false,
      { { 0, 0, .4 }, { .325, 0, 0 }, { .225, 0, 0 }, O },
      { Z, Z, { 0, 0, -1 }, { 0, 0, -1 } },
      1 << 2,
      0,
      O,
      0 },
    { "SCARA on a column",
      4,
      CHAIN_NONE,
      CHAIN_SCARA,
      false,
      { O, { 0, 0, .4 }, { .325, 0, 0 }, { .225, 0, 0 } },
      { Z, Z, Z, { 0, 0, -1 } },
      1,
      0,
      O,
      0 },
    { "palletizer",
      4,
      CHAIN_NONE,
      CHAIN_WRIST_PARALLEL,
      false,
      { { 0, 0, .7425 }, { .26, 0, 0 }, { 0, 0, .945 }, { 1.025, 0, 0 } },
      { Z, Y, Y, { 0, 0, -1 } },
      0,
      2,
      { .22, 0, -.2825 },
      0 },
    { "gantry",
      6,
      CHAIN_NONE,
      CHAIN_GANTRY,
      false,
      { { 0, 0, 2 },
        { .1, 0, .2 },
        { 0, .1, -.3 },
        { 0, 0, -.2 },
        { 0, .05, -.1 },
        { 0, 0, -.15 } },
      { X, { .1, 1, 0 }, { 0, 0, -1 }, Z, Y, Z },
      7,
      0,
      { 0, 0, -.1 },
      0 },
    { "iiwa 7, joint 3 held",
      7,
      2,
      CHAIN_WRIST_SHOULDER,
      false,
      { { 0, 0, .15 },
        { 0, 0, .19 },
        { 0, 0, .21 },
        { 0, 0, .19 },
        { 0, 0, .21 },
        { 0, 0, .19 },
        { 0, 0, .081 } },
      { Z, Y, Z, { 0, -1, 0 }, Z, Y, Z },
      0,
      0,
      { 0, 0, .045 },
      0 },
    { "iiwa 7 by its arm angle",
      7,
      CHAIN_ARM_ANGLE,
      CHAIN_SHOULDER_WRIST,
      false,
      { { 0, 0, .15 },
        { 0, 0, .19 },
        { 0, 0, .21 },
        { 0, 0, .19 },
        { 0, 0, .21 },
        { 0, 0, .19 },
        { 0, 0, .081 } },
      { Z, Y, Z, { 0, -1, 0 }, Z, Y, Z },
      0,
      0,
      { 0, 0, .045 },
      0 },
    { "Panda, joint 7 held",
      7,
      6,
      CHAIN_WRIST_SHOULDER,
      true,
      { { 0, 0, .333 },
        O,
        { 0, 0, .316 },
        { .0825, 0, 0 },
        { -.0825, 0, .384 },
        O,
        { .088, 0, 0 } },
      { Z, Y, Z, { 0, -1, 0 }, Z, { 0, -1, 0 }, { 0, 0, -1 } },
      0,
      0,
      { 0, 0, -.107 },
      0 },
    { "arm on a track",
      7,
      0,
      CHAIN_WRIST_PARALLEL,
      false,
      { O,
        { 0, 0, .445 },
        { .15, 0, 0 },
        { 0, 0, .7 },
        { 0, 0, .115 },
        { .795, 0, 0 },
        { .085, 0, 0 } },
      { Y, Z, Y, Y, X, Y, X },
      1,
      0,
      O,
      0 },
    { "CRX-10iA",
      6,
      CHAIN_NONE,
      CHAIN_ITERATED,
      false,
      { { 0, 0, .245 }, O, { 0, 0, .71 }, O, { .54, 0, 0 }, { .16, -.15, 0 } },
      { Z, Y, { 0, -1, 0 }, { -1, 0, 0 }, { 0, -1, 0 }, { -1, 0, 0 } },
      0,
      0,
      O,
      0 },
    { "two joints",
      2,
      CHAIN_NONE,
      CHAIN_ITERATED,
      false,
      { O, { .3, 0, 0 } },
      { Z, Y },
      0,
      0,
      { .2, 0, .1 },
      0 },
    { "palletizer driven from the base",
      4,
      CHAIN_NONE,
      CHAIN_WRIST_PARALLEL,
      false,
      { { 0, 0, .7425 }, { .26, 0, 0 }, { 0, 0, .945 }, { 1.025, 0, 0 } },
      { Z, Y, { 0, -1, 0 }, { 0, 0, -1 } },
      0,
      2,
      { .22, 0, -.2825 },
      1 },
};
enum { RIG_COUNT = sizeof RIGS / sizeof RIGS[0] };

static inline struct chain rig_chain(const struct rig *r)
{
    struct chain c = { .joints = r->joints,
                       .flange.turn = { { 0, 0, 1 }, { 0, 1, 0 }, { -1, 0, 0 } } };

    memcpy(c.flange.at, r->flange, sizeof c.flange.at);
    for (int i = 0; i < r->joints; i++) {
        const double *a = r->axis[i], length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
        memcpy(c.joint[i].origin, r->origin[i], sizeof c.joint[i].origin);
        for (int k = 0; k < 3; k++) {
            c.joint[i].axis[k] = a[k] / length;
        }
        c.joint[i].slides = r->slides >> i & 1;
    }
    c.joint[r->joints - 1].level = r->level;
    c.joint[2].level = r->fore ? r->fore : c.joint[2].level;
    return c;
}

static inline struct chain_form rig_form(const struct rig *r)
{
    const struct chain c = rig_chain(r);
    struct chain_form f;

    chain_form_of(&c, r->held, &f);
    return f;
}

/* Joints anywhere. [rad], [m] */
static inline void rig_anywhere(const struct chain *c, uint64_t *seed, double q[CHAIN_JOINTS])
{
    memset(q, 0, CHAIN_JOINTS * sizeof *q);
    for (int i = 0; i < c->joints; i++) {
        q[i] = check_real(seed, -3.1, 3.1) * (c->joint[i].slides ? 0.2 : 1.0);
    }
}

/* Farthest that a number of two poses differs. [m], 1 */
static inline double rig_between(const struct chain_pose *a, const struct chain_pose *b)
{
    double most = 0.0;
    for (int i = 0; i < 3; i++) {
        most = fmax(most, fabs(a->at[i] - b->at[i]));
        for (int k = 0; k < 3; k++) {
            most = fmax(most, fabs(a->turn[i][k] - b->turn[i][k]));
        }
    }
    return most;
}

/* Largest difference of joints, whole turns left out. */
static inline double rig_apart(const struct chain *c, const double a[CHAIN_JOINTS],
                               const double b[CHAIN_JOINTS])
{
    double most = 0.0;
    for (int i = 0; i < c->joints; i++) {
        const double d = a[i] - b[i];
        most = fmax(most, fabs(c->joint[i].slides ? d : remainder(d, 6.283185307179586)));
    }
    return most;
}

#endif
