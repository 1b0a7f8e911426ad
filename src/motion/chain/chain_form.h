/* chain_form - which closed form solves an arm's inverse kinematics, recognised by its numbers.
 *
 * Which lines the axes are at zero decides it: where they meet and which are in parallel. The same
 * from the flange inwards: an arm whose first three axes meet is one with a spherical wrist, seen
 * from its flange.
 */
#ifndef CHAIN_FORM_H
#define CHAIN_FORM_H

#include "chain.h"

enum chain_kind {
    CHAIN_ITERATED,       /* none of those below: by iteration, one branch */
    CHAIN_WRIST_PARALLEL, /* the axes behind joint 3 meet; axes 2 and 3 in parallel: OPW's arms,
                            * and four-axis palletizers */
    CHAIN_WRIST_SHOULDER, /* they meet; axes 1 and 2 meet, too */
    CHAIN_WRIST_ELBOW,    /* they meet; axes 2 and 3 meet, too */
    CHAIN_WRIST_COLUMN,   /* they meet; axes 1 and 2 in parallel */
    CHAIN_THREE_PARALLEL, /* axes 2, 3, 4 in parallel, 5 and 6 meet: UR's arms */
    CHAIN_SCARA,          /* three turning joints and a sliding one, all in parallel */
    CHAIN_GANTRY,         /* three sliding joints, behind them up to three that turn */
    CHAIN_SHOULDER_WRIST  /* seven joints: axes 1 to 3 meet, and 5 to 7 */
};

/* Flags of a branch, which is a sum of those that its kind has: the sign of a factor is negative.
 * They are numbered as OPW_FLIP, OPW_ELBOW, OPW_BACK. */
enum chain_flag { CHAIN_FLIP = 1, CHAIN_ELBOW = 2, CHAIN_BACK = 4 };

/* What an arm of seven joints leaves to the caller. */
enum {
    CHAIN_NONE = -1,     /* nothing: up to six joints */
    CHAIN_ARM_ANGLE = -2 /* angle of the elbow about the line from shoulder to wrist */
};

/* Axes as lines at zero, base frame. */
struct chain_lines {
    int32_t count;
    bool slides[CHAIN_JOINTS];
    double axis[CHAIN_JOINTS][3];
    double point[CHAIN_JOINTS][3]; /* [m] on the axis */
    struct chain_pose home;        /* of the flange */
};

struct chain_form {
    struct chain chain;
    enum chain_kind kind;
    int32_t held;     /* joint that the caller holds (0 ..), CHAIN_NONE or CHAIN_ARM_ANGLE */
    bool reversed;    /* solved from the flange inwards */
    uint32_t flags;   /* sum of enum chain_flag that its branches have */
    double size;      /* [m] of the arm, or 1 */
    double deviation; /* how far the axes miss the form, in units of its size; above
                       * CHAIN_EXACT each branch is improved by iteration */
};

/* A form that the axes miss by more is not taken; one that they miss by less is theirs. */
#define CHAIN_LOOSE 2e-3
#define CHAIN_EXACT 1e-13

/* The arm's form. Of seven joints `held` is left to the caller: joint 3 (2) where that is
 * CHAIN_NONE, or the arm angle of an arm that has none. */
void chain_form_of(const struct chain *c, int32_t held, struct chain_form *f);

/* The joint (0 ..) that keeps its angle where the wrist's axes are in line; -1: there is none. */
int chain_form_open(const struct chain_form *f);

/* The lines and points with which a form is solved. */
struct chain_points {
    struct chain_lines lines; /* reversed if the form is */
    double centre[3];         /* [m] where the axes of the wrist meet */
    double meeting[3];        /* [m] where two others do, or those of the shoulder */
};

/* Lines of a chain, and those that are left when joint `held` stands at `value`. */
void chain_lines_of(const struct chain *c, struct chain_lines *l);
void chain_lines_held(const struct chain *c, int32_t held, double value, struct chain_lines *l);

/* Seen from the flange. */
void chain_lines_reverse(struct chain_lines *l);

/* Points for a kind; returns how far the lines miss it, in units of size. */
double chain_points_of(enum chain_kind kind, const struct chain_lines *l, double size,
                       struct chain_points *p);

#endif
