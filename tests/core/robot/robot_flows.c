/* Moves that flow: joints, lines, circles in a row, with zones and stops, at random. In every cycle each joint keeps its
 * speed, acceleration and jerk, and the tip is within the zone of the ways that were programmed. */
#include <math.h>
#include <stdlib.h>

#include "robot_rig.h"

static uint64_t seed = 1;

static double draw(double low, double high)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(seed >> 11) * 0x1p-53;
}

enum { MOVES = 12, STEPS = 400, CYCLES = 400000 };

/* The ways as programmed, as points of the tip. */
static double way[MOVES][STEPS + 1][3];
static double zone_of[MOVES + 1]; /* at the start of each */

static double q_now[OPW_JOINTS];

static void tip(const struct robot_config *c, const double q[OPW_JOINTS], double at[3])
{
    const struct pose p = manipulator_pose(&c->arm, q);
    memcpy(at, p.at, sizeof p.at);
}

/* Squared distance from a way. */
static double off_way(const double at[3], const double w[STEPS + 1][3])
{
    double least = INFINITY;
    for (int k = 0; k < STEPS; k++) {
        double part;
        const double off = rig_off(at, w[k], w[k + 1], &part);
        const double d[3] = { at[0] - w[k][0], at[1] - w[k][1], at[2] - w[k][2] };
        const double end = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        least = fmin(least, part >= 0.0 && part <= 1.0 ? off : end);
    }
    return least;
}

struct seen {
    double speed, acc, jerk, off; /* largest shares of the limits; of the zone */
    double time;
};

/* Drive to the end, or up to an end of the time. */
static void drive(const struct robot_config *c, int moves, struct seen *s)
{
    static double q[CYCLES][OPW_JOINTS];
    int n = 0;

    memcpy(q[0], robot.joint, sizeof q[0]);
    for (n = 1; n < CYCLES && !robot_idle(&robot); n++) {
        robot_cycle(&robot, c);
        memcpy(q[n], robot.joint, sizeof q[n]);
    }
    CHECK(robot_idle(&robot) && !robot.lost);
    s->time = n * CYCLE;
    for (int k = 0; k < n + 3; k++) {
        for (int i = 0; i < OPW_JOINTS; i++) {
            double x[4];
            for (int m = 0; m < 4; m++) {
                const int at = k + m - 3;
                x[m] = q[at < 0 ? 0 : at >= n ? n - 1 : at][i];
            }
            const double v = (x[3] - x[2]) / CYCLE, a = (x[3] - 2 * x[2] + x[1]) / CYCLE / CYCLE;
            const double j = (x[3] - 3 * x[2] + 3 * x[1] - x[0]) / CYCLE / CYCLE / CYCLE;
            const struct manipulator_joint *l = &c->arm.joint[i];
            const double noise = 8.0 * 0x1p-52 * fmax(1.0, fabs(x[3])) / CYCLE / CYCLE / CYCLE;
            if (getenv("DBG") && fabs(a) > l->acc * (1 + 1e-6)) printf("  t %.4f joint %d acc %.9f rates %.9f %.9f %.9f\n", k*CYCLE, i, a/l->acc, (x[1]-x[0])/CYCLE, (x[2]-x[1])/CYCLE, v);
            s->speed = fmax(s->speed, fabs(v) / l->speed);
            s->acc = fmax(s->acc, fabs(a) / l->acc);
            s->jerk = fmax(s->jerk, c->smooth > 0.0 ? (fabs(j) - noise) / (l->acc / c->smooth) : 0.0);
        }
    }
    for (int k = 0; k < n; k += 7) {
        double at[3], off = INFINITY;
        tip(c, q[k], at);
        for (int m = 0; m < moves; m++) {
            const double zone = fmax(zone_of[m], zone_of[m + 1]);
            off = fmin(off, fmax(0.0, off_way(at, way[m]) - 2e-3) / fmax(zone, 1e-9));
        }
        if (getenv("DBG") && off > 1.0) { int bm=0; double bd=1e9; for (int m=0;m<moves;m++){double d=off_way(at,way[m]); if(d<bd){bd=d;bm=m;}} printf("  t %.4f off %.4f nearest %d d %.3f zones %.3f %.3f line %d\n", k*CYCLE, off, bm, bd, zone_of[bm], zone_of[bm+1], 0);}
        s->off = fmax(s->off, off);
    }
}

