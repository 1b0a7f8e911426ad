/* Iteration: what it says is proved holds, against closed forms and fine steps. */
#include "chain_iterate.h"
#include "chain_rig.h"

static uint64_t seed = 23;

/* Where it says that joints are those to which others lead, the closed form stepped finely along
 * the straight way comes to the same. */
static void followed(const struct rig *r, double off)
{
    const struct chain_form f = rig_form(r);
    int same = 0;
    enum { PLACES = 100, STEPS = 200 };

    for (int n = 0; n < PLACES; n++) {
        double q[CHAIN_JOINTS], to[CHAIN_JOINTS], found[CHAIN_JOINTS], step[CHAIN_JOINTS];
        double all[CHAIN_BRANCHES][CHAIN_JOINTS], low[CHAIN_JOINTS], high[CHAIN_JOINTS];
        struct chain_pose pose, at;
        bool lost = false;
        rig_anywhere(&f.chain, &seed, q);
        memcpy(to, q, sizeof to);
        for (int i = 0; i < f.chain.joints; i++) {
            to[i] += check_real(&seed, -off, off);
            low[i] = -INFINITY;
            high[i] = INFINITY;
        }
        chain_forward(&f.chain, to, &pose);
        memcpy(found, q, sizeof found);
        if (chain_iterate(&f.chain, -1, f.size, &pose, found) != CHAIN_FOLLOWED) {
            continue;
        }
        chain_forward(&f.chain, found, &at);
        CHECK(rig_between(&at, &pose) < 1e-11);
        memcpy(step, q, sizeof step);
        for (int k = 1; k <= STEPS && !lost; k++) { /* parts of the way by the closed form */
            struct chain_pose part, start;
            chain_forward(&f.chain, q, &start);
            chain_iterate_between(&start, &pose, (double)k / STEPS, &part);
            const uint32_t there = chain_inverse(&f, &part, step, 0xff, all);
            double next[CHAIN_JOINTS];
            lost =
                chain_nearest(&f, there, (const double(*)[CHAIN_JOINTS])all, step, low, high, next)
                < 0;
            lost = lost || rig_apart(&f.chain, next, step) > 0.1;
            memcpy(step, next, sizeof step);
        }
        if (!lost) {
            CHECK(rig_apart(&f.chain, step, found) < 1e-6);
            same++;
        }
    }
    CHECK(same > PLACES / 2);
}

/* Close joints lead to the very solution, a pose out of reach to none; what is found far away is
 * one. */
static void found(const struct rig *r)
{
    const struct chain_form f = rig_form(r);
    int there = 0, back = 0;
    enum { PLACES = 60 };

    for (int n = 0; n < PLACES; n++) {
        double q[CHAIN_JOINTS], near[CHAIN_JOINTS], all[CHAIN_BRANCHES][CHAIN_JOINTS];
        struct chain_pose pose, at;
        rig_anywhere(&f.chain, &seed, q);
        chain_forward(&f.chain, q, &pose);
        for (int i = 0; i < f.chain.joints; i++) {
            near[i] = q[i] + check_real(&seed, -1e-4, 1e-4);
        }
        if (chain_inverse(&f, &pose, near, 1, all)) {
            back += rig_apart(&f.chain, all[0], q) < 1e-9;
            chain_forward(&f.chain, all[0], &at);
            CHECK(rig_between(&at, &pose) < 1e-11);
        }
        rig_anywhere(&f.chain, &seed, near);
        if (chain_inverse(&f, &pose, near, 1, all)) {
            there++;
            chain_forward(&f.chain, all[0], &at);
            CHECK(rig_between(&at, &pose) < 1e-11);
        }
        pose.at[2] += 3.0;
        CHECK_EQ(chain_inverse(&f, &pose, q, 1, all), 0);
    }
    CHECK(back > 0.97 * PLACES);
    CHECK(there > 0.9 * PLACES);
}

/* The gain is infinite where the arm is singular, and bounds what rates differences show. */
static void gains(void)
{
    const struct chain_form f = rig_form(&RIGS[1]);

    for (int n = 0; n < 100; n++) {
        double q[CHAIN_JOINTS], near[CHAIN_JOINTS], factor[3];
        struct chain_pose pose, moved;
        rig_anywhere(&f.chain, &seed, q);
        chain_factors(&f, q, factor);
        if (fabs(factor[0]) < 0.1 || fabs(factor[1]) < 0.1 || fabs(factor[2]) < 0.1) {
            continue;
        }
        const double gain = chain_iterate_gain(&f.chain, -1, f.size, q), h = 1e-6 * f.size;
        double most = 0.0;
        chain_forward(&f.chain, q, &pose);
        for (int i = 0; i < 3; i++) {
            moved = pose;
            moved.at[i] += h;
            memcpy(near, q, sizeof near);
            CHECK(chain_iterate(&f.chain, -1, f.size, &moved, near) == CHAIN_FOLLOWED);
            most = fmax(most, rig_apart(&f.chain, near, q) / 1e-6);
        }
        CHECK(most <= gain * (1.0 + 1e-3) && most > 0.05 * gain);
        q[4] = 0.0;
        CHECK(!(chain_iterate_gain(&f.chain, -1, f.size, q) < 1e12));
    }
}

int main(void)
{
    followed(&RIGS[1], 0.05);
    followed(&RIGS[0], 0.05);
    followed(&RIGS[11], 0.05);
    found(&RIGS[16]);
    found(&RIGS[17]);
    gains();
    return check_result();
}
