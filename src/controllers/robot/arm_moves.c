#include "arm_moves.h"

#include <math.h>
#include <string.h>

void arm_moves_start(struct arm_moves *c, const double turn[4], double external)
{
    memset(c, 0, sizeof *c);
    memcpy(c->move[0].turn, turn, 4 * sizeof *turn);
    c->move[0].external[0] = c->move[0].external[1] = external;
    c->count = 1; /* a move that is over */
}

static const struct arm_move *move_of(const struct arm_moves *c, int32_t n)
{
    return &c->move[n % ARM_MOVES_SIZE];
}

void arm_moves_add(struct arm_moves *c, const struct arm_move *move, double way)
{
    struct arm_move *m = &c->move[c->count % ARM_MOVES_SIZE];
    const int axis = c->count % 3;

    *m = *move;
    m->from = c->at[axis];
    m->to = c->at[axis] += way;
    c->count++;
}

void arm_moves_drop(struct arm_moves *c)
{
    c->count--;
    c->at[c->count % 3] = move_of(c, c->count)->from;
}

int arm_moves_axis(const struct arm_moves *c)
{
    return 3 + (c->count - 1) % 3;
}

/* Part of a move, 0 .. 1, that is over at a place. */
static double part_of(const struct arm_moves *c, int32_t n, const double place[AXES])
{
    const struct arm_move *m = move_of(c, n);
    const double u = place[3 + n % 3];
    return u >= m->to ? 1.0 : u <= m->from ? 0.0 : (u - m->from) / (m->to - m->from);
}

/* Coordinates end within an ulp of where they should, and so may seem to have begun; this is four.
 * More of it would be a leap: joint 4 sees what the tip goes meanwhile over the sine of joint 5. */
static const double ROUNDING = 1e-15;

/* The latest move that has begun to turn, or the oldest known. */
static int32_t active(const struct arm_moves *c, const double place[AXES])
{
    const int32_t oldest = c->count > ARM_MOVES_SIZE ? c->count - ARM_MOVES_SIZE : 0;
    int32_t n = c->count - 1;

    while (n > oldest && !(place[3 + n % 3] > (1.0 + ROUNDING) * move_of(c, n)->from)) {
        n--;
    }
    return n;
}

/* Turn an orientation by part of a move. */
static void turned(const struct arm_move *m, double part, double turn[4])
{
    const double by[3] = { part * m->by[0], part * m->by[1], part * m->by[2] };
    double q[4];

    quaternion_by_vector(by, q);
    quaternion_product(q, turn, turn);
}

static void attitude(const struct arm_moves *c, int32_t n, const double place[AXES], double turn[4])
{
    const struct arm_move *m = move_of(c, n);
    const int32_t oldest = c->count > ARM_MOVES_SIZE ? c->count - ARM_MOVES_SIZE : 0;
    const bool corner =
        m->kind == ARM_MOVE_POSE && n > oldest && move_of(c, n - 1)->kind == ARM_MOVE_POSE;
    const double before = corner ? part_of(c, n - 1, place) : 1.0;

    memcpy(turn, m->turn, 4 * sizeof *turn);
    if (before < 1.0) {
        memcpy(turn, move_of(c, n - 1)->turn, 4 * sizeof *turn);
        turned(move_of(c, n - 1), before, turn);
    }
    if (m->kind == ARM_MOVE_POSE) {
        turned(m, part_of(c, n, place), turn);
    }
}

static bool joints(const void *geometry, const double place[AXES], double joint[AXES])
{
    const struct arm_geometry *g = geometry;
    const int32_t n = active(g->moves, place);
    const struct arm_move *m = move_of(g->moves, n);
    const double part = part_of(g->moves, n, place);
    struct pose pose;

    if (m->kind == ARM_MOVE_POSE || part >= 1.0) {
        memcpy(pose.at, place, sizeof pose.at);
        attitude(g->moves, n, place, pose.turn);
        return manipulator_joints(g->arm, &pose, joint);
    }
    double q[OPW_JOINTS];
    memcpy(q, joint, sizeof q);
    for (int i = m->kind == ARM_MOVE_WRIST ? 3 : 0; i < OPW_JOINTS; i++) {
        q[i] = m->joint[i] + part * m->step[i];
    }
    if (m->kind == ARM_MOVE_WRIST && !manipulator_arm(g->arm, place, q)) {
        return false;
    }
    memcpy(joint, q, sizeof q);
    return true;
}

void arm_moves_pose(const struct arm_geometry *g, const double place[AXES],
                    const double joint[AXES], struct pose *pose)
{
    const int32_t n = active(g->moves, place);
    const struct arm_move *m = move_of(g->moves, n);

    if (m->kind != ARM_MOVE_POSE && part_of(g->moves, n, place) < 1.0) {
        *pose = manipulator_pose(g->arm, joint);
        return;
    }
    memcpy(pose->at, place, sizeof pose->at);
    attitude(g->moves, n, place, pose->turn);
}

double arm_moves_external(const struct arm_moves *c, const double place[AXES])
{
    const int32_t n = active(c, place);
    const double *e = move_of(c, n)->external, part = part_of(c, n, place);
    return part < 1.0 ? e[0] + part * (e[1] - e[0]) : e[1];
}

bool arm_moves_by_joints(const struct arm_moves *c, const double place[AXES])
{
    return move_of(c, active(c, place))->kind == ARM_MOVE_JOINTS;
}

/* U V W turn about the axes of the moves under way. */
static bool rates(const void *geometry, const double joint[AXES], const double slope[AXES],
                  double rate[AXES])
{
    const struct arm_geometry *g = geometry;
    const struct arm_moves *c = g->moves;
    const struct arm_move *m = move_of(c, c->count - 1);
    double motion[6] = { slope[0], slope[1], slope[2], 0.0, 0.0, 0.0 };

    if (m->to > m->from) {
        const double per = slope[arm_moves_axis(c)] / (m->to - m->from);
        for (int i = 0; i < 3; i++) {
            motion[3 + i] = per * m->by[i];
        }
        if (m->kind == ARM_MOVE_JOINTS) {
            for (int i = 0; i < OPW_JOINTS; i++) {
                rate[i] = per * m->step[i];
            }
            return true;
        }
    }
    return manipulator_rates(g->arm, joint, motion, rate);
}

static void place(const void *geometry, const double joint[AXES], double at[AXES])
{
    const struct arm_geometry *g = geometry;
    const struct pose p = manipulator_pose(g->arm, joint);

    memcpy(at, p.at, sizeof p.at);
    memcpy(at + 3, g->moves->at, sizeof g->moves->at);
}

struct kinematics arm_moves_kinematics(void)
{
    return (struct kinematics){ joints, rates, place };
}
