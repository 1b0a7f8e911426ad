#include "quaternion.h"

#include <math.h>
#include <string.h>

#include "elementary.h"

static const double DEGREE = 0.017453292519943295;

/* Sine of half the angle between two orientations that count as nearly equal: its square is lost in
 * rounding. */
static const double NEARLY = 1e-8;

/* Cosine of B below which A and C turn about the same axis. */
static const double UPRIGHT = 1e-9;

void quaternion_product(const double a[4], const double b[4], double c[4])
{
    const double p[4] = { a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0] };
    memcpy(c, p, sizeof p);
}

void quaternion_inverse(const double a[4], double c[4])
{
    const double p[4] = { a[0], -a[1], -a[2], -a[3] };
    memcpy(c, p, sizeof p);
}

void quaternion_normalise(double a[4])
{
    const double n = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2] + a[3] * a[3]);
    for (int i = 0; i < 4; i++) {
        a[i] = n > 0.0 ? a[i] / n : i == 0 ? 1.0 : 0.0;
    }
}

void quaternion_turn(const double a[4], const double v[3], double turned[3])
{
    double m[3][3];

    quaternion_matrix(a, m);
    const double r[3] = { m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2],
                          m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2],
                          m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2] };
    memcpy(turned, r, sizeof r);
}

void quaternion_by_vector(const double v[3], double a[4])
{
    const double angle = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const struct el_turn half = el_sincos(0.5 * angle);
    const double per = angle > 0.0 ? half.sine / angle : 0.5;

    a[0] = half.cosine;
    for (int i = 0; i < 3; i++) {
        a[i + 1] = per * v[i];
    }
}

void quaternion_vector(const double a[4], double v[3])
{
    const double sine = sqrt(a[1] * a[1] + a[2] * a[2] + a[3] * a[3]);
    const double side = a[0] < 0.0 ? -1.0 : 1.0;
    const double per = sine > 0.0 ? 2.0 * el_atan2(sine, side * a[0]) / sine : 2.0;

    for (int i = 0; i < 3; i++) {
        v[i] = side * per * a[i + 1];
    }
}

void quaternion_slerp(const double a[4], const double b[4], double part, double c[4])
{
    const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
    const double side = dot < 0.0 ? -1.0 : 1.0;
    double across[4], sine = 0.0;

    for (int i = 0; i < 4; i++) {
        across[i] = side * b[i] - fabs(dot) * a[i];
        sine += across[i] * across[i];
    }
    sine = sqrt(sine);
    const double half = el_atan2(sine, fabs(dot));
    const double first = sine < NEARLY ? 1.0 - part : el_sin((1.0 - part) * half) / el_sin(half);
    const double last = sine < NEARLY ? part : el_sin(part * half) / el_sin(half);
    for (int i = 0; i < 4; i++) {
        c[i] = first * a[i] + last * side * b[i];
    }
    quaternion_normalise(c);
}

void quaternion_matrix(const double a[4], double m[3][3])
{
    const double w = a[0], x = a[1], y = a[2], z = a[3];
    const double r[3][3] = {
        { 1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y) },
        { 2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x) },
        { 2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y) }
    };
    memcpy(m, r, sizeof r);
}

/* The largest of the four first: it is at least 1/2. */
void quaternion_of_matrix(const double m[3][3], double a[4])
{
    const double trace = m[0][0] + m[1][1] + m[2][2];
    int i = 0;

    for (int k = 1; k < 3; k++) {
        i = m[k][k] > m[i][i] ? k : i;
    }
    if (trace > m[i][i]) {
        a[0] = 0.5 * sqrt(1.0 + trace);
        a[1] = (m[2][1] - m[1][2]) / (4.0 * a[0]);
        a[2] = (m[0][2] - m[2][0]) / (4.0 * a[0]);
        a[3] = (m[1][0] - m[0][1]) / (4.0 * a[0]);
    } else {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        a[i + 1] = 0.5 * sqrt(1.0 + m[i][i] - m[j][j] - m[k][k]);
        a[0] = (m[k][j] - m[j][k]) / (4.0 * a[i + 1]);
        a[j + 1] = (m[j][i] + m[i][j]) / (4.0 * a[i + 1]);
        a[k + 1] = (m[k][i] + m[i][k]) / (4.0 * a[i + 1]);
    }
    quaternion_normalise(a);
}

void quaternion_by_angles(const double angle[3], double a[4])
{
    double half[3][4] = { { 0 }, { 0 }, { 0 } };

    for (int i = 0; i < 3; i++) {
        const struct el_turn t = el_sincos(0.5 * DEGREE * angle[i]);
        half[i][0] = t.cosine;
        half[i][i + 1] = t.sine;
    }
    quaternion_product(half[2], half[1], a);
    quaternion_product(a, half[0], a);
}

void quaternion_angles(const double a[4], double angle[3])
{
    double m[3][3];

    quaternion_matrix(a, m);
    const double cosine = el_hypot(m[0][0], m[1][0]);
    angle[1] = el_atan2(-m[2][0], cosine) / DEGREE;
    if (cosine > UPRIGHT) {
        angle[0] = el_atan2(m[2][1], m[2][2]) / DEGREE;
        angle[2] = el_atan2(m[1][0], m[0][0]) / DEGREE;
    } else {
        angle[0] = el_atan2(-m[1][2], m[1][1]) / DEGREE;
        angle[2] = 0.0;
    }
}
