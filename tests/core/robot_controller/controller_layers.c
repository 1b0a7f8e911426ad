/* Each layer's answer to each edge, to the clock, against a model that knows when every edge is and
 * looks for the first interrupt, tick and poll behind it. */
#include "controller_rig.h"

enum { EDGES = 400, PAUSE = 60000 };

static int64_t edge[LAYERS][EDGES], answer[LAYERS][EDGES];

/* The first clock from + k every at or behind a clock. */
static int64_t behind(int64_t clock, int64_t from, int64_t every)
{
    return clock <= from ? from : from + (clock - from + every - 1) / every * every;
}

static int64_t expected(enum layer layer, int64_t e, int64_t run)
{
    const struct layers_config *c = &config.layers;
    const int64_t seen = behind(e, 0, SLOT), of = behind(e, run, INTERVAL);
    const int64_t copied = of + WAIT + config.copy_in;
    int64_t at = 0;

    switch (layer) {
    case LAYER_INTERRUPT: at = seen + WAIT + c->access; break;
    case LAYER_DRIVER:    at = of + RUN; break;
    case LAYER_TIMER:
        for (int64_t tick = c->tick; at == 0; tick += c->tick) {
            const int64_t over = (tick + c->access) / config.bus * config.bus;
            at = over - config.bus >= seen ? tick + c->access : 0;
        }
        break;
    default: at = behind(behind(copied, c->poll, c->poll) - WAIT, run, INTERVAL) + RUN;
    }
    return behind(at, 0, SLOT);
}

static void watch(int count[LAYERS], int answered[LAYERS], int64_t origin[LAYERS])
{
    for (int i = 0; i < LAYERS; i++) {
        if (count[i] < EDGES && edge[i][count[i]] > now && edge[i][count[i]] <= now + config.bus) {
            fpga_change_input(&card, i, edge[i][count[i]++]);
        }
        if (card.output_clock[i] > origin[i]) {
            origin[i] = answer[i][answered[i]++] = card.output_clock[i];
        }
    }
}

static void each_edge(int64_t bus, int64_t access, int64_t poll, int64_t tick)
{
    const enum layer quickest = bus < SLOT ? LAYER_INTERRUPT : LAYER_DRIVER;
    uint64_t random = 7;
    int count[LAYERS] = { 0 }, answered[LAYERS] = { 0 };
    int64_t origin[LAYERS] = { 0 };

    rig_document();
    config.bus = bus;
    config.layers.access = access;
    config.layers.poll = poll;
    config.layers.tick = tick;
    for (int i = quickest; i < LAYERS; i++) {
        config.layers.follow[i] = 1u << i;
        for (int k = 0; k < EDGES; k++) {
            edge[i][k] = check_random(&random, (k + 1) * PAUSE, (k + 1) * PAUSE + PAUSE / 2);
        }
    }
    for (int i = 0; i < (int)quickest; i++) {
        count[i] = EDGES;
    }
    rig_power_on();
    while (now < (EDGES + 2) * PAUSE) {
        rig_instant();
        watch(count, answered, origin);
    }
    const int64_t run = card.irq.clock % INTERVAL + INTERVAL;
    for (int i = quickest; i < LAYERS; i++) {
        CHECK_EQ(answered[i], EDGES);
        for (int k = 0; k < answered[i] && check_failures < 20; k++) {
            CHECK_EQ(answer[i][k] - edge[i][k], expected(i, edge[i][k], run) - edge[i][k]);
        }
    }
    CHECK_EQ(card.late, 0);
    CHECK_EQ(card.underruns, 0);
}

/* Between polls there is a quantum more with the probability of a crowded PC. */
static void crowded(void)
{
    enum { POLLS = 100000 };
    struct layers_config c = { .poll = 100, .quantum = 300, .crowded = 0.3 };
    struct layers l;
    struct layers_copy seen;
    int64_t before = 100;

    layers_start(&l, &c, 3);
    for (int k = 0; k < POLLS; k++) {
        CHECK(layers_poll(&l, &c, INT64_MAX / 2, &seen));
        CHECK(l.poll - before == 100 || l.poll - before == 400);
        before = l.poll;
    }
    /* 5 sigma of a binomial number */
    CHECK_NEAR((double)(l.poll - 100 - POLLS * 100) / 300.0, 0.3 * POLLS, 5 * sqrt(0.21 * POLLS));
    CHECK_EQ(l.polls, POLLS);
}

/* What a layer has put out it does not put out again, and what it does not follow never. */
static void masks(void)
{
    struct layers_config c = { .follow = { [LAYER_DRIVER] = 0x6 } };
    struct layers l;
    struct layers_copy seen;
    struct outbox out = { 0 };

    layers_start(&l, &c, 1);
    layers_put(&l, &c, 0x3, 10, &out);
    layers_put(&l, &c, 0x3, 20, &out);
    CHECK_EQ(out.count, 1);
    layers_put(&l, &c, 0x5, 30, &out);
    CHECK_EQ(out.count, 2);
    CHECK_EQ(out.entry[0].mask, 0x2);
    CHECK_EQ(out.entry[0].value, 0x2);
    CHECK_EQ(out.entry[1].mask, 0x6);
    CHECK_EQ(out.entry[1].value, 0x4);
    CHECK_EQ(out.entry[1].clock, 30);
    /* A poll at the very clock counts, and asks once. */
    c = (struct layers_config){ .poll = 100, .follow = { [LAYER_USER] = 0x1 } };
    layers_start(&l, &c, 1);
    layers_copied(&l, 100, 0x1);
    CHECK(!layers_poll(&l, &c, 99, &seen));
    CHECK(layers_poll(&l, &c, 100, &seen));
    CHECK_EQ(seen.inputs, 0x1);
    CHECK_EQ(seen.clock, 100);
    out.count = 0;
    layers_put(&l, &c, 0, 110, &out);
    layers_put(&l, &c, 0, 210, &out);
    CHECK_EQ(out.count, 1);
    CHECK_EQ(out.entry[0].clock, 110);
}

int main(void)
{
    each_edge(20, ACCESS, 9137, 7123);
    each_edge(100, SLOT - WAIT + 1, 12000, 8000);
    each_edge(100, ACCESS, 4100, 4000);
    each_edge(500, ACCESS, 9137, 7123); /* twice the grid is less than a run */
    crowded();
    masks();
    return check_result();
}
