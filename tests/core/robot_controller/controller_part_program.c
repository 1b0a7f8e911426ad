/* Part programs whose A B C turn the tool: every kind of order, on its path. */
#include "controller_pc.h"

static const int64_t LONG = 60LL * FPGA_CLOCK_HZ; /* [clocks] no program takes so long */

/* Begin 100 mm below and beside the start, tool down. */
static void begin(const char *program)
{
    config = pc_config();
    pc_start(NULL, program);
    controller_rehearse(&controller, &config, &text);
    CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
    controller_start(&controller, &config);
}

static void lines(void)
{
    begin("G0 X900 Y0 Z500 A180 B0 C180\nG1 X1000 F6000\nA170 F600\nG20 X40 F100\nA180 F600\n"
          "G21 X900 Y50 B10 F6000\n");
    const double from = controller.robot.pose.at[2];
    CHECK(from > 1000.0);
    double most = 0.0, turn = 0.0, time[8] = { 0 };
    while (!controller_done(&controller) && now < LONG) {
        double before[4], v[3];
        memcpy(before, controller.robot.pose.turn, sizeof before);
        pc_cycle();
        const int line = controller.robot.line;
        time[line < 8 ? line : 0] += CYCLE;
        most = line == 2 ? fmax(most, controller.robot.speed) : most;
        quaternion_inverse(before, before);
        quaternion_product(controller.robot.pose.turn, before, before);
        quaternion_vector(before, v);
        const double spin = hypot(hypot(v[0], v[1]), v[2]) / CYCLE / DEGREE;
        turn = line == 3 || line == 5 ? fmax(turn, spin) : turn;
    }
    CHECK_NEAR(most, 100.0, 1e-6);
    /* F600 is 10 deg/s, in G20, too: 10 degrees take a second and the ramps, which are short. */
    CHECK_NEAR(turn, 10.0, 1e-3);
    CHECK(time[3] > 1.0 && time[3] < 1.3);
    CHECK_NEAR(time[5], time[3], 2e-4);
    pc_at(900.0, 50.0, 500.0, 1e-6);
    CHECK_NEAR(pc_off(180.0, 10.0, 180.0), 0.0, 1e-6);
    CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
}

/* Arcs and helices in the three planes keep their radius and their rise, at the feed. */
static void arcs(void)
{
    static const struct {
        const char *program;
        int plane;
        double rise, length;
    } a[] = {
        { "G0 X900 Y0 Z500 A180 C180\nG17 G2 X950 Y50 I50 J0 F3000\n", 2, 0.0, 0.25 },
        { "G0 X900 Y0 Z500 A180 C180\nG17 G3 X900 Y0 I50 J0 F3000\n", 2, 0.0, 1.0 },
        { "G0 X900 Y0 Z500 A180 C180\nG18 G2 X950 Z550 I50 K0 F3000\n", 1, 0.0, 0.75 },
        { "G0 X900 Y0 Z500 A180 C180\nG19 G3 Y50 Z550 J50 K0 F3000\n", 0, 0.0, 0.75 },
        { "G0 X900 Y0 Z500 A180 C180\nG17 G2 X950 Y50 Z530 I50 J0 F3000\n", 2, 30.0, 0.25 },
        { "G0 X900 Y0 Z500 A180 C180\nG17 G3 Z540 I50 J0 P3 C150 F3000\n", 2, 40.0, 3.0 },
        { "G0 X900 Y0 Z500 A180 C180\nG18 G3 X950 Z550 Y-20 I50 K0 F3000\n", 1, -20.0, 0.25 },
        { "G0 X900 Y0 Z500 A180 C180\nG19 G2 Y50 Z550 X920 J50 K0 F3000\n", 0, 20.0, 0.25 },
    };
    for (size_t n = 0; n < sizeof a / sizeof *a; n++) {
        const int k = a[n].plane, i = (k + 1) % 3, j = (k + 2) % 3;
        const double start[3] = { 900.0, 0.0, 500.0 };
        double centre[3] = { 950.0, 0.0, 500.0 }, most = 0.0, off = 0.0, way = 0.0;
        begin(a[n].program);
        if (k == 0) {
            centre[0] = 900.0;
            centre[1] = 50.0;
        }
        while (!controller_done(&controller) && now < LONG) {
            pc_cycle();
            const double *at = controller.robot.pose.at;
            if (controller.robot.line < 2) {
                way = controller.robot.length;
                continue;
            }
            most = fmax(most, controller.robot.speed);
            off = fmax(off, fabs(hypot(at[i] - centre[i], at[j] - centre[j]) - 50.0));
        }
        way = controller.robot.length - way;
        CHECK_NEAR(way, hypot(a[n].length * 314.159265358979, a[n].rise), 0.02);
        CHECK(off < 1e-6);
        CHECK_NEAR(most, 50.0, 1e-3);
        CHECK_NEAR(controller.robot.pose.at[k] - start[k], a[n].rise, 1e-6);
        CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
        CHECK(controller_done(&controller));
    }
}

