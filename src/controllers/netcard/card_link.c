/* The parser task, and what the card has to tell the PC. */
#include "netcard_parts.h"

#include <string.h>

enum { FEW_PAGES = 4 };

static uint16_t credit(const struct netcard *c)
{
    return (uint16_t)job_store_credit(&c->store);
}

static uint16_t missing(const struct netcard *c)
{
    const int32_t page = job_store_missing(&c->store);

    return page < 0 ? NET_NO_PAGE : (uint16_t)page;
}

void card_tell_store(struct netcard *c)
{
    enum net_code code;

    if (job_store_ended(&c->store, &code)) {
        session_job(&c->session, code, (uint16_t)c->store.fault, credit(c), missing(c));
        if (c->state == NET_EMPTY || c->state == NET_READY) {
            card_rest(c);
        }
    }
    if (c->asked && job_store_known(&c->store)) {
        c->asked = false;
        c->credit = credit(c);
        session_job(&c->session, NET_DONE, 0, c->credit, missing(c));
    } else if (!c->asked && c->store.phase == STORE_TAKE && c->credit < FEW_PAGES
               && credit(c) >= 2 * FEW_PAGES) {
        c->credit = credit(c);
        session_ack(&c->session, c->credit, missing(c));
    }
}

static int job_begin(struct netcard *c, const uint8_t *payload)
{
    const struct card_rule rule = card_rule(c->state, CARD_DO_RECEIVE);
    enum net_code code = c->settings.write_during_run ? NET_DONE : rule.code;
    struct net_job_begin m;

    net_get_job_begin(payload, &m);
    if (card_job_under_way(c) && c->place.slot != c->store.job.slot) {
        code = NET_BUSY; /* the free slot is the one that is read */
    }
    if (card_job_under_way(c) && c->settings.slots == 1) {
        code = NET_BUSY;
    }
    if (code == NET_DONE) {
        code = job_store_begin(&c->store, m.bytes, m.hash, m.crc);
    }
    if (code != NET_DONE) {
        session_job(&c->session, code, 0, credit(c), missing(c));
        return -1;
    }
    if (c->state == NET_READY || c->state == NET_EMPTY) {
        card_rest(c);
    }
    c->asked = true;
    return NETCARD_GIVE_STORAGE;
}

static int job_data(struct netcard *c, const struct session_message *m)
{
    struct net_job_pages p;

    net_get_job_pages(m->payload, &p);
    for (uint32_t i = 0; i < p.count; i++) {
        const enum net_code code =
            job_store_page(&c->store, p.page + i,
                           m->payload + NET_BYTES_job_pages + i * NET_PAGE_BYTES);
        if (code != NET_DONE) {
            session_nak(&c->session, m->sequence, code, (uint16_t)(p.page + i));
            return NETCARD_GIVE_STORAGE;
        }
    }
    c->credit = credit(c);
    session_drop(&c->session); /* the credit counts from behind this message */
    session_ack(&c->session, c->credit, missing(c));
    return NETCARD_GIVE_STORAGE;
}

static int job_end(struct netcard *c, const uint8_t *payload)
{
    struct net_job_end m;

    net_get_job_end(payload, &m);
    const enum net_code code = job_store_end(&c->store, m.crc);
    if (code != NET_DONE) {
        session_job(&c->session, code, (uint16_t)c->store.fault, credit(c), missing(c));
        return -1;
    }
    return NETCARD_GIVE_STORAGE;
}

static void answer(struct netcard *c, uint32_t number, enum card_command command,
                   enum net_code code)
{
    c->result = (struct netcard_result){ c->result.count + 1, command, code };
    if (number) {
        session_result(&c->session, number, code, (uint8_t)c->state);
    }
}

static int order(struct netcard *c, uint32_t number, enum card_command command, uint32_t axes)
{
    enum net_code code;
    const int give = card_order(c, command, axes, &code);

    if (code == NET_CODES) {
        c->clear = CLEAR_GIVEN;
        c->clear_number = number;
        return -1;
    }
    answer(c, number, command, code);
    return give;
}

/* Answer the RESET that has waited for the drives: it is refused if a drive still has its alarm or
 * the emergency stop acts. */
