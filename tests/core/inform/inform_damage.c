/* A run that came back as bytes: what no program can have left is found, what one leaves is not. */
#include "inform_given.h"

static struct inform_run run;

/* Change one word of the state by hand. */
static void broken(const char *what, struct inform_run bad)
{
    if (!inform_damaged(&bad, &program)) {
        check_failures++;
        printf("%s is not found\n", what);
    }
}

#define BROKEN(change) \
    do { \
        struct inform_run bad = run; \
        bad.change; \
        broken(#change, bad); \
    } while (0)

/* Whatever passes runs on without leaving its arrays; the sanitizers see it. */
static void any_bytes(void)
{
    uint64_t seed = 11;
    int good = 0;
    for (int n = 0; n < 20000; n++) {
        struct inform_run other = run;
        unsigned char *byte = (unsigned char *)&other;
        for (int k = 0; k < 3; k++) {
            byte[check_random(&seed, 0, sizeof other - 1)] ^= 1u << check_random(&seed, 0, 7);
        }
        if (inform_damaged(&other, &program)) {
            continue;
        }
        good++;
        for (int k = 0; k < 20; k++) {
            const struct inform_inputs in = { .now = k, .reached = INT64_MAX, .di = (uint32_t)k };
            struct inform_request r;
            inform_next(&other, &program, &points, &in, 5, &r);
            CHECK(!inform_damaged(&other, &program));
        }
    }
    CHECK(good > 1000 && good < 19000);
}

int main(void)
{
    CHECK_EQ(read_program("LOOP 3\nCALL JOB:B\nMOVL P2\nWAIT IN#(1)=ON T=1\nENDLOOP\nJOB B\n"
                          "LOOP\nINC B001\nSET R002 0.5\nRET IF B001>5\nENDLOOP"), 0);
    inform_begin(&run, &program, &START);
    for (int n = 0; n < 3; n++) {
        const struct inform_inputs in = { .now = 1000 * n, .reached = 1 };
        struct inform_request r;
        inform_next(&run, &program, &points, &in, 50, &r);
        CHECK(!inform_damaged(&run, &program));
    }
    CHECK(run.began >= 0 && run.moves == 1);
    BROKEN(depth = -1);
    BROKEN(depth = INFORM_CALLS + 1);
    BROKEN(frame[0].pc = -1);
    BROKEN(frame[INFORM_CALLS].pc = program.count);
    BROKEN(frame[3].loop[7] = -2);
    BROKEN(whole[0][99] = 256);
    BROKEN(whole[0][0] = -1);
    BROKEN(whole[1][5] = 32768);
    BROKEN(whole[1][5] = -32769);
    BROKEN(real[99] = NAN);
    BROKEN(real[0] = INFINITY);
    BROKEN(moves = -1);
    BROKEN(moves = INT64_MAX);
    BROKEN(began = -2);
    BROKEN(idle = -1);
    BROKEN(idle = INFORM_IDLE_MAX + 1);
    BROKEN(speed[INFORM_VJ] = 0.0);
    BROKEN(speed[INFORM_V] = NAN);
    BROKEN(speed[INFORM_VR] = -1.0);
    BROKEN(rotary = 2);
    BROKEN(level = 9);
    BROKEN(level = -1);
    BROKEN(tool = 64);
    BROKEN(user = -1);
    BROKEN(ended = 2);
    BROKEN(fault = INFORM_FAULT_COUNT);
    any_bytes();
    return check_result();
}
