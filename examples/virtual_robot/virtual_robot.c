/* A program on the virtual robot: moves by calls, one of them refused, then a job in the robot
 * language. motionfmu.virtual.robot.robot_example does the same.
 *
 *     cc -O2 virtual_robot.c $(pkg-config --cflags --libs motionfmu-robot_station) -o virtual_robot
 *     ./virtual_robot plate.job plate.points
 */
#include <stdio.h>

#include <motionfmu/robot_station.h>
#include <motionfmu/short_names.h>
#include <motionfmu/controller_words.h>

static struct robot_station station; /* 600 kB: not on the stack */
static struct robot_job_points points;
static struct robot_job_program jobs;

/* Run and print ten times a second until all rests. */
static void run(const struct orders_text *program)
{
    struct robot_station_reading r;
    do {
        robot_station_run(&station, station.clock + FPGA_CLOCK_HZ / 10, program);
        robot_station_read(&station, &r);
        printf("%6.1f s  X %9.3f  Y %9.3f  Z %9.3f mm  %6.2f mm/s  OT %d\n",
               (double)station.clock / FPGA_CLOCK_HZ, r.pose[0], r.pose[1], r.pose[2],
               station.controller.robot.speed, (int)station.card.outputs);
    } while (!r.rests);
    printf("pulses %lld %lld %lld, underruns %d, error %d\n", (long long)r.pulses[0],
           (long long)r.pulses[1], (long long)r.pulses[2], (int)station.card.underruns,
           (int)station.controller.trouble.error);
}

/* A line or a circle's end: X Y Z [mm], A B C [deg], feed [mm/s]. */
static int move(enum robot_kind kind, const double to[6], const double *via)
{
    struct robot_move m = { .kind = kind,
                            .feed = 200.0,
                            .share = 0.5,
                            .zone = 2.0,
                            .target = { .branch = ROBOT_ANY_BRANCH, .pose = pose_of(to, to + 3) } };
    struct robot_refusal why;
    char words[CONTROLLER_WORDS];

    for (int i = 0; via && i < 3; i++) {
        m.via[i] = via[i];
    }
    const enum robot_status status =
        controller_move(&station.controller, &station.config, &m, &station.tool, &why);
    if (status != ROBOT_OK) {
        controller_refusal_words(status, &why, words);
        printf("%s\n", words);
    }
    return status != ROBOT_OK;
}

static int calls(void)
{
    static const double START[6] = { 1000.0, 0.0, 700.0, 180.0, 0.0, 180.0 },
                        VIA[3] = { 1100.0, 100.0, 700.0 },
                        END[6] = { 1000.0, 200.0, 700.0, 180.0, 0.0, 180.0 },
                        FAR[6] = { 2000.0, 0.0, 700.0, 180.0, 0.0, 180.0 };

    if (move(ROBOT_JOINTS, START, NULL) || move(ROBOT_CIRCLE, END, VIA)) {
        return 1;
    }
    run(NULL);
    return !move(ROBOT_LINE, FAR, NULL);
}

/* The text of a file; its length. */
static int64_t read_file(const char *name, char text[65536])
{
    FILE *file = fopen(name, "r");
    if (!file) {
        perror(name);
        return 0;
    }
    const int64_t length = (int64_t)fread(text, 1, 65536, file);
    fclose(file);
    return length;
}

static int job(const char *name, const char *points_name)
{
    static char text[65536];
    struct robot_job_report r;
    char message[ROBOT_JOB_MESSAGE_MAX];
    const struct orders_text program = { .job = &jobs, .points = &points };

    robot_job_points_clear(&points, ROBOT_JOB_NO_AXIS);
    if (robot_job_points_read(&points, ROBOT_JOB_NO_AXIS, text, read_file(points_name, text), &r)
            < 0
        || robot_job_read(&jobs, &points, text, read_file(name, text), &r) < 0) {
        robot_job_message(&r, text, message);
        printf("%s\n", message);
        return 1;
    }
    station.controller.start.pressed = true;
    run(&program);
    return station.controller.trouble.error != CONTROLLER_OK;
}

int main(int argc, char **argv)
{
    struct robot_station_config config = robot_station_defaults();
    struct controller_wrong wrong;

    config.controller.ik_time = 30e-6;
    if (!robot_station_start(&station, &config, &wrong)) {
        printf("%s = %g\n", wrong.name, wrong.value);
        return 1;
    }
    return calls() || (argc > 2 && job(argv[1], argv[2]));
}
