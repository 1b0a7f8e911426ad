/* Programmable inputs against a model that looks at each line at each unit of time. */
#include "check.h"

#include <string.h>

#include "card_inputs.h"

static struct card_inputs c;

/* --- The model: a line is one small machine; what its routine has to do is kept as a list. --- */
struct line {
    int level, known; /* at the pin; as the program believes */
    int queued;       /* 0, 1: the routine is to be called */
    int by_timer;     /* called for the end of the deaf time and nothing else */
    int left;         /* units of the deaf time; 0: over or none */
    int later;        /* the action waits */
};
static struct line model[CARD_INPUTS];
static long long lost, ignored;

static int is_wanted(const struct card_input *in, int level)
{
    switch (in->edge) {
    case CARD_EDGE_RISE: return level == 1;
    case CARD_EDGE_FALL: return level == 0;
    default:             return 1;
    }
}

static void model_level(int i, const struct card_input *in, int level)
{
    struct line *l = &model[i];
    if (level == l->level) {
        return;
    }
    l->level = level;
    if (l->left > 0) {
        ignored++;
    } else if (in->debounce > 0 || is_wanted(in, level)) {
        lost += l->queued;
        l->queued = 1;
        l->by_timer = 0;
    }
}

static void model_time(int i)
{
    struct line *l = &model[i];
    if (l->left > 0 && --l->left == 0 && (l->later || l->level != l->known)) {
        l->queued = l->by_timer = 1;
    }
}

static enum card_action model_routine(int i, const struct card_input *in)
{
    struct line *l = &model[i];
    const int at_once = in->action == CARD_PAUSE || in->action == CARD_STOP;
    l->queued = 0;
    if (in->debounce == 0) {
        return in->action;
    }
    const int later = l->later, timer = l->by_timer;
    l->later = l->by_timer = 0;
    if (l->level == l->known) {
        if (!timer) {
            l->left = (int)in->debounce;
        }
        return later || (!timer && at_once) ? in->action : CARD_NONE;
    }
    l->known = l->level;
    l->left = (int)in->debounce;
    if (is_wanted(in, l->level) && at_once) {
        return in->action;
    }
    l->later = is_wanted(in, l->level) && in->action != CARD_NONE;
    return CARD_NONE;
}

static const int vector_of[CARD_INPUTS] = { 0, 1, 2, 3, 4, 5, 5, 5, 5, 5, 6, 6, 6, 6, 6, 6 };

/* Random levels, slow and bouncing, and routines that come late. */
static void against_model(void)
{
    uint64_t seed = 11;
    long long actions = 0, served = 0, shared = 0;
    for (int run = 0; run < 600 && !check_failures; run += CHECK_EACH) {
        struct card_inputs_config k;
        for (int i = 0; i < CARD_INPUTS; i++) {
            k.line[i] =
                (struct card_input){ (enum card_action)check_random(&seed, 0, 5),
                                     (enum card_edge)check_random(&seed, 0, 2),
                                     check_random(&seed, 0, 2) ? check_random(&seed, 1, 60) : 0 };
        }
        uint32_t levels = (uint32_t)check_random(&seed, 0, 0xFFFF);
        const int often = (int)check_random(&seed, 1, 60), lazy = (int)check_random(&seed, 1, 30);
        card_inputs_start(&c, &k, levels);
        memset(model, 0, sizeof model);
        for (int i = 0; i < CARD_INPUTS; i++) {
            model[i].level = model[i].known = levels >> i & 1;
        }
        lost = ignored = 0;
        for (int now = 1; now < 3000; now++) {
            int64_t next = INT64_MAX;
            for (int i = 0; i < CARD_INPUTS; i++) {
                if (model[i].left > 0 && now - 1 + model[i].left < next) {
                    next = now - 1 + model[i].left;
                }
                model_time(i);
            }
            CHECK_EQ(card_inputs_next(&c), next);
            if (next == now) {
                card_inputs_advance(&c, now);
            }
            if (check_random(&seed, 0, often) == 0) {
                levels ^=
                    (uint32_t)(check_random(&seed, 0, 0xFFFF) & check_random(&seed, 0, 0xFFFF));
                for (int i = 0; i < CARD_INPUTS; i++) {
                    model_level(i, &k.line[i], levels >> i & 1);
                }
                card_inputs_set(&c, levels, now);
            }
            uint32_t vectors = 0;
            for (int i = 0; i < CARD_INPUTS; i++) {
                vectors |= (uint32_t)model[i].queued << vector_of[i];
            }
            CHECK_EQ(card_inputs_vectors(&c), vectors);
            while (vectors && check_random(&seed, 0, lazy) == 0) {
                int vector = (int)check_random(&seed, 0, CARD_VECTORS - 1), want = -1, count = 0;
                for (int i = CARD_INPUTS - 1; i >= 0; i--) {
                    if (vector_of[i] == vector && model[i].queued) {
                        want = i;
                        count++;
                    }
                }
                const struct card_input_served s = card_inputs_serve(&c, vector, now);
                CHECK_EQ(s.line, want);
                const enum card_action action =
                    want < 0 ? CARD_NONE : model_routine(want, &k.line[want]);
                CHECK_EQ(s.action, action);
                actions += action != CARD_NONE;
                served += want >= 0;
                shared += count > 1;
            }
            CHECK(c.lost == lost && c.ignored == ignored);
        }
    }
    printf("inputs: %lld served, %lld actions, %lld times the lowest of several\n", served, actions,
           shared);
    CHECK(CHECK_EACH > 1 || (served > 50000 && actions > 30000 && shared > 1000));
}