static void end_clear(struct netcard *c)
{
    const enum net_code code = c->axes.stop || c->axes.alarm ? NET_ALARM : NET_DONE;

    c->clear = CLEAR_NONE;
    if (code == NET_DONE) {
        c->error = NET_DONE;
        card_rest(c);
    }
    answer(c, c->clear_number, CARD_DO_RESET, code);
}

static void output(struct netcard *c, const uint8_t *payload)
{
    struct net_output m;
    enum net_code code = NET_DONE;

    net_get_output(payload, &m);
    if (card_outputs_flag_pins(&c->outputs, m.pins,
                               &(struct mc_po){ 0, m.mode, m.level, m.width })) {
        card_pend(c, NETCARD_SOFTWARE);
    } else {
        code = NET_RANGE;
    }
    session_result(&c->session, m.number, code, (uint8_t)c->state);
}

static void config_set(struct netcard *c, const uint8_t *payload)
{
    enum net_code code = card_rule(c->state, CARD_DO_SET).code;
    struct net_config_set m;

    net_get_config_set(payload, &m);
    if (code == NET_DONE && !card_settings_set(&c->settings, m.id, m.index, m.value)) {
        code = NET_RANGE;
    }
    session_result(&c->session, m.number, code, (uint8_t)c->state);
}

static void config_get(struct netcard *c, const struct session_message *m)
{
    struct net_config_get q;
    struct net_config a;

    net_get_config_get(m->payload, &q);
    a.id = q.id;
    a.index = q.index;
    if (card_settings_get(&c->settings, q.id, q.index, &a.value)) {
        session_setting(&c->session, &a);
    } else {
        session_nak(&c->session, m->sequence, NET_RANGE, q.id);
    }
}

_Static_assert(NET_PAUSE - NET_START == (int)CARD_DO_PAUSE
                   && NET_STOP - NET_START == (int)CARD_DO_STOP
                   && NET_RESET - NET_START == (int)CARD_DO_RESET,
               "messages of commands in their order");

int card_message(struct netcard *c)
{
    struct session_message m;
    struct net_command n;
    struct net_home h;

    if (!session_next(&c->session, &m, c->now)) {
        return -1;
    }
    switch (m.type) {
    case NET_JOB_BEGIN: return job_begin(c, m.payload);
    case NET_JOB_DATA:  return job_data(c, &m);
    case NET_JOB_END:   return job_end(c, m.payload);
    case NET_HOME:
        net_get_home(m.payload, &h);
        return order(c, h.number, CARD_DO_HOME, h.axes & ((1u << CARD_AXES) - 1));
    case NET_OUTPUT:     output(c, m.payload); return -1;
    case NET_CONFIG_SET: config_set(c, m.payload); return -1;
    case NET_CONFIG_GET: config_get(c, &m); return -1;
    case NET_START:
    case NET_PAUSE:
    case NET_STOP:
    case NET_RESET:
        net_get_command(m.payload, &n);
        return order(c, n.number, (enum card_command)(m.type - NET_START), 0);
    default: return -1;
    }
}

static uint32_t switches(const struct netcard *c)
{
    const struct netcard_axes *a = &c->axes;

    return a->plus | a->minus << 4 | a->origin << 8 | a->alarm << 12 | c->homed << 16
           | (uint32_t)a->stop << 20;
}

void card_busy(const struct netcard *c, int64_t busy[CARD_LOADS])
{
    _Static_assert(CARD_LOADS == NETCARD_TASKS + 1, "the tasks, and all interrupts together");
    for (int i = 0; i < NETCARD_TASKS; i++) {
        busy[i] = kernel_busy(&c->kernel, i);
    }
    busy[NETCARD_TASKS] = 0;
    for (int i = 0; i < NETCARD_INTERRUPTS; i++) {
        busy[NETCARD_TASKS] += kernel_busy(&c->kernel, KERNEL_TASKS + i);
    }
}

void card_tell_status(struct netcard *c)
{
    struct net_status s = { .state = (uint8_t)c->state,
                            .error = (uint8_t)c->error,
                            .inputs = (uint16_t)c->input_levels,
                            .outputs = (uint16_t)c->outputs.levels,
                            .stock = (uint16_t)c->player.fifo.stock,
                            .job = card_job_under_way(c) ? c->played_id : c->store.job.id,
                            .frame = (uint32_t)netcard_frames(c),
                            .underflows = (uint32_t)c->player.dry,
                            .switches = switches(c),
                            .rate = (uint16_t)(player_rate(&c->player) * 1000.0),
                            .wear = flash_wear(&c->flash) };
    int64_t busy[CARD_LOADS];

    _Static_assert(sizeof s.load == 2 * CARD_LOADS, "what STATUS has room for");
    for (int i = 0; i < CARD_AXES; i++) {
        s.position[i] = (int32_t)netcard_position(c, i);
    }
    card_busy(c, busy);
    card_load_tell(&c->load, c->kernel.processor.clock, busy, s.load);
    session_status(&c->session, &s, c->now);
}