/* A helix that the joints slow, so that it has many pieces. */
static void winding(void)
{
    double off = 0.0, most = 0.0;
    int pieces = 0;
    begin("G0 X500 Y0 Z500 A180 C180\nG17 G3 Z560 I350 J0 P2 F60000\n");
    while (!controller_done(&controller) && now < LONG) {
        pc_cycle();
        const double *at = controller.robot.pose.at;
        pieces =
            controller.robot.tool_path.count > pieces ? controller.robot.tool_path.count : pieces;
        most = fmax(most, controller.robot.line == 2 ? controller.robot.speed : 0.0);
        if (controller.robot.line == 2) {
            const double angle = atan2(-at[1], 850.0 - at[0]);
            const double turns = (at[2] - 500.0) / 30.0;
            off = fmax(off, fabs(hypot(at[0] - 850.0, at[1]) - 350.0));
            off =
                fmax(off,
                     350.0 * fabs(remainder(angle - turns * 6.283185307179586, 6.283185307179586)));
        }
    }
    CHECK(pieces > 4 && most > 100.0);
    CHECK(off < 1e-5);
    pc_at(500.0, 0.0, 560.0, 1e-6);
}

/* G64 P rounds a corner within it and does not stop; outputs, dwells and stops in their order. */
static void corners(void)
{
    for (int n = 0; n < 3; n++) {
        begin(n == 1   ? "G0 X900 Y0 Z500 A180 C180\nG64 P2\nG1 X950 F6000\nY50\n"
              : n == 2 ? "G0 X900 Y0 Z500 A180 C180\nG64\nG1 X950 F6000\nY50\n"
                       : "G0 X900 Y0 Z500 A180 C180\nG61\nG1 X950 F6000\nY50\n");
        double nearest = 1e9, slowest = 1e9;
        while (!controller_done(&controller) && now < LONG) {
            pc_cycle();
            const double *at = controller.robot.pose.at;
            const double off = hypot(hypot(at[0] - 950.0, at[1]), at[2] - 500.0);
            nearest = fmin(nearest, off);
            slowest = off < 20.0 ? fmin(slowest, controller.robot.speed) : slowest;
        }
        CHECK(n == 1   ? nearest > 0.5 && nearest <= 2.0001
              : n == 2 ? nearest > 3.0 && nearest < 64.0
                       : nearest < 1e-4);
        CHECK(n ? slowest > 10.0 : slowest < 1.0);
        pc_at(950.0, 50.0, 500.0, 1e-6);
    }
}

static void switches(void)
{
    begin("G0 X900 Y0 Z500 A180 C180\nG1 X910 F6000\nM64 P3\nM62 P0\nX920\nM63 P0\nX930\n"
          "M65 P3\nG4 P0.05\nM0\nX940\n");
    double at[4] = { 0 }, rest = 0.0;
    int before = 0;
    while (controller_status(&controller, &panel) != CONTROLLER_PAUSED && now < LONG) {
        pc_cycle();
        for (int bit = 0; bit < 4; bit += 3) { /* where output 0, 3 goes on, off */
            if (((card.inputs ^ before) >> bit) & 1) {
                at[bit / 3 * 2 + (before >> bit & 1)] = controller.robot.pose.at[0];
            }
        }
        before = card.inputs;
        rest += controller_status(&controller, &panel) == CONTROLLER_DELAY ? CYCLE : 0.0;
    }
    CHECK_NEAR(at[0], 910.0, 1e-4); /* M62 with the motion to 920, M63 with that to 930 */
    CHECK_NEAR(at[1], 920.0, 1e-4);
    CHECK_NEAR(at[2], 910.0, 1e-4);
    CHECK_NEAR(at[3], 930.0, 1e-4);
    CHECK_NEAR(rest, 0.05, 1.5e-4);
    pc_run(1000);
    pc_at(930.0, 0.0, 500.0, 1e-6); /* M0 lasts */
    pc_press(&panel.start);
    pc_run(5);
    CHECK_EQ(controller_status(&controller, &panel), CONTROLLER_RUNNING);
    while (!controller_done(&controller) && now < LONG) {
        pc_cycle();
    }
    pc_at(940.0, 0.0, 500.0, 1e-6);
}