/* A button that bounces for 3 ms at each end, debounce 10 ms, routine 2 us behind the edge: actions
 * within `held` and 40 ms more [ns], and the time of the first. */
static int press(enum card_action action, enum card_edge edge, int64_t held, int bounces,
                 int64_t *first)
{
    struct card_inputs_config k = { .line = { [12] = { action, edge, 10000000 } } };
    uint64_t seed = 17;
    int64_t at[64], now = 0;
    int n = 0, actions = 0;
    for (int end = 0; end < 2; end++) {
        int64_t t = 1000000 + end * held;
        for (int i = 0; i < 2 * bounces + 1; i++) {
            at[n++] = t;
            t += check_random(&seed, 1000, 3000000 / (2 * bounces + 1));
        }
    }
    card_inputs_start(&c, &k, 0);
    *first = -1;
    for (int i = 0; now < held + 41000000;) {
        int64_t next = card_inputs_next(&c);
        next = i < n && at[i] < next ? at[i] : next;
        if (next > held + 41000000) {
            break;
        }
        now = next;
        card_inputs_advance(&c, now);
        if (i < n && at[i] == now) {
            card_inputs_set(&c, (uint32_t)(++i % 2) << 12, now);
        }
        if (card_inputs_vectors(&c)) {
            CHECK_EQ(card_inputs_vectors(&c), 1u << 6);
            now += 2000;
            if (card_inputs_serve(&c, 6, now).action == action) {
                *first = actions++ ? *first : now;
            }
        }
    }
    return actions;
}

static void buttons(void)
{
    int64_t first;
    for (int bounces = 0; bounces < 12; bounces++) {
        CHECK_EQ(press(CARD_STOP, CARD_EDGE_RISE, 100000000, bounces, &first), 1);
        CHECK_EQ(first, 1002000); /* the first edge, and the routine's latency */
        CHECK_EQ(press(CARD_START, CARD_EDGE_RISE, 100000000, bounces, &first), 1);
        CHECK_EQ(first, 11004000); /* the end of the deaf time */
        CHECK_EQ(press(CARD_PAUSE, CARD_EDGE_FALL, 100000000, bounces, &first), 1);
        CHECK_EQ(first, 101002000);
        CHECK_EQ(press(CARD_EVENT, CARD_EDGE_BOTH, 100000000, bounces, &first), 2);
        /* let go within the deaf time: stop has acted, a start does not */
        CHECK_EQ(press(CARD_STOP, CARD_EDGE_RISE, 5000000, bounces, &first), 1);
        CHECK_EQ(press(CARD_START, CARD_EDGE_RISE, 5000000, bounces, &first), 0);
    }
    /* a spike shorter than the latency of the routine */
    CHECK_EQ(press(CARD_STOP, CARD_EDGE_RISE, 500, 0, &first), 1);
    CHECK_EQ(press(CARD_START, CARD_EDGE_RISE, 500, 0, &first), 0);
}

/* Kept once while it is served, a second one is lost. */
static void one_deep(void)
{
    const struct card_inputs_config k = { .line = { [3] = { CARD_EVENT, CARD_EDGE_RISE, 0 } } };
    card_inputs_start(&c, &k, 0);
    CHECK_EQ(card_inputs_set(&c, 8, 10), 8);
    CHECK_EQ(card_inputs_serve(&c, 3, 11).line, 3);
    card_inputs_set(&c, 0, 12);
    card_inputs_set(&c, 8, 13);
    card_inputs_set(&c, 0, 14);
    card_inputs_set(&c, 8, 15);
    CHECK(c.lost == 1 && c.edges == 5);
    CHECK_EQ(card_inputs_serve(&c, 3, 16).action, CARD_EVENT);
    CHECK_EQ(card_inputs_serve(&c, 3, 17).line, -1);
}

int main(void)
{
    against_model();
    buttons();
    one_deep();
    return check_result();
}
