/* Bounds of the joints' derivatives: nowhere on a part of a path are they exceeded, and on a short
 * part they are what the joints have. */
#include "bounds.h"
#include "robot_rig.h"

enum { CASES = 400, PLACES = 64 };

static uint64_t seed = 20260731;

/* A move that is planned: a line, a circle, an arc with turns, or by the wrist. */
static bool planned(struct robot_config *c, int n)
{
    double joint[OPW_JOINTS], end[OPW_JOINTS];
    struct robot_refusal why;
    struct robot_move m = { .kind = n % 4 == 1   ? ROBOT_CIRCLE
                                    : n % 4 == 2 ? ROBOT_ARC
                                                 : ROBOT_LINE,
                            .singular = n % 4 == 3 ? ROBOT_WRIST : ROBOT_SLOW,
                            .feed = 50.0,
                            .target.branch = ROBOT_ANY_BRANCH };

    for (int i = 0; i < OPW_JOINTS; i++) {
        joint[i] = 0.8 * check_real(&seed, c->arm.joint[i].low, c->arm.joint[i].high);
        end[i] = joint[i] + check_real(&seed, -0.5, 0.5);
        m.normal[i % 3] = check_real(&seed, -1.0, 1.0);
    }
    c->arm.tool.at[0] = check_real(&seed, -200.0, 200.0);
    robot_start(&robot, c, joint);
    m.target.pose = manipulator_pose(&c->arm, end);
    const double *at = robot.pose.at, *to = m.target.pose.at, *z = m.normal;
    const double size = sqrt(z[0] * z[0] + z[1] * z[1] + z[2] * z[2]);
    for (int i = 0; i < 3; i++) {
        m.via[i] = 0.5 * (at[i] + to[i]) + check_real(&seed, -50.0, 50.0);
        m.normal[i] /= size;
    }
    const double radius = check_real(&seed, 5.0, 80.0);
    m.centre[0] = at[0] - radius * z[1]; /* across the normal */
    m.centre[1] = at[1] + radius * z[0];
    m.centre[2] = at[2];
    m.sweep = check_real(&seed, -20.0, 20.0);
    return robot_move(&robot, c, &m, &why) == ROBOT_OK && robot.tool_path.path.length > 1.0;
}

static void joints_at(const struct arm_geometry *g, double part, double joint[OPW_JOINTS])
{
    double place[AXES], slope[AXES];

    path_at(&robot.tool_path.path, part * robot.tool_path.path.length, place, slope);
    CHECK(arm_moves_kinematics().joints(g, place, joint));
}

/* Differences of the joints at a part of the path, over 2 h of the way. */
static void differences(const struct arm_geometry *g, double part, double h,
                        const double near[OPW_JOINTS], double slope[OPW_JOINTS],
                        double bend[OPW_JOINTS])
{
    double q[3][OPW_JOINTS];

    for (int k = 0; k < 3; k++) {
        memcpy(q[k], near, sizeof q[k]);
        joints_at(g, part + (k - 1) * h / robot.tool_path.path.length, q[k]);
    }
    for (int i = 0; i < OPW_JOINTS; i++) {
        slope[i] = (q[2][i] - q[0][i]) / (2.0 * h);
        bend[i] = (q[2][i] - 2.0 * q[1][i] + q[0][i]) / (h * h);
    }
}

int main(void)
{
    struct robot_config c = rig_config();
    int moves = 0, known = 0, near_it = 0;

    for (int n = 0; n < CASES; n += CHECK_EACH) {
        if (!planned(&c, n)) {
            continue;
        }
        struct manipulator arm = c.arm;
        const struct arm_geometry g = { &arm, &robot.moves };
        const double size = pow(2.0, -floor(check_real(&seed, 2.0, 9.0)));
        const double from = size * floor(check_real(&seed, 0.0, 1.0 / size));
        const double length = robot.tool_path.path.length, h = 0.02;
        double middle[OPW_JOINTS], slope[OPW_JOINTS], bend[OPW_JOINTS];
        struct bounds b;
        moves++;
        arm.tool = robot.tool;
        memcpy(middle, robot.joint, sizeof middle);
        for (int k = 1; k <= 4096; k++) {
            joints_at(&g, (from + 0.5 * size) * k / 4096, middle);
        }
        if (!bounds_of(&g, &robot.tool_path.path, from, from + size, middle, &b)) {
            continue;
        }
        known++;
        for (int k = 0; k <= PLACES; k++) {
            const double room = h / length;
            const double part = fmax(room, fmin(1.0 - room, from + size * k / PLACES));
            differences(&g, part, h, middle, slope, bend);
            for (int i = 0; i < OPW_JOINTS; i++) { /* 1e-9: rounding of the differences */
                CHECK(fabs(slope[i]) <= b.most.slope[i] * (1.0 + 1e-4) + 1e-9);
                CHECK(fabs(bend[i]) <= b.most.bend[i] * (1.0 + 1e-2) + 1e-8);
            }
        }
        /* On a part of 0.02 mm hardly anything is given away. */
        const double at = from + 0.5 * size, half = fmin(at, 0.01 / length);
        if (at + half <= 1.0
            && bounds_of(&g, &robot.tool_path.path, at - half, at + half, middle, &b)) {
            differences(&g, at, h, middle, slope, bend);
            bool close = true;
            for (int i = 0; i < OPW_JOINTS; i++) {
                close = close && b.most.slope[i] <= fabs(slope[i]) * 1.02 + 1e-6
                        && b.most.bend[i] <= fabs(bend[i]) * 1.2 + 1e-6;
            }
            near_it += close;
        }
    }
    printf("%d moves, %d with bounds, %d close\n", moves, known, near_it);
    CHECK(moves > CASES / CHECK_EACH / 3 && known > moves * 3 / 4 && near_it > known * 9 / 10);
    return check_result();
}
