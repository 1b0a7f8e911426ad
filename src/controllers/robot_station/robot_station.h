/* robot_station - a whole robot control on one clock: PC with its robot controller, FPGA card, an
 * arm whose joints stand where the pulses are.
 *
 *     struct robot_station_config config = robot_station_defaults();
 *     struct robot_station *s = ...;                   one struct without pointers
 *     robot_station_start(s, &config, &wrong);
 *     controller_move(&s->controller, &s->config, &move, &s->tool, &why);    any call, between runs
 *     robot_station_run(s, s->clock + FPGA_CLOCK_HZ, NULL);        one second
 *     robot_station_read(s, &reading);
 *
 * PC and card meet on the bus grid k T_b, as the FMUs do whose communication step is T_b: what the
 * PC works out at an instant crosses at the next one with its clocks. A run cut in pieces gives the
 * same bits as one in one go.
 */
#ifndef ROBOT_STATION_H
#define ROBOT_STATION_H

#include "fpga_wires.h"
#include "controller_calls.h"
#include "controller_settings.h"

struct robot_station_config {
    struct controller_settings controller;
    struct fpga_config card; /* slot_clocks and format are those of the controller */
};

struct robot_station {
    struct controller controller;
    struct controller_config config;
    struct controller_panel panel; /* hold, override and single as you like; a key is pressed by
                              * controller.start.pressed, .abort, .reset, .teach, .replay */
    struct fpga card;
    struct fpga_host host; /* as published last */
    struct fpga_taken taken;
    struct pose tool;            /* of the user's moves */
    double ai[FPGA_ANALOG];      /* [V] pins, set them as you like; */
    uint32_t inputs;             /* a bit each, */
    uint32_t alarm;              /* of the drives, a bit an axis, */
    bool emergency;              /* and the emergency stop */
    double ai_seen[FPGA_ANALOG]; /* [V] by the card */
    int64_t clock;               /* [25 ns] everything up to here has happened */
    int64_t instant;             /* [clock] next instant of the bus grid */
};

/* What there is to see at the station's clock beside the state itself. Lengths in mm, angles in
 * deg. */
struct robot_station_reading {
    int64_t pulses[OPW_JOINTS];       /* put out */
    double joint[OPW_JOINTS];         /* where the arm is, */
    double pose[6];                   /* X Y Z A B C of its tip; */
    double external;                  /* [mm] [deg] of the axis outside the arm, */
    double external_command;          /* and at the end of the pulses written */
    double base_command[3];           /* where a track then has the arm's base */
    double joint_command[OPW_JOINTS]; /* at the end of the pulses written, */
    double pose_command[6];
    int32_t configuration; /* sum of enum opw_flag */
    double factors[3];     /* from singular: [mm], 1, 1 */
    int32_t status;        /* enum controller_status */
    int32_t line;          /* of the program, that moves; 0 none */
    bool done;             /* the program has ended and the arm rests */
    bool rests;            /* nothing is left to do and every pulse is out */
};

/* Settings of the robot controller; the card interrupts every 100 us at rest, an alarm of a drive
 * stops, a stop switches the drives off. */
struct robot_station_config robot_station_defaults(void);

/* Power on at clock 0, at rest. False: refused, nothing has changed, *wrong says why. */
bool robot_station_start(struct robot_station *s, const struct robot_station_config *config,
                         struct controller_wrong *wrong);

/* Run up to and including clock `until`; nothing if that has passed. The program begins, or goes on
 * behind a pause, once controller.start.pressed. */
void robot_station_run(struct robot_station *s, int64_t until, const struct orders_text *program);

void robot_station_read(const struct robot_station *s, struct robot_station_reading *r);

/* Plan each move of a part program from where the arm is: *trial is room, its trouble says which is
 * refused. */
void robot_station_rehearse(const struct robot_station *s, const struct orders_text *program,
                            struct controller *trial);

/* X Y Z A B C [mm], [deg] of a pose. */
void robot_station_pose(const struct pose *pose, double value[6]);

#endif
