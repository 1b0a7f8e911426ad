/* A card's state from outside with one thing wrong is refused. */
#include "card_bench.h"

static struct netcard c, good;

/* With the statement done to it, the state is refused; what it was before is none the worse. */
#define REFUSED(...) \
    do { \
        __VA_ARGS__; \
        CHECK(netcard_damage(&c, c.now) != NULL); \
        memcpy(&c, &good, sizeof c); \
        CHECK(netcard_damage(&c, c.now) == NULL); \
    } while (0)

static void card(void)
{
    REFUSED(c.settings.tick_ns = 0);
    REFUSED(c.now += 20);
    REFUSED(c.boot = -1);
    REFUSED(c.state = NET_STATES);
    REFUSED(c.resumes = NET_PAUSED);
    REFUSED(c.first = NETCARD_ORDERS);
    REFUSED(c.first = -1);
    REFUSED(c.orders = NETCARD_ORDERS + 1);
    REFUSED(c.order[3].command = CARD_COMMANDS);
    REFUSED(c.jobs = INT32_MAX);
    REFUSED(c.result.count = INT32_MAX);
    REFUSED(c.dropped = -1);
    REFUSED(c.zero[2] = INT64_MAX);
    REFUSED(c.latch[0] = INT64_MIN);
    REFUSED(c.origin[3] = INT64_MAX);
    REFUSED(c.served[10] = -1);
    REFUSED(c.place.slot = 2);
    REFUSED(c.place.bytes = FLASH_BYTES + 1);
    REFUSED(c.place.slot = -1; c.page.wanted = true);
    REFUSED(c.reader.page.frames = JOB_PAGE_FRAMES + 1);
    REFUSED(c.reader.at = -1);
    REFUSED(c.reader.at = c.reader.page.frames + 1);
    REFUSED(c.reader.header.events = JOB_EVENTS + 1);
    REFUSED(c.reader.header.rest = c.reader.header.events + 1);
    REFUSED(c.loading = -1);
    REFUSED(c.way[1].commanded = INT64_MAX);
    REFUSED(c.way[2].speed = NAN);
    REFUSED(c.way[3].rest = -1.0);
    REFUSED(c.reader.frame = c.reader.header.frames + 1);
}