/* Act on the loss of the link, as the settings say. Returns the semaphore to be given, -1: none. */
static int lost(struct netcard *c)
{
    enum net_code code;

    switch (c->settings.on_link_loss) {
    case CARD_LOSS_PAUSE: return card_order(c, CARD_DO_PAUSE, 0, &code);
    case CARD_LOSS_STOP:  return card_order(c, CARD_DO_STOP, 0, &code);
    default:              return -1;
    }
}

/* Give a semaphore, if there is one. */
static void give(struct netcard *c, int semaphore)
{
    if (semaphore >= 0) {
        kernel_give(&c->kernel, semaphore);
    }
}

void card_parse(struct netcard *c)
{
    enum { LOAD, WAIT, LOOK, MESSAGE, ORDER, STATUS, CLEARED };
    struct session_message m;
    int semaphore;

    switch (c->step[NETCARD_PARSER]) {
    case LOAD: /* before all else: the job is looked for in the flash */
        card_spend(c, NETCARD_PARSER, c->loading, WAIT);
        return;
    case WAIT: card_take(c, NETCARD_PARSER, NETCARD_GIVE_BYTES, LOOK); return;
    case MESSAGE:
        c->step[NETCARD_PARSER] = LOOK;
        semaphore = card_message(c);
        session_drop(&c->session);
        give(c, semaphore);
        return;
    case ORDER:
        c->step[NETCARD_PARSER] = LOOK;
        semaphore =
            order(c, 0, (enum card_command)c->order[c->first].command, c->order[c->first].axes);
        c->first = (c->first + 1) % NETCARD_ORDERS;
        c->orders--;
        give(c, semaphore);
        return;
    case CLEARED:
        c->step[NETCARD_PARSER] = LOOK;
        end_clear(c);
        return;
    case STATUS:
        c->step[NETCARD_PARSER] = LOOK;
        card_tell_status(c);
        return;
    default: break;
    }
    if (c->clear == CLEAR_OVER) {
        card_work(c, NETCARD_PARSER, c->settings.step_cycles, CLEARED);
    } else if (c->orders > 0) {
        card_work(c, NETCARD_PARSER, c->settings.packet_cycles, ORDER);
    } else if (session_next(&c->session, &m, c->now)) {
        card_work(c, NETCARD_PARSER,
                  c->settings.packet_cycles + (int64_t)c->settings.byte_cycles * (int64_t)m.length,
                  MESSAGE);
    } else if (session_status_time(&c->session) <= c->now) {
        card_work(c, NETCARD_PARSER, c->settings.packet_cycles, STATUS);
    } else {
        c->step[NETCARD_PARSER] = WAIT;
        if (session_lost(&c->session)) {
            give(c, lost(c));
        }
    }
}

size_t netcard_receive(struct netcard *c, const uint8_t *bytes, size_t n)
{
    struct session_message m;
    const size_t taken = c->power ? session_bytes(&c->session, bytes, n, c->now) : 0;

    if (taken > 0 && session_next(&c->session, &m, c->now)) {
        card_pend(c, NETCARD_NETWORK);
    }
    return taken;
}

size_t netcard_send(struct netcard *c, uint8_t *bytes, size_t most)
{
    return c->power ? session_out(&c->session, bytes, most) : 0;
}

void netcard_connected(struct netcard *c, bool yes)
{
    struct session_about a = { .credit = credit(c), .state = (uint8_t)c->state };

    if (!c->power) {
        return;
    }
    if (yes) {
        if (c->store.job.slot >= 0) {
            memcpy(a.job, c->store.job.hash, sizeof a.job);
        }
        session_connected(&c->session, &a, c->now);
    } else {
        session_cut(&c->session, c->now);
    }
    card_pend(c, NETCARD_NETWORK);
}

bool netcard_wants_connection(const struct netcard *c)
{
    return c->power && session_wants(&c->session);
}