/* What is refused before anything moves. */
static void refused(void)
{
    static const struct {
        const char *program;
        int line;
        enum robot_status status;
    } r[] = {
        { "G0 X900 Y0 Z500 A180 C180\nG1 X5000 F600\n", 2, ROBOT_FAR },
        { "G0 X900 Y0 Z5000 A180 C180\n", 1, ROBOT_FAR },
        { "G0 X1100 Y0 Z400 A180 C180\n\nG1 X900 Y900\nG1 X-900 F6000\nG1 Y-900\nG1 X900\nG1 Y0\n",
          5, ROBOT_OUTSIDE },
    };
    for (size_t n = 0; n < sizeof r / sizeof *r; n++) {
        config = pc_config();
        pc_start(NULL, r[n].program);
        controller_rehearse(&controller, &config, &text);
        CHECK_EQ(controller.trouble.error, CONTROLLER_MOVE);
        CHECK_EQ(controller.trouble.line, r[n].line);
        CHECK_EQ(controller.trouble.status, r[n].status);
    }
}

/* Inputs are waited for when motion has ended, analog outputs change there; M6 stops. */
static void asked(void)
{
    static const struct {
        const char *words;
        double result, least;
    } w[] = {
        { "M64 P5\nM66 P5 L3 Q1", 1.0, 0.0 },
        { "M66 P5 L3 Q0.2", -1.0, 0.2 },
        { "M66 P5 L4 Q1", 0.0, 0.0 },
        { "M66 P5", 0.0, 0.0 },
        { "M66 E3", 2.5, 0.0 },
    };
    for (size_t n = 0; n < sizeof w / sizeof *w; n++) {
        char program[160];
        snprintf(program, sizeof program,
                 "G0 X900 Y0 Z500 A180 C180\nG1 X910 F6000 M67 E1 Q1.5\n"
                 "M68 E3 Q-2\n%s\nX920\n",
                 w[n].words);
        begin(program);
        double stood = 0.0;
        while (!controller_done(&controller) && now < LONG) {
            pc_cycle();
            card.irq_ai[3] = 2.5;
            card.irq_inputs = card.inputs;
            const double x = controller.robot.pose.at[0];
            CHECK(x > 909.999 || fabs(controller.volt[3]) == 0.0);
            stood += fabs(x - 910.0) < 1e-6 ? CYCLE : 0.0;
        }
        CHECK_EQ(controller.trouble.error, CONTROLLER_OK);
        CHECK_NEAR(controller.orders.gcode.input, w[n].result, 0.0);
        CHECK(stood >= w[n].least && stood < w[n].least + 0.05);
        CHECK(controller.volt[1] == 1.5 && controller.volt[3] == -2.0);
        pc_at(920.0, 0.0, 500.0, 1e-6);
    }
    begin("G0 X900 Y0 Z500 A180 C180\nT3 M6\nG43.1 Z10\nG1 X910 F6000 Z500\n");
    for (int stops = 0; stops < 2; stops++) {
        config.orders.tool_stop = stops;
        pc_start(NULL, given.text);
        controller_rehearse(&controller, &config, &text);
        controller_start(&controller, &config);
        for (int n = 0; n < 60000 && !controller_done(&controller); n++) {
            pc_cycle();
        }
        CHECK_EQ(controller_done(&controller), !stops);
        CHECK_EQ(controller_status(&controller, &panel) == CONTROLLER_PAUSED, stops);
    }
    pc_press(&panel.start);
    while (!controller_done(&controller) && now < LONG) {
        pc_cycle();
    }
    pc_at(910.0, 0.0, 510.0, 1e-6);

    struct fault_list all;
    begin("G0 X900 Y0 Z500 A180 C180\nG38.2 X910 F100\nX1 Q2\nM19\n");
    orders_check(&config.orders, &text, &controller.robot.pose, &all);
    CHECK(all.count == 2 && all.of[0].fault == FAULT_NO_PROBE && all.of[0].line == 2);
    CHECK(all.of[1].fault == FAULT_UNUSED && all.of[1].line == 3 && all.notes == 1);
}

int main(void)
{
    lines();
    arcs();
    winding();
    corners();
    switches();
    refused();
    asked();
    return check_result();
}