static void parts(void)
{
    REFUSED(c.kernel.config.tasks = 7);
    REFUSED(c.kernel.config.tick = -1);
    REFUSED(c.kernel.config.tick = 0);
    REFUSED(c.kernel.next_tick = c.kernel.processor.clock + 2 * c.kernel.config.tick);
    REFUSED(c.kernel.current = KERNEL_TASKS);
    REFUSED(c.kernel.first = NETCARD_TASKS);
    REFUSED(c.kernel.asked = KERNEL_TASKS + NETCARD_INTERRUPTS);
    REFUSED(c.kernel.asked = (c.kernel.current + 1) % NETCARD_TASKS);
    REFUSED(c.kernel.events = -1);
    REFUSED(c.kernel.turns = INT64_MAX);
    REFUSED(c.kernel.processor.tasks = PROCESSOR_TASKS + 1);
    REFUSED(c.kernel.processor.running = PROCESSOR_TASKS);
    REFUSED(c.kernel.processor.clock++);
    REFUSED(c.kernel.processor.task[NETCARD_TASKS].ready = true);
    REFUSED(c.kernel.processor.task[KERNEL_TASKS + NETCARD_INTERRUPTS].ready = true);
    REFUSED(c.kernel.processor.task[NETCARD_RUN].left = -1);
    REFUSED(c.kernel.processor.task[NETCARD_RUN].busy = -1);
    REFUSED(c.kernel.processor.task[(c.kernel.current + 1) % NETCARD_TASKS].ready = true);
    REFUSED(c.kernel.task[NETCARD_TASKS].ready = true);
    REFUSED(c.kernel.task[KERNEL_TASKS].ready = false);
    REFUSED(c.kernel.task[NETCARD_RUN].priority = -1);
    REFUSED(c.kernel.task[NETCARD_RUN].base = 1001);
    REFUSED(c.kernel.task[NETCARD_RUN].rank = -1);
    REFUSED(c.kernel.task[NETCARD_RUN].since = c.kernel.ticks + 1);
    REFUSED(c.kernel.task[NETCARD_RUN].turn = INT64_MAX);
    REFUSED(c.kernel.task[NETCARD_RUN].place = INT64_MAX);
    REFUSED(c.kernel.task[NETCARD_RUN].queue = KERNEL_QUEUES);
    REFUSED(c.kernel.task[NETCARD_RUN].call = KERNEL_CALLS);
    REFUSED(c.kernel.task[NETCARD_RUN].notified = KERNEL_NOTIFY_STATES);
    REFUSED(c.kernel.task[NETCARD_RUN].wake = -1);
    REFUSED(c.kernel.task[NETCARD_RUN].ticks = -1);
    REFUSED(c.kernel.task[NETCARD_RUN].result = KERNEL_IN_VAIN - 1);
    REFUSED(c.kernel.queue[3].count = 2);
    REFUSED(c.kernel.queue[3].first = KERNEL_ITEMS);
    REFUSED(c.kernel.queue[3].holder = NETCARD_TASKS);
    REFUSED(c.kernel.config.queue[3].kind = KERNEL_KINDS);
    REFUSED(c.kernel.pending[NETCARD_INTERRUPTS] = 0);
    REFUSED(c.flash.work = (enum flash_work)3);
    REFUSED(c.flash.at = -1; c.flash.work = FLASH_ERASE);
    REFUSED(c.store.waiting = STORE_BUFFER + 1);
    REFUSED(c.store.slots = 3);
    REFUSED(c.player.clock++);
    REFUSED(c.player.fifo.stock = FRAME_FIFO_LARGEST + 1);
    REFUSED(c.player.fifo.head = -1);
    REFUSED(c.inputs.pending = 1u << 16);
    REFUSED(c.outputs.levels = 1u << 16);
    REFUSED(c.load.latest = CARD_LOAD_MARKS);
    REFUSED(c.load.mark[3].clock = c.kernel.processor.clock + 1);
    REFUSED(c.load.mark[0].busy[6] = -1);
    REFUSED(c.load.mark[3].clock = c.kernel.processor.clock;
            c.load.mark[3].busy[2] = kernel_busy(&c.kernel, 2) + 1);
    REFUSED(c.load.mark[3].clock = c.kernel.processor.clock;
            c.load.mark[3].busy[6] = 0);        /* more in no time than there is */
    REFUSED(c.session.channel.held = NET_FRAME + 1);
    REFUSED(c.session.channel.out_first = NET_OUT);
}

/* Each setting at either end of its range: what a card starts with is a state of it. */
static void ends(const struct card_settings *usual)
{
    struct netcard_config config = bench_config();
    struct card_wrong wrong;
    int started = 0;

#define ENDS(type, name, elements, unit, start, low, high, words) \
    for (int end = 0; end < 2; end++) { \
        config.settings = *usual; \
        *(type *)&config.settings.name = (type)(end ? (high) : (low)); \
        if (card_settings_good(&config.settings, &wrong)) { \
            bench_start(&c, &config); \
            CHECK(netcard_damage(&c, c.now) == NULL); \
            started++; \
        } \
    }
    CARD_SETTINGS(ENDS)
    CHECK(started > 100);
}

int main(void)
{
    const struct netcard_config config = bench_config();

    bench_make(1000, 100, NULL, 0);
    bench_start(&c, &config);
    CHECK_EQ(bench_order(&c, CARD_DO_START), NET_DONE);
    bench_pass(&c, 100);
    memcpy(&good, &c, sizeof good);
    CHECK(netcard_damage(&c, c.now) == NULL);
    card();
    parts();
    ends(&config.settings);
    return check_result();
}
