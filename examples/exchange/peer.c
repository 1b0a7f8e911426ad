/* A peer of `motionfmu live --exchange` in plain C: a spring and a damper that hold an axis.
 *
 *     cc -O2 -o peer peer.c && ./peer PORT HOST HOST_PORT SECONDS [STIFFNESS DAMPING]
 *
 * It hears on PORT one position [m] and one speed [m/s] of each datagram, and answers with the
 * force [N] = -stiffness position - damping speed. A datagram, little endian, is the same both
 * ways: "MFX1", number, number heard last, simulated time [ns], flags, count of values, values.
 * At its end it prints what came, what was lost on the way, and how late: the histogram of the
 * times between two datagrams. */
#define _POSIX_C_SOURCE 200809L
#include <arpa/inet.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum { HEAD = 24, VALUES_MAX = 180, CLASSES = 24 };

struct datagram {
    char magic[4];
    uint32_t number, heard;
    uint64_t time; /* [ns] */
    uint16_t flags, count;
    double value[VALUES_MAX];
} __attribute__((packed));

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* The class of a time: [0] up to 1 us, then each twice as long as the one before. */
static int class_of(double seconds)
{
    int k = 0;
    for (double end = 1e-6; seconds > end && k < CLASSES - 1; end *= 2.0) {
        k++;
    }
    return k;
}

/* A socket that hears on a port of this machine for 0.1 s at a time; -1. */
static int open_link(const char *port)
{
    struct sockaddr_in own = { .sin_family = AF_INET, .sin_port = htons((uint16_t)atoi(port)) };
    const struct timeval wait = { .tv_usec = 100000 };
    const int s = socket(AF_INET, SOCK_DGRAM, 0);
    own.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (s < 0 || bind(s, (struct sockaddr *)&own, sizeof own) != 0) {
        return -1;
    }
    setsockopt(s, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    return s;
}

/* Hear one datagram with two values; false if none came. */
static bool hear(int s, struct datagram *in)
{
    const ssize_t size = recv(s, in, sizeof *in, 0);
    return size == HEAD + 16 && memcmp(in->magic, "MFX1", 4) == 0 && in->count == 2;
}

static void print_times(const unsigned long late[CLASSES])
{
    for (int k = 0; k < CLASSES; k++) {
        if (late[k]) {
            printf("  up to %8.0f: %lu\n", (double)(1u << k), late[k]);
        }
    }
}

int main(int argc, char **argv)
{
    if (argc != 5 && argc != 7) {
        fprintf(stderr, "peer PORT HOST HOST_PORT SECONDS [STIFFNESS DAMPING]\n");
        return 2;
    }
    const double stiffness = argc == 7 ? atof(argv[5]) : 1e5;
    const double damping = argc == 7 ? atof(argv[6]) : 1e3;
    struct sockaddr_in host = { .sin_family = AF_INET, .sin_port = htons((uint16_t)atoi(argv[3])) };
    const int s = open_link(argv[1]);
    if (s < 0 || inet_pton(AF_INET, argv[2], &host.sin_addr) != 1) {
        perror("peer");
        return 1;
    }
    const double end = now() + atof(argv[4]);
    uint32_t number = 0, last = 0;
    unsigned long taken = 0, missing = 0, late[CLASSES] = { 0 };
    double before = 0.0;
    while (now() < end) {
        struct datagram in, out = { .magic = { 'M', 'F', 'X', '1' }, .count = 1 };
        if (!hear(s, &in)) {
            continue;
        }
        const double at = now();
        missing += last && in.number > last + 1 ? in.number - last - 1 : 0;
        late[class_of(before > 0.0 ? at - before : 0.0)]++;
        before = at;
        last = in.number;
        taken++;
        out.number = ++number;
        out.heard = last;
        out.time = in.time;
        out.value[0] = -stiffness * in.value[0] - damping * in.value[1];
        sendto(s, &out, HEAD + 8, 0, (struct sockaddr *)&host, sizeof host);
    }
    printf("taken %lu, missing %lu; times between two [us]:\n", taken, missing);
    print_times(late);
    close(s);
    return taken ? 0 : 1;
}
