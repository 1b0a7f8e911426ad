#include "brake.h"

#include <math.h>

#include "el_extremes.h"

void brake_rest(struct brake *b)
{
    b->count = 1;
    b->step[0] = (struct brake_step){ 0.0, 0.0 };
}

/* The two neighbours that differ least in speed become one. */
static void merge(struct brake_step *step, int32_t count)
{
    int32_t k = 0;

    for (int32_t i = 1; i + 1 < count; i++) {
        k = step[i + 1].speed - step[i].speed < step[k + 1].speed - step[k].speed ? i : k;
    }
    step[k].even = step[k + 1].even;
    for (int32_t i = k + 1; i + 1 < count; i++) {
        step[i] = step[i + 1];
    }
}

void brake_limit(struct brake *b, double speed, double even)
{
    struct brake_step all[BRAKE_STEPS + 1];
    int32_t n = 0, from = 0;

    while (from < b->count && b->step[from].speed < speed) {
        all[n++] = b->step[from++];
    }
    if (n == 0 || even > all[n - 1].even) {
        all[n++] = (struct brake_step){ speed, even };
    }
    for (; from < b->count; from++) {
        if (b->step[from].even > all[n - 1].even) { /* else the step before says more */
            all[n++] = b->step[from];
        }
    }
    if (n > BRAKE_STEPS) {
        merge(all, n--);
    }
    for (int32_t i = 0; i < n; i++) {
        b->step[i] = all[i];
    }
    b->count = n;
}

static double braked(const struct brake_step *s, double way, double dec)
{
    return way <= s->even ? s->speed : sqrt(s->speed * s->speed + 2.0 * dec * (way - s->even));
}

void brake_back(struct brake *b, double way, double dec)
{
    double least = INFINITY; /* [mm/s] what steps allow that are no longer even here */
    int32_t n = 0, from = 0;

    for (; from < b->count && b->step[from].even <= way; from++) {
        least = el_min(least, braked(&b->step[from], way, dec));
    }
    if (from == b->count || least < b->step[from].speed) {
        b->step[n++] = (struct brake_step){ least, 0.0 };
    }
    for (; from < b->count; from++) {
        b->step[n++] = (struct brake_step){ b->step[from].speed, b->step[from].even - way };
    }
    b->count = n;
}

struct brake_segment brake_next(const struct brake *b, double s, double place, double dec)
{
    struct brake_segment p = { place, INFINITY, INFINITY };

    for (int32_t i = 0; i < b->count; i++) {
        if (place - b->step[i].even > s) {
            p.end = el_min(p.end, place - b->step[i].even);
        } else {
            p.top = el_min(p.top, b->step[i].speed);
        }
    }
    for (int32_t i = 0; i < b->count; i++) {
        p.leave = el_min(p.leave, braked(&b->step[i], place - p.end, dec));
    }
    p.leave = el_min(p.leave, p.top);
    return p;
}