/* A move of the joints to somewhere near. */
static bool joints(const struct robot_config *c, double reach, double zone, int m)
{
    struct robot_move move = { .kind = ROBOT_JOINTS, .share = draw(0.3, 1.0), .zone = zone };
    struct robot_refusal why;
    double q[OPW_JOINTS];

    move.target.by_joints = true;
    for (int i = 0; i < OPW_JOINTS; i++) {
        const struct manipulator_joint *j = &c->arm.joint[i];
        move.target.joint[i] = fmin(j->high, fmax(j->low, q_now[i] + reach * draw(-1.0, 1.0)));
    }
    const enum robot_status status = robot_move(&robot, c, &move, &why);
    CHECK_EQ(status, ROBOT_OK);
    for (int k = 0; k <= STEPS; k++) {
        for (int i = 0; i < OPW_JOINTS; i++) {
            q[i] = q_now[i] + (move.target.joint[i] - q_now[i]) * k / STEPS;
        }
        tip(c, q, way[m][k]);
    }
    memcpy(q_now, move.target.joint, sizeof q_now);
    return true;
}

/* A line to somewhere near, turning the tool. */
static bool line(const struct robot_config *c, double zone, int m)
{
    struct robot_move move = { .kind = ROBOT_LINE, .feed = draw(50.0, 2500.0), .zone = zone };
    struct robot_refusal why;
    const struct pose from = manipulator_pose(&c->arm, q_now);
    const double by[3] = { draw(-0.5, 0.5), draw(-0.5, 0.5), draw(-0.5, 0.5) };

    move.target.branch = ROBOT_ANY_BRANCH;
    move.target.pose = from;
    quaternion_by_vector(by, move.target.pose.turn);
    quaternion_product(move.target.pose.turn, from.turn, move.target.pose.turn);
    for (int i = 0; i < 3; i++) {
        move.target.pose.at[i] += draw(-300.0, 300.0);
    }
    if (robot_move(&robot, c, &move, &why) != ROBOT_OK) {
        return false;
    }
    for (int k = 0; k <= STEPS; k++) {
        for (int i = 0; i < 3; i++) {
            way[m][k][i] = from.at[i] + (move.target.pose.at[i] - from.at[i]) * k / STEPS;
        }
    }
    robot_end(&robot, q_now);
    return true;
}

static void anywhere(const struct robot_config *c, double q[OPW_JOINTS])
{
    for (int i = 0; i < OPW_JOINTS; i++) {
        q[i] = 0.5 * draw(c->arm.joint[i].low, c->arm.joint[i].high);
    }
}

static void chains(const struct robot_config *c, int number, int kinds)
{
    struct seen most = { .off = 0.0 };
    int corners = 0;

    for (int n = 0; n < number; n++) {
        struct seen s = { .off = 0.0 };
        int m = 0;
        seed = (uint64_t)n * 2654435761u + 17u;
        anywhere(c, q_now);
        robot_start(&robot, c, q_now);
        for (int tries = 0; m < MOVES && tries < 40 && robot_ready(&robot); tries++) {
            const double zone = draw(0.0, 1.0) < 0.2 ? 0.0 : draw(0.5, 60.0);
            const bool by_joints = kinds == 0 || (kinds == 2 && draw(0.0, 1.0) < 0.5);
            if (by_joints ? joints(c, 0.6, zone, m) : line(c, zone, m)) {
                zone_of[++m] = zone;
            }
        }
        zone_of[0] = 0.0;
        drive(c, m, &s);
        for (int i = 0; i < OPW_JOINTS; i++) {
            CHECK_NEAR(robot.joint[i], q_now[i], 1e-6);
        }
        if (s.speed > 1.0 + 1e-6 || s.acc > 1.0 + 1e-6 || s.jerk > 1.0 + 1e-6 || s.off > 1.0) {
            printf("chain %d of %d moves: speed %.9f acc %.9f jerk %.9f off %.6f\n", n, m, s.speed, s.acc, s.jerk, s.off);
        }
        most.speed = fmax(most.speed, s.speed);
        most.acc = fmax(most.acc, s.acc);
        most.jerk = fmax(most.jerk, s.jerk);
        most.off = fmax(most.off, s.off);
        most.time += s.time;
        corners += m;
    }
    printf("kinds %d smooth %g: speed %.9f acc %.9f jerk %.9f off %.6f, %d moves %.1f s\n", kinds, c->smooth, most.speed, most.acc, most.jerk, most.off, corners, most.time);
    CHECK(most.speed <= 1.0 + 1e-6 && most.acc <= 1.0 + 1e-6 && most.jerk <= 1.0 + 1e-6);
    CHECK(most.off <= 1.0);
}

int main(int argc, char **argv)
{
    struct robot_config c = rig_config();
    const int number = argc > 1 ? atoi(argv[1]) : 10;

    c.flow = true;
    for (int kinds = argc > 2 ? atoi(argv[2]) : 0; kinds < (argc > 2 ? atoi(argv[2]) + 1 : 3); kinds++) {
        c.smooth = 0.05;
        chains(&c, number, kinds);
        c.smooth = 0.0;
        chains(&c, number, kinds);
    }
    return check_result();
}
